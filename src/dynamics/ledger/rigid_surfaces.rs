//! Resultant reactions of rigid surfaces at their reference nodes. Section 9 of docs/theory.md.

use crate::dynamics::results::RigidReaction;
use crate::dynamics::step::StepProblem;
use crate::model::{Model, RigidBody};

/// The rigid surfaces of a model with their nodes.
pub(crate) struct RigidSurfaces(Vec<(RigidBody, Vec<usize>)>);

impl RigidSurfaces {
    /// Those that have a reference node.
    pub fn new(model: &Model) -> Self {
        let with_nodes = |body: &RigidBody| {
            let surface = &model.surfaces[body.surface];
            (*body, surface.nodes(&model.mesh))
        };
        RigidSurfaces(model.rigid_bodies.iter().map(with_nodes).collect())
    }

    /// Number of surfaces.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Moves the reactions from the nodes of the surfaces to the reference nodes, in the
    /// configuration of displacements `u`: the force sum R_a and the moment sum (x_a - x_ref) x
    /// R_a, eq. (9.9).
    pub fn collect(
        &self,
        problem: &StepProblem,
        u: &[f64],
        reaction: &mut [f64],
    ) -> Vec<RigidReaction> {
        let of_surface = |(body, nodes): &(RigidBody, Vec<usize>)| {
            let center = problem.position(u, body.reference);
            let mut sum = RigidReaction::default();
            for &node in nodes {
                let [fx, fy] = [2 * node, 2 * node + 1].map(|p| std::mem::take(&mut reaction[p]));
                let x = problem.position(u, node);
                sum.force[0] += fx;
                sum.force[1] += fy;
                sum.moment += (x[0] - center[0]) * fy - (x[1] - center[1]) * fx;
            }
            reaction[2 * body.reference] += sum.force[0];
            reaction[2 * body.reference + 1] += sum.force[1];
            sum
        };
        self.0.iter().map(of_surface).collect()
    }
}
