//! Weights of the donors of one node. Section 2 of docs/theory.md, Redistributed mass.

use nalgebra::{Matrix3, Vector3};

use crate::vectors::{difference, length};

/// Least number of donors: three points make an affine function.
const LEAST_DONORS: usize = 3;
/// Largest sum of |w|: beyond it a node is not extrapolated from its donors. Weights of regular meshes are
/// ratios of small numbers, and their sums may be 6; they are never so little more.
const MOST_WEIGHT: f64 = 6.0 + 1e-6;
/// Least width of the donors, as a part of their length: narrower ones lie on a line but for the digits of
/// their coordinates.
const LEAST_WIDTH: f64 = 1e-3;

/// Weights of donors at the positions `donors` for a node at `x`, affine and the larger the nearer:
///
/// ```text
/// p_j = (1, (X_j - X)/h),  phi_j = (h/r_j)²,  r_j = |X_j - X|,  h = min r_j
/// w_j = phi_j p_j.G^-1 e1,  G = sum phi_j p_j p_j^T                           eq. (2.18)
/// ```
///
/// so that sum w_j = 1 and sum w_j X_j = X. None where the donors are too few, lie nearly on a line, or
/// only on one side far away: neither a motion of all points nor their order decides.
pub(super) fn weights(x: [f64; 2], donors: &[[f64; 2]]) -> Option<Vec<f64>> {
    if donors.len() < LEAST_DONORS {
        return None;
    }
    let arms: Vec<[f64; 2]> = donors.iter().map(|&donor| difference(x, donor)).collect();
    let h = arms
        .iter()
        .map(|&r| length(r))
        .fold(f64::INFINITY, f64::min);
    let p = |r: &[f64; 2]| Vector3::new(1.0, r[0] / h, r[1] / h);
    let phi = |r: &[f64; 2]| (h / length(*r)).powi(2);
    let g: Matrix3<f64> = arms.iter().map(|r| phi(r) * p(r) * p(r).transpose()).sum();
    if width(&g) < LEAST_WIDTH {
        return None;
    }
    let cholesky = g.cholesky()?;
    let mut w = vec![0.0; arms.len()];
    // the second time for what round-off has left of sum w p = e1
    for _ in 0..2 {
        let sum: Vector3<f64> = arms.iter().zip(&w).map(|(r, w)| *w * p(r)).sum();
        let solution = cholesky.solve(&(Vector3::x() - sum));
        for (w, r) in w.iter_mut().zip(&arms) {
            *w += phi(r) * p(r).dot(&solution);
        }
    }
    let size: f64 = w.iter().map(|w| w.abs()).sum();
    (size <= MOST_WEIGHT).then_some(w)
}

