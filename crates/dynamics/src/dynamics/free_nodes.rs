//! Nodes without mass that carry no contact force, and the stiffness of the elements at these nodes. See
//! docs/theory/impacts.md, Releases.

use std::collections::BTreeSet;

use super::increment::Solved;
use super::step::{FactoredMatrix, StepProblem};
use crate::contact::tolerances::TIED_ROW;
use crate::contact::{ClosedPair, Constraint};
use crate::elements::Motion;
use crate::linear::{Assembled, Transformation, linear_solver};

/// The free nodes without mass of some bodies.
pub(super) struct FreeNodes {
    /// Map from the dofs of the free nodes to unknowns.
    pub map: Transformation,
    /// Elements at the free nodes.
    elements: Vec<usize>,
    /// Pattern of the stiffness of the elements at the free nodes.
    pattern: Assembled,
}

impl FreeNodes {
    /// The free nodes of the bodies of the pairs `opened`: no closed pair acts on them at the end of an increment.
    pub fn new(problem: &StepProblem, solved: &Solved, opened: &[&ClosedPair]) -> Self {
        let is_free = free(problem, solved, opened);
        let touches = |&element: &usize| {
            let mut nodes = problem.elements.nodes(element).iter();
            nodes.any(|&node| is_free[node])
        };
        let elements: Vec<usize> = (0..problem.elements.len()).filter(touches).collect();
        let mut unknowns = 0;
        let row = |dof: usize| match is_free[dof / 2] && problem.unknowns.depends(dof) {
            true => {
                unknowns += 1;
                vec![(unknowns - 1, 1.0)]
            }
            false => Vec::new(),
        };
        let rows: Vec<_> = (0..2 * is_free.len()).map(row).collect();
        let map = Transformation::new(unknowns, rows);
        let of_node = |&node: &usize| [2 * node, 2 * node + 1];
        let nodes = |&element: &usize| problem.elements.nodes(element);
        let dofs = |element: &usize| nodes(element).iter().flat_map(of_node).collect();
        let lists: Vec<Vec<usize>> = elements.iter().map(dofs).collect();
        FreeNodes {
            pattern: Assembled::new(&map, &lists),
            map,
            elements,
        }
    }

    /// Stiffness K_ii of the free nodes in the configuration of a motion.
    pub fn stiffness(&self, problem: &StepProblem, motion: Motion) -> FactoredMatrix {
        let mut k = self.pattern.clone();
        for (list, &element) in self.elements.iter().enumerate() {
            k.add(list, &problem.elements.tangent(element, motion), 1.0);
        }
        FactoredMatrix::new(
            (linear_solver(problem.settings.solver), problem.method()),
            k,
            &self.map,
        )
    }

    /// Whether the gap of a constraint depends on free nodes (without mass and contact force).
    pub fn open(&self, constraint: &Constraint) -> bool {
        let rows = &constraint.derivative_rows().normal;
        let mut entries = constraint.dofs.iter().zip(rows);
        entries.any(|(&dof, b)| b.abs() > TIED_ROW && !self.map.row(dof).is_empty())
    }
}

/// For every node whether it is without mass, belongs to a body of the pairs `opened`, and has no
/// closed pair.
fn free(problem: &StepProblem, solved: &Solved, opened: &[&ClosedPair]) -> Vec<bool> {
    let body_of = problem.parts.of_nodes();
    let nodes = opened.iter().flat_map(|closed| closed.pair().nodes);
    let bodies: BTreeSet<usize> = nodes.map(|node| body_of[node]).collect();
    let mut free = vec![false; body_of.len()];
    for node in problem.redistribution.massless() {
        free[node] = bodies.contains(&body_of[node]);
    }
    for (constraint, _) in solved.contact.forces.acting() {
        // next to a vertex the row at the far end of the segment is only round-off
        let rows = (constraint.dofs.iter()).zip(&constraint.derivative_rows().normal);
        let held = rows.filter(|(_, b)| b.abs() > TIED_ROW);
        held.for_each(|(&dof, _)| free[dof / 2] = false);
    }
    free
}
