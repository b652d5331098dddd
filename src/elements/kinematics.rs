//! Finite-strain kinematics at an integration point (section 2 of docs/theory.md), at one
//! configuration or between two (energy-momentum form, section 4).

use nalgebra::{Matrix2, SMatrix};

use super::integration_point::Point;

/// The configuration in which internal force and tangent are evaluated; displacements of the
/// element's nodes are 2 x N (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Configuration<const N: usize> {
    /// Displacements u: F(u), S = dW/dE at E(u).
    At(SMatrix<f64, 2, N>),
    /// Energy-momentum form between start u0 and end u1: F at the mid configuration (u0 + u1)/2 and
    /// a stress that does the work of the strain energy (Simo & Tarnow 1992).
    Between(SMatrix<f64, 2, N>, SMatrix<f64, 2, N>),
}

/// The smaller of two values; NaN when one is.
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// Displacement gradient H = du/dX, eq. (2.1).
pub fn displacement_gradient<const N: usize>(
    point: &Point<N>,
    u: &SMatrix<f64, 2, N>,
) -> Matrix2<f64> {
    u * point.gradient
}

/// Green-Lagrange strain E = (H + H^T + H^T H)/2, eq. (2.2), from H so that small strains keep their
/// digits.
pub fn green_lagrange(h: &Matrix2<f64>) -> Matrix2<f64> {
    (h + h.transpose() + h.transpose() * h) / 2.0
}

/// det F = det(I + H).
pub(super) fn determinant(h: &Matrix2<f64>) -> f64 {
    (Matrix2::identity() + h).determinant()
}
