//! Strains that differ from the mean of an element, in the measure in which the energy of its material is convex. Section 2
//! of docs/theory.md, Enhanced strains.
//!
//! # Derivation
//!
//! With the mean Ebar of the displacement strains and Cbar = I + 2 Ebar, what an element has beside its mean is
//! A = E + M alpha - Ebar. Its strain is Ebar + A in the measure of Green and Lagrange. Cbar exp(2 Cbar^-1 A) is additive
//! in logarithmic strains instead. Cayley's approximation of the exponential agrees with it up to the second order:
//!
//! ```text
//! I + 2 E_g = Cbar (1 - Q)^-1 (1 + Q),   Q = Cbar^-1 A
//! E_g = Ebar + A + A H A,   H = (Cbar - A)^-1, or 0 in the measure of Green and Lagrange
//! ```
//!
//! It is singular where Cbar + A is. The displacements, whose strain is linear in q (eq. 2.27), turn a point of a
//! parallelogram inside out there, so that the material feels it. With N = H A, W = 1 + N and dH = -H (2 dEbar - dA) H
//! the derivatives are
//!
//! ```text
//! dE_g  = dEbar + W^T dA W - 2 N^T dEbar N = dEbar + dA + dA N + N^T B,   B = dA W - 2 dEbar N
//! d²E_g = B_1^T H B_2 + its transpose
//! ```

use nalgebra::SMatrix;

use crate::materials::StrainMeasure;

/// A tensor in D directions.
pub(super) type Tensor<const D: usize> = SMatrix<f64, D, D>;

/// Mean strain of an element, and the measure in which strains are added to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct MeanStrain<const D: usize> {
    /// Ebar
    pub strain: Tensor<D>,
    pub measure: StrainMeasure,
}

/// The difference between two symmetric tensors has the round-off of their product; half of it and its transpose has not.
fn symmetric<const D: usize>(t: Tensor<D>) -> Tensor<D> {
    (t + t.transpose()) / 2.0
}

/// The first variation of a strain of the displacements or of the element: at a point, and of the mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct Variation<const D: usize> {
    pub at_point: Tensor<D>,
    pub of_mean: Tensor<D>,
}

/// A strain of an element at a point beside its mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct AddedStrain<const D: usize> {
    /// E + M alpha
    linear: Tensor<D>,
    /// A
    beside: Tensor<D>,
    /// H, NaN where the point or the mean has turned inside out.
    h: Tensor<D>,
    /// N
    n: Tensor<D>,
}

impl<const D: usize> MeanStrain<D> {
    /// Adds what E + M alpha has beside the mean.
    pub fn add(&self, linear: Tensor<D>) -> AddedStrain<D> {
        let beside = linear - self.strain;
        let h = match self.measure {
            StrainMeasure::Green => Some(Tensor::zeros()),
            StrainMeasure::Logarithmic => {
                let mean = Tensor::identity() + self.strain * 2.0;
                let both = [mean + beside, mean - beside].map(|c| c.cholesky());
                let all_positive = both.iter().all(Option::is_some);
                let inverse = (mean - beside).try_inverse();
                inverse.filter(|_| all_positive).map(symmetric)
            }
        };
        let h = h.unwrap_or(Tensor::from_element(f64::NAN));
        AddedStrain {
            linear,
            beside,
            h,
            n: h * beside,
        }
    }
}

impl<const D: usize> AddedStrain<D> {
    /// E_g
    pub fn strain(&self) -> Tensor<D> {
        self.linear + symmetric(self.beside * self.n)
    }

    /// E_g less that at the start of a variation, with a round-off that is relative to the variation:
    ///
    /// ```text
    /// A1 H1 A1 - A0 H0 A0 = dA H1 A1 + A0 dH A1 + A0 H0 dA,   dH = -H1 (2 dEbar - dA) H0
    /// ```
    pub fn change(
        &self,
        start: &Self,
        Variation { at_point, of_mean }: &Variation<D>,
    ) -> Tensor<D> {
        let da = at_point - of_mean;
        let dh = self.h * (da - of_mean * 2.0) * start.h;
        let before = start.n.transpose();
        at_point + symmetric(da * self.n + start.beside * dh * self.beside + before * da)
    }

    /// What a stress S on E_g does work on:
    ///
    /// ```text
    /// S:dE_g = T:(dE + M dalpha) - R:dEbar,   T = W S W^T,   R = T - S + 2 N S N^T
    /// ```
    pub fn conjugate(&self, s: &Tensor<D>) -> [Tensor<D>; 2] {
        let half = self.n * s;
        let square = symmetric(half * self.n.transpose());
        let more = half + half.transpose() + square;
        [s + more, more + square * 2.0]
    }

