//! Non-smooth Gauss-Seidel: each contact in turn is solved exactly, with the forces of all others fixed. See
//! docs/theory/complementarity.md, The hybrid.

use super::dense::{List, axpy, filled};
use super::problems::{ContactState, Counters};
use super::scaled::Scaled;

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
    use crate::lcp::{FreeUnknowns, FrictionalLcp};

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
