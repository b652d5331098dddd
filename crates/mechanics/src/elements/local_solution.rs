//! Strains of an element that make its energy least, found in the element by Newton's method. Section 2 of
//! docs/theory.md, Enhanced strains.

use nalgebra::{DMatrix, SMatrix, SVector, SymmetricEigen};

/// Steps of the local solution, and halvings of a step.
const MOST_STEPS: usize = 60;
/// Step at which the local solution ends as part of the strains: its own square is round-off.
pub(super) const LAST_STEP: f64 = 1e-8;
/// Part of the slope by which a step has to lower the energy.
const DESCENT: f64 = 1e-4;

/// Values that make an energy least, eq. (2.28), from some `alpha` on: Newton's method with a line search, the eigenvalues of the
/// stiffness taken positive. `derivatives` gives slope and stiffness, `change` the energy of the second values less that
/// of the first; the solution ends with a step of the size `last`. None where it does not converge.
pub(super) fn least<const A: usize>(
    mut alpha: SVector<f64, A>,
    derivatives: impl Fn(&SVector<f64, A>) -> (SVector<f64, A>, SMatrix<f64, A, A>),
    change: impl Fn(&SVector<f64, A>, &SVector<f64, A>) -> f64,
    last: f64,
) -> Option<SVector<f64, A>> {
    for _ in 0..MOST_STEPS {
        let (slope, stiffness) = derivatives(&alpha);
        let step = descent(stiffness, &slope)?;
        if step.amax() <= last {
            return Some(alpha + step);
        }
        let wanted = DESCENT * slope.dot(&step);
        let lengths = (0..MOST_STEPS).map(|halvings| 0.5_f64.powi(halvings as i32));
        let mut lengths = lengths.filter(|&t| change(&alpha, &(alpha + step * t)) <= t * wanted);
        alpha += step * lengths.next()?;
    }
    None
}

/// As [`least`] where there is no energy: the values at which the slope is zero.
pub(super) fn zero<const A: usize>(
    derivatives: impl Fn(&SVector<f64, A>) -> (SVector<f64, A>, SMatrix<f64, A, A>),
    last: f64,
) -> Option<SVector<f64, A>> {
    let mut alpha = SVector::<f64, A>::zeros();
    for _ in 0..MOST_STEPS {
        let (slope, stiffness) = derivatives(&alpha);
        let step = descent(stiffness, &slope)?;
        alpha += step;
        if step.amax() <= last {
            return Some(alpha);
        }
    }
    None
}

/// K^-1 g of a positive definite K; none of others. The factors of K = L D L^T take no roots: units that differ by powers
/// of two change no bit.
fn positive<const A: usize>(
    k: &SMatrix<f64, A, A>,
    g: &SVector<f64, A>,
) -> Option<SVector<f64, A>> {
    // D L^T is left above the diagonal of `rows`
    let (mut rows, mut x) = (*k, *g);
    for j in 0..A {
        let pivot = rows[(j, j)];
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        for i in j + 1..A {
            let factor = rows[(i, j)] / pivot;
            x[i] -= factor * x[j];
            for c in j + 1..A {
                rows[(i, c)] -= factor * rows[(j, c)];
            }
        }
    }
    for j in (0..A).rev() {
        for c in j + 1..A {
            x[j] -= rows[(j, c)] * x[c];
        }
        x[j] /= rows[(j, j)];
    }
    Some(x)
}

/// -|K|^-1 g, where |K| has the eigenvalues of K without their signs; none where they are zero or no numbers.
fn descent<const A: usize>(k: SMatrix<f64, A, A>, g: &SVector<f64, A>) -> Option<SVector<f64, A>> {
    let step = match positive(&k, g) {
        Some(step) => -step,
        None => {
            let k = DMatrix::from_column_slice(A, A, k.as_slice());
            let pairs = SymmetricEigen::try_new(k, f64::EPSILON, 1000)?;
            let mut step = SVector::<f64, A>::zeros();
            for (value, v) in pairs
                .eigenvalues
                .iter()
                .zip(pairs.eigenvectors.column_iter())
            {
                step -= v * (v.dot(g) / value.abs());
            }
            step
        }
    };
    step.iter().all(|x| x.is_finite()).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn units_that_differ_by_a_power_of_two_change_no_bit() {
        let positive = Matrix3::new(3.0, 0.7, -0.2, 0.7, 2.0, 0.3, -0.2, 0.3, 1.1);
        let indefinite = positive - Matrix3::identity() * 1.7;
        let g = Vector3::new(0.3, -1.1, 0.7);
        for k in [positive, indefinite] {
            let step = descent(k, &g).expect("finite");
            assert!(step.dot(&g) < 0.0);
            for units in [2.0_f64, 2.0_f64.powi(-11), 2.0_f64.powi(20)] {
                assert_eq!(descent(k * units, &(g * units)), Some(step), "{units}");
            }
        }
        let exact = -positive.try_inverse().expect("regular") * g;
        assert!((descent(positive, &g).expect("finite") - exact).norm() < 1e-14);
    }
}