    /// dE_g of a variation, and its B.
    pub fn variation(&self, Variation { at_point, of_mean }: &Variation<D>) -> [Tensor<D>; 2] {
        let da = at_point - of_mean;
        let b = da + (da - of_mean * 2.0) * self.n;
        let first = at_point + symmetric(da * self.n + self.n.transpose() * b);
        [first, b]
    }

    /// 2 H B S, whose product with another B is S : d²E_g.
    pub fn second_stress(&self, b: &Tensor<D>, s: &Tensor<D>) -> Tensor<D> {
        self.h * b * s * 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    const MEAN: Matrix3<f64> = Matrix3::new(0.3, 0.1, 0.0, 0.1, -0.1, 0.0, 0.0, 0.0, 0.05);
    const LINEAR: Matrix3<f64> = Matrix3::new(0.35, 0.14, 0.0, 0.14, -0.2, 0.0, 0.0, 0.0, 0.1);
    const WAY: Matrix3<f64> = Matrix3::new(0.3, -0.2, 0.0, -0.2, 0.1, 0.0, 0.0, 0.0, -0.4);
    const OF_MEAN: Matrix3<f64> = Matrix3::new(0.1, 0.3, 0.0, 0.3, -0.2, 0.0, 0.0, 0.0, 0.2);
    const STRESS: Matrix3<f64> = Matrix3::new(2.0, 0.7, 0.0, 0.7, -1.0, 0.0, 0.0, 0.0, 1.3);

    fn mean(strain: Matrix3<f64>) -> MeanStrain<3> {
        let measure = StrainMeasure::Logarithmic;
        MeanStrain { strain, measure }
    }

    #[test]
    fn derivatives_are_those_of_the_strain() {
        let at = |t: f64| mean(MEAN + OF_MEAN * t).add(LINEAR + WAY * t).strain();
        let start = mean(MEAN).add(LINEAR);
        let variation = Variation {
            at_point: WAY,
            of_mean: OF_MEAN,
        };
        let ([first, b], h) = (start.variation(&variation), 1e-4);
        assert!((first - (at(h) - at(-h)) / (2.0 * h)).norm() < 1e-7);
        let [on_all, on_mean] = start.conjugate(&STRESS);
        let work = on_all.dot(&WAY) - on_mean.dot(&OF_MEAN);
        assert!((work - STRESS.dot(&first)).abs() < 1e-14);
        let second = (at(h) - at(0.0) * 2.0 + at(-h)) / (h * h);
        let found = start.second_stress(&b, &STRESS).dot(&b);
        assert!((found - STRESS.dot(&second)).abs() < 1e-6);
        for size in [0.3, 1e-4] {
            let step = WAY * size;
            let end = mean(MEAN + OF_MEAN * size).add(LINEAR + step);
            let variation = Variation {
                at_point: step,
                of_mean: OF_MEAN * size,
            };
            let found = end.change(&start, &variation);
            assert!((found - (at(size) - at(0.0))).norm() < 1e-14);
        }
    }

    #[test]
    fn logarithms_of_stretches_are_added_up_to_the_second_order() {
        let mean = mean(Matrix3::from_diagonal(&Vector3::new(1.5, -0.3, 0.0)));
        let logarithm = |e: f64| (1.0 + 2.0 * e).ln() / 2.0;
        for size in [1e-2, 1e-3] {
            let linear = Matrix3::from_diagonal(&Vector3::new(1.5 + 4.0 * size, -0.3, 0.0));
            let found = logarithm(mean.add(linear).strain()[0]) - logarithm(1.5) - size;
            assert!(found.abs() < size * size * size, "{found}");
        }
    }

    #[test]
    fn the_material_feels_that_displacements_turn_a_point_inside_out() {
        // bent in its plane, a bar of the stretch F has F + q s at s, and the strain that is linear in q
        let stretch: f64 = 1.3;
        let strain = |f: f64| Matrix3::from_diagonal(&Vector3::new((f * f - 1.0) / 2.0, 0.1, 0.2));
        let of = |qs: f64| {
            let linear = strain(stretch) + Matrix3::from_diagonal(&Vector3::x()) * stretch * qs;
            let c = mean(strain(stretch)).add(linear).strain() * 2.0 + Matrix3::identity();
            c.determinant()
        };
        let all: Vec<f64> = (0..20)
            .map(|i| of(-stretch * f64::from(i) / 20.0))
            .collect();
        assert!(all.windows(2).all(|pair| pair[1] < pair[0]), "{all:?}");
        let last = of(-stretch * (1.0 - 1e-12));
        assert!(last > 0.0 && last < 1e-11, "{last}");
        assert!(of(-1.01 * stretch).is_nan());
    }
}
