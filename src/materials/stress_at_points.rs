//! What internal force and tangent of an element ask at its integration points. Section 2 of
//! docs/theory.md.

use nalgebra::{Matrix2, Matrix3};

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
