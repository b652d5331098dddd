//! Shares of the patterns that are added to the velocities, so that each pattern gives its own energy. See
//! docs/theory/impacts.md, Landing return.

use nalgebra::DMatrix;

/// Relative change of the shares at which the sweeps end. The energy of all shares together is exact whatever the
/// tolerance is.
const LAST_CHANGE: f64 = 1e-13;
/// Most sweeps.
const MOST_SWEEPS: usize = 1000;
/// Momentum along a pattern up to which this momentum is round-off of a zero velocity, relative to the momentum that
/// belongs to the energy to be given.
const REST_MOMENTUM: f64 = 1e-8;

/// Signs of the shares: the signs of the momenta b along the patterns, so each share strengthens the motion along its
/// pattern and never reverses it. Without any motion along a pattern its share has the sign of the force.
pub(super) fn signs(a: &DMatrix<f64>, b: &[f64], energies: &[f64]) -> Vec<f64> {
    let sign = |j: usize| {
        let is_at_rest = b[j].abs() <= REST_MOMENTUM * (2.0 * a[(j, j)] * energies[j]).sqrt();
        if b[j] < 0.0 && !is_at_rest { -1.0 } else { 1.0 }
    };
    (0..b.len()).map(sign).collect()
}

/// Shares y of the patterns, with the given signs,
///
/// ```text
/// y_j (b_j + sum_k A_jk y_k / 2) = D_j  or  |y_j| = Y_j,   eq. (6.9)
/// ```
///
/// Here A_jk = w_j.M w_k (energy for y = 1), b_j = w_j.M V1 - s_j + c_j; `energies` are the energies D_j > 0 and `most`
/// the limits Y_j. For any signs of the shares y there is exactly one solution if no limit Y_j is reached: the minimum
/// of a convex function, which is found coordinate by coordinate. A pattern has no share if it has no energy, or if its
/// share at the limit Y_j would remove energy.
pub(super) fn shares(
    a: &DMatrix<f64>,
    b: &[f64],
    energies: &[f64],
    signs: &[f64],
    most: &[f64],
) -> Vec<f64> {
    let n = b.len();
    let (mut y, mut has_share) = (vec![0.0; n], vec![true; n]);
    for _ in 0..MOST_SWEEPS {
        let mut change = 0.0_f64;
        for j in (0..n).filter(|&j| has_share[j]).collect::<Vec<_>>() {
            let others: f64 = (0..n).filter(|&k| k != j).map(|k| a[(j, k)] * y[k]).sum();
            let (a, b) = (a[(j, j)] / 2.0, signs[j] * (b[j] + others / 2.0));
            let root = positive_root(a, b, energies[j]).min(most[j]);
            has_share[j] = b + a * root > 0.0;
            let share = if has_share[j] { root } else { 0.0 };
            change = change.max((signs[j] * share - y[j]).abs() / share.max(f64::MIN_POSITIVE));
            y[j] = signs[j] * share;
        }
        if change <= LAST_CHANGE {
            break;
        }
    }
    y
}

/// Energy given by every share y_j, y_j (b_j + sum_k A_jk y_k/2); the sum of these energies is the change of energy by
/// all shares, eq. (6.9).
pub(super) fn given(a: &DMatrix<f64>, b: &[f64], y: &[f64]) -> Vec<f64> {
    let half = |j: usize| (0..y.len()).map(|k| a[(j, k)] * y[k]).sum::<f64>() / 2.0;
    (0..y.len()).map(|j| y[j] * (b[j] + half(j))).collect()
}

/// The root y > 0 of a y² + b y = D for a, D > 0; 0 without a pattern (a = 0).
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

    proptest! {
        /// The patterns are random over 4 velocities: up to 4 independent patterns, and also equal patterns.
        #[test]
        fn every_share_gives_its_own_energy_and_strengthens_the_motion(
            w in proptest::collection::vec(proptest::collection::vec(-1.0..1.0_f64, 4), 1..7),
            v in proptest::collection::vec(-1.0..1.0_f64, 4),
            d in proptest::collection::vec(0.001..1.0_f64, 7),
            bound in 0.01..10.0_f64,
        ) {
            let dot = |p: &[f64], q: &[f64]| -> f64 { p.iter().zip(q).map(|(p, q)| p * q).sum() };
            let n = w.len();
            let a = DMatrix::from_fn(n, n, |j, k| dot(&w[j], &w[k]));
            let b: Vec<f64> = w.iter().map(|w| dot(w, &v)).collect();
            let signs = signs(&a, &b, &d[..n]);
            let y = shares(&a, &b, &d[..n], &signs, &[f64::INFINITY; 7]);
            for (j, given) in given(&a, &b, &y).into_iter().enumerate() {
                prop_assert!((given - d[j]).abs() < 1e-6, "{given} {}", d[j]);
                prop_assert!(y[j] * b[j] >= 0.0);
            }
            // no share is above its bound, and a share at its bound gives only a part of its energy
            let y = shares(&a, &b, &d[..n], &signs, &[bound; 7]);
            for (j, given) in given(&a, &b, &y).into_iter().enumerate() {
                prop_assert!(y[j].abs() <= bound && given > -1e-6 && given < d[j] + 1e-6);
                prop_assert!(y[j] == 0.0 || y[j].abs() == bound || (given - d[j]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn a_point_mass_keeps_its_speed_whenever_it_lands() {
        // a mass 1 with the speed 1 lands after the part s of the increment and ends it with the velocity -(1 - 2 s),
        // so D = 2 s (1 - s)
        for s in [0.0625, 0.25, 0.5, 0.75, 0.9375] {
            let (v, d) = (1.0 - 2.0 * s, 2.0 * s * (1.0 - s));
            let (a, b) = (DMatrix::from_element(1, 1, 4.0), [2.0 * v]);
            let y = shares(&a, &b, &[d], &signs(&a, &b, &[d]), &[f64::INFINITY])[0];
            let expected = if s > 0.5 { -1.0 } else { 1.0 };
            assert!((v + 2.0 * y - expected).abs() < 1e-15, "{s}");
        }
    }

    #[test]
    fn patterns_that_are_alike_share_alike_and_one_without_motion_has_none() {
        let a = DMatrix::from_row_slice(3, 3, &[1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        let y = shares(
            &a,
            &[0.5, 0.5, 0.0],
            &[0.1; 3],
            &[1.0; 3],
            &[f64::INFINITY; 3],
        );
        assert!((y[0] - y[1]).abs() < 1e-12 && y[2] == 0.0, "{y:?}");
    }
}
