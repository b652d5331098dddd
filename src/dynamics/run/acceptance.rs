//! Checks that a converged increment must pass before it is accepted, and the failures of those that
//! do not. Section 4 of docs/theory.md, Cutback.

use super::time_control::NominalIncrement;
use crate::contact::{ClosedPairs, Penetration};
use crate::dynamics::events::{FailedSubincrement, Subincrement};
use crate::dynamics::increment::{Failed, Returned, Solved};
use crate::dynamics::landing::{return_landings, return_release};
use crate::dynamics::ledger::{Ledger, check_balance, check_energy_gain};
use crate::dynamics::release::{ReleaseStart, bring_to_rest};
use crate::dynamics::results::{Cause, Failure, State};
use crate::dynamics::step::{Interval, StepPlace, StepProblem, Workspace};

/// Most halvings of an increment because of the energy that contact puts in.
const GAIN_HALVINGS: u32 = 5;

/// Where a subincrement starts from: motion, closed pairs and energies at the end of the last one.
#[derive(Clone, Copy)]
pub(crate) struct Before<'a> {
    pub state: &'a State,
    pub closed: &'a ClosedPairs,
    pub ledger: &'a Ledger,
}

/// An accepted subincrement, what is given back after it, and the ledger with its energies.
pub(crate) struct Accepted {
    pub subincrement: Subincrement,
    pub returned: Returned,
    pub ledger: Ledger,
}

impl Accepted {
    /// Accepts a converged subincrement, `halvings` times halved, of the `nominal` increment, if it passes
    /// the checks.
    pub fn new(
        problem: &StepProblem,
        workspace: &mut Workspace,
        before: Before,
        mut subincrement: Subincrement,
        halvings: u32,
        nominal: &NominalIncrement,
    ) -> Result<Self, FailedSubincrement> {
        let Subincrement {
            interval, solved, ..
        } = &mut subincrement;
        let may_be_halved = halvings < GAIN_HALVINGS && interval.dt / 2.0 >= nominal.dt_min;
        match checked(
            problem,
            workspace,
            before,
            (*interval, solved),
            may_be_halved,
        ) {
            Ok((returned, ledger)) => Ok(Accepted {
                subincrement,
                returned,
                ledger,
            }),
            Err(cause) => Err(Box::new((
                subincrement.interval,
                Failed {
                    cause,
                    course: None,
                    worst: None,
                    passes: subincrement.solved.passes,
                },
            ))),
        }
    }
}

/// Checks a converged increment, brings released nodes to rest, gives back what landings and releases have
/// taken and enters it in the ledger: no element may be turned inside out, no node may have gone through a surface, the
/// energies must be finite and in balance, and contact must put in none where the increment may be halved for that.
fn checked(
    problem: &StepProblem,
    workspace: &mut Workspace,
    before: Before,
    (interval, solved): (Interval, &mut Solved),
    may_be_halved: bool,
) -> Result<(Returned, Ledger), Cause> {
    let start = ReleaseStart {
        state: before.state,
        closed: before.closed,
    };
    let release = bring_to_rest(problem, workspace, start, interval, solved);
    problem.check_end(&solved.end)?;
    check_paths(problem, workspace, before, solved)?;
    let dt = interval.dt;
    let from = (before.state, dt);
    let mut returned = return_landings(problem, workspace, from, solved)?;
    return_release(problem, workspace, from, solved, (release, &mut returned))?;
    problem.follow_donors(&mut solved.end.v);
    problem.follow_donors(&mut solved.end.a);
    let ledger = before.ledger.clone();
    let ledger = ledger.with(problem, before.state, (solved, &returned), dt)?;
    if may_be_halved {
        check_energy_gain(problem, before.state, &ledger, solved)?;
    }
    check_balance(problem, &workspace.stiffness, &ledger, solved)?;
    Ok((returned, ledger))
}

/// No node may have gone into a body on its straight path from U0 to U1. What the tolerance of the
/// passes leaves of a displacement is no depth.
fn check_paths(
    problem: &StepProblem,
    workspace: &mut Workspace,
    before: Before,
    solved: &Solved,
) -> Result<(), Cause> {
    let unsolved = problem.unsolved(&solved.d);
    let (u0, u1) = (&before.state.u, &solved.end.u);
    let closed = [before.closed, &solved.forces.closed];
    let found = workspace.find_penetration([u0, u1], closed, &unsolved);
    found.map_or(Ok(()), |Penetration { slave, segment, .. }| {
        let [a, b] = segment;
        Err(Cause::Crossed {
            slave,
            segment,
            prescribed: !problem.unknowns.moves(&[slave, a, b]),
        })
    })
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
        course,
        worst,
        passes,
    } = failed;
    Failure {
        increment,
        step: place.number,
        time: interval.start.total,
        dt: interval.dt,
        cause,
        course,
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
        course: None,
        worst: None,
        passes: Vec::new(),
        halvings: 0,
    })
}
