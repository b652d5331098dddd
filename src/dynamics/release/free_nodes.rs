//! Nodes without mass that carry no contact force, with the stiffness that holds them. Section 6 of
//! docs/theory.md, Releases.

use std::collections::BTreeSet;

use crate::contact::tolerances::TIED_ROW;
use crate::contact::{ClosedPair, Constraint, Corner, PairTarget};
use crate::dynamics::increment::Solved;
use crate::dynamics::step::{FactoredMatrix, StepProblem};
use crate::elements::Motion;
use crate::linear::{Assembled, Transformation, linear_solver};

/// The free nodes without mass of some bodies.
pub(super) struct FreeNodes {
    /// Their dofs as unknowns.
    pub map: Transformation,
    /// Elements at them.
    elements: Vec<usize>,
    /// Pattern of their stiffness.
    pattern: Assembled,
}

impl FreeNodes {
    /// Those of the bodies of the pairs `opened` that no closed pair holds at the end of an increment.
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

    /// Their stiffness K_ii in the configuration of a motion.
    pub fn stiffness(&self, problem: &StepProblem, motion: Motion) -> FactoredMatrix {
        let mut k = self.pattern.clone();
        for (list, &element) in self.elements.iter().enumerate() {
            k.add(list, &problem.elements.tangent(element, motion), 1.0);
        }
        FactoredMatrix::new(linear_solver(problem.settings.solver), k, &self.map)
    }

    /// Whether the gap of a constraint depends on them.
    pub fn open(&self, constraint: &Constraint) -> bool {
        let rows = &constraint.derivative_rows().normal;
        let mut entries = constraint.dofs.iter().zip(rows);
        entries.any(|(&dof, b)| b.abs() > TIED_ROW && !self.map.row(dof).is_empty())
    }
}

/// Which nodes are without mass, of the bodies of the pairs `opened`, and held by no closed pair.
fn free(problem: &StepProblem, solved: &Solved, opened: &[&ClosedPair]) -> Vec<bool> {
    let body_of = problem.parts.of_nodes();
    let targets = opened.iter().filter_map(|pair| pair_target(problem, pair));
    let nodes = targets.flat_map(|target| target.nodes);
    let bodies: BTreeSet<usize> = nodes.map(|node| body_of[node]).collect();
    let mut free = vec![false; body_of.len()];
    for node in problem.redistribution.massless() {
        free[node] = bodies.contains(&body_of[node]);
    }
    let acting = solved.forces.acting();
    for node in acting.flat_map(|(constraint, _)| constraint.nodes()) {
        free[node] = false;
    }
    free
}

/// Slave node and target of a closed pair.
pub(super) fn pair_target(problem: &StepProblem, pair: &ClosedPair) -> Option<PairTarget> {
    let mut slave = pair.key.slave_index;
    for contact in problem.contacts {
        let Some(&node) = contact.slaves.get(slave) else {
            slave -= contact.slaves.len();
            continue;
        };
        let [a, b] = contact.segments[pair.target.segment];
        let end = |corner: Corner| contact.segments[corner.next][1];
        return Some(PairTarget {
            slave_index: pair.key.slave_index,
            target: pair.target,
            nodes: [node, a, b, pair.target.corner.map_or(b, end)],
            from: None,
            friction: contact.friction,
        });
    }
    None
}
