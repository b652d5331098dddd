//! Integration points of the elements with their precomputed gradients and weights
//! (total-Lagrangian form), and deformation and stress there. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector};

use crate::materials::StressAtPoints;

/// One integration point in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point<const N: usize> {
    /// Shape functions h_a.
    pub shape: SVector<f64, N>,
    /// Gradients dh_a/dX_i, row a (1/length).
    pub gradient: SMatrix<f64, N, 2>,
    /// Weight: t det(dX/dr) times the quadrature weight (length^3).
    pub volume: f64,
}

/// An element with N nodes and P integration points in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference<const N: usize, const P: usize> {
    /// Integration points of stress and internal force.
    pub points: [Point<N>; P],
    /// Consistent mass per density, int h_a h_b dOmega (length^3).
    pub mass: SMatrix<f64, N, N>,
}

impl<const N: usize, const P: usize> Reference<N, P> {
    /// Volume of the element (length^3).
    pub fn volume(&self) -> f64 {
        self.points.iter().map(|p| p.volume).sum()
    }

    /// Share of each node in a uniform force per volume, int h_a dOmega (length^3).
    pub fn nodal_volume(&self) -> SVector<f64, N> {
        self.points.iter().map(|p| p.shape * p.volume).sum()
    }
}

/// Green-Lagrange strains at which a material is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strains {
    /// One strain.
    At(Matrix2<f64>),
    /// Those of start and end, in the energy-momentum form.
    Between(Matrix2<f64>, Matrix2<f64>),
}

impl Strains {
    /// Second Piola-Kirchhoff stress at a point, eq. (2.3), or energy-momentum stress, eq. (4.8)
    /// (force/length^2).
    #[inline(always)]
    pub fn stress(&self, material: &impl StressAtPoints, point: usize) -> Matrix2<f64> {
        match self {
            Strains::At(e) => material.stress(point, e),
            Strains::Between(e0, e1) => material.mean_stress(point, [e0, e1]),
        }
    }

    /// Tangent of [`Self::stress`] in Voigt order (force/length^2).
    #[inline(always)]
    pub fn tangent(&self, material: &impl StressAtPoints, point: usize) -> Matrix3<f64> {
        match self {
            Strains::At(e) => material.tangent(point, e),
            Strains::Between(e0, e1) => material.mean_tangent(point, [e0, e1]),
        }
    }

    /// The strain at the end.
    pub fn end(&self) -> &Matrix2<f64> {
        match self {
            Strains::At(e) | Strains::Between(_, e) => e,
        }
    }
}

/// Deformation and stress at an integration point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// Displacement gradient H = F - I of the strain-displacement matrix.
    pub h: Matrix2<f64>,
    /// Green-Lagrange strain that the material has, or strains.
    pub strains: Strains,
    /// Determinant of the deformation gradient in the plane that the material has.
    pub material_determinant: f64,
    /// Second Piola-Kirchhoff stress S that does work on the strain of the displacements
    /// (force/length^2).
    pub s: Matrix2<f64>,
    /// Smallest determinant of F met: of the configuration, and of the end in the energy-momentum
    /// form.
    pub determinant: f64,
}

impl PointState {
    /// Deformation gradient F.
    pub fn f(&self) -> Matrix2<f64> {
        Matrix2::identity() + self.h
    }
}
