//! Solves a frictional problem: the order of the methods, and the check of each answer. Section 8 of
//! docs/theory.md.

use bumpalo::Bump;

use super::active_set::{Outcome, active_set, first_states};
use super::gauss_seidel::gauss_seidel;
use super::solution::{FrictionalSolution, Method, Spare};
use crate::lcp::pivots::{LemkeSettings, lemke_forces, perturbation};
use crate::lcp::problems::{
    ContactState, Counters, FrictionalLcp, LcpError, List, Scaled, TOLERANCE, copy, expect_size,
    filled, frictional_residual, list,
};
use crate::lcp::warm_start::{kept_factors::KeptFactors, reduced};

/// Gauss-Seidel sweeps between two calls of the active set.
const SWEEPS: [usize; 3] = [10, 40, 160];

/// Largest arena that is kept for the next problem: what a larger one holds takes longer than its memory.
const KEPT_BYTES: usize = 1 << 24;

/// Paths of Lemke's method that are tried.
const PATHS: usize = 4;

/// The method a caller asks for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LcpMethod {
    /// Warm active set, Gauss-Seidel sweeps, Lemke: the first that succeeds.
    #[default]
    Hybrid,
    /// Lemke's method from the start.
    Lemke,
}

/// Solves a frictional problem, from the states of a similar one when `warm` is given.
pub fn solve_frictional(
    problem: &FrictionalLcp,
    warm: Option<&[ContactState]>,
    method: LcpMethod,
) -> Result<FrictionalSolution, LcpError> {
    solve_similar(problem, warm, method, &mut KeptFactors::default())
}

/// Solves a frictional problem of a row of similar ones, between which factors are kept.
pub fn solve_similar(
    problem: &FrictionalLcp,
    warm: Option<&[ContactState]>,
    method: LcpMethod,
    kept: &mut KeptFactors,
) -> Result<FrictionalSolution, LcpError> {
    problem.check()?;
    if let Some(states) = warm {
        expect_size("warm states", problem.len(), states.len())?;
    }
    let mut arena = std::mem::take(&mut kept.arena);
    let solved = solve_in(problem, warm, method, (kept, &arena));
    if arena.allocated_bytes() <= KEPT_BYTES {
        arena.reset();
        kept.arena = arena;
    }
    solved
}

/// Solves a frictional problem with its lists in an arena.
fn solve_in(
    problem: &FrictionalLcp,
    warm: Option<&[ContactState]>,
    method: LcpMethod,
    (kept, arena): (&mut KeptFactors, &Bump),
) -> Result<FrictionalSolution, LcpError> {
    let mut counters = Counters::default();
    if !problem.penetrates() {
        let states = filled(arena, ContactState::Open, problem.len());
        let forces = [(); 2].map(|()| filled(arena, 0.0, problem.len()));
        let found = (&*states, forces);
        let spare = &mut kept.spare;
        return Ok(finish(problem, found, (Method::Trivial, counters), spare));
    }
    let scaled = Scaled::new(problem, arena)?;
    if method == LcpMethod::Hybrid
        && let Some(solution) = iterate(problem, &scaled, warm, (kept, &mut counters))
    {
        return Ok(solution);
    }
    lemke(problem, &scaled, &mut counters)
}

/// The active set from the warm states, with factors of its own where it fails with kept ones, whose round-off moves
/// contacts that are nearly one; then from the states after ever more Gauss-Seidel sweeps, which break its cycles.
fn iterate(
    problem: &FrictionalLcp,
    scaled: &Scaled,
    warm: Option<&[ContactState]>,
    (kept, counters): (&mut KeptFactors, &mut Counters),
) -> Option<FrictionalSolution> {
    let mut states = warm.map_or_else(|| first_states(scaled), |warm| known(scaled, warm));
    let mut rounds = SWEEPS.into_iter();
    loop {
        let mut p = match active_set(scaled, states.clone(), kept, counters) {
            Outcome::Converged(states, p) => {
                let forces = scaled.forces(&admissible(scaled, &states, &p));
                let (found, how) = ((&*states, forces), (Method::ActiveSet, *counters));
                let solution = finish(problem, found, how, &mut kept.spare);
                if solution.residual <= TOLERANCE {
                    return Some(solution);
                }
                p
            }
            Outcome::Failed(p) => p,
        };
        if kept.forget() {
            continue;
        }
        project(scaled, &mut p);
        states = gauss_seidel(scaled, &mut p, rounds.next()?, counters);
    }
}

/// Warm states, in which frictionless contacts have one closed state only.
fn known<'a>(scaled: &Scaled<'a>, warm: &[ContactState]) -> List<'a, ContactState> {
    let state = |(state, tangent): (&ContactState, &Option<usize>)| match tangent {
        None if state.is_closed() => ContactState::SlipPlus,
        _ => *state,
    };
    list(scaled.arena, warm.iter().zip(&scaled.tangents).map(state))
}

/// Brings forces into the friction cone.
fn project(scaled: &Scaled, p: &mut [f64]) {
    for i in 0..scaled.contacts {
        p[i] = p[i].max(0.0);
        if let Some(t) = scaled.tangents[i] {
            p[t] = p[t].max(-scaled.mu[i] * p[i]).min(scaled.mu[i] * p[i]);
        }
    }
}

/// Lemke's method, along up to [`PATHS`] paths with different covering vectors: where round-off
/// ends one path on a ray, another reaches a solution. The error is that of the first path.
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

/// One path of Lemke's method. The forces of its states are then solved for directly, which
/// is more accurate than the exchanges, and states that are wrong because of ties within the
/// tolerance are corrected; redundant contacts may need the forces of the path itself.
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
    let corrected = match active_set(scaled, copy(scaled.arena, &found.states), kept, unread) {
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
                let forces = scaled.forces(&admissible(scaled, &states, &p));
                let (found, how) = ((&*states, forces), (Method::Lemke, *counters));
                finish(problem, found, how, &mut Spare::default())
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

/// Forces moved into the friction cone where round-off left them outside: Pn >= 0, |Pt| <= mu Pn.
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

/// The solution with motion and residual recomputed from the problem.
fn finish(
    problem: &FrictionalLcp,
    (states, [pn, pt]): (&[ContactState], [List<f64>; 2]),
    (method, counters): (Method, Counters),
    spare: &mut Spare,
) -> FrictionalSolution {
    let (residual, motion) = frictional_residual(problem, [&pn, &pt], pn.bump());
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
        residual,
        method,
        counters,
    }
}
