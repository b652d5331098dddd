//! Integration points of elements with all components of the strain, and kinematics there. Section 2 of docs/theory.md,
//! Bodies of revolution.

use nalgebra::{Matrix2, Vector2, Vector4};
use smallvec::SmallVec;

use crate::elements::formulation::{green_lagrange, smaller};
use crate::elements::shapes::ShapeAtPoints;
use crate::elements::solid::MAX_NODES;
use crate::materials::Symmetric;
use crate::model::Thickness;

/// One value for each integration point of an element.
pub(super) type OfPoints<T> = SmallVec<[T; 9]>;

/// The points of an element of a shape with nodes at `x`.
pub(super) fn ring_points(
    shape: &ShapeAtPoints,
    x: &[[f64; 2]],
    thickness: Thickness,
) -> OfPoints<RingPoint> {
    let point = |p: usize| {
        let natural = &shape.natural[p][..shape.nodes];
        let mut j = Matrix2::zeros();
        for (x, h) in x.iter().zip(natural) {
            j += Vector2::from(*x) * Vector2::from(*h).transpose();
        }
        let det = j.determinant();
        let inverse = Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det;
        let values = shape.values[p];
        let place = x
            .iter()
            .zip(&values)
            .fold(Vector2::zeros(), |sum, (x, h)| sum + Vector2::from(*x) * *h);
        let (mut gradient, mut around) = ([Vector2::zeros(); MAX_NODES], [0.0; MAX_NODES]);
        for (a, h) in natural.iter().enumerate() {
            gradient[a] = inverse.tr_mul(&Vector2::from(*h));
            if thickness == Thickness::Around {
                around[a] = values[a] / place.x;
            }
        }
        let area = det * shape.weights[p];
        RingPoint {
            shape: values,
            place,
            gradient,
            around,
            area,
            volume: thickness.at(place.x) * area,
        }
    };
    (0..shape.weights.len()).map(point).collect()
}

/// One integration point in the reference configuration; the first entries belong to the nodes of the element.
#[derive(Debug, Clone)]
pub(super) struct RingPoint {
    /// Shape functions h_a.
    pub shape: [f64; MAX_NODES],
    /// Its place (length).
    pub place: Vector2<f64>,
    /// Gradients dh_a/dX (1/length).
    pub gradient: [Vector2<f64>; MAX_NODES],
    /// h_a/R; zero in plane strain, the ring of an infinite radius (1/length).
    pub around: [f64; MAX_NODES],
    /// det(dX/dr) times the quadrature weight (length^2).
    pub area: f64,
    /// The same times 2 pi R, eq. (2.32), or the thickness (length^3).
    pub volume: f64,
}

impl RingPoint {
    /// H and h of displacements of the nodes.
    pub fn displacement_gradient(&self, u: &[Vector2<f64>; MAX_NODES]) -> Gradient {
        let (mut h, mut around) = (Matrix2::zeros(), 0.0);
        for (a, u) in u.iter().enumerate() {
            h += u * self.gradient[a].transpose();
            around += u.x * self.around[a];
        }
        Gradient { h, around }
    }
}

/// Displacement gradient at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gradient {
    /// H = du/dX in the section.
    pub h: Matrix2<f64>,
    /// h = u_r/R around the axis.
    pub around: f64,
}

impl Gradient {
    /// Deformation gradient F in the section.
    pub fn f(&self) -> Matrix2<f64> {
        Matrix2::identity() + self.h
    }

    /// Stretch 1 + h around the axis.
    pub fn stretch_around(&self) -> f64 {
        1.0 + self.around
    }

    /// E = (H + H^T + H^T H)/2 and E_33 = h + h²/2, eq. (2.2) and eq. (2.31).
    pub fn strain(&self) -> Symmetric {
        let e = green_lagrange(&self.h);
        let around = self.around + self.around * self.around / 2.0;
        Symmetric::of_plane(&e, around)
    }

    /// det F in the section, or its product with the stretch around the axis where one of both is not positive.
    pub fn determinant(&self) -> f64 {
        let of_section = self.f().determinant();
        smaller(of_section, of_section * self.stretch_around())
    }

    /// The gradient halfway to another.
    fn halfway(&self, other: &Self) -> Self {
        Gradient {
            h: (self.h + other.h) / 2.0,
            around: (self.around + other.around) / 2.0,
        }
    }
}

/// Displacement gradients of a point at the start, halfway and at the end of a motion: three times the same at one
/// configuration.
#[derive(Debug, Clone, Copy)]
pub(super) struct StrainPath {
    pub start: Gradient,
    pub halfway: Gradient,
    pub end: Gradient,
}

impl StrainPath {
    pub fn new(start: Gradient, end: Gradient) -> Self {
        StrainPath {
            start,
            halfway: start.halfway(&end),
            end,
        }
    }

    /// Smallest determinant met.
    pub fn determinant(&self) -> f64 {
        smaller(self.halfway.determinant(), self.end.determinant())
    }
}

/// The part of a symmetric tensor in the section.
pub(super) fn section(s: &Symmetric) -> Matrix2<f64> {
    Matrix2::new(s.x, s.w, s.w, s.y)
}

/// A symmetric tensor as the vector (11, 22, 33, 2*12) of strains.
pub(super) fn as_strain(e: &Symmetric) -> Vector4<f64> {
    Vector4::new(e.x, e.y, e.z, 2.0 * e.w)
}
