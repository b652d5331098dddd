//! Forces of given contact states. The forces follow from a linear system, which is solved directly or with kept
//! factors of the same states with another Q.

use super::dense::{Factors, List, copy, filled, list, max_abs};
use super::kept::KeptFactors;
use super::problems::ContactState;
use super::scaled::Scaled;

/// Shift of the diagonal, relative to its entries, that makes a singular system solvable.
const SHIFT: f64 = 1e-10;

/// Largest difference of mirrored entries of a symmetric matrix, relative to its diagonal entries.
const ASYMMETRY: f64 = 1e-9;

/// Largest residual of forces that count as accurate, relative to the sum of the terms of its rows.
const ACCURATE: f64 = 4.0 * f64::EPSILON;

/// Residual below which corrections end as they cannot improve it, relative to the sum of the terms of its rows.
const ROUND_OFF: f64 = 0.5 * f64::EPSILON;

/// Limits of the corrections of forces by the residual.
struct Corrections {
    /// Smallest and largest number of solves.
    solves: [usize; 2],
    /// Ratio of successive residuals above which the corrections end.
    rate: f64,
}

/// Limits with the factors of the system itself. The first correction makes the gaps exact to round-off; only the
/// shifted system needs more.
const OWN: Corrections = Corrections {
    solves: [2, 7],
    rate: 0.1,
};

/// Number of solves with the factors of another Q that replace a factorisation of the system; large systems get more,
/// one for every [`UNKNOWNS_PER_SOLVE`] unknowns.
const KEPT_SOLVES: usize = 6;

/// Number of unknowns for each solve with the factors of another Q.
const UNKNOWNS_PER_SOLVE: usize = 24;

/// Forces p and their motion v.
type Solution<'a> = (List<'a, f64>, List<'a, f64>);

impl Corrections {
    /// Limits with the factors of another Q; larger systems allow more solves.
    fn kept(size: usize) -> Self {
        let most = KEPT_SOLVES.max(size / UNKNOWNS_PER_SOLVE);
        Corrections {
            solves: [1, most],
            rate: f64::EPSILON.powf(1.0 / most as f64),
        }
    }
}

/// Solves for the forces p of the given states, and their motion v = Q p + b: closed contacts have gap = 0, sticking
/// ones slip = 0, sliding ones Pt = -+mu Pn, and open ones no force. `None` if no solution is finite. Redundant
/// contacts, whose forces are undetermined, share the load.
pub(crate) fn forces<'a>(
    scaled: &Scaled<'a>,
    states: &[ContactState],
    kept: &mut KeptFactors,
) -> Option<Solution<'a>> {
    let unknowns = unknowns(scaled, states);
    if unknowns.is_empty() {
        let arena = scaled.arena;
        return Some((filled(arena, 0.0, scaled.size()), copy(arena, &scaled.b)));
    }
    let size = unknowns.len();
    if let Some(found) = from_kept(scaled, states, &unknowns, kept) {
        return Some(found);
    }
    let matrix = || matrix(scaled, states, &unknowns);
    let nothing_slides = scaled.owners.iter().all(|i| states[*i].slip_sign() == 0.0);
    let values = matrix();
    let regular = if nothing_slides && scaled.free == 0 && is_symmetric(&values, size) {
        Factors::cholesky(values, size)
    } else {
        Factors::lu(values, size)
    };
    let solution = |factors: &Factors| {
        let solve = |b: &mut [f64]| factors.solve(b);
        let (p, v, _) = refine(scaled, states, &unknowns, (&OWN, solve));
        p.iter().all(|v| v.is_finite()).then_some((p, v))
    };
    match regular {
        Some(factors) => {
            let found = solution(&factors);
            kept.keep(scaled, states, factors);
            found
        }
        None => solution(&Factors::lu(shifted(matrix(), size), size)?),
    }
}

/// Forces from kept factors, if they are as accurate as forces from the factors of the system itself.
fn from_kept<'a>(
    scaled: &Scaled<'a>,
    states: &[ContactState],
    unknowns: &[usize],
    kept: &KeptFactors,
) -> Option<Solution<'a>> {
    let factors = kept.serving(scaled, states)?;
    let corrections = Corrections::kept(unknowns.len());
    let solve = |b: &mut [f64]| factors.solve(b);
    let (p, v, error) = refine(scaled, states, unknowns, (&corrections, solve));
    (error <= ACCURATE * terms(scaled, &p)).then_some((p, v))
}

