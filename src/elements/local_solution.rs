//! Strains of an element that make its energy least, found in the element by Newton's method. Section 2 of
//! docs/theory.md, Enhanced strains.

use nalgebra::{DMatrix, SMatrix, SVector, SymmetricEigen};

/// Steps of the local solution, and halvings of a step.
const MOST_STEPS: usize = 60;
/// Step at which the local solution ends as part of the strains: its own square is round-off.
pub(super) const LAST_STEP: f64 = 1e-8;
/// Part of the slope by which a step has to lower the energy.
const DESCENT: f64 = 1e-4;

/// Values that make an energy least, eq. (2.28), from zero on: Newton's method with a line search, the eigenvalues of the
/// stiffness taken positive. `derivatives` gives slope and stiffness, `change` the energy of the second values less that
/// of the first; the solution ends with a step of the size `last`. None where it does not converge.
pub(super) fn least<const A: usize>(
    derivatives: impl Fn(&SVector<f64, A>) -> (SVector<f64, A>, SMatrix<f64, A, A>),
    change: impl Fn(&SVector<f64, A>, &SVector<f64, A>) -> f64,
    last: f64,
) -> Option<SVector<f64, A>> {
    let mut alpha = SVector::<f64, A>::zeros();
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

/// -|K|^-1 g, where |K| has the eigenvalues of K without their signs; none where they are zero or no numbers.
fn descent<const A: usize>(k: SMatrix<f64, A, A>, g: &SVector<f64, A>) -> Option<SVector<f64, A>> {
    let step = match k.cholesky() {
        Some(factor) => -factor.solve(g),
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
