//! What an element asks of a material at an integration point. Sections 2 and 4 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector};
use smallvec::SmallVec;

use super::Symmetric;

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

    /// The law of a metal as one.
    fn as_metal(&self) -> Option<&dyn MetalLaw> {
        None
    }

    /// The measure of strain in which the potential of the stress is convex: that of logarithms where the law fulfils Hill's
    /// inequality.
    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Logarithmic
    }
}

/// A potential W(E; m) of a metal whose element has hourglass modes, less the elastic energy of these, on strains
/// (11, 22, 2*12) or (11, 22, 33, 2*12). m is what they add to q² (force^2/length^4), eq. (2.48).
pub trait BentLaw<const N: usize> {
    /// W at a second strain and m less that at the first ones, with `by` the difference of m and with a round-off that is
    /// relative to the changes (force/length^2).
    fn change(&self, z0: &[f64], ends: [&SVector<f64, N>; 2], modes: [f64; 2], by: f64) -> f64;

    /// S (force/length^2) and dW/dm.
    fn stress(&self, z0: &[f64], e: &SVector<f64, N>, modes: f64) -> (SVector<f64, N>, f64);

    /// Second derivatives of the potential.
    fn tangent(&self, z0: &[f64], e: &SVector<f64, N>, modes: f64) -> BentTangent<N>;
}

/// Second derivatives of a potential W(E; m), and the first by m.
#[derive(Debug, Clone, Copy)]
pub struct BentTangent<const N: usize> {
    /// C (force/length^2).
    pub tangent: SMatrix<f64, N, N>,
    /// dW/dm and d²W/dm².
    pub by_modes: [f64; 2],
    /// dS/dm.
    pub stress_by_modes: SVector<f64, N>,
}

/// What the elements with hourglass modes ask of a metal.
pub trait MetalLaw: BentLaw<3> + BentLaw<4> + std::fmt::Debug {
    /// 3 mu and H_k (force/length^2).
    fn moduli(&self) -> [f64; 2];

    /// Internal variables at the end of the strains of an increment with m at its start and at its end, what is dissipated
    /// (force/length^2), and the part r of the trial strain that flows.
    fn update(&self, strains: &Strains, z0: &[f64], modes: [f64; 2], z1: &mut [f64]) -> [f64; 2];

    /// As [`Self::update`] in a ring.
    fn ring_update(
        &self,
        strains: &Strains<Symmetric>,
        z0: &[f64],
        modes: [f64; 2],
        z1: &mut [f64],
    ) -> [f64; 2];
}

/// A metal with the internal variables of a point, and those of the hourglass modes of its element.
#[derive(Debug, Clone, Copy)]
pub struct Metal<'a> {
    /// The law.
    pub law: &'a dyn MetalLaw,
    /// Variables of the point.
    pub of_point: &'a [f64],
    /// Variables of the hourglass modes.
    pub of_modes: &'a [f64],
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

    /// A metal with its variables of the first point, and with those behind the points.
    fn metal(&self, _points: usize) -> Option<Metal<'_>> {
        None
    }
}
