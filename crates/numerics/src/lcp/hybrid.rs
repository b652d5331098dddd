//! Solves a frictional problem by several methods, one after the other, and checks each answer: the active set from
//! warm states, from the states after Gauss-Seidel sweeps and after proximal steps, and Lemke's method. See
//! docs/theory/complementarity.md, The hybrid.

use bumpalo::Bump;
use nalgebra::DVector;

use super::active_set::{Changes, Outcome, active_set, first_states};
use super::basis::perturbation;
use super::dense::{List, copy, filled, list};
use super::free_solution::{Solvers, search, tip_over};
use super::gauss_seidel::gauss_seidel;
use super::joints::Joints;
use super::kept::KeptFactors;
use super::known::Known;
use super::lemke::{LemkeSettings, lemke_forces};
use super::problems::{
    ContactState, Counters, FrictionalLcp, FrictionalSolution, LcpError, Method, Spare, Stability,
    expect_size,
};
use super::proximal::proximal_states;
use super::reduced;
use super::residual::{TOLERANCE, frictional_residual};
use super::scaled::Scaled;

/// Number of Gauss-Seidel sweeps before the active set starts anew.
const SWEEPS: usize = 10;

/// Size of the largest arena that is kept for the next problem (bytes): with a larger one, allocating memory costs
/// little compared with the solve.
const KEPT_BYTES: usize = 1 << 24;

/// Largest number of paths of Lemke's method that are tried.
const PATHS: usize = 4;

/// The method that a caller asks for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LcpMethod {
    /// The first of these methods that succeeds: active set from warm states, active set after Gauss-Seidel sweeps,
    /// active set after proximal steps, Lemke's method.
    #[default]
    Hybrid,
    /// Lemke's method from the start.
    Lemke,
}

/// Solves a frictional problem, starting from the states of a similar problem if `warm` is given.
pub fn solve_frictional(
    problem: &FrictionalLcp,
    warm: Option<&[ContactState]>,
    method: LcpMethod,
) -> Result<FrictionalSolution, LcpError> {
    let known = warm.map(Known::of_states);
    solve_similar(problem, known, method, &mut KeptFactors::default())
}

/// Solves one of several similar frictional problems; factors are kept from one to the next.
pub fn solve_similar(
    problem: &FrictionalLcp,
    known: Option<Known>,
    method: LcpMethod,
    kept: &mut KeptFactors,
) -> Result<FrictionalSolution, LcpError> {
    problem.check()?;
    if let Some(Known { states, .. }) = known {
        expect_size("warm states", problem.len(), states.len())?;
    }
    let mut arena = std::mem::take(&mut kept.arena);
    let solved = solve_in(problem, known, method, (kept, &arena));
    if arena.allocated_bytes() <= KEPT_BYTES {
        arena.reset();
        kept.arena = arena;
    }
    solved
}

/// Solves a frictional problem; its lists lie in an arena.
fn solve_in(
    problem: &FrictionalLcp,
    known: Option<Known>,
    method: LcpMethod,
    (kept, arena): (&mut KeptFactors, &Bump),
) -> Result<FrictionalSolution, LcpError> {
    let mut counters = Counters::default();
    if !problem.penetrates() && problem.free.is_empty() {
        let states = filled(arena, ContactState::Open, problem.len());
        let forces = [(); 2].map(|()| filled(arena, 0.0, problem.len()));
        let found = (&*states, forces, filled(arena, 0.0, 0));
        let spare = &mut kept.spare;
        return Ok(finish(problem, found, (Method::Trivial, counters), spare));
    }
    let scaled = Scaled::new(problem, arena)?;
    let warm = match method {
        LcpMethod::Hybrid => iterate(problem, &scaled, known, (kept, &mut counters)),
        LcpMethod::Lemke => None,
    };
    let solution = match warm {
        Some(solution) => solution,
        None if problem.free.is_empty() => return lemke(problem, &scaled, &mut counters),
        None => search(problem, &scaled, known, (&SOLVERS, &mut counters))?,
    };
    match problem.unstable_motion(&solution.state) {
        None => Ok(solution),
        Some(motion) => {
            let from = (&solution, motion);
            let (found, stability) =
                match tip_over(problem, &scaled, from, (&SOLVERS, &mut counters)) {
                    Some(stable) => (stable, Stability::Tipped),
                    None => (solution, Stability::Unstable),
                };
            Ok(FrictionalSolution { stability, ..found })
        }
    }
}

