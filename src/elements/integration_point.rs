//! Integration points of the elements with their precomputed gradients and weights
//! (total-Lagrangian form), and deformation and stress there. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, SMatrix, SVector};

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

/// Deformation and stress at an integration point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// Displacement gradient H = F - I of the strain-displacement matrix.
    pub h: Matrix2<f64>,
    /// Green-Lagrange strain that the material has.
    pub strain: Matrix2<f64>,
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
