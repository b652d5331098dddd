//! What an element asks of a material: of a law at one integration point, and of the stress at all its points.
//! Sections 2 and 4 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3};

/// What happens across the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Across {
    /// Stretch F_zz.
    pub stretch: f64,
    /// Second Piola-Kirchhoff stress S_zz (force/length^2).
    pub stress: f64,
}

/// A material in the plane: energy, stress and tangent at a strain E, given the internal variables z
/// that the last accepted increment has committed. No function changes z: [`Self::update`] returns the
/// variables of the end, which the caller commits with the increment or forgets with it.
///
/// Energies are per reference volume (force/length^2).
pub trait ConstitutiveLaw {
    /// Number of internal variables at a point.
    fn variables(&self) -> usize {
        0
    }

    /// Stored energy W(E, z).
    fn stored_energy(&self, e: &Matrix2<f64>, z: &[f64]) -> f64;

    /// W(E1, z) - W(E0, z), with a round-off that is relative to E1 - E0: it may not be formed as the
    /// difference of two energies, which keeps no digits where E1 is near E0.
    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> f64;

    /// Second Piola-Kirchhoff stress S = dW/dE, eq. (2.3) (force/length^2).
    fn stress(&self, e: &Matrix2<f64>, z: &[f64]) -> Matrix2<f64>;

    /// Tangent C = dS/dE, eq. (2.3), in Voigt order (force/length^2).
    fn tangent(&self, e: &Matrix2<f64>, z: &[f64]) -> Matrix3<f64>;

    /// Stretch and stress across the thickness.
    fn across(&self, e: &Matrix2<f64>, z: &[f64]) -> Across;

    /// Energy-momentum stress between two strains: S:(E1 - E0) = W(E1, z) - W(E0, z),
    /// eq. (4.8): [`super::energy_momentum::stress`] has it for any energy.
    fn mean_stress(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> Matrix2<f64>;

    /// Symmetric part of 2 dS/dE1 of [`Self::mean_stress`], in Voigt order (force/length^2).
    fn mean_tangent(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> Matrix3<f64>;

    /// Writes the internal variables at strain `e` to `updated` and returns the energy dissipated on
    /// the way from `z` to them (force/length^2, >= 0): W(E, z) - W(E, updated).
    fn update(&self, _e: &Matrix2<f64>, _z: &[f64], _updated: &mut [f64]) -> f64 {
        0.0
    }
}

/// A stress that follows from the strains at the integration points of one element: that of its
/// material, or that of its viscosity.
pub trait StressAtPoints {
    /// Second Piola-Kirchhoff stress at a point (force/length^2).
    fn stress(&self, point: usize, e: &Matrix2<f64>) -> Matrix2<f64>;

    /// Stress between the strains of start and end at a point (force/length^2).
    fn mean_stress(&self, point: usize, strains: [&Matrix2<f64>; 2]) -> Matrix2<f64>;

    /// Tangent of [`Self::stress`] at a point in Voigt order (force/length^2).
    fn tangent(&self, point: usize, e: &Matrix2<f64>) -> Matrix3<f64>;

    /// Symmetric part of twice the derivative of [`Self::mean_stress`] by the strain of the end, in
    /// Voigt order (force/length^2).
    fn mean_tangent(&self, point: usize, strains: [&Matrix2<f64>; 2]) -> Matrix3<f64>;
}
