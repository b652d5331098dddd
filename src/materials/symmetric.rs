//! Symmetric tensors whose components 13 and 23 are zero, as those of plane strain and of bodies of revolution, and
//! products of them as matrices that act on strains (11, 22, 33, 2*12). Section 2 of docs/theory.md.

use nalgebra::{Matrix4, Vector4};

/// Components 11, 22, 33, 12.
pub type Symmetric = Vector4<f64>;

/// I in the components of a symmetric tensor.
pub const IDENTITY: Symmetric = Vector4::new(1.0, 1.0, 1.0, 0.0);

/// A:B of two symmetric tensors.
pub fn contract(a: &Symmetric, b: &Symmetric) -> f64 {
    a.dot(b) + a.w * b.w
}

/// Cofactor tensor of a symmetric one: det(A) A^-1.
pub fn cofactor(m: &Symmetric) -> Symmetric {
    Vector4::new(m.y * m.z, m.x * m.z, m.x * m.y - m.w * m.w, -m.w * m.z)
}

/// A x A: E -> (A:E) A, on strains (11, 22, 33, 2*12).
pub fn dyad(a: &Symmetric, b: &Symmetric) -> Matrix4<f64> {
    a * b.transpose()
}

/// A x B + B x A.
pub fn both(a: &Symmetric, b: &Symmetric) -> Matrix4<f64> {
    dyad(a, b) + dyad(b, a)
}

/// A o A: E -> A E A, on strains (11, 22, 33, 2*12).
pub fn product(a: &Symmetric) -> Matrix4<f64> {
    let (x, y, z, w) = (a.x, a.y, a.z, a.w);
    Matrix4::new(
        x * x,
        w * w,
        0.0,
        x * w,
        w * w,
        y * y,
        0.0,
        y * w,
        0.0,
        0.0,
        z * z,
        0.0,
        x * w,
        y * w,
        0.0,
        (x * y + w * w) / 2.0,
    )
}
