//! What a converged increment must pass before it is accepted (docs/theory.md, cutback).

use super::energy::Ledger;
use super::energy_check::check_energy_gain;
use crate::dynamics::increment::{Failed, Solved};
use crate::dynamics::results::{Failure, State};
use crate::dynamics::step::{StepPlace, StepProblem};

/// A converged increment and the ledger with it.
pub(crate) struct Accepted {
    pub solved: Solved,
    pub ledger: Ledger,
}

impl Accepted {
    /// A converged increment of length `dt` from `start`, with its energies.
    ///
    /// # Errors
    /// Energies that are not finite; energy that contact puts in, where the increment `may_be_halved`
    /// for it.
    pub fn new(
        problem: &StepProblem,
        (start, ledger): (&State, &Ledger),
        solved: Solved,
        dt: f64,
        may_be_halved: bool,
    ) -> Result<Self, Failed> {
        match ledger.clone().with(problem, start, &solved, dt) {
            Ok(after) => {
                let solved = match may_be_halved {
                    true => check_energy_gain(problem, start, ledger, solved)?,
                    false => solved,
                };
                Ok(Accepted {
                    solved,
                    ledger: after,
                })
            }
            Err(cause) => Err(Failed {
                cause,
                worst: None,
                passes: solved.passes,
            }),
        }
    }
}

/// The failure of a start whose motion or energies are not finite.
pub(crate) fn start_failure(state: &State, ledger: &Ledger, place: StepPlace) -> Option<Failure> {
    let checked = state.check_finite().and_then(|()| ledger.check(state));
    checked.err().map(|cause| Failure {
        increment: 0,
        step: place.number,
        time: place.start,
        dt: 0.0,
        cause,
        worst: None,
        passes: Vec::new(),
        halvings: 0,
    })
}
