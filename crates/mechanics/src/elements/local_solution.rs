//! Strains of an element that minimise its energy, found in the element by Newton's method. See
//! docs/theory/elements.md, Enhanced strains.

// Loops over strains: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use nalgebra::{DMatrix, SymmetricEigen};

use super::block::dot;
use crate::materials::number::LANES;
use crate::materials::{Lanes, Number};

/// Largest number of steps of the local solution, and of halvings of a step.
const MOST_STEPS: usize = 60;
/// Step, relative to the strains, at which the local solution ends: the square of this step is round-off.
pub const LAST_STEP: f64 = 1e-8;
/// Part of the slope by which a step must lower the energy.
const DESCENT: f64 = 1e-4;

/// For every element whether its solution is still sought; the values of solved elements are not read.
pub type Wanted = [bool; LANES];
/// The A strains of each element.
pub type Alpha<const A: usize> = [Lanes; A];
/// Second derivatives of the energy with respect to the A strains.
pub type Stiffness<const A: usize> = [[Lanes; A]; A];

/// Values that minimise the energies of elements, eq. (2.28), starting at `alpha`: Newton's method with a line search
/// and the absolute eigenvalues of the stiffness. `derivatives` gives slope and stiffness, and `change` the energy at
/// the second values less that at the first; the solution ends with a step of the size `last`. Values of an element are
/// NaN if its solution does not converge. The values of an element do not depend on the other elements.
pub fn least<const A: usize>(
    mut alpha: Alpha<A>,
    derivatives: impl Fn(&Alpha<A>, Wanted) -> (Alpha<A>, Stiffness<A>),
    change: impl Fn(&Alpha<A>, &Alpha<A>, Wanted) -> Lanes,
    last: Lanes,
) -> Alpha<A> {
    let mut is_open = [true; LANES];
    for _ in 0..MOST_STEPS {
        let (slope, stiffness) = derivatives(&alpha, is_open);
        let step = descent(&stiffness, &slope);
        let wanted = dot(&slope, &step) * DESCENT;
        for lane in 0..LANES {
            let size = largest(&step, lane);
            if !size.is_finite() {
                fail(&mut alpha, &mut is_open, lane);
            } else if is_open[lane] && size <= last.0[lane] {
                is_open[lane] = false;
                move_lane(&mut alpha, &step, lane, 1.0);
            }
        }
        let (mut is_searching, mut length) = (is_open, [1.0; LANES]);
        for _ in 0..MOST_STEPS {
            if is_searching == [false; LANES] {
                break;
            }
            let mut to = alpha;
            for lane in (0..LANES).filter(|&lane| is_searching[lane]) {
                move_lane(&mut to, &step, lane, length[lane]);
            }
            let change = change(&alpha, &to, is_searching);
            for lane in (0..LANES).filter(|&lane| is_open[lane]) {
                if is_searching[lane] && change.0[lane] <= length[lane] * wanted.0[lane] {
                    is_searching[lane] = false;
                } else if is_searching[lane] {
                    length[lane] /= 2.0;
                }
            }
        }
        for lane in 0..LANES {
            match (is_open[lane], is_searching[lane]) {
                (false, _) => {}
                (true, true) => fail(&mut alpha, &mut is_open, lane),
                (true, false) => move_lane(&mut alpha, &step, lane, length[lane]),
            }
        }
        if is_open == [false; LANES] {
            return alpha;
        }
    }
    (0..LANES).for_each(|lane| fail(&mut alpha, &mut is_open, lane));
    alpha
}

/// Finds, as [`least`] does but without an energy, the values at which the slope is zero.
pub fn zero<const A: usize>(
    derivatives: impl Fn(&Alpha<A>, Wanted) -> (Alpha<A>, Stiffness<A>),
    last: Lanes,
) -> Alpha<A> {
    let (mut alpha, mut is_open) = ([Lanes::ZERO; A], [true; LANES]);
    for _ in 0..MOST_STEPS {
        let (slope, stiffness) = derivatives(&alpha, is_open);
        let step = descent(&stiffness, &slope);
        for lane in 0..LANES {
            let size = largest(&step, lane);
            if !size.is_finite() {
                fail(&mut alpha, &mut is_open, lane);
            } else if is_open[lane] {
                is_open[lane] = size > last.0[lane];
                move_lane(&mut alpha, &step, lane, 1.0);
            }
        }
        if is_open == [false; LANES] {
            return alpha;
        }
    }
    (0..LANES).for_each(|lane| fail(&mut alpha, &mut is_open, lane));
    alpha
}

/// Adds `part` times a step to the values of one element.
fn move_lane<const A: usize>(alpha: &mut Alpha<A>, step: &Alpha<A>, lane: usize, part: f64) {
    for (alpha, step) in alpha.iter_mut().zip(step) {
        alpha.0[lane] += step.0[lane] * part;
    }
}

/// Sets the values of one unsolved element to NaN.
fn fail<const A: usize>(alpha: &mut Alpha<A>, is_open: &mut [bool; LANES], lane: usize) {
    if std::mem::take(&mut is_open[lane]) {
        alpha.iter_mut().for_each(|alpha| alpha.0[lane] = f64::NAN);
    }
}

