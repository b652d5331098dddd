//! Products of symmetric tensors of the plane as matrices that act on strains in Voigt order (E_xx, E_yy,
//! 2 E_xy).

use nalgebra::{Matrix2, Matrix3, Vector3};

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
