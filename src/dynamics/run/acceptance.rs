//! Checks that a converged increment must pass before it is accepted, and the failures of those that
//! do not. Section 4 of docs/theory.md, Cutback.

use super::nominal_increment::NominalIncrement;
use crate::dynamics::events::{FailedSubincrement, Subincrement};
use crate::dynamics::increment::Failed;
use crate::dynamics::ledger::{Ledger, check_energy_gain};
use crate::dynamics::results::{Failure, State};
use crate::dynamics::step::{Interval, StepPlace, StepProblem};

/// Most halvings of an increment because of the energy that contact puts in.
const GAIN_HALVINGS: u32 = 5;

/// An accepted subincrement, and the ledger with its energies.
pub(crate) struct Accepted {
    pub subincrement: Subincrement,
    pub ledger: Ledger,
}

impl Accepted {
    /// Accepts a converged subincrement, `halvings` times halved, of the `nominal` increment: its
    /// energies must be finite, and contact must put in none while halvings are left for that.
    pub fn new(
        problem: &StepProblem,
        (start, ledger): (&State, &Ledger),
        subincrement: Subincrement,
        halvings: u32,
        nominal: &NominalIncrement,
    ) -> Result<Self, FailedSubincrement> {
        let Subincrement {
            interval, solved, ..
        } = &subincrement;
        let dt = interval.dt;
        let may_be_halved = halvings < GAIN_HALVINGS && dt / 2.0 >= nominal.dt_min;
        let after = ledger.clone().with(problem, start, solved, dt);
        let checked = after.and_then(|after| match may_be_halved {
            true => check_energy_gain(problem, start, ledger, solved).map(|()| after),
            false => Ok(after),
        });
        match checked {
            Ok(ledger) => Ok(Accepted {
                subincrement,
                ledger,
            }),
            Err(cause) => Err(Box::new((
                subincrement.interval,
                Failed {
                    cause,
                    worst: None,
                    passes: subincrement.solved.passes,
                },
            ))),
        }
    }
}

/// The failure of increment number `increment`, `halvings` times halved.
pub(crate) fn failure(
    increment: usize,
    place: StepPlace,
    (interval, failed): (Interval, Failed),
    halvings: u32,
) -> Failure {
    let Failed {
        cause,
        worst,
        passes,
    } = failed;
    Failure {
        increment,
        step: place.number,
        time: interval.start.total,
        dt: interval.dt,
        cause,
        worst,
        passes,
        halvings,
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
