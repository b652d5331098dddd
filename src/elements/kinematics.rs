//! Deformation and stress at an integration point: finite-strain kinematics (section 2 of
//! docs/theory.md) at one configuration or in the energy-momentum form (section 4).

use nalgebra::{Matrix2, SMatrix};

use super::reference::Point;
use super::voigt::{Elasticity, stress};

/// The configuration in which internal force and tangent are evaluated; displacements of the
/// element's nodes are 2 x N (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Configuration<const N: usize> {
    /// Displacements u: F(u), S = C E(u).
    At(SMatrix<f64, 2, N>),
    /// Energy-momentum form between start u0 and end u1: F at the mid configuration (u0 + u1)/2 and
    /// the mean stress, eq. (4.8) (Simo & Tarnow 1992).
    Between(SMatrix<f64, 2, N>, SMatrix<f64, 2, N>),
}

/// Deformation and stress at an integration point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// Deformation gradient F.
    pub f: Matrix2<f64>,
    /// Second Piola-Kirchhoff stress S (force/length^2).
    pub s: Matrix2<f64>,
    /// Smallest determinant of F met: of the configuration, and of the end in the energy-momentum
    /// form.
    pub determinant: f64,
}

impl<const N: usize> Configuration<N> {
    /// Deformation gradient and stress at a point.
    pub fn state(&self, point: &Point<N>, c: &Elasticity) -> PointState {
        match self {
            Configuration::At(u) => {
                // F = I + H, eq. (2.1)
                let h = displacement_gradient(point, u);
                let f = Matrix2::identity() + h;
                PointState {
                    f,
                    s: stress(c, &green_lagrange(&h)),
                    determinant: f.determinant(),
                }
            }
            Configuration::Between(u0, u1) => {
                let (h0, h1) = (
                    displacement_gradient(point, u0),
                    displacement_gradient(point, u1),
                );
                let f = Matrix2::identity() + (h0 + h1) / 2.0;
                // S_m = (S(U0) + S(U1))/2 = C (E(U0) + E(U1))/2, eq. (4.8)
                let e = (green_lagrange(&h0) + green_lagrange(&h1)) / 2.0;
                let end = (Matrix2::identity() + h1).determinant();
                PointState {
                    f,
                    s: stress(c, &e),
                    determinant: smaller(f.determinant(), end),
                }
            }
        }
    }
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
