//! Solves a frictional problem by several methods and checks each answer. One method is the primal-dual active set on
//! the contact states, which is Newton's method on the contact law. The other is non-smooth Gauss-Seidel, which solves
//! each contact in turn exactly with the forces of all others fixed. See docs/theory/complementarity.md.

use bumpalo::Bump;
use nalgebra::DVector;

use super::basis::perturbation;
use super::dense::{List, axpy, copy, filled, list, max_abs};
use super::free_solution::{Solvers, search, tip_over};
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
            changes = Changes::Together(&joints);
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

/// Largest number of solves in one call of the active set.
const ACTIVE_SET_ITERATIONS: usize = 25;

/// The answer of the problem of a joint.
fn solve_joint(problem: &FrictionalLcp, states: &[ContactState]) -> Option<FrictionalSolution> {
    solve_frictional(problem, Some(states), LcpMethod::Hybrid).ok()
}

/// Number of iterations of single contacts before joints are tried: most problems are solved by then, at less cost.
const ALONE: usize = 5;

/// Violation of a condition, relative to the largest force, up to which a state does not change: otherwise round-off
/// would change degenerate contacts for ever.
const ACTIVE_SET_TOLERANCE: f64 = 1e-12;

/// Round-off of gaps that depend on free unknowns, relative to the largest of these unknowns.
const FREE_ROUND_OFF: f64 = 1e-14;

/// Result of a call of the active set.
pub(crate) enum Outcome<'a> {
    /// The states and their forces satisfy every condition.
    Converged(List<'a, ContactState>, List<'a, f64>),
    /// The states repeat, or no forces belong to them; the value holds the last forces found.
    Failed(List<'a, f64>),
}

/// Which contacts change their states together.
#[derive(Clone, Copy)]
pub(crate) enum Changes<'j, 'k> {
    /// Every contact changes its state alone; if there are joints, the iteration ends early.
    Alone(&'j Joints<'k>),
    /// The contacts of a joint change their states together.
    Together(&'j Joints<'k>),
}

/// Computes the forces of the states, and changes states that contradict forces and motion, until no state changes.
/// Repeated states mean failure.
pub(crate) fn active_set<'a>(
    scaled: &Scaled<'a>,
    mut states: List<'a, ContactState>,
    changes: Changes,
    (kept, counters): (&mut KeptFactors, &mut Counters),
) -> Outcome<'a> {
    let mut visited: List<List<ContactState>> = List::new_in(scaled.arena);
    let mut last = filled(scaled.arena, 0.0, scaled.size());
    while visited.len() < ACTIVE_SET_ITERATIONS {
        counters.active_set_iterations += 1;
        let Some((p, v)) = reduced::forces(scaled, &states, kept) else {
            break;
        };
        let mut next = next_states(scaled, &states, &p, &v);
        if next == states {
            return Outcome::Converged(states, p);
        }
        match changes {
            Changes::Alone(joints)
                if visited.len() == ALONE && joints.are_some(scaled.contacts) =>
            {
                last = p;
                break;
            }
            Changes::Alone(_) => {}
            Changes::Together(joints) => {
                joints.change(scaled, &states, &mut next, ([&p, &v], solve_joint));
            }
        }
        last = p;
        visited.push(std::mem::replace(&mut states, next));
        if visited.contains(&states) {
            break;
        }
    }
    Outcome::Failed(last)
}

/// The states that follow from the forces p of `states` and the motion v.
fn next_states<'a>(
    scaled: &Scaled<'a>,
    states: &[ContactState],
    p: &[f64],
    v: &[f64],
) -> List<'a, ContactState> {
    let (forces, free) = p.split_at(scaled.free_places().start);
    let of_forces = ACTIVE_SET_TOLERANCE * max_abs(forces).max(1.0);
    let of_motion = of_forces + FREE_ROUND_OFF * max_abs(free);
    let next = (0..scaled.contacts).map(|i| {
        let tolerance = match states[i].is_closed() {
            true => of_forces,
            false => of_motion,
        };
        next_state(scaled, states[i], i, p, v, tolerance)
    });
    list(scaled.arena, next)
}

