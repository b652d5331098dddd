//! The correction of a pass while its solve goes on: gaps and slips at the contacts are known before its
//! end, and contact forces join its right-hand side. Section 5 of docs/theory.md, One solve.

use super::contact_system::ContactSystem;
use crate::contact::Constraint;
use crate::dynamics::step::ResponseVectors;
use crate::linear::LinearError;

/// u + W (f + B^T P) of some constraints, W being the inverse of the system matrix: at the nodes of the
/// constraints at any time, everywhere at the end.
pub(super) struct Response<'a> {
    /// Displacements u, over all dofs.
    start: &'a [f64],
    vectors: ResponseVectors,
}

impl<'a> Response<'a> {
    /// Begins with the forces `f`, over all dofs, and P = 0.
    ///
    /// # Errors
    /// A matrix without factors.
    pub fn begin(
        system: &mut ContactSystem,
        [start, f]: [&'a [f64]; 2],
        constraints: &[Constraint],
    ) -> Result<Self, LinearError> {
        let mut vectors = system.system.take_vectors();
        let ResponseVectors {
            nodes,
            unknowns,
            forces,
            at_nodes,
            ..
        } = &mut vectors;
        replace(nodes, constraints.iter().flat_map(Constraint::nodes));
        let dofs = nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]);
        let terms = dofs.flat_map(|dof| system.map.row(dof));
        replace(unknowns, terms.map(|term| term.0));
        forces.clear();
        at_nodes.resize(start.len(), 0.0);
        system.system.begin(system.map, f)?;
        Ok(Response { start, vectors })
    }

    /// Writes g + Gn y and Dt + Gt y of every constraint, y being the response so far, 0 where that is nothing.
    pub fn gaps_and_slips(
        &mut self,
        system: &mut ContactSystem,
        constraints: &[Constraint],
        found: &mut Vec<[f64; 2]>,
    ) {
        let start = self.start;
        let ResponseVectors {
            nodes,
            unknowns,
            values,
            at_nodes: y,
            ..
        } = &mut self.vectors;
        system.system.partial(unknowns, values);
        let value = |unknown: &usize| values[unknowns.partition_point(|u| u < unknown)];
        for &node in nodes.iter() {
            let of_dof = |dof: usize| -> f64 {
                let terms = system.map.row(dof).iter();
                terms.map(|(unknown, c)| c * value(unknown)).sum()
            };
            let mut own = [of_dof(2 * node), of_dof(2 * node + 1)];
            system.system.rotation().turn_node(node, &mut own);
            (y[2 * node], y[2 * node + 1]) =
                (start[2 * node] + own[0], start[2 * node + 1] + own[1]);
        }
        let after = |c: &Constraint| {
            [c.gap + c.gap_change(y), c.slip + c.slip_change(y)].map(|length| c.resolved(length))
        };
        found.clear();
        found.extend(constraints.iter().map(after));
    }

    /// Takes forces of the given constraints into the right-hand side, in place of those
    /// before; gaps and slips without them must have been asked for.
    pub fn set_forces<'c>(
        &mut self,
        system: &mut ContactSystem,
        acting: impl Iterator<Item = (&'c Constraint, [f64; 2])>,
    ) {
        let forces = &mut self.vectors.forces;
        forces.iter_mut().for_each(|force| force.1 = -force.1);
        let before = forces.len();
        for (constraint, force) in acting {
            for (node, mut force) in constraint.nodal_forces(force) {
                system.system.rotation().turn_node_back(node, &mut force);
                for (dof, force) in [2 * node, 2 * node + 1].into_iter().zip(force) {
                    let terms = system.map.row(dof).iter();
                    forces.extend(terms.map(|&(unknown, c)| (unknown, c * force)));
                }
            }
        }
        system.system.add(forces);
        forces.drain(..before);
    }

    /// Writes the response, over all dofs.
    ///
    /// # Errors
    /// A solution that is not finite.
    pub fn end(
        self,
        system: &mut ContactSystem,
        response: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        system.system.give_back(self.vectors);
        system.system.end(system.map, self.start, response)
    }
}

/// Puts numbers in place of those in a list: increasing, each once.
fn replace(list: &mut Vec<usize>, numbers: impl Iterator<Item = usize>) {
    list.clear();
    list.extend(numbers);
    list.sort_unstable();
    list.dedup();
}