/// The solvers of the complementarity problems within a problem with free unknowns.
const SOLVERS: Solvers = Solvers {
    resisted: |problem, known| {
        let kept = &mut KeptFactors::default();
        solve_similar(problem, known, LcpMethod::Hybrid, kept)
    },
    from_states,
};

/// The answer of the active set from some states, without kept factors.
fn from_states(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    states: &[ContactState],
    counters: &mut Counters,
) -> Option<FrictionalSolution> {
    let states = closed_alike(scaled, states);
    let no_joints = Joints::none();
    let alone = Changes::Alone(&no_joints);
    match active_set(
        scaled,
        states,
        alone,
        (&mut KeptFactors::default(), counters),
    ) {
        Outcome::Converged(states, p) => {
            let found = scaled.found(&states, &admissible(scaled, &states, &p));
            let how = (Method::ActiveSet, *counters);
            let solution = finish(problem, found, how, &mut Spare::default());
            (solution.residual <= TOLERANCE).then_some(solution)
        }
        Outcome::Failed(_) => None,
    }
}

/// Calls the active set from the warm states, contact by contact, until a call succeeds. If the first call does not end
/// soon, the second one uses joints. If the active set still fails, kept factors are dropped, because their round-off may
/// move nearly identical contacts. Then the active set starts from the states after Gauss-Seidel sweeps, which break its
/// cycles, and at last from the states after proximal steps.
fn iterate(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    known: Option<Known>,
    (kept, counters): (&mut KeptFactors, &mut Counters),
) -> Option<FrictionalSolution> {
    let mut states = match known {
        Some(Known { states, .. }) => closed_alike(scaled, states),
        None => first_states(scaled),
    };
    let joints = known.map_or_else(Joints::none, |known| Joints::of(known.joints));
    let mut ways = [Way::Sweeps, Way::Steps].into_iter();
    let mut has_kept = kept.has_factors();
    let mut changes = Changes::Alone(&joints);
    loop {
        let mut p = match active_set(scaled, states.clone(), changes, (kept, counters)) {
            Outcome::Converged(states, p) => {
                let found = scaled.found(&states, &admissible(scaled, &states, &p));
                let how = (Method::ActiveSet, *counters);
                let solution = finish(problem, found, how, &mut kept.spare);
                if solution.residual <= TOLERANCE || problem.is_empty() {
                    return Some(solution);
                }
                p
            }
            Outcome::Failed(p) => p,
        };
        if let Changes::Alone(_) = changes
            && joints.are_some(scaled.contacts)
        {
            changes = Changes::Together(&joints, solve_joint);
            continue;
        }
        kept.forget();
        if scaled.free > 0 {
            match std::mem::take(&mut has_kept) {
                true => continue,
                false => return None,
            }
        }
        states = match ways.next()? {
            Way::Sweeps => {
                project(scaled, &mut p);
                gauss_seidel(scaled, &mut p, SWEEPS, counters)
            }
            Way::Steps => proximal_states(scaled, states, counters)?,
        };
    }
}

/// A way to other states, from which the active set starts anew.
enum Way {
    /// Gauss-Seidel sweeps.
    Sweeps,
    /// Proximal steps.
    Steps,
}

/// The warm states, in which frictionless contacts have only one closed state.
fn closed_alike<'a>(scaled: &Scaled<'a>, warm: &[ContactState]) -> List<'a, ContactState> {
    let state = |(state, tangent): (&ContactState, &Option<usize>)| match tangent {
        None if state.is_closed() => ContactState::SlipPlus,
        _ => *state,
    };
    list(scaled.arena, warm.iter().zip(&scaled.tangents).map(state))
}

/// Projects forces into the friction cone.
fn project(scaled: &Scaled, p: &mut [f64]) {
    for i in 0..scaled.contacts {
        p[i] = p[i].max(0.0);
        if let Some(t) = scaled.tangents[i] {
            p[t] = p[t].max(-scaled.mu[i] * p[i]).min(scaled.mu[i] * p[i]);
        }
    }
}

/// Lemke's method, along up to [`PATHS`] paths with different covering vectors: if round-off ends one path on a ray,
/// another path may reach a solution. The error is that of the first path.
fn lemke(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    counters: &mut Counters,
) -> Result<FrictionalSolution, LcpError> {
    let first = follow(problem, scaled, &vec![1.0; scaled.contacts], counters);
    if first.is_ok() {
        return first;
    }
    let mut covering = perturbation(scaled.contacts);
    for _ in 1..PATHS {
        let other = follow(problem, scaled, &covering, counters);
        if other.is_ok() {
            return other;
        }
        covering.rotate_left(1);
        covering.iter_mut().for_each(|d| *d *= *d);
    }
    first
}

