//! What an element asks of a material at an integration point. Sections 2 and 4 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3};
use smallvec::SmallVec;

/// Green-Lagrange strains at which a material is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strains<E = Matrix2<f64>> {
    /// One strain.
    At(E),
    /// Those of start and end of an increment, in the energy-momentum form.
    Between(E, E),
}

impl<E> Strains<E> {
    /// The strain at the end.
    pub fn end(&self) -> &E {
        match self {
            Strains::At(e) | Strains::Between(_, e) => e,
        }
    }
}

/// Measures of strain in which energies are convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrainMeasure {
    /// E of Green and Lagrange.
    Green,
    /// Logarithms of stretches.
    Logarithmic,
}

impl StrainMeasure {
    /// k of C0 + 2 A + 2 k A C0^-1 A, in which strains A are added to C0 in this measure up to their second order.
    pub fn second_order(self) -> f64 {
        match self {
            StrainMeasure::Green => 0.0,
            StrainMeasure::Logarithmic => 1.0,
        }
    }
}

/// What happens across the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Across {
    /// Stretch F_zz.
    pub stretch: f64,
    /// Second Piola-Kirchhoff stress S_zz (force/length^2).
    pub stress: f64,
}

/// A material in the plane. From the strains of an iterate and the internal variables z0 that the last accepted
/// increment has committed follow the stress, its tangent and the internal variables z1 of the iterate, by a local
/// solution (return mapping) where the law needs one.
///
/// Energies are per reference volume (force/length^2), the stored one apart from the dissipated one.
pub trait ConstitutiveLaw {
    /// Number of internal variables at a point.
    fn variables(&self) -> usize {
        0
    }

    /// Second Piola-Kirchhoff stress S, eq. (2.3), or energy-momentum stress, eq. (4.8) (force/length^2), and z1 at the
    /// end of the strains, which is written to `z1`.
    fn stress(&self, strains: &Strains, z0: &[f64], z1: &mut [f64]) -> Matrix2<f64>;

    /// Tangent dS/dE of [`Self::stress`], or the symmetric part of 2 dS/dE1 in the energy-momentum form, z1 following
    /// the strain, in Voigt order (force/length^2).
    fn tangent(&self, strains: &Strains, z0: &[f64]) -> Matrix3<f64>;

    /// Stresses of the points of an element, all of one kind of strains and with their z0 one after the other
    /// (force/length^2).
    fn stresses(&self, strains: &[Strains], z0: &[f64], s: &mut [Matrix2<f64>]) {
        let count = self.variables();
        let mut z1: SmallVec<[f64; 8]> = SmallVec::from_elem(0.0, count);
        for (p, (strains, s)) in strains.iter().zip(s).enumerate() {
            let z0 = &z0[p * count..(p + 1) * count];
            z1.copy_from_slice(z0);
            *s = self.stress(strains, z0, &mut z1);
        }
    }

    /// Tangents of the points of an element, as [`Self::stresses`].
    fn tangents(&self, strains: &[Strains], z0: &[f64], c: &mut [Matrix3<f64>]) {
        let count = self.variables();
        for (p, (strains, c)) in strains.iter().zip(c).enumerate() {
            *c = self.tangent(strains, &z0[p * count..(p + 1) * count]);
        }
    }

    /// Stored energy W(E, z).
    fn stored_energy(&self, e: &Matrix2<f64>, z: &[f64]) -> f64;

    /// Energy D >= 0 dissipated on the way from z0 to the z1 of the strains.
    fn dissipation(&self, _strains: &Strains, _z0: &[f64]) -> f64 {
        0.0
    }

    /// Stretch and stress across the thickness.
    fn across(&self, e: &Matrix2<f64>, z: &[f64]) -> Across;

    /// Accumulated plastic strain.
    fn plastic_strain(&self, _z: &[f64]) -> f64 {
        0.0
    }

    /// Yield stress of a metal (force/length^2).
    fn yield_stress(&self, _z: &[f64]) -> Option<f64> {
        None
    }

    /// The measure of strain in which the potential of the stress is convex: that of logarithms where the law fulfils Hill's
    /// inequality.
    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Logarithmic
    }

    /// Part of the yield stress that a strain uses of a metal, 1 where it flows.
    fn used_strength(&self, _e: &Matrix2<f64>, _z: &[f64]) -> f64 {
        0.0
    }
}

/// A stress that follows from the strains at the integration points of one element: that of its
/// material, or that of its viscosity.
pub trait StressAtPoints {
    /// Second Piola-Kirchhoff stress at a point (force/length^2).
    fn stress(&self, point: usize, strains: &Strains) -> Matrix2<f64>;

    /// Tangent of [`Self::stress`] at a point, as [`ConstitutiveLaw::tangent`] (force/length^2).
    fn tangent(&self, point: usize, strains: &Strains) -> Matrix3<f64>;

    /// Stresses of all points, all of one kind of strains.
    fn stresses<const P: usize>(&self, strains: &[Strains; P]) -> [Matrix2<f64>; P] {
        std::array::from_fn(|p| self.stress(p, &strains[p]))
    }

    /// Tangents of all points, all of one kind of strains.
    fn tangents<const P: usize>(&self, strains: &[Strains; P]) -> [Matrix3<f64>; P] {
        std::array::from_fn(|p| self.tangent(p, &strains[p]))
    }

    /// Whether the stress is that of a change of the strains, without a stored energy.
    fn is_viscous(&self) -> bool {
        false
    }

    /// Tangent at no strain without internal variables; that of no change of the strains where the stress is that of a
    /// change (force/length^2).
    fn initial_tangent(&self) -> Matrix3<f64> {
        let zero = Matrix2::zeros();
        self.tangent(0, &Strains::Between(zero, zero))
    }

    /// As [`ConstitutiveLaw::convex_in`]; that of a viscosity is quadratic in the strains of Green and Lagrange.
    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Green
    }

    /// The variables of an element behind those of its points; none of a law without an element.
    fn beyond(&self, _points: usize) -> &[f64] {
        &[]
    }

    /// Yield stress of a metal at the first point (force/length^2), and the variables behind those of the points.
    fn yielding(&self, _points: usize) -> Option<(f64, &[f64])> {
        None
    }
}
