//! Checks that a converged increment must pass before it is accepted, and the failures of those that
//! do not. Section 4 of docs/theory.md, Cutback.

use super::nominal_increment::NominalIncrement;
use crate::contact::{ClosedPairs, Penetration};
use crate::dynamics::events::{FailedSubincrement, Subincrement};
use crate::dynamics::increment::{Failed, Solved};
use crate::dynamics::landing::return_landings;
use crate::dynamics::ledger::{Ledger, check_energy_gain};
use crate::dynamics::results::{Cause, Failure, State};
use crate::dynamics::step::{Interval, StepPlace, StepProblem, Workspace, sum};

/// Most halvings of an increment because of the energy that contact puts in.
const GAIN_HALVINGS: u32 = 5;

/// Where a subincrement starts from: motion, closed pairs and energies at the end of the last one.
#[derive(Clone, Copy)]
pub(crate) struct Before<'a> {
    pub state: &'a State,
    pub closed: &'a ClosedPairs,
    pub ledger: &'a Ledger,
}

/// An accepted subincrement, and the ledger with its energies.
pub(crate) struct Accepted {
    pub subincrement: Subincrement,
    pub ledger: Ledger,
}

impl Accepted {
    /// Accepts a converged subincrement, `halvings` times halved, of the `nominal` increment, and gives
    /// back what its landings have taken: no node may have gone through a surface, the energies must be finite, and contact must put in none while
    /// halvings are left for that.
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
        let checked = check_paths(problem, workspace, before, solved)
            .and_then(|()| return_landings(problem, workspace, interval.dt, solved))
            .and_then(|()| {
                let ledger = before.ledger.clone();
                ledger.with(problem, before.state, solved, interval.dt)
            })
            .and_then(|after| match may_be_halved {
                true => {
                    check_energy_gain(problem, before.state, before.ledger, solved).map(|()| after)
                }
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
                    course: None,
                    worst: None,
                    passes: subincrement.solved.passes,
                },
            ))),
        }
    }
}

/// No node may have gone into a body on its straight path from U0 to U0 + d. What the tolerance of the
/// passes leaves of a displacement is no depth.
fn check_paths(
    problem: &StepProblem,
    workspace: &mut Workspace,
    before: Before,
    solved: &Solved,
) -> Result<(), Cause> {
    let largest = problem.parts.largest_of_bodies(&solved.d);
    let unsolved = |&body: &usize| problem.settings.tolerance * largest[body];
    let unsolved: Vec<f64> = problem.parts.of_nodes().iter().map(unsolved).collect();
    let (u0, u1) = (&before.state.u, sum(&before.state.u, &solved.d));
    let closed = [before.closed, &solved.forces.closed];
    let found = workspace.find_penetration([u0, &u1], closed, &unsolved);
    found.map_or(Ok(()), |Penetration { slave, segment }| {
        let [a, b] = segment;
        if std::env::var("DBGP").is_ok() { 
            let (p,q)=(problem.place(u0,[slave,a,b]),problem.place(&u1,[slave,a,b]));
            eprintln!("crossed slave {slave} segment {segment:?} start xi {} gap {:e} end xi {} gap {:e} len {}",p.xi,p.gap,q.xi,q.gap,q.length);
            for (c,f) in solved.forces.iter() { if c.nodes().any(|n| n==slave||n==a||n==b) { eprintln!("  pair {:?} gap {:e} start_gap {:e} force {:?} from {:?}", c.source.nodes, c.gap, c.start_gap, f.map(|f| f.force), c.source.from); } }
            for c in before.closed.iter() { eprintln!("  before {:?}", c.key); }
        }
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
