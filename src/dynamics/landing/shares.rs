//! How much of every pattern is added to the velocities, so that each gives its own energy. Section 6
//! of docs/theory.md, Landing return.

use nalgebra::DMatrix;

/// Change of the shares, as a part of them, at which sweeps end: their total is exact in any case.
const SWEPT: f64 = 1e-13;
/// Most sweeps.
const SWEEPS: usize = 1000;
/// Momentum along a pattern, as a part of that of the energy to be given, that is round-off of a
/// velocity of zero.
const AT_REST: f64 = 1e-8;

/// Signs of the shares: those of b, which strengthen the motion along each pattern and never reverse it; without any
/// motion the pattern of the force is taken.
pub(super) fn signs(a: &DMatrix<f64>, b: &[f64], energies: &[f64]) -> Vec<f64> {
    let sign = |j: usize| {
        let is_at_rest = b[j].abs() <= AT_REST * (2.0 * a[(j, j)] * energies[j]).sqrt();
        if b[j] < 0.0 && !is_at_rest { -1.0 } else { 1.0 }
    };
    (0..b.len()).map(sign).collect()
}

/// Shares y of the patterns with the given signs,
///
/// ```text
/// y_j (b_j + sum_k A_jk y_k / 2) = D_j,   eq. (6.9)
/// ```
///
/// A_jk = w_j.M w_k (energy for y = 1), b_j = w_j.M V1 - s_j + c_j, `energies` D_j > 0. There is one solution for any
/// signs of y: the minimum of a convex function, found coordinate by coordinate. A pattern without energy has no share.
pub(super) fn shares(a: &DMatrix<f64>, b: &[f64], energies: &[f64], signs: &[f64]) -> Vec<f64> {
    let n = b.len();
    let mut y = vec![0.0; n];
    for _ in 0..SWEEPS {
        let mut change = 0.0_f64;
        for j in 0..n {
            let sign = signs[j];
            let others: f64 = (0..n).filter(|&k| k != j).map(|k| a[(j, k)] * y[k]).sum();
            let root = positive_root(a[(j, j)] / 2.0, sign * (b[j] + others / 2.0), energies[j]);
            change = change.max((sign * root - y[j]).abs() / root.max(f64::MIN_POSITIVE));
            y[j] = sign * root;
        }
        if change <= SWEPT {
            break;
        }
    }
    let has_pattern = |&j: &usize| y[j] != 0.0;
    let energy = (0..n).filter(has_pattern).map(|j| energies[j]).sum();
    scaled_to(a, b, energy, y)
}

/// The shares times the factor with which they give the whole energy.
fn scaled_to(a: &DMatrix<f64>, b: &[f64], energy: f64, mut y: Vec<f64>) -> Vec<f64> {
    let n = y.len();
    let mut sums = [0.0; 2];
    for j in 0..n {
        sums[0] += y[j] * (0..n).map(|k| a[(j, k)] * y[k]).sum::<f64>() / 2.0;
        sums[1] += y[j] * b[j];
    }
    let factor = positive_root(sums[0], sums[1], energy);
    y.iter_mut().for_each(|y| *y *= factor);
    y
}

/// The root y > 0 of a y² + b y = D for a, D > 0; 0 where there is no pattern, a = 0.
fn positive_root(a: f64, b: f64, energy: f64) -> f64 {
    if a <= 0.0 {
        return 0.0;
    }
    let root = (b * b + 4.0 * a * energy).sqrt();
    match b > 0.0 {
        true => 2.0 * energy / (b + root),
        false => (root - b) / (2.0 * a),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Energy that every share gives.
    fn given(a: &DMatrix<f64>, b: &[f64], y: &[f64]) -> Vec<f64> {
        let n = y.len();
        let half = |j: usize| (0..n).map(|k| a[(j, k)] * y[k]).sum::<f64>() / 2.0;
        (0..n).map(|j| y[j] * (b[j] + half(j))).collect()
    }

    proptest! {
        /// Random patterns of 4 velocities, at most as many independent ones, also alike.
        #[test]
        fn every_share_gives_its_own_energy_and_strengthens_the_motion(
            w in proptest::collection::vec(proptest::collection::vec(-1.0..1.0_f64, 4), 1..7),
            v in proptest::collection::vec(-1.0..1.0_f64, 4),
            d in proptest::collection::vec(0.001..1.0_f64, 7),
        ) {
            let dot = |p: &[f64], q: &[f64]| -> f64 { p.iter().zip(q).map(|(p, q)| p * q).sum() };
            let n = w.len();
            let a = DMatrix::from_fn(n, n, |j, k| dot(&w[j], &w[k]));
            let b: Vec<f64> = w.iter().map(|w| dot(w, &v)).collect();
            let y = shares(&a, &b, &d[..n], &signs(&a, &b, &d[..n]));
            for (j, given) in given(&a, &b, &y).into_iter().enumerate() {
                prop_assert!((given - d[j]).abs() < 1e-6, "{given} {}", d[j]);
                prop_assert!(y[j] * b[j] >= 0.0);
            }
            let total: f64 = given(&a, &b, &y).iter().sum();
            prop_assert!((total - d[..n].iter().sum::<f64>()).abs() < 1e-12);
        }
    }

    #[test]
    fn a_point_mass_keeps_its_speed_whenever_it_lands() {
        // it lands after the part s of the increment and leaves it with -(1 - 2 s) of its speed of 1:
        // mass 1, D = 2 s (1 - s)
        for s in [0.0625, 0.25, 0.5, 0.75, 0.9375] {
            let (v, d) = (1.0 - 2.0 * s, 2.0 * s * (1.0 - s));
            let (a, b) = (DMatrix::from_element(1, 1, 4.0), [2.0 * v]);
            let y = shares(&a, &b, &[d], &signs(&a, &b, &[d]))[0];
            let expected = if s > 0.5 { -1.0 } else { 1.0 };
            assert!((v + 2.0 * y - expected).abs() < 1e-15, "{s}");
        }
    }

    #[test]
    fn patterns_that_are_alike_share_alike_and_one_without_motion_has_none() {
        let a = DMatrix::from_row_slice(3, 3, &[1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        let y = shares(&a, &[0.5, 0.5, 0.0], &[0.1; 3], &[1.0; 3]);
        assert!((y[0] - y[1]).abs() < 1e-12 && y[2] == 0.0, "{y:?}");
    }
}
