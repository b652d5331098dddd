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

/// The map to one integration point from its natural coordinates r: all that differs between two
/// elements of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian {
    /// (dX/dr)^-1 (1/length).
    pub inverse: Matrix2<f64>,
    /// Weight: t det(dX/dr) times the quadrature weight (length^3).
    pub volume: f64,
}

/// Shape functions of N nodes at P integration points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeFunctions<const N: usize, const P: usize> {
    /// Shape functions h_a at every point.
    pub values: [[f64; N]; P],
    /// Natural derivatives dh_a/dr_i at every point.
    pub natural: [[[f64; 2]; N]; P],
    /// Quadrature weight of every point.
    pub weight: f64,
}

impl<const N: usize, const P: usize> ShapeFunctions<N, P> {
    /// dX/dr at every point of an element between nodes at `x` (column a for node a), of thickness `t`.
    pub fn jacobians(&self, x: &SMatrix<f64, 2, N>, t: f64) -> [Jacobian; P] {
        self.natural.map(|natural| {
            let j: Matrix2<f64> = x * SMatrix::<f64, N, 2>::from_fn(|a, i| natural[a][i]);
            let det = j.determinant();
            Jacobian {
                inverse: Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det,
                volume: t * self.weight * det,
            }
        })
    }

    /// The element with these jacobians, dh/dX = dh/dr (dX/dr)^-1.
    pub fn reference(&self, jacobians: &[Jacobian; P]) -> Reference<N, P> {
        let point = |p: usize| Point {
            shape: SVector::from(self.values[p]),
            gradient: SMatrix::<f64, N, 2>::from_fn(|a, i| self.natural[p][a][i])
                * jacobians[p].inverse,
            volume: jacobians[p].volume,
        };
        Reference {
            points: std::array::from_fn(point),
        }
    }
}

/// An element with N nodes and P integration points in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference<const N: usize, const P: usize> {
    /// Integration points of stress and internal force.
    pub points: [Point<N>; P],
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