/// Sum of the absolute values of the diagonal terms of Q p and of the free unknowns.
fn terms(scaled: &Scaled, p: &[f64]) -> f64 {
    let q = scaled.q();
    let own = |k: usize| (q[(k, k)] * p[k]).abs();
    let free = scaled.free_places();
    let of_forces: f64 = (0..free.start).map(own).sum();
    of_forces + free.map(|k| p[k].abs()).sum::<f64>()
}

/// Positions in p of the unknowns, free unknowns last; they are also the rows that must vanish.
fn unknowns<'a>(scaled: &Scaled<'a>, states: &[ContactState]) -> List<'a, usize> {
    let closed = (0..scaled.contacts).filter(|i| states[*i].is_closed());
    let tangents = scaled.owners.iter().zip(scaled.contacts..);
    let stick = tangents
        .filter(|(i, _)| states[**i] == ContactState::Stick)
        .map(|(_, k)| k);
    list(
        scaled.arena,
        closed.chain(stick).chain(scaled.free_places()),
    )
}

/// The matrix of the system by columns: the part of Q at the unknowns, where the column of a sliding Pn is Q e_n - slip
/// sign mu Q e_t.
fn matrix(scaled: &Scaled, states: &[ContactState], unknowns: &[usize]) -> Vec<f64> {
    let mut values = Vec::with_capacity(unknowns.len() * unknowns.len());
    for k in unknowns {
        let column = scaled.column(*k);
        match sliding(scaled, states, *k) {
            None => values.extend(unknowns.iter().map(|r| column[*r])),
            Some((t, factor)) => {
                let tangent = scaled.column(t);
                values.extend(unknowns.iter().map(|r| column[*r] + factor * tangent[*r]));
            }
        }
    }
    values
}

/// For an unknown k that is the Pn of a sliding contact: the position t of its Pt and the factor in
/// Pt = factor Pn.
fn sliding(scaled: &Scaled, states: &[ContactState], k: usize) -> Option<(usize, f64)> {
    if k >= scaled.contacts || states[k].slip_sign() == 0.0 {
        return None;
    }
    scaled.tangents[k].map(|t| (t, slide(scaled, states, k)))
}

/// The factor in Pt = factor Pn of contact i; zero if the contact does not slide.
fn slide(scaled: &Scaled, states: &[ContactState], i: usize) -> f64 {
    -states[i].slip_sign() * scaled.mu[i]
}

/// Whether the two triangles of a matrix are equal up to differences that the corrections by the
/// residual remove.
fn is_symmetric(matrix: &[f64], size: usize) -> bool {
    let at = |i: usize, j: usize| matrix[i + j * size];
    let is_mirrored = |i: usize, j: usize| {
        let scale = (at(i, i) * at(j, j)).abs().sqrt();
        (at(i, j) - at(j, i)).abs() <= ASYMMETRY * scale
    };
    (0..size).all(|j| (0..j).all(|i| is_mirrored(i, j)))
}

/// The matrix with its diagonal increased a little.
fn shifted(mut matrix: Vec<f64>, size: usize) -> Vec<f64> {
    let largest = (0..size).fold(0.0_f64, |l, i| l.max(matrix[i + i * size].abs()));
    (0..size).for_each(|i| matrix[i + i * size] += SHIFT * largest);
    matrix
}

/// Computes p and v from solves with some factors. Both are corrected by the residual of the system itself, as long as
/// this residual falls and is not yet round-off. The last value is the largest residual.
fn refine<'a>(
    scaled: &Scaled<'a>,
    states: &[ContactState],
    unknowns: &[usize],
    (corrections, solve): (&Corrections, impl Fn(&mut [f64])),
) -> (List<'a, f64>, List<'a, f64>, f64) {
    let arena = scaled.arena;
    let [mut p, mut best] = [(); 2].map(|()| filled(arena, 0.0, scaled.size()));
    let mut motion = List::new_in(arena);
    let mut residual = List::with_capacity_in(unknowns.len(), arena);
    let mut smallest = f64::INFINITY;
    let [least, most] = corrections.solves;
    for solves in 0..=most {
        let v = match solves {
            0 => copy(arena, &scaled.b),
            _ => scaled.motion(&p),
        };
        residual.clear();
        residual.extend(unknowns.iter().map(|k| -v[*k]));
        let error = max_abs(&residual);
        if error.is_nan() || error >= smallest {
            break;
        }
        let stagnates = error > corrections.rate * smallest;
        best.copy_from_slice(&p);
        motion = v;
        smallest = error;
        if stagnates || (solves >= least && error <= ROUND_OFF * terms(scaled, &p)) {
            break;
        }
        solve(&mut residual);
        for (k, correction) in unknowns.iter().zip(&residual) {
            p[*k] += correction;
            if let Some((t, factor)) = sliding(scaled, states, *k) {
                p[t] = factor * p[*k];
            }
        }
    }
    (best, motion, smallest)
}