/// The next state of contact i.
fn next_state(
    scaled: &Scaled,
    state: ContactState,
    i: usize,
    p: &[f64],
    v: &[f64],
    tolerance: f64,
) -> ContactState {
    use ContactState::{Open, SlipMinus, SlipPlus, Stick};
    let keeps = if state == Open {
        v[i] >= -tolerance
    } else {
        p[i] >= -tolerance
    };
    let Some(t) = scaled.tangents[i] else {
        return if (state == Open) == keeps {
            Open
        } else {
            SlipPlus
        };
    };
    let limit = scaled.mu[i] * p[i];
    match (state, keeps) {
        (Open, true) => Open,
        (Open, false) => landing(scaled, i, t, v),
        (_, false) => Open,
        (Stick, _) if p[t] > limit + tolerance => SlipMinus,
        (Stick, _) if p[t] < -limit - tolerance => SlipPlus,
        (SlipPlus | SlipMinus, _) if state.slip_sign() * v[t] < -tolerance => {
            // The force that stops the slip comes on top of the friction that drove it.
            if v[t].abs() / scaled.q()[(t, t)] <= 2.0 * limit {
                Stick
            } else {
                ContactState::sliding(v[t])
            }
        }
        _ => state,
    }
}

/// State of contact i that closes with motion v: it sticks if the force that would stop its slip does not exceed mu
/// times the force that would stop its penetration.
fn landing(scaled: &Scaled, i: usize, t: usize, v: &[f64]) -> ContactState {
    let normal = -v[i] / scaled.q()[(i, i)];
    let tangential = -v[t] / scaled.q()[(t, t)];
    if tangential.abs() <= scaled.mu[i] * normal {
        ContactState::Stick
    } else {
        ContactState::sliding(v[t])
    }
}

/// Initial states if no states are known: they follow from the motion without forces.
pub(crate) fn first_states<'a>(scaled: &Scaled<'a>) -> List<'a, ContactState> {
    let open = filled(scaled.arena, ContactState::Open, scaled.contacts);
    let none = filled(scaled.arena, 0.0, scaled.size());
    next_states(scaled, &open, &none, &scaled.b)
}

/// Largest change of a force, relative to the largest force, in a sweep that ends the iteration.
const GAUSS_SEIDEL_TOLERANCE: f64 = 1e-13;

/// Improves the forces `p` by at most `sweeps` sweeps; returns the states of the last sweep.
pub(crate) fn gauss_seidel<'a>(
    scaled: &Scaled<'a>,
    p: &mut [f64],
    sweeps: usize,
    counters: &mut Counters,
) -> List<'a, ContactState> {
    let mut states = filled(scaled.arena, ContactState::Open, scaled.contacts);
    let mut v = scaled.motion(p);
    for _ in 0..sweeps {
        counters.gauss_seidel_sweeps += 1;
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for (i, state) in states.iter_mut().enumerate() {
            let (new, pn, pt) = local(scaled, i, p, &v);
            *state = new;
            change = change.max(update(scaled, i, pn, p, &mut v));
            if let Some(t) = scaled.tangents[i] {
                change = change.max(update(scaled, t, pt, p, &mut v));
            }
            largest = largest.max(pn);
        }
        if change <= GAUSS_SEIDEL_TOLERANCE * largest {
            break;
        }
    }
    states
}

/// Sets force k and adds its effect to the motion; returns the size of the change.
fn update(scaled: &Scaled, k: usize, force: f64, p: &mut [f64], v: &mut [f64]) -> f64 {
    let change = force - p[k];
    axpy(change, scaled.column(k), v);
    p[k] = force;
    change.abs()
}

