//! Largest values of a run so far, which are lower bounds of the scales of its increments. See docs/theory/time.md,
//! Convergence.

use super::parts::{Parts, PerBody};
use super::step_problem::StepProblem;
use crate::archive::{Archive, ArchiveError};
use crate::linear::larger;

/// Round-off of a sum of some terms, relative to its largest term.
pub(crate) const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// Largest displacement of every body and largest force of every part so far. A body that has carried a load keeps the
/// round-off of this load. So a small remainder does not become the scale after loads, displacements and motions have
/// gone back to zero.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Seen {
    /// Displacement of every body (length).
    displacement: PerBody,
    /// Load and internal force of every part (force). The list omits inertia and contact forces, which grow without
    /// bound as increments become shorter.
    force: PerBody,
}

impl Seen {
    /// The values before the first increment of a run, all zero.
    pub fn new(parts: &Parts) -> Self {
        let none = |count: usize| std::iter::repeat_n(0.0, count).collect();
        Seen {
            displacement: none(parts.bodies()),
            force: none(parts.of_parts().len()),
        }
    }

    /// Transfers all values to or from an archive.
    ///
    /// # Errors
    /// The archive belongs to another model.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        archive.transfer_values(&mut self.displacement)?;
        archive.transfer_values(&mut self.force)
    }

    /// Enters the displacement, load and internal force of an increment.
    pub fn take_in(&mut self, problem: &StepProblem, u: &[f64], forces: [&[f64]; 2]) {
        let parts = problem.parts;
        let forces = forces.map(|force| problem.unknowns.magnitudes(force));
        let of_increment = [
            parts.largest_of_bodies(u),
            parts.largest_of_all(forces.iter().map(|force| force.as_ref())),
        ];
        let own = [&mut self.displacement, &mut self.force];
        for (most, values) in own.into_iter().zip(&of_increment) {
            enlarge(most, values);
        }
    }

    /// Largest displacements so far, including the displacements of an iterate.
    pub fn displacements(&self, mut of_iterate: PerBody) -> PerBody {
        enlarge(&mut of_iterate, &self.displacement);
        of_iterate
    }

    /// Part of the displacements of every body (also of an iterate) that the passes do not resolve: the tolerance times
    /// the largest displacement so far, or the round-off of positions (length).
    pub fn unresolved(&self, problem: &StepProblem, u: &[f64]) -> PerBody {
        let tolerance = problem.settings.tolerance;
        let mut all: PerBody = (self.displacement.iter())
            .map(|most| tolerance * most)
            .collect();
        for (node, &body) in problem.parts.of_nodes().iter().enumerate() {
            for x in problem.position(u, node) {
                all[body] = larger(all[body], ROUND_OFF * x.abs());
            }
        }
        all
    }

    /// Largest forces before the increment.
    pub fn forces(&self) -> &PerBody {
        &self.force
    }
}

/// Raises each value to the corresponding entry of `values`, if that entry is larger.
fn enlarge(most: &mut PerBody, values: &PerBody) {
    for (most, value) in most.iter_mut().zip(values) {
        *most = larger(*most, *value);
    }
}
