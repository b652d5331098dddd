//! Solves frictional problems with free unknowns for which the warm active set finds no solution, or a solution with
//! unstable free unknowns. See docs/theory/complementarity.md, Free unknowns.

use nalgebra::DVector;

use super::known::Known;
use super::problems::{ContactState, Counters, FrictionalLcp, FrictionalSolution, LcpError};
use super::scaled::Scaled;

/// Stiffness that resists free unknowns in proximal steps, relative to the mean stiffness of the contacts.
const RESISTED: f64 = 1e-2;
/// Number of proximal steps with this stiffness. After these steps each step goes [`FARTHER`] times as far as the last
/// one; [`STEPS`] is the total number.
const STEADY_STEPS: usize = 20;
const FARTHER: f64 = 4.0;
const STEPS: usize = 30;
/// Largest number of contacts to which an unstable body tips over, one after the other.
const TIPS: usize = 4;

/// Function that solves a problem without free unknowns, from data known about it.
type SolveResisted = fn(&FrictionalLcp, Option<Known>) -> Result<FrictionalSolution, LcpError>;

/// Function that returns the answer of the active set from some states.
type FromStates =
    fn(&FrictionalLcp, &Scaled, &[ContactState], &mut Counters) -> Option<FrictionalSolution>;

/// Functions that solve the intermediate problems.
pub(super) struct Solvers {
    pub resisted: SolveResisted,
    pub from_states: FromStates,
}

/// Solves problems in which `part` times E resists the free unknowns, by proximal steps, until the active set finds a
/// solution from the states of their answers:
///
/// ```text
/// (S + part E) x = L^T P + h + part E x_last    eq. (8.9)
/// ```
///
/// The error is that of the first of these problems that has no answer.
pub(super) fn search(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    known: Option<Known>,
    (solvers, counters): (&Solvers, &mut Counters),
) -> Result<FrictionalSolution, LcpError> {
    let mut error = None;
    let mut last: Option<FrictionalSolution> = None;
    let diagonal = problem.free.regular.diagonal();
    let mut part = (RESISTED / (problem.compliance() * diagonal.mean())).max(1.0);
    for step in 0..STEPS {
        let x = last.as_ref().map(|last| &last.free);
        let states = last.as_ref().map(|last| &last.state[..]);
        let from = match states {
            Some(states) => Some(Known {
                states,
                joints: known.map_or(&Vec::new, |known| known.joints),
            }),
            None => known,
        };
        match solve_resisted(&problem.resisted(part, x), from, (solvers, counters)) {
            Ok(found) => {
                if states != Some(&found.state[..])
                    && let Some(solution) =
                        (solvers.from_states)(problem, scaled, &found.state, counters)
                {
                    return Ok(solution);
                }
                if step >= STEADY_STEPS {
                    part = (part / FARTHER).max(1.0);
                }
                last = Some(found);
            }
            Err(failed) => {
                error.get_or_insert(failed);
                part *= FARTHER;
            }
        }
    }
    let (pivots, members) = (counters.pivots, Vec::new());
    Err(error.unwrap_or(LcpError::Ray { pivots, members }))
}

/// The answer of a problem whose free unknowns are resisted; these unknowns are eliminated.
fn solve_resisted(
    problem: &FrictionalLcp,
    known: Option<Known>,
    (solvers, counters): (&Solvers, &mut Counters),
) -> Result<FrictionalSolution, LcpError> {
    let found = (solvers.resisted)(&problem.eliminated(), known)?;
    *counters += found.counters;
    let forces: Vec<f64> = found.pn.iter().chain(&found.pt).copied().collect();
    let free = problem.free.balanced(&forces);
    Ok(FrictionalSolution { free, ..found })
}

/// The stable solution to which an unstable one tips over along a motion of its free unknowns; `None` if there is no
/// such solution.
pub(super) fn tip_over(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    (solution, mut motion): (&FrictionalSolution, DVector<f64>),
    (solvers, counters): (&Solvers, &mut Counters),
) -> Option<FrictionalSolution> {
    let mut last = None;
    for _ in 0..TIPS {
        let states = problem.tipped(last.as_ref().unwrap_or(solution), &motion)?;
        let found = (solvers.from_states)(problem, scaled, &states, counters)?;
        match problem.unstable_motion(&found.state) {
            None => return Some(found),
            Some(further) => motion = further,
        }
        last = Some(found);
    }
    None
}
