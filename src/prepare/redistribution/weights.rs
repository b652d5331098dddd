//! Weights of the donors of one node. Section 2 of docs/theory.md, Redistributed mass.

use nalgebra::{Matrix3, Vector3};

use crate::vectors::{difference, length};

/// Least number of donors: three points make an affine function.
const LEAST_DONORS: usize = 3;
/// Largest sum of |w|: beyond it a node is not extrapolated from its donors.
const MOST_WEIGHT: f64 = 6.0;
/// Least pivot of G, relative to its diagonal: below it the donors lie on a line.
const LEAST_PIVOT: f64 = 1e-10;

/// Weights of donors at the positions `donors` for a node at `x`, affine and the larger the nearer:
///
/// ```text
/// p_j = (1, (X_j - X)/h),  phi_j = (h/r_j)²,  r_j = |X_j - X|,  h = min r_j
/// w_j = phi_j p_j.G^-1 e1,  G = sum phi_j p_j p_j^T                           eq. (2.18)
/// ```
///
/// so that sum w_j = 1 and sum w_j X_j = X. None where the donors are too few, lie on a line, or
/// only on one side far away.
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
    let cholesky = g.cholesky()?;
    let is_small = |k: usize| cholesky.l_dirty()[(k, k)].powi(2) < LEAST_PIVOT * g[(k, k)];
    if (0..3).any(is_small) {
        return None;
    }
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
}
