//! Solutions of frictional problems with free unknowns where the warm active set finds none, or one whose free unknowns are
//! unstable. Section 8 of docs/theory.md, Free unknowns.

use nalgebra::DVector;

use super::basis::perturbation;
use super::known::Known;
use super::pivoted::Pivoted;
use super::problems::{ContactState, Counters, FrictionalLcp, FrictionalSolution, LcpError};
use super::scaled::Scaled;

/// Stiffness that resists free unknowns in proximal steps, beside that of the contacts in the mean.
const RESISTED: f64 = 1e-2;
/// Steps with that part, after which each goes so many times as far as the last one, and all of them.
const STEADY_STEPS: usize = 20;
const FARTHER: f64 = 4.0;
const STEPS: usize = 30;
/// Contacts that an unstable body tips over to at most.
const TIPS: usize = 4;
/// Paths of Lemke's method that are tried.
const PATHS: usize = 4;

/// Solves a problem without free unknowns, of which something is known.
type SolveResisted = fn(&FrictionalLcp, Option<Known>) -> Result<FrictionalSolution, LcpError>;

/// The answer of the active set from some states.
type FromStates =
    fn(&FrictionalLcp, &Scaled, &[ContactState], &mut Counters) -> Option<FrictionalSolution>;

/// What solves the problems on the way.
pub(super) struct Solvers {
    pub resisted: SolveResisted,
    pub from_states: FromStates,
}

/// An answer by proximal steps, else from the states that Lemke's method finds with the free unknowns pivoted in.
pub(super) fn search(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    known: Option<Known>,
    (solvers, counters): (&Solvers, &mut Counters),
) -> Result<FrictionalSolution, LcpError> {
    by_steps(problem, scaled, known, (solvers, counters))
        .or_else(|error| pivoted_in(problem, scaled, (solvers, counters)).ok_or(error))
}

/// The active set from the states of problems in which a part of E resists the free unknowns, whose answer moves on by
/// proximal steps until it serves:
///
/// ```text
/// (S + part E) x = L^T P + h + part E x_last    eq. (8.9)
/// ```
///
/// The error is that of the first of these problems without an answer.
fn by_steps(
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
                is_part: false,
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

/// The answer of a problem whose free unknowns are resisted, and eliminated.
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

/// The active set from the states of Lemke's method with the free unknowns pivoted in, along paths with several covering
/// vectors.
fn pivoted_in(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    (solvers, counters): (&Solvers, &mut Counters),
) -> Option<FrictionalSolution> {
    let pivoted = Pivoted::new(scaled)?;
    let mut covering = vec![1.0; pivoted.size()];
    for path in 0..PATHS {
        counters.lemke_calls += 1;
        if let Ok((states, pivots)) = pivoted.states(&covering) {
            counters.pivots += pivots;
            let solution = (solvers.from_states)(problem, scaled, &states, counters);
            if solution.is_some() {
                return solution;
            }
        }
        match path {
            0 => covering = perturbation(pivoted.size()),
            _ => covering.rotate_left(1),
        }
    }
    None
}

/// The solution whose free unknowns are stable that an unstable one tips over to along a motion of them, if there is any.
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
