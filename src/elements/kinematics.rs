//! Deformation and stress at an integration point: finite-strain kinematics (section 2 of
//! docs/theory.md) at one configuration or in the energy-momentum form (section 4).

use nalgebra::{Matrix2, Matrix3, SMatrix};

use super::reference::Point;
use crate::materials::ConstitutiveLaw;

/// The configuration in which internal force and tangent are evaluated; displacements of the
/// element's nodes are 2 x N (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Configuration<const N: usize> {
    /// Displacements u: F(u), S(E(u)).
    At(SMatrix<f64, 2, N>),
    /// Energy-momentum form between start u0 and end u1: F at the mid configuration (u0 + u1)/2 and
    /// the energy-momentum stress, eq. (4.8).
    Between(SMatrix<f64, 2, N>, SMatrix<f64, 2, N>),
}

/// Strain, or strains, at which stress and tangent of an integration point are evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strains {
    /// One strain.
    At(Matrix2<f64>),
    /// Strains at the start and at the end.
    Between(Matrix2<f64>, Matrix2<f64>),
}

/// Deformation at an integration point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deformation {
    /// Deformation gradient F.
    pub f: Matrix2<f64>,
    /// Green-Lagrange strains.
    pub strains: Strains,
    /// Smallest determinant of F met: of the configuration, and of the end in the energy-momentum
    /// form.
    pub determinant: f64,
}

impl Deformation {
    /// Second Piola-Kirchhoff stress S (force/length^2).
    pub fn stress<L: ConstitutiveLaw>(&self, law: &L) -> Matrix2<f64> {
        match &self.strains {
            Strains::At(e) => law.stress(e, &[]),
            Strains::Between(e0, e1) => law.mean_stress(e0, e1, &[]),
        }
    }

    /// Tangent C in Voigt order (force/length^2).
    pub fn tangent<L: ConstitutiveLaw>(&self, law: &L) -> Matrix3<f64> {
        match &self.strains {
            Strains::At(e) => law.tangent(e, &[]),
            Strains::Between(e0, e1) => law.mean_tangent(e0, e1, &[]),
        }
    }
}

impl<const N: usize> Configuration<N> {
    /// Deformation at a point.
    pub fn deformation(&self, point: &Point<N>) -> Deformation {
        match self {
            Configuration::At(u) => {
                // F = I + H, eq. (2.1)
                let h = displacement_gradient(point, u);
                let f = Matrix2::identity() + h;
                Deformation {
                    f,
                    strains: Strains::At(green_lagrange(&h)),
                    determinant: f.determinant(),
                }
            }
            Configuration::Between(u0, u1) => {
                let h0 = displacement_gradient(point, u0);
                let h1 = displacement_gradient(point, u1);
                let f = Matrix2::identity() + (h0 + h1) / 2.0;
                let end = (Matrix2::identity() + h1).determinant();
                Deformation {
                    f,
                    strains: Strains::Between(green_lagrange(&h0), green_lagrange(&h1)),
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
