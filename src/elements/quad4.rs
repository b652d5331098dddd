//! The bilinear isoparametric quadrilateral Q4, fully integrated. Section 2 of docs/theory.md.

use nalgebra::SMatrix;

use super::block::Shape;
use super::displacement::Displacement;
use super::formulation::{Reference, ShapeFunctions};
use super::solid::Solid;
use crate::materials::lanes::Lanes;

/// Q4 in the displacement formulation (CPE4, CPS4).
pub type Quad4 = Solid<4, 4, 8, Displacement>;

/// Natural coordinates of the nodes.
///
/// ```text
///  3 ---- 2   s
///  |      |   ^
///  |      |   |
///  0 ---- 1   +--> r
/// ```
const NODES: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Natural coordinates of the integration points: those of the nodes times 1/sqrt(3).
const GAUSS: f64 = 0.577_350_269_189_625_8;
/// Linear shape functions (1 + GAUSS)/2 and (1 - GAUSS)/2 of an edge at its integration points, with
/// the 1/2 of the natural derivative across.
const NEAR: f64 = (1.0 + GAUSS) / 4.0;
const FAR: f64 = (1.0 - GAUSS) / 4.0;

/// The quadrilateral: bilinear shape functions h_a = (1 + r_a r)(1 + s_a s)/4 at 2 x 2 Gauss points.
pub struct Quadrilateral;

impl Shape<4, 4> for Quadrilateral {
    const FUNCTIONS: ShapeFunctions<4, 4> = functions();

    /// dv/dr depends on s alone and dv/ds on r alone: both follow from the differences along the edges.
    #[inline(always)]
    fn derivatives(v: &[Lanes; 4]) -> [[Lanes; 2]; 4] {
        let (bottom, top) = (v[1] - v[0], v[2] - v[3]);
        let (left, right) = (v[3] - v[0], v[2] - v[1]);
        let r = [bottom * NEAR + top * FAR, bottom * FAR + top * NEAR];
        let s = [left * NEAR + right * FAR, left * FAR + right * NEAR];
        [[r[0], s[0]], [r[0], s[1]], [r[1], s[1]], [r[1], s[0]]]
    }

    #[inline(always)]
    fn nodal_sums(q: &[[Lanes; 2]; 4]) -> [Lanes; 4] {
        let r = [q[0][0] + q[1][0], q[2][0] + q[3][0]];
        let s = [q[0][1] + q[3][1], q[1][1] + q[2][1]];
        let (bottom, top) = (r[0] * NEAR + r[1] * FAR, r[0] * FAR + r[1] * NEAR);
        let (left, right) = (s[0] * NEAR + s[1] * FAR, s[0] * FAR + s[1] * NEAR);
        [
            Lanes::ZERO - bottom - left,
            bottom - right,
            top + right,
            left - top,
        ]
    }
}

/// Shape functions at the integration points.
const fn functions() -> ShapeFunctions<4, 4> {
    let (mut values, mut natural) = ([[0.0; 4]; 4], [[[0.0; 2]; 4]; 4]);
    let mut k = 0;
    while k < 16 {
        let (p, a) = (k / 4, k % 4);
        let [r, s] = [GAUSS * NODES[p][0], GAUSS * NODES[p][1]];
        let [ra, sa] = NODES[a];
        values[p][a] = (1.0 + ra * r) * (1.0 + sa * s) / 4.0;
        natural[p][a] = [ra * (1.0 + sa * s) / 4.0, sa * (1.0 + ra * r) / 4.0];
        k += 1;
    }
    ShapeFunctions {
        values,
        natural,
        weight: 1.0,
    }
}

/// Four-node quadrilateral with 2 x 2 Gauss points and thickness `t`.
///
/// `x`: reference coordinates, column a for node a (length), counter-clockwise.
pub fn reference(x: &SMatrix<f64, 2, 4>, t: f64) -> Reference<4, 4> {
    let functions = Quadrilateral::FUNCTIONS;
    functions.reference(&functions.jacobians(x, t))
}

/// Consistent mass per density, m_ab = int h_a h_b dOmega (length^3); exact at 2 x 2 points, det(dX/dr)
/// being linear.
pub fn mass(element: &Reference<4, 4>) -> SMatrix<f64, 4, 4> {
    let points = element.points.iter();
    points
        .map(|p| p.shape * p.shape.transpose() * p.volume)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix2;

    fn distorted() -> SMatrix<f64, 2, 4> {
        SMatrix::from_columns(&[[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]].map(|p| p.into()))
    }

    #[test]
    fn gradients_reproduce_a_linear_field() {
        let x = distorted();
        for p in reference(&x, 1.0).points {
            // sum_a X_a dh_a/dX = I, sum_a dh_a/dX = 0
            let identity: Matrix2<f64> = x * p.gradient;
            assert!((identity - Matrix2::identity()).norm() < 1e-14);
            assert!(p.gradient.row_sum().norm() < 1e-15);
        }
    }

    #[test]
    fn volume_and_mass_total_are_area_times_thickness() {
        let x = distorted();
        // shoelace formula
        let area: f64 = (0..4)
            .map(|a| {
                let (p, q) = (x.column(a), x.column((a + 1) % 4));
                (p[0] * q[1] - q[0] * p[1]) / 2.0
            })
            .sum();
        let element = reference(&x, 0.25);
        assert!((element.volume() - 0.25 * area).abs() < 1e-15);
        assert!((mass(&element).sum() - 0.25 * area).abs() < 1e-15);
        assert!((element.nodal_volume().sum() - 0.25 * area).abs() < 1e-15);
    }
}