/// State and forces of contact i alone, from its 2 x 2 block of Q and the motion b due to the other
/// contacts: g = a Pn + c Pt + b_n, Dt = f Pn + e Pt + b_t.
fn local(scaled: &Scaled, i: usize, p: &[f64], v: &[f64]) -> (ContactState, f64, f64) {
    let q = scaled.q();
    let a = q[(i, i)];
    let Some(t) = scaled.tangents[i] else {
        let pn = -(v[i] - a * p[i]) / a;
        return closed_or_open(ContactState::SlipPlus, pn, 0.0);
    };
    let (c, f) = (q[(i, t)], q[(t, i)]);
    let (e, mu) = (q[(t, t)], scaled.mu[i]);
    let b_n = v[i] - a * p[i] - c * p[t];
    let b_t = v[t] - f * p[i] - e * p[t];
    if b_n >= 0.0 {
        return (ContactState::Open, 0.0, 0.0);
    }
    let determinant = a * e - c * f;
    let (pn, pt) = (
        (c * b_t - e * b_n) / determinant,
        (f * b_n - a * b_t) / determinant,
    );
    if pn >= 0.0 && pt.abs() <= mu * pn {
        return (ContactState::Stick, pn, pt);
    }
    // Pt = -s mu Pn and g = 0; the side whose slip has the sign s, if any.
    for (state, s) in [
        (ContactState::SlipPlus, 1.0),
        (ContactState::SlipMinus, -1.0),
    ] {
        let pn = -b_n / (a - s * mu * c);
        if pn >= 0.0 && s * ((f - s * mu * e) * pn + b_t) >= 0.0 {
            return closed_or_open(state, pn, -s * mu * pn);
        }
    }
    closed_or_open(ContactState::sliding(pt), -b_n / a, 0.0)
}

/// State and forces if pn is positive and finite; else the open state without forces.
fn closed_or_open(state: ContactState, pn: f64, pt: f64) -> (ContactState, f64, f64) {
    if pn > 0.0 && pn.is_finite() {
        (state, pn, pt)
    } else {
        (ContactState::Open, 0.0, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use bumpalo::Bump;
    use nalgebra::DMatrix;

    use super::*;
    use crate::lcp::FreeUnknowns;

    #[test]
    fn beyond_the_cone_a_sticking_contact_slides_on_either_side() {
        let problem = FrictionalLcp {
            q: DMatrix::identity(2, 2),
            gap: vec![-1.0].into(),
            slip: vec![2.0].into(),
            mu: vec![0.5].into(),
            free: FreeUnknowns::default(),
        };
        let arena = Bump::new();
        let scaled = Scaled::new(&problem, &arena).expect("finite");
        let next = |pt: f64| {
            let p = [1.0, pt];
            next_state(&scaled, ContactState::Stick, 0, &p, &[0.0; 2], 1e-12)
        };
        assert_eq!(next(0.5), ContactState::Stick);
        assert_eq!(next(-0.5), ContactState::Stick);
        assert_eq!(next(0.6), ContactState::SlipMinus);
        assert_eq!(next(-0.6), ContactState::SlipPlus);
    }
}

#[cfg(test)]
mod gauss_seidel_tests {
    use bumpalo::Bump;
    use nalgebra::DMatrix;

    use super::*;
    use crate::lcp::FreeUnknowns;

    /// Three uncoupled contacts: one is open, one slides, and one sticks.
    #[test]
    fn contacts_alone_are_solved_in_one_sweep() {
        let problem = FrictionalLcp {
            q: DMatrix::identity(6, 6),
            gap: vec![0.5, -1.0, -1.0].into(),
            slip: vec![2.0, 2.0, -0.25].into(),
            mu: vec![0.5; 3].into(),
            free: FreeUnknowns::default(),
        };
        let arena = Bump::new();
        let scaled = Scaled::new(&problem, &arena).expect("finite");
        let mut p = vec![0.0; 6];
        let states = gauss_seidel(&scaled, &mut p, 1, &mut Counters::default());
        assert_eq!(
            states,
            [
                ContactState::Open,
                ContactState::SlipPlus,
                ContactState::Stick
            ]
        );
        assert_eq!(p, [0.0, 1.0, 1.0, 0.0, -0.5, 0.25]);
    }
}