/// Follows one path of Lemke's method. The forces of its states are then computed directly, which is more accurate, and
/// states that are wrong because of ties within the tolerance are corrected. With redundant contacts the forces of the
/// path itself may be needed.
fn follow(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    covering: &[f64],
    counters: &mut Counters,
) -> Result<FrictionalSolution, LcpError> {
    counters.lemke_calls += 1;
    let found = lemke_forces(scaled, covering, &LemkeSettings::default());
    counters.pivots += match &found {
        Ok(found) => found.pivots,
        Err(LcpError::Ray { pivots, .. } | LcpError::PivotLimit { pivots }) => *pivots,
        Err(_) => 0,
    };
    let found = found?;
    let (kept, unread) = (&mut KeptFactors::default(), &mut Counters::default());
    let states = copy(scaled.arena, &found.states);
    let no_joints = Joints::none();
    let alone = Changes::Alone(&no_joints);
    let corrected = match active_set(scaled, states, alone, (kept, unread)) {
        Outcome::Converged(states, p) => Some((states, p)),
        Outcome::Failed(_) => None,
    };
    let own = || copy(scaled.arena, &found.states);
    let direct = || reduced::forces(scaled, &found.states, kept).map(|(p, _)| (own(), p));
    let candidates = corrected
        .into_iter()
        .chain(std::iter::once_with(direct).flatten());
    let found_forces = copy(scaled.arena, &found.p);
    accept(
        candidates
            .chain([(own(), found_forces)])
            .map(|(states, p)| {
                let found = scaled.found(&states, &admissible(scaled, &states, &p));
                finish(
                    problem,
                    found,
                    (Method::Lemke, *counters),
                    &mut Spare::default(),
                )
            }),
    )
}

/// The first solution whose residual is small enough.
fn accept(
    solutions: impl Iterator<Item = FrictionalSolution>,
) -> Result<FrictionalSolution, LcpError> {
    let mut smallest = f64::INFINITY;
    for solution in solutions {
        if solution.residual <= TOLERANCE {
            return Ok(solution);
        }
        smallest = smallest.min(solution.residual);
    }
    Err(LcpError::Residual {
        value: smallest,
        tolerance: TOLERANCE,
    })
}

/// Forces moved into the friction cone if round-off left them outside: Pn >= 0, |Pt| <= mu Pn.
fn admissible<'a>(scaled: &Scaled<'a>, states: &[ContactState], p: &[f64]) -> List<'a, f64> {
    let mut p = copy(scaled.arena, p);
    for i in 0..scaled.contacts {
        p[i] = if states[i].is_closed() {
            p[i].max(0.0)
        } else {
            0.0
        };
        if let Some(t) = scaled.tangents[i] {
            let limit = scaled.mu[i] * p[i];
            p[t] = match states[i].slip_sign() {
                0.0 => p[t].max(-limit).min(limit),
                sign => -sign * limit,
            };
        }
    }
    p
}

/// The solution; its motion and residual are recomputed from the problem.
fn finish(
    problem: &FrictionalLcp,
    (states, [pn, pt], x): (&[ContactState], [List<f64>; 2], List<f64>),
    (method, counters): (Method, Counters),
    spare: &mut Spare,
) -> FrictionalSolution {
    let (residual, motion) = frictional_residual(problem, ([&pn, &pt], &x), pn.bump());
    let (gap, slip) = motion.split_at(problem.len());
    // Without friction the solution leaves the direction of slip open: take it from the slip.
    let states = (0..problem.len()).map(|i| match states[i] {
        closed if closed.is_closed() && problem.mu[i] == 0.0 => ContactState::sliding(slip[i]),
        other => other,
    });
    let mut state = std::mem::take(&mut spare.states);
    state.clear();
    state.extend(states);
    FrictionalSolution {
        state,
        pn: spare.vector(0, &pn),
        pt: spare.vector(1, &pt),
        gap: spare.vector(2, gap),
        slip: spare.vector(3, slip),
        free: DVector::from_column_slice(&x),
        stability: Stability::default(),
        residual,
        method,
        counters,
    }
}

/// The answer of the problem of a joint.
fn solve_joint(problem: &FrictionalLcp, states: &[ContactState]) -> Option<FrictionalSolution> {
    solve_frictional(problem, Some(states), LcpMethod::Hybrid).ok()
}