/// Largest absolute value in one element; NaN if one of the values is NaN.
fn largest<const A: usize>(values: &Alpha<A>, lane: usize) -> f64 {
    values
        .iter()
        .fold(0.0, |most: f64, value| match value.0[lane].is_nan() {
            true => f64::NAN,
            false if most.is_nan() => most,
            false => most.max(value.0[lane].abs()),
        })
}

/// The solution K^-1 g; NaN for elements whose matrix K is not positive definite. The factorisation K = L D L^T needs
/// no roots, so the result has the same bits in units that differ by powers of two.
fn positive<const A: usize>(k: &Stiffness<A>, g: &Alpha<A>) -> Alpha<A> {
    // the elimination leaves D L^T above the diagonal of `rows`
    let (mut rows, mut x) = (*k, *g);
    for j in 0..A {
        let pivot = rows[j][j].each(|pivot| match pivot > 0.0 {
            true => pivot,
            false => f64::NAN,
        });
        rows[j][j] = pivot;
        for i in j + 1..A {
            let factor = rows[i][j] / pivot;
            x[i] = x[i] - factor * x[j];
            for c in j + 1..A {
                rows[i][c] = rows[i][c] - factor * rows[j][c];
            }
        }
    }
    for j in (0..A).rev() {
        for c in j + 1..A {
            x[j] = x[j] - rows[j][c] * x[c];
        }
        x[j] = x[j] / rows[j][j];
    }
    x
}

/// The products of K^-1 and some columns; zero for elements whose matrix K is singular.
pub fn solved<const A: usize, const M: usize>(
    k: &Stiffness<A>,
    columns: &[Alpha<A>; M],
) -> [Alpha<A>; M] {
    let mut all = columns.each_ref().map(|column| positive(k, column));
    for lane in 0..LANES {
        if !all.as_flattened().iter().any(|x| x.0[lane].is_nan()) {
            continue;
        }
        let inverse = DMatrix::from_fn(A, A, |i, j| k[i][j].0[lane]).try_inverse();
        for (x, column) in all.iter_mut().zip(columns) {
            for (i, x) in x.iter_mut().enumerate() {
                let terms = |inverse: &DMatrix<f64>| {
                    (0..A).map(|j| inverse[(i, j)] * column[j].0[lane]).sum()
                };
                x.0[lane] = inverse.as_ref().map_or(0.0, terms);
            }
        }
    }
    all
}

/// The step -|K|^-1 g, where |K| has the absolute eigenvalues of K. The result is NaN in the lane of an element for
/// which no step exists, because an eigenvalue is zero or not finite.
fn descent<const A: usize>(k: &Stiffness<A>, g: &Alpha<A>) -> Alpha<A> {
    let mut step = positive(k, g).map(|x| x * -1.0);
    for lane in 0..LANES {
        if step.iter().all(|x| !x.0[lane].is_nan()) {
            continue;
        }
        let matrix = DMatrix::from_fn(A, A, |i, j| k[i][j].0[lane]);
        let Some(pairs) = SymmetricEigen::try_new(matrix, f64::EPSILON, 1000) else {
            continue;
        };
        let mut own = [0.0; A];
        let columns = pairs.eigenvectors.column_iter();
        for (value, v) in pairs.eigenvalues.iter().zip(columns) {
            let along: f64 = v.iter().zip(g).map(|(v, g)| v * g.0[lane]).sum();
            for (own, v) in own.iter_mut().zip(v.iter()) {
                *own -= v * (along / value.abs());
            }
        }
        for (step, own) in step.iter_mut().zip(own) {
            step.0[lane] = own;
        }
    }
    step
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
        let found = |units: f64| {
            let k: Stiffness<3> = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    Lanes([positive[(i, j)] * units, indefinite[(i, j)] * units])
                })
            });
            descent(&k, &std::array::from_fn(|i| Lanes::all(g[i] * units)))
        };
        let step = found(1.0);
        for lane in 0..LANES {
            assert!((0..3).map(|i| step[i].0[lane] * g[i]).sum::<f64>() < 0.0);
        }
        for units in [2.0_f64, 2.0_f64.powi(-11), 2.0_f64.powi(20)] {
            assert_eq!(found(units), step, "{units}");
        }
        let exact = -positive.try_inverse().expect("regular") * g;
        assert!((0..3).all(|i| (step[i].0[0] - exact[i]).abs() < 1e-14));
    }

    #[test]
    fn elements_side_by_side_have_the_values_that_they_have_alone() {
        // energies (x - c)^4 + (x - c)²/2: some of the elements take more steps
        let solve = |c: [f64; 2]| {
            let derivatives = |x: &Alpha<1>, _: Wanted| {
                let d = x[0] - Lanes(c);
                ([d * d * d * 4.0 + d], [[d * d * 12.0 + 1.0]])
            };
            let energy = |x: Lanes| {
                let d = x - Lanes(c);
                d * d * d * d + d * d * 0.5
            };
            let change =
                |from: &Alpha<1>, to: &Alpha<1>, _: Wanted| energy(to[0]) - energy(from[0]);
            least([Lanes::ZERO], derivatives, change, Lanes::all(1e-8))[0].0
        };
        let [far, near] = solve([30.0, 0.1]);
        assert!((far - 30.0).abs() < 1e-14 && (near - 0.1).abs() < 1e-14);
        assert_eq!(solve([0.1, 0.1]), [near, near]);
        assert_eq!(solve([30.0, 30.0]), [far, far]);
    }
}
