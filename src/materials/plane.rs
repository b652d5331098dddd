//! The plane: what elements assume across the thickness, the moduli of a law near its reference state, and products of
//! symmetric tensors as matrices that act on strains in Voigt order (E_xx, E_yy, 2 E_xy). Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3, Vector3};

/// Kinematic assumption across the thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Plane {
    /// No stress across the thickness (CPS elements).
    Stress,
    /// No strain across the thickness (CPE elements).
    Strain,
    /// A body of revolution around the axis x = 0, which moves without torsion (CAX elements).
    Revolution,
}

/// Moduli of the linear elastic material that a law is near its reference state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmallStrainModuli {
    /// Young's modulus E (force/length^2).
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
}

/// A x A: E -> (A : E) A.
#[inline]
pub fn dyad(a: &Matrix2<f64>) -> Matrix3<f64> {
    let a = Vector3::new(a.m11, a.m22, a.m12);
    a * a.transpose()
}

/// A o A, (A_ik A_jl + A_il A_jk)/2: E -> A E A.
#[inline]
pub fn product(a: &Matrix2<f64>) -> Matrix3<f64> {
    let (xx, yy, xy) = (a.m11, a.m22, a.m12);
    Matrix3::new(
        xx * xx,
        xy * xy,
        xx * xy,
        xy * xy,
        yy * yy,
        yy * xy,
        xx * xy,
        yy * xy,
        (xx * yy + xy * xy) / 2.0,
    )
}
