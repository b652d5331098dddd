//! Data that one frictional problem leaves to the next, similar one: the factors of its last system, and the memory of
//! its solves. See docs/numerics.md, Kept factors of a complementarity problem.

use bumpalo::Bump;

use super::dense::Factors;
use super::problems::{ContactState, FrictionalSolution, Spare};
use super::scaled::Scaled;
use crate::archive::{Archive, ArchiveError};

/// Factors of the system of some states, and the memory of the solves.
#[derive(Default)]
pub struct KeptFactors {
    kept: Option<Kept>,
    /// Arena in which the lists of a solve lie.
    pub(super) arena: Bump,
    pub(super) spare: Spare,
}

/// Factors with a description of their system: the states, and the units of its entries.
#[derive(serde::Serialize, serde::Deserialize)]
struct Kept {
    states: Vec<ContactState>,
    /// Number of free unknowns.
    free: usize,
    weights: Vec<f64>,
    compliance: f64,
    factors: Factors,
}

impl KeptFactors {
    /// Transfers the factors.
    ///
    /// # Errors
    /// The archive does not hold factors.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        archive.transfer(&mut self.kept)
    }

    /// Keeps the memory of a solution that is not needed any more, for the next one.
    pub fn take(&mut self, solution: FrictionalSolution) {
        self.spare.take(solution);
    }

    /// Whether there are factors.
    pub(super) fn has_factors(&self) -> bool {
        self.kept.is_some()
    }

    /// Forgets the factors.
    pub(super) fn forget(&mut self) {
        self.kept = None;
    }

    /// The factors, if they belong to a system of the same states in the same units.
    pub(super) fn serving(&self, scaled: &Scaled, states: &[ContactState]) -> Option<&Factors> {
        let kept = self.kept.as_ref()?;
        let are_same = kept.states == states
            && kept.free == scaled.free
            && *kept.weights == *scaled.weights
            && kept.compliance == scaled.compliance;
        are_same.then_some(&kept.factors)
    }

    /// Keeps the factors of the system of the given states.
    pub(super) fn keep(&mut self, scaled: &Scaled, states: &[ContactState], factors: Factors) {
        self.kept = Some(Kept {
            states: states.to_vec(),
            free: scaled.free,
            weights: scaled.weights.to_vec(),
            compliance: scaled.compliance,
            factors,
        });
    }
}
