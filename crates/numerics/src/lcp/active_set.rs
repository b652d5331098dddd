//! The primal-dual active set on the contact states, which is Newton's method on the contact law. See
//! docs/theory/complementarity.md, The hybrid.

use super::dense::{List, filled, list, max_abs};
use super::joints::{Joints, SolveJoint};
use super::kept::KeptFactors;
use super::problems::{ContactState, Counters};
use super::reduced;
use super::scaled::Scaled;

/// Largest number of solves in one call of the active set.
const ACTIVE_SET_ITERATIONS: usize = 25;

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
    /// The contacts of a joint change their states together, to those of the solution of the problem of the joint.
    Together(&'j Joints<'k>, SolveJoint),
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
            Changes::Together(joints, solve) => {
                joints.change(scaled, &states, &mut next, ([&p, &v], solve));
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

#[cfg(test)]
mod tests {
    use bumpalo::Bump;
    use nalgebra::DMatrix;

    use super::*;
    use crate::lcp::{FreeUnknowns, FrictionalLcp};

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
