//! Checks that a converged increment must pass before it is accepted, and the failures of increments that do not pass.
//! See docs/theory/time.md, Cutback.

use super::nominal_increments::NominalIncrement;
use crate::contact::NodeAtSegment;
use crate::dynamics::events::{FailedSubincrement, Subincrement};
use crate::dynamics::increment::{Failed, Solved};
use crate::dynamics::landing::return_landings;
use crate::dynamics::ledger::{Ledger, check_balance, check_energy_gain};
use crate::dynamics::release::bring_to_rest;
use crate::dynamics::release_return::return_release;
use crate::dynamics::results::{Cause, Failure, State};
use crate::dynamics::step::{Interval, StepPlace, StepProblem, Workspace};

/// Largest number of times that an increment is halved because contact adds energy.
const GAIN_HALVINGS: u32 = 5;

/// Start of a subincrement: state and energies at the end of the last subincrement.
#[derive(Clone, Copy)]
pub(crate) struct SubincrementStart<'a> {
    pub state: &'a State,
    pub ledger: &'a Ledger,
}

/// An accepted subincrement, and the ledger with the energies of the subincrement.
pub(crate) struct Accepted {
    pub subincrement: Subincrement,
    pub ledger: Ledger,
}

impl Accepted {
    /// Finishes a converged subincrement of the `nominal` increment, which has been halved `halvings` times, and
    /// accepts the subincrement if it passes the checks.
    pub fn new(
        problem: &StepProblem,
        workspace: &mut Workspace,
        before: SubincrementStart,
        mut subincrement: Subincrement,
        halvings: u32,
        nominal: &NominalIncrement,
    ) -> Result<Self, FailedSubincrement> {
        let Subincrement {
            interval, solved, ..
        } = &mut subincrement;
        let may_be_halved = halvings < GAIN_HALVINGS && interval.dt / 2.0 >= nominal.dt_min;
        let finished = finish_motion(problem, workspace, before.state, *interval, solved);
        let accepted = finished.and_then(|()| {
            accept(
                problem,
                workspace,
                before,
                interval.dt,
                solved,
                may_be_halved,
            )
        });
        match accepted {
            Ok(ledger) => Ok(Accepted {
                subincrement,
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

/// Finishes the motion of a converged increment: brings released nodes to rest and gives back the energy that landings
/// and releases have removed. Fails if an element is turned inside out or a node has passed through a surface.
fn finish_motion(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &State,
    interval: Interval,
    solved: &mut Solved,
) -> Result<(), Cause> {
    let release = bring_to_rest(problem, workspace, start, interval, solved);
    problem.check_end(&solved.end)?;
    check_paths(problem, workspace, start, solved)?;
    let dt = interval.dt;
    return_landings(problem, workspace, start, dt, solved)?;
    return_release(problem, workspace, start, dt, solved, release)?;
    problem.follow_donors(&mut solved.end.v);
    problem.follow_donors(&mut solved.end.a);
    Ok(())
}

/// Enters a finished increment of length `dt` in the ledger. Fails if the energies are not finite or not in balance, or
/// if contact adds energy and the increment may be halved for that reason.
fn accept(
    problem: &StepProblem,
    workspace: &Workspace,
    before: SubincrementStart,
    dt: f64,
    solved: &Solved,
    may_be_halved: bool,
) -> Result<Ledger, Cause> {
    let ledger = before.ledger.clone();
    let ledger = ledger.entered(problem, workspace, before.state, solved, dt)?;
    if may_be_halved {
        check_energy_gain(problem, before.state, &ledger, solved)?;
    }
    check_balance(problem, workspace, &ledger, solved)?;
    Ok(ledger)
}

/// Checks that no node has entered a body on its straight path from U0 to U1. A depth within the
/// error that the tolerance of the passes leaves does not count as entry.
fn check_paths(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &State,
    solved: &Solved,
) -> Result<(), Cause> {
    let (end, unsolved) = (&solved.end, problem.unsolved(&solved.d));
    let closed = [&start.contact, &end.contact];
    let found = workspace.find_penetration([&start.u, &end.u], closed, &unsolved);
    found.map_or(Ok(()), |NodeAtSegment { nodes, .. }| {
        let [slave, a, b] = nodes;
        Err(Cause::Crossed {
            slave,
            segment: [a, b],
            prescribed: !problem.unknowns.moves(&nodes),
        })
    })
}

/// The failure of an attempt at the increment number `increment`, which has been halved `halvings`
/// times.
pub(crate) fn failure(
    increment: usize,
    place: StepPlace,
    interval: Interval,
    failed: Failed,
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
    checked.err().map(|cause| failure_at_start(cause, 0, place))
}

/// The failure of a step before its first increment, when the run has done `increment` increments.
pub(crate) fn failure_at_start(cause: Cause, increment: usize, place: StepPlace) -> Failure {
    Failure {
        increment,
        step: place.number,
        time: place.start,
        dt: 0.0,
        cause,
        course: None,
        worst: None,
        passes: Vec::new(),
        halvings: 0,
    }
}
