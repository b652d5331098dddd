//! Strains that differ from the mean of an element, in the measure in which the energy of its material is convex. Section 2
//! of docs/theory.md, Enhanced strains.
//!
//! # Derivation
//!
//! With the mean Ebar of the displacement strains, Cbar = I + 2 Ebar and P = Cbar^-1, what an element has beside its mean
//! is A = E + M alpha - Ebar. Its strain is Ebar + A in the measure of Green and Lagrange. Cbar exp(2 P A) is additive in
//! logarithmic strains instead; up to its second order
//!
//! ```text
//! E_g = Ebar + A + k A P A,   k = 1, or 0 in the measure of Green and Lagrange
//! ```
//!
//! whose derivatives follow from d(A P A) = dA P A + A P dA - 2 A P dEbar P A.

use nalgebra::SMatrix;

/// A tensor in D directions.
pub(super) type Tensor<const D: usize> = SMatrix<f64, D, D>;

/// Mean strain of an element in a measure.
#[derive(Debug, Clone, Copy)]
pub(super) struct MeanStrain<const D: usize> {
    strain: Tensor<D>,
    /// P
    inverse: Tensor<D>,
    /// k
    second: f64,
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

impl<const D: usize> MeanStrain<D> {
    /// Of a mean of strains; `second` is k. NaN where the mean has turned inside out.
    pub fn new(strain: Tensor<D>, second: f64) -> Self {
        let inverse = match second > 0.0 {
            true => (Tensor::identity() + strain * 2.0).try_inverse(),
            false => Some(Tensor::zeros()),
        };
        let inverse = symmetric(inverse.unwrap_or(Tensor::from_element(f64::NAN)));
        MeanStrain {
            strain,
            inverse,
            second,
        }
    }

    /// E_g from E + M alpha.
    pub fn strain(&self, linear: &Tensor<D>) -> Tensor<D> {
        let a = linear - self.strain;
        linear + symmetric(a * self.inverse * a) * self.second
    }

    /// E_g at the end less that at the start, whose E + M alpha has changed by `change` and whose mean by `of_mean`, with a
    /// round-off that is relative to these changes:
    ///
    /// ```text
    /// A1 P1 A1 - A0 P0 A0 = dA P1 A1 + A0 dP A1 + A0 P0 dA,   dP = -2 P1 dEbar P0
    /// ```
    pub fn change(
        [start, end]: [&Self; 2],
        [linear0, linear1]: [&Tensor<D>; 2],
        Variation { at_point, of_mean }: &Variation<D>,
    ) -> Tensor<D> {
        let (a0, a1) = (linear0 - start.strain, linear1 - end.strain);
        let (p0, p1) = (start.inverse, end.inverse);
        let (da, dp) = (at_point - of_mean, p1 * of_mean * p0 * -2.0);
        at_point + symmetric(da * p1 * a1 + a0 * dp * a1 + a0 * p0 * da) * end.second
    }

    /// What does work on E + M alpha at a point beside the stress S on E_g, and what does none on the mean, so that the
    /// sum of both does work on A alone:
    ///
    /// ```text
    /// Z = k (P A S + S A P),   Y = 2 k P A S A P,   S:dE_g = (S + Z):(dE + M dalpha) - (Z + Y):dEbar
    /// ```
    pub fn conjugate(&self, linear: &Tensor<D>, s: &Tensor<D>) -> [Tensor<D>; 2] {
        let pa = self.inverse * (linear - self.strain);
        let half = pa * s * self.second;
        [
            half + half.transpose(),
            symmetric(half * pa.transpose()) * 2.0,
        ]
    }

    /// dE_g of a variation, and B = dA - 2 dEbar P A, with which S : d²E_g = 2 k tr(S B_1^T P B_2).
    pub fn variation(
        &self,
        linear: &Tensor<D>,
        Variation { at_point, of_mean }: &Variation<D>,
    ) -> [Tensor<D>; 2] {
        let pa = self.inverse * (linear - self.strain);
        let da = at_point - of_mean;
        let b = da - of_mean * pa * 2.0;
        let half = (da - pa.transpose() * of_mean) * pa;
        [at_point + (half + half.transpose()) * self.second, b]
    }

    /// k (P B S + its transpose), whose product with another B is S : d²E_g.
    pub fn second_stress(&self, b: &Tensor<D>, s: &Tensor<D>) -> Tensor<D> {
        self.inverse * b * s * (2.0 * self.second)
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

    #[test]
    fn derivatives_are_those_of_the_strain() {
        let at = |t: f64| MeanStrain::new(MEAN + OF_MEAN * t, 1.0).strain(&(LINEAR + WAY * t));
        let mean = MeanStrain::new(MEAN, 1.0);
        let variation = Variation {
            at_point: WAY,
            of_mean: OF_MEAN,
        };
        let ([first, b], h) = (mean.variation(&LINEAR, &variation), 1e-4);
        assert!((first - (at(h) - at(-h)) / (2.0 * h)).norm() < 1e-7);
        let [z, y] = mean.conjugate(&LINEAR, &STRESS);
        let work = (STRESS + z).dot(&WAY) - (z + y).dot(&OF_MEAN);
        assert!((work - STRESS.dot(&first)).abs() < 1e-14);
        let second = (at(h) - at(0.0) * 2.0 + at(-h)) / (h * h);
        let found = mean.second_stress(&b, &STRESS).dot(&b);
        assert!((found - STRESS.dot(&second)).abs() < 1e-6);
        for size in [0.3, 1e-4] {
            let (end, step) = (MeanStrain::new(MEAN + OF_MEAN * size, 1.0), WAY * size);
            let variation = Variation {
                at_point: step,
                of_mean: OF_MEAN * size,
            };
            let found = MeanStrain::change([&mean, &end], [&LINEAR, &(LINEAR + step)], &variation);
            assert!((found - (at(size) - at(0.0))).norm() < 1e-14);
        }
    }

    #[test]
    fn logarithms_of_stretches_are_added_up_to_the_second_order() {
        let mean = MeanStrain::new(Matrix3::from_diagonal(&Vector3::new(1.5, -0.3, 0.0)), 1.0);
        let logarithm = |e: f64| (1.0 + 2.0 * e).ln() / 2.0;
        for size in [1e-2, 1e-3] {
            let linear = Matrix3::from_diagonal(&Vector3::new(1.5 + 4.0 * size, -0.3, 0.0));
            let found = logarithm(mean.strain(&linear)[0]) - logarithm(1.5) - size;
            assert!(found.abs() < size * size * size, "{found}");
        }
    }
}
