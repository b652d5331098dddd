//! The forces of given contact states: a linear system, solved directly, or with the factors of a similar one.

use crate::lcp::pivots::Factors;
use crate::lcp::problems::{ContactState, Scaled, max_abs};

/// Shift of the diagonal, relative to its entries, that makes a singular system solvable.
const SHIFT: f64 = 1e-10;

/// Difference of mirrored entries, relative to their diagonal entries, of a symmetric matrix.
const ASYMMETRY: f64 = 1e-9;

/// Corrections by the residual: the first makes the gaps exact to round-off, more are needed only
/// by the shifted system.
const CORRECTIONS: usize = 6;

/// Corrections with the factors of a similar system.
const SIMILAR_CORRECTIONS: usize = 12;

/// Residual of forces that are as good as those of the own factors, in units of the sum of the terms of
/// its rows.
const ACCURATE: f64 = 4.0 * f64::EPSILON;

/// Factors of the system of some states, which serve for similar systems of the same states too: their
/// corrections by the residual converge.
#[derive(Default)]
pub struct KeptFactors {
    kept: Option<(Vec<ContactState>, Factors)>,
}

impl KeptFactors {
    /// Those of a system of the given states and size, if there are any.
    fn of(&self, states: &[ContactState], size: usize) -> Option<&Factors> {
        let kept = self.kept.as_ref().filter(|(of, _)| of == states);
        kept.map(|(_, factors)| factors)
            .filter(|factors| factors.size() == size)
    }
}

/// Solves for the forces p of the given states, and their motion v = Q p + b:
/// gap = 0 where closed, slip = 0 where sticking, Pt = -+mu Pn where sliding, no force where open.
/// None when no solution is finite. Where redundant contacts leave the forces undetermined they
/// share the load.
pub(crate) fn forces(
    scaled: &Scaled,
    states: &[ContactState],
    kept: &mut KeptFactors,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let unknowns = unknowns(scaled, states);
    if unknowns.is_empty() {
        return Some((vec![0.0; scaled.size()], scaled.b.clone()));
    }
    let size = unknowns.len();
    if let Some(factors) = kept.of(states, size)
        && let Some(found) = similar(scaled, states, &unknowns, factors)
    {
        return Some(found);
    }
    let matrix = || matrix(scaled, states, &unknowns);
    let nothing_slides = scaled.owners.iter().all(|i| states[*i].slip_sign() == 0.0);
    let values = matrix();
    let regular = if nothing_slides && is_symmetric(&values, size) {
        Factors::cholesky(values, size)
    } else {
        Factors::lu(values, size)
    };
    let solution = |factors: &Factors| {
        let (p, v, _) = refine(scaled, states, &unknowns, (factors, CORRECTIONS));
        p.iter().all(|v| v.is_finite()).then_some((p, v))
    };
    match regular {
        Some(factors) => {
            let found = solution(&factors);
            kept.kept = Some((states.to_vec(), factors));
            found
        }
        None => solution(&Factors::lu(shifted(matrix(), size), size)?),
    }
}

/// Forces from the factors of a similar system, if they are as good as those from the own ones.
fn similar(
    scaled: &Scaled,
    states: &[ContactState],
    unknowns: &[usize],
    factors: &Factors,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let (p, v, error) = refine(scaled, states, unknowns, (factors, SIMILAR_CORRECTIONS));
    let terms: f64 = (0..p.len()).map(|k| (scaled.q[(k, k)] * p[k]).abs()).sum();
    (error <= ACCURATE * terms).then_some((p, v))
}

/// Positions in p of the unknowns, which are also the rows that must vanish.
fn unknowns(scaled: &Scaled, states: &[ContactState]) -> Vec<usize> {
    let closed = (0..scaled.contacts).filter(|i| states[*i].is_closed());
    let tangents = scaled.owners.iter().zip(scaled.contacts..);
    let stick = tangents
        .filter(|(i, _)| states[**i] == ContactState::Stick)
        .map(|(_, k)| k);
    closed.chain(stick).collect()
}

/// The matrix of the system by columns: Q on the unknowns; the column of a sliding Pn is
/// Q e_n - slip sign mu Q e_t.
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
    scaled.tangents[k].map(|t| (t, -states[k].slip_sign() * scaled.mu[k]))
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

/// p and v from the factors, corrected by the residual of the unfactored system at most the given number
/// of times, as long as it decreases, and the largest residual.
fn refine(
    scaled: &Scaled,
    states: &[ContactState],
    unknowns: &[usize],
    (factors, corrections): (&Factors, usize),
) -> (Vec<f64>, Vec<f64>, f64) {
    let mut p = vec![0.0; scaled.size()];
    let mut best = (p.clone(), scaled.b.clone());
    let mut smallest = f64::INFINITY;
    for _ in 0..=corrections {
        let v = scaled.motion(&p);
        let mut residual: Vec<f64> = unknowns.iter().map(|k| -v[*k]).collect();
        let error = max_abs(&residual);
        if error.is_nan() || error >= smallest {
            break;
        }
        let stagnates = error > 0.1 * smallest;
        best = (p.clone(), v);
        smallest = error;
        if stagnates {
            break;
        }
        factors.solve(&mut residual);
        for (k, correction) in unknowns.iter().zip(&residual) {
            p[*k] += correction;
            if let Some((t, factor)) = sliding(scaled, states, *k) {
                p[t] = factor * p[*k];
            }
        }
    }
    let (p, v) = best;
    (p, v, smallest)
}
