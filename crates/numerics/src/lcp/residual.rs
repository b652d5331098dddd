//! The check of a solution, computed from the data and independent of every method.

use bumpalo::Bump;
use nalgebra::DVector;

use super::dense::{List, add_product_and_sizes, filled, list, max_abs};
use super::problems::{FrictionalLcp, Lcp};
use super::scaled::Equilibration;
use crate::linear::{SMALLEST, larger, largest};

/// Largest residual of a point that counts as a solution.
pub(crate) const TOLERANCE: f64 = 1e-9;

/// Factor with which the terms |M_ij z_j| enter the scale of a residual. Evaluating w has a round-off of about 1e-16 of
/// the largest term, so 1e-9 of the scale is never below round-off.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Residual of z: zero for a solution, infinite if a number is not finite or a size is wrong. Errors so small that they
/// have lost digits count as zero.
///
/// r = max_i |z_i - max(0, z_i - w_i)| / s,  w = M z + q,  s = max |q| + 1e-6 max |M| |z|,
/// after rows and columns of M are scaled to entries near 1 (which makes the residual independent
/// of the units of z and w).
pub fn residual(lcp: &Lcp, z: &DVector<f64>) -> f64 {
    if lcp.check().is_err() || z.len() != lcp.q.len() {
        return f64::INFINITY;
    }
    let Equilibration { rows, columns } = Equilibration::of(&lcp.m);
    let w = lcp.w(z);
    let terms = lcp.m.abs() * z.abs();
    let (mut error, mut scale) = (0.0_f64, SMALLEST);
    for i in 0..z.len() {
        let (z_i, w_i) = (z[i] / columns[i], w[i] * rows[i]);
        error = worse(error, smaller(z_i, w_i));
        scale = scale.max(rows[i] * lcp.q[i].abs() + ROUNDING * rows[i] * terms[i]);
        // below, numbers lose digits
        scale = scale.max(SMALLEST * larger(rows[i], 1.0 / columns[i]));
    }
    relative(error, scale)
}

/// Residual of the forces (pn, pt) and free unknowns x of a frictional problem, which is zero for a solution, and the
/// gaps and slips under these forces.
///
/// The law of eq. (3.6) is written as r = max over contacts of |min(Pn, g)|, |min(T+, Dt+)|, |min(T-, Dt-)| with T+- =
/// (mu Pn +- Pt)/2 and Dt+- the positive and negative part of the slip. The unit of length is the deepest penetration,
/// or the penetration that forces on free unknowns would make if it is larger, plus 1e-6 of the terms of Q P. The unit
/// of force is this length over the mean of diag Qnn; it holds for the residual of the balance of free unknowns, too.
pub(crate) fn frictional_residual<'a>(
    problem: &FrictionalLcp,
    ([pn, pt], x): ([&[f64]; 2], &[f64]),
    arena: &'a Bump,
) -> (f64, List<'a, f64>) {
    let n = problem.gap.len();
    let mut motion = list(arena, problem.gap.iter().chain(&problem.slip).copied());
    let mut terms = filled(arena, 0.0, 2 * n);
    let forces = list(arena, pn.iter().chain(pt).copied());
    add_product_and_sizes(problem.q.as_slice(), &forces, &mut motion, &mut terms);
    let moved = problem.free.motions.as_slice();
    add_product_and_sizes(moved, x, &mut motion, &mut terms);
    let deepest = problem.gap.iter().fold(0.0_f64, |l, g| l.max(-g));
    let compliance = problem.compliance();
    let of_forces = compliance * largest(problem.free.force.as_slice());
    let contact = |i: usize| ([motion[i], motion[n + i]], [pn[i], pt[i]], problem.mu[i]);
    let length = larger(
        larger(deepest, of_forces) + ROUNDING * max_abs(&terms),
        problem.smallest_length(),
    );
    let law = law_residual((0..n).map(contact), compliance, length);
    let left = compliance * problem.free.left_over(x, &forces);
    let residual = worse(law, relative(left, length));
    // what is so small has lost its digits, and is no error
    match residual * length <= problem.smallest_length() {
        true => (0.0, motion),
        false => (residual, motion),
    }
}

/// Residual of the contact law, eq. (3.6), for the gap and slip, Pn and Pt, and mu of every contact. The unit of length
/// is `length`, and the unit of force is `length` over `compliance`.
pub(crate) fn law_residual(
    contacts: impl Iterator<Item = ([f64; 2], [f64; 2], f64)>,
    compliance: f64,
    length: f64,
) -> f64 {
    let mut error = 0.0_f64;
    for ([gap, slip], [pn, pt], mu) in contacts {
        let limit = mu * pn;
        error = worse(error, smaller(compliance * pn, gap));
        error = worse(error, smaller(compliance * 0.5 * (limit + pt), part(slip)));
        error = worse(error, smaller(compliance * 0.5 * (limit - pt), part(-slip)));
    }
    relative(error, length)
}

/// The larger of `error` and |value|; infinite when the value is not a number.
fn worse(error: f64, value: f64) -> f64 {
    if value.is_nan() {
        f64::INFINITY
    } else {
        error.max(value.abs())
    }
}

/// The smaller of two numbers, NaN if either is.
fn smaller(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}

/// The positive part, NaN of NaN.
fn part(slip: f64) -> f64 {
    if slip < 0.0 { 0.0 } else { slip }
}

/// error / scale, but never NaN: a zero error gives 0 at any scale, and a scale that overflows gives infinity.
fn relative(error: f64, scale: f64) -> f64 {
    if error == 0.0 {
        0.0
    } else if scale > 0.0 && scale.is_finite() {
        error / scale
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::lcp::FreeUnknowns;

    #[test]
    fn residual_is_zero_only_for_solutions() {
        let lcp = Lcp {
            m: DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]),
            q: DVector::from_row_slice(&[-1.0, -1.0]),
        };
        let third = 1.0 / 3.0;
        assert!(residual(&lcp, &DVector::from_element(2, third)) < 1e-15);
        assert!(residual(&lcp, &DVector::from_row_slice(&[0.5, 0.0])) > 0.1);
        assert!(residual(&lcp, &DVector::zeros(2)) > 0.1);
        assert_eq!(residual(&lcp, &DVector::zeros(3)), f64::INFINITY);
        assert_eq!(
            residual(&lcp, &DVector::from_element(2, f64::NAN)),
            f64::INFINITY
        );
    }

    #[test]
    fn frictional_residual_sees_each_condition() {
        let problem = FrictionalLcp {
            q: DMatrix::identity(2, 2),
            gap: DVector::from_element(1, -1.0),
            slip: DVector::from_element(1, 2.0),
            mu: DVector::from_element(1, 0.5),
            free: FreeUnknowns::default(),
        };
        let residual_of = |forces| frictional_residual(&problem, (forces, &[]), &Bump::new()).0;
        // Sliding: Pn = 1, Pt = -mu Pn, slip 1.5 > 0.
        assert_eq!(residual_of([&[1.0], &[-0.5]]), 0.0);
        assert!(
            residual_of([&[1.0], &[0.5]]) > 0.1,
            "friction drives the slip"
        );
        assert!(
            residual_of([&[1.0], &[0.0]]) > 0.1,
            "below the limit yet slides"
        );
        assert!(residual_of([&[1.0], &[-0.7]]) > 0.05, "above the limit");
        assert!(residual_of([&[0.5], &[-0.25]]) > 0.1, "penetrates");
        assert!(residual_of([&[2.0], &[-1.0]]) > 0.1, "pushes at a distance");
    }
}