#[cfg(test)]
mod tests {
    use bumpalo::Bump;
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::lcp::{FreeUnknowns, FrictionalLcp};
    use ContactState::{Open, SlipMinus, SlipPlus, Stick};

    const CONTACTS: usize = 40;

    /// A problem of contacts at the given places of an elastic surface; all of them penetrate.
    fn problem(places: &[f64], compliance: f64) -> FrictionalLcp {
        let n = places.len();
        let entry = |i: usize, j: usize| {
            let distance = places[i % n] - places[j % n];
            let decay = compliance * (-distance.abs() / 4.0).exp();
            let side = if distance == 0.0 {
                0.0
            } else {
                distance.signum()
            };
            match (i < n, j < n) {
                (true, true) => decay,
                (false, false) => 0.8 * decay,
                (true, false) => 0.1 * decay * side,
                (false, true) => -0.1 * decay * side,
            }
        };
        FrictionalLcp {
            q: DMatrix::from_fn(2 * n, 2 * n, entry),
            gap: DVector::from_element(n, -1.0),
            slip: DVector::from_fn(n, |i, _| 0.1 * i as f64 - 0.5),
            mu: DVector::from_element(n, 0.3),
            free: FreeUnknowns::default(),
        }
    }

    /// Places of contacts with a given distance from each other.
    fn places(distance: f64) -> Vec<f64> {
        (0..CONTACTS).map(|i| distance * i as f64).collect()
    }

    /// States of every kind.
    fn states() -> Vec<ContactState> {
        let states = (0..CONTACTS).map(|i| [Stick, SlipPlus, Open, SlipMinus, Stick][i % 5]);
        states.collect()
    }

    /// Factors kept of a system.
    fn kept() -> KeptFactors {
        let (mut kept, arena) = (KeptFactors::default(), Bump::new());
        let scaled = Scaled::new(&problem(&places(2.0), 1.0), &arena).expect("finite");
        forces(&scaled, &states(), &mut kept).expect("regular");
        kept
    }

    #[test]
    fn forces_by_kept_factors_are_those_by_own_ones() {
        let (kept, states, arena) = (kept(), states(), Bump::new());
        let scaled = Scaled::new(&problem(&places(2.0), 1.0001), &arena).expect("finite");
        let unknowns = unknowns(&scaled, &states);
        let (p, v) = from_kept(&scaled, &states, &unknowns, &kept).expect("converges");
        let own = forces(&scaled, &states, &mut KeptFactors::default()).expect("regular");
        for (found, own) in [(p, own.0), (v, own.1)] {
            let most = max_abs(&own);
            let differ = |(a, b): (&f64, f64)| (a - b).abs() >= 1e-12 * most;
            assert!(!found.iter().zip(own).any(differ));
        }
    }

    #[test]
    fn factors_of_their_own_replace_those_that_do_not_serve() {
        let (mut kept, states, arena) = (kept(), states(), Bump::new());
        let scaled = Scaled::new(&problem(&places(2.0), 1.0), &arena).expect("finite");
        // other states
        let all = vec![Stick; CONTACTS];
        assert!(from_kept(&scaled, &all, &unknowns(&scaled, &all), &kept).is_none());
        // Q is another one: corrections by the residual do not converge
        let far = Scaled::new(&problem(&places(100.0), 1.0), &arena).expect("finite");
        let unknowns = unknowns(&far, &states);
        assert!(from_kept(&far, &states, &unknowns, &kept).is_none());
        let (p, v) = forces(&far, &states, &mut kept).expect("own factors");
        assert!(unknowns.iter().all(|k| v[*k].abs() < 1e-13 * max_abs(&p)));
    }

    #[test]
    fn contacts_that_are_one_share_the_load() {
        let arena = Bump::new();
        // the first contact is there twice
        let places: Vec<f64> = std::iter::once(0.0).chain(places(2.0)).collect();
        let states: Vec<_> = std::iter::once(Stick).chain(states()).collect();
        let twice = Scaled::new(&problem(&places, 1.0), &arena).expect("finite");
        let (p, v) = forces(&twice, &states, &mut KeptFactors::default()).expect("shared");
        let mut closed = (0..places.len()).filter(|i| states[*i].is_closed());
        assert!(closed.all(|i| v[i].abs() < 1e-10 * max_abs(&p)));
        let difference = (p[0] - p[1]).abs();
        assert!(difference < 1e-5 * max_abs(&p), "{} {}", p[0], p[1]);
    }
}
