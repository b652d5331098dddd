//! Kinds of contact constraints: which kind is made for which target. Section 3 of docs/theory.md.

use nalgebra::DMatrix;

use super::constraint::{Configurations, Constraint};
use super::projection::project;
use super::targets::PairTarget;
use super::{disc, node_to_corner, node_to_segment, surface_to_surface};

impl Constraint {
    /// The constraint of a slave node at its target.
    pub fn new(source: PairTarget, at: &Configurations) -> Self {
        if !source.points.is_empty() {
            return surface_to_surface::constraint(source, at);
        }
        if let Some(round) = source.round {
            return disc::constraint(source, &round, at);
        }
        match source.target.corner {
            None => node_to_segment::constraint(source, at),
            Some(corner) => node_to_corner::constraint(source, corner, at),
        }
    }

    /// Contact stiffness Kc of the contact force, eq. (4.12), over the dofs of the constraint (force/length).
    pub fn stiffness(&self, force: [f64; 2], at: &Configurations) -> DMatrix<f64> {
        let change = self.change(force, at);
        (&change + change.transpose()) / 2.0
    }

    /// Change of its contact force with the iterate, d(Bn^T Pn + Bt^T Pt)/dU at constant Pn and Pt, over its dofs
    /// (force/length): not symmetric under friction.
    pub fn change(&self, force: [f64; 2], at: &Configurations) -> DMatrix<f64> {
        match (&self.source.points[..], &self.source.round) {
            ([], None) => self.change_of_node(force, at),
            ([], Some(round)) => disc::change(&self.source, round, force, at),
            (points, _) => surface_to_surface::change(self, points, force, at),
        }
    }

    /// Whether the slave node of a pair is beyond the ends of its segment in the iterate.
    pub fn is_beyond_ends(&self, at: &Configurations) -> bool {
        let PairTarget { nodes, target, .. } = &self.source;
        let [s, a, b] = at.iterate([nodes[0], nodes[1], nodes[2]]);
        target.corner.is_none() && !(0.0..=1.0).contains(&project(s, a, b).xi)
    }

    /// The same constraint at the start, with the segment that holds the node there.
    pub fn at_start(&self, start: &Configurations) -> Self {
        let mut source = surface_to_surface::at_start(self.source.clone().allowing(0));
        if let Some(round) = &mut source.round
            && let Some(from) = round.from.take()
        {
            (source.nodes[1], source.nodes[2], round.arc) =
                (from.nodes[0], from.nodes[1], from.arc);
        }
        if let Some(from) = source.from.take() {
            let [a, b] = from.ends;
            (source.nodes[1], source.nodes[2], source.nodes[3]) = (a, b, b);
            source.bulges = [from.bulge; 2];
        }
        Constraint {
            mu: self.mu,
            mu_varies: self.mu_varies,
            shrinkage: self.shrinkage,
            ..Constraint::new(source, start)
        }
    }

    /// The same constraint between other configurations, at whose start the same target holds the node.
    pub fn untilted(&self, at: &Configurations) -> Self {
        Constraint::new(self.source.clone().untilted(), at)
    }

    /// Its gap between other configurations, and the length that it is relative to there.
    pub fn gap_and_scale(&self, at: &Configurations) -> (f64, f64) {
        let source = &self.source;
        if source.points.is_empty() && source.round.is_none() && source.target.corner.is_none() {
            return node_to_segment::gap_and_scale(source, at);
        }
        let other = self.relinearized(at);
        (other.gap, other.scale)
    }

    /// The same constraint between other configurations.
    pub fn relinearized(&self, at: &Configurations) -> Self {
        Constraint {
            mu: self.mu,
            mu_varies: self.mu_varies,
            ..Constraint::new(self.source.clone(), at)
        }
    }
}
