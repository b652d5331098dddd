//! Primal-dual active set on the contact states: Newton's method on the contact law.

use crate::lcp::problems::{ContactState, Counters, List, Scaled, filled, list, max_abs};
use crate::lcp::warm_start::{kept_factors::KeptFactors, reduced};

/// Solves allowed in one call.
const ITERATIONS: usize = 25;

/// A condition violated by less than this, relative to the largest force, does not change a state:
/// round-off would otherwise change degenerate contacts for ever.
const TOLERANCE: f64 = 1e-12;

/// Result of a call.
pub(crate) enum Outcome<'a> {
    /// The states and their forces satisfy every condition.
    Converged(List<'a, ContactState>, List<'a, f64>),
    /// The states repeat or have no forces; the last forces found.
    Failed(List<'a, f64>),
}

/// Solves for the forces of the states and changes the states that forces and motion contradict,
/// until none changes. Repeated states mean failure.
pub(crate) fn active_set<'a>(
    scaled: &Scaled<'a>,
    mut states: List<'a, ContactState>,
    kept: &mut KeptFactors,
    counters: &mut Counters,
) -> Outcome<'a> {
    let mut visited: List<List<ContactState>> = List::new_in(scaled.arena);
    let mut last = filled(scaled.arena, 0.0, scaled.size());
    while visited.len() < ITERATIONS {
        counters.active_set_iterations += 1;
        let Some((p, v)) = reduced::forces(scaled, &states, kept) else {
            break;
        };
        let next = next_states(scaled, &states, &p, &v);
        if next == states {
            return Outcome::Converged(states, p);
        }
        last = p;
        visited.push(std::mem::replace(&mut states, next));
        if visited.contains(&states) {
            break;
        }
    }
    Outcome::Failed(last)
}

/// The states that follow from the forces p of `states` and their motion v.
fn next_states<'a>(
    scaled: &Scaled<'a>,
    states: &[ContactState],
    p: &[f64],
    v: &[f64],
) -> List<'a, ContactState> {
    let tolerance = TOLERANCE * max_abs(p).max(1.0);
    let next = (0..scaled.contacts).map(|i| next_state(scaled, states[i], i, p, v, tolerance));
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

/// State of contact i that closes with motion v: it sticks when the force that would stop its slip
/// is within the limit of the force that would stop its penetration.
fn landing(scaled: &Scaled, i: usize, t: usize, v: &[f64]) -> ContactState {
    let normal = -v[i] / scaled.q()[(i, i)];
    let tangential = -v[t] / scaled.q()[(t, t)];
    if tangential.abs() <= scaled.mu[i] * normal {
        ContactState::Stick
    } else {
        ContactState::sliding(v[t])
    }
}

/// Initial states when none are known: those that follow from the motion without forces.
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
    use crate::lcp::problems::FrictionalLcp;

    #[test]
    fn beyond_the_cone_a_sticking_contact_slides_on_either_side() {
        let problem = FrictionalLcp {
            q: DMatrix::identity(2, 2),
            gap: vec![-1.0].into(),
            slip: vec![2.0].into(),
            mu: vec![0.5].into(),
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