/// Width of the donors as a part of their length: with the scatter of the arms about their mean, which is the
/// Schur complement of G_11,
///
/// ```text
/// S = G_rr - G_r1 G_1r/G_11,  (width/length)² = det S/(tr S)²                 eq. (2.19)
/// ```
///
/// NaN where all donors are in one place.
fn width(g: &Matrix3<f64>) -> f64 {
    let scatter = |i: usize, k: usize| g[(i, k)] - g[(i, 0)] * g[(0, k)] / g[(0, 0)];
    let [xx, xy, yy] = [scatter(1, 1), scatter(1, 2), scatter(2, 2)];
    let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
    (determinant / (trace * trace)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a grid that is bent and scaled.
    fn grid(scale: f64) -> Vec<[f64; 2]> {
        let at = |k: u32| (f64::from(k % 5), f64::from(k / 5));
        let bent =
            |(i, j): (f64, f64)| [i + 0.2 * (1.3 * j).sin(), 1.0 + j + 0.3 * (0.9 * i).cos()];
        let points = (0..15).map(|k| bent(at(k)));
        points.map(|p| p.map(|x| scale * x)).collect()
    }

    #[test]
    fn affine_functions_are_exact() {
        for scale in [1e-3, 1.0, 1e5] {
            let (x, donors) = ([2.1 * scale, 0.2 * scale], grid(scale));
            let w = weights(x, &donors).expect("weights");
            let sum: f64 = w.iter().sum();
            assert!((sum - 1.0).abs() < 1e-15, "{sum}");
            for (i, own) in x.iter().enumerate() {
                let sum: f64 = w.iter().zip(&donors).map(|(w, x)| w * x[i]).sum();
                assert!((sum - own).abs() < 4e-15 * scale, "{sum} {own}");
            }
        }
    }

    #[test]
    fn by_hand_between_three_nodes() {
        // three points have one affine function: a node at the middle of two takes half of each
        let w = weights([0.5, 0.0], &[[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]]).expect("weights");
        for (w, expected) in w.iter().zip([0.5, 0.5, 0.0]) {
            assert!((w - expected).abs() < 1e-15, "{w}");
        }
    }

    #[test]
    fn too_few_donors_a_line_and_far_extrapolation_give_none() {
        let line: Vec<[f64; 2]> = (0..6).map(|k| [f64::from(k), 0.5]).collect();
        assert_eq!(weights([2.0, 0.0], &line[..2]), None);
        assert_eq!(weights([2.0, 0.0], &line), None);
        let thin: Vec<[f64; 2]> = (0..6)
            .map(|k| [f64::from(k), 0.5 + 0.1 * f64::from(k % 2)])
            .collect();
        assert_eq!(weights([2.0, 0.0], &thin), None);
        assert!(weights([2.0, 0.4], &thin).is_some());
    }

    /// Points turned by an angle, mirrored if so, and moved.
    fn moved(points: &[[f64; 2]], angle: f64, mirror: f64, to: [f64; 2]) -> Vec<[f64; 2]> {
        let (sin, cos) = angle.sin_cos();
        let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, mirror * (sin * x + cos * y)];
        let points = points.iter().map(|&point| turn(point));
        points
            .map(|[x, y]| [x + to[0], mirror * y + to[1]])
            .collect()
    }

    proptest::proptest! {
        /// A node on the line of its donors, or beside it, keeps its mass wherever the line lies and whatever
        /// the last digits of its points; a layer of elements of any use gives its mass up.
        #[test]
        fn donors_nearly_on_a_line_give_none_in_any_frame(
            angle in -4.0..4.0_f64,
            mirrored in proptest::bool::ANY,
            to in [-1e3..1e3_f64, -1e3..1e3_f64],
            beside in -1e-5..1e-5_f64,
            noise in proptest::collection::vec(-1e-5..1e-5_f64, 7),
        ) {
            let at = |k: usize, y: f64| [0.6 * k as f64, y];
            let line = noise.iter().enumerate().map(|(k, &y)| at(k, y));
            let mut points: Vec<[f64; 2]> = line.collect();
            points.push([-0.6, beside]);
            let mirror = if mirrored { -1.0 } else { 1.0 };
            let points = moved(&points, angle, mirror, to);
            proptest::prop_assert_eq!(weights(points[7], &points[..7]), None);
            proptest::prop_assert_eq!(weights(points[6], &points[..6]), None);

            // two rows of elements 50 times as long as high
            let rows: Vec<[f64; 2]> = (0..10).map(|k| at(k / 2, 0.012 * (1 + k % 2) as f64)).collect();
            let mut points = rows.clone();
            points.push([1.2, 0.0]);
            let points = moved(&points, angle, mirror, to);
            let expected = weights([1.2, 0.0], &rows).expect("weights");
            let found = weights(points[10], &points[..10]).expect("weights");
            for (found, expected) in found.iter().zip(expected) {
                proptest::prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_sum_of_weights_at_the_limit_is_within_it() {
        // a node at the distance 5/2 of two rows of donors has the weights 7/2 and -5/2 of a row
        let rows = |by: f64| -> Vec<[f64; 2]> {
            let row = |y: f64| [-1.0, 0.0, 1.0].map(|x| [0.1 * x, y]);
            [row(2.5 + by), row(3.5 + by)].concat()
        };
        for angle in [0.0, 0.3, 1.0, 2.0, 3.0, 4.0, 5.0] {
            for (by, expected) in [(0.0, true), (1e-3, false)] {
                let points = moved(&rows(by), angle, 1.0, [7.0, -3.0]);
                let node = moved(&[[0.0; 2]], angle, 1.0, [7.0, -3.0])[0];
                assert_eq!(weights(node, &points).is_some(), expected, "{angle} {by}");
            }
        }
    }
}
