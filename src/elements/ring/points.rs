//! Integration points of elements with all components of the strain, and kinematics there. Section 2 of docs/theory.md,
//! Bodies of revolution.

use nalgebra::{Matrix2, Vector2, Vector4};
use smallvec::SmallVec;

use crate::elements::block::IntegratedShape;
use crate::elements::formulation::{ShapeFunctions, green_lagrange, smaller};
use crate::elements::shapes::{
    QuadraticTriangle, Quadrilateral, ReducedSerendipity, Serendipity, Triangle,
};
use crate::elements::solid::MAX_NODES;
use crate::materials::Symmetric;
use crate::model::{self, ElementType, Formulation, Thickness};

/// One value for each integration point of an element.
pub(super) type OfPoints<T> = SmallVec<[T; 9]>;

/// Shape functions, gradients and weights of a shape at some points.
#[derive(Debug, Clone)]
pub(super) struct Points {
    nodes: usize,
    /// Shape functions h_a.
    values: Vec<[f64; MAX_NODES]>,
    /// Natural derivatives dh_a/dr_i.
    natural: Vec<[[f64; 2]; MAX_NODES]>,
    /// Quadrature weights.
    weights: Vec<f64>,
}

impl Points {
    fn new<const N: usize, const P: usize>(functions: &ShapeFunctions<N, P>) -> Self {
        let values = functions.values.iter().map(|all| {
            let mut padded = [0.0; MAX_NODES];
            padded[..N].copy_from_slice(all);
            padded
        });
        let natural = functions.natural.iter().map(|all| {
            let mut padded = [[0.0; 2]; MAX_NODES];
            padded[..N].copy_from_slice(all);
            padded
        });
        Points {
            nodes: N,
            values: values.collect(),
            natural: natural.collect(),
            weights: functions.weights.to_vec(),
        }
    }

    /// Those of stress and internal force of an element type.
    pub fn of_stress(element_type: ElementType) -> Self {
        let is_reduced = [Formulation::Reduced, Formulation::ReducedLinearPressure]
            .contains(&element_type.formulation);
        match element_type.shape {
            model::Shape::Tri3 => Points::new(&Triangle::FUNCTIONS),
            model::Shape::Quad4 => Points::new(&Quadrilateral::FUNCTIONS),
            model::Shape::Tri6 => Points::new(&QuadraticTriangle::FUNCTIONS),
            model::Shape::Quad8 if is_reduced => Points::new(&ReducedSerendipity::FUNCTIONS),
            model::Shape::Quad8 => Points::new(&Serendipity::FUNCTIONS),
        }
    }

    /// Those of mass and body force of a ring: of a degree higher by that of the radius than in the plane.
    pub fn of_mass(shape: model::Shape) -> Self {
        match shape {
            model::Shape::Tri3 => Points::new(&Triangle::RING_MASS),
            model::Shape::Quad4 => Points::new(&Quadrilateral::RING_MASS),
            model::Shape::Tri6 => Points::new(&QuadraticTriangle::MASS),
            model::Shape::Quad8 => Points::new(&Serendipity::FUNCTIONS),
        }
    }

    /// The points of an element with nodes at `x`.
    pub fn map(&self, x: &[[f64; 2]], thickness: Thickness) -> OfPoints<RingPoint> {
        let point = |p: usize| {
            let natural = &self.natural[p][..self.nodes];
            let mut j = Matrix2::zeros();
            for (x, h) in x.iter().zip(natural) {
                j += Vector2::from(*x) * Vector2::from(*h).transpose();
            }
            let det = j.determinant();
            let inverse = Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det;
            let shape = self.values[p];
            let place = x
                .iter()
                .zip(&shape)
                .fold(Vector2::zeros(), |sum, (x, h)| sum + Vector2::from(*x) * *h);
            let (mut gradient, mut around) = ([Vector2::zeros(); MAX_NODES], [0.0; MAX_NODES]);
            for (a, h) in natural.iter().enumerate() {
                gradient[a] = inverse.tr_mul(&Vector2::from(*h));
                if thickness == Thickness::Around {
                    around[a] = shape[a] / place.x;
                }
            }
            let area = det * self.weights[p];
            RingPoint {
                shape,
                place,
                gradient,
                around,
                area,
                volume: thickness.at(place.x) * area,
            }
        };
        (0..self.weights.len()).map(point).collect()
    }
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
        Vector4::new(e.m11, e.m22, around, e.m12)
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
