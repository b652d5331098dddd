//! The shapes of elements with their quadrature and mass: the constant-strain triangle T3 and the bilinear isoparametric
//! quadrilateral Q4, fully integrated. Section 2 of docs/theory.md.

use nalgebra::SMatrix;

use super::block::Shape;
use super::displacement::Displacement;
use super::formulation::{Reference, ShapeFunctions};
use super::mean_dilatation::MeanDilatation;
use super::solid::Solid;
use crate::materials::lanes::Lanes;

/// T3 in the displacement formulation (CPE3, CPS3).
pub type Tri3 = Solid<3, 1, 6, Displacement>;

/// The triangle: linear shape functions h = (1 - r - s, r, s) at its centroid.
pub struct Triangle;

impl Shape<3, 1> for Triangle {
    const FUNCTIONS: ShapeFunctions<3, 1> = ShapeFunctions {
        values: [[1.0 / 3.0; 3]],
        natural: [[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]],
        weight: 0.5,
    };

    #[inline(always)]
    fn derivatives(v: &[Lanes; 3]) -> [[Lanes; 2]; 1] {
        [[v[1] - v[0], v[2] - v[0]]]
    }

    #[inline(always)]
    fn nodal_sums([[r, s]]: &[[Lanes; 2]; 1]) -> [Lanes; 3] {
        [Lanes::ZERO - *r - *s, *r, *s]
    }

    /// m_ab = V (1 + delta_ab) / 12
    fn mass(element: &Reference<3, 1>) -> SMatrix<f64, 3, 3> {
        (SMatrix::repeat(1.0) + SMatrix::identity()) * (element.volume() / 12.0)
    }
}

/// Q4 in the displacement formulation (CPE4, CPS4).
pub type Quad4 = Solid<4, 4, 8, Displacement>;
/// Q4 with mean dilatation (CPE4 with `FORMULATION=MEAN DILATATION`).
pub type Quad4MeanDilatation = Solid<4, 4, 8, MeanDilatation>;

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
    const FUNCTIONS: ShapeFunctions<4, 4> = bilinear();

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

    /// Exact at 2 x 2 points, det(dX/dr) being linear.
    fn mass(element: &Reference<4, 4>) -> SMatrix<f64, 4, 4> {
        let points = element.points.iter();
        points
            .map(|p| p.shape * p.shape.transpose() * p.volume)
            .sum()
    }
}

/// Shape functions at the integration points.
const fn bilinear() -> ShapeFunctions<4, 4> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix2;

    /// Gradients, volume and mass of an element of thickness 0.25 between nodes at `x`, whose corners come first.
    fn check<S: Shape<N, P>, const N: usize, const P: usize>(
        x: SMatrix<f64, 2, N>,
        corners: usize,
    ) {
        let element = S::reference(&x, 0.25);
        for p in element.points {
            // sum_a X_a dh_a/dX = I, sum_a dh_a/dX = 0
            let identity: Matrix2<f64> = x * p.gradient;
            assert!((identity - Matrix2::identity()).norm() < 1e-14);
            assert!(p.gradient.row_sum().norm() < 1e-15);
        }
        // shoelace formula
        let area: f64 = (0..corners)
            .map(|a| {
                let (p, q) = (x.column(a), x.column((a + 1) % corners));
                (p[0] * q[1] - q[0] * p[1]) / 2.0
            })
            .sum();
        assert!((element.volume() - 0.25 * area).abs() < 1e-15);
        assert!((S::mass(&element).sum() - 0.25 * area).abs() < 1e-15);
        assert!((element.nodal_volume().sum() - 0.25 * area).abs() < 1e-15);
    }

    #[test]
    fn linear_fields_volume_and_mass() {
        let quad = [[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]];
        check::<Quadrilateral, 4, 4>(SMatrix::from_columns(&quad.map(|p| p.into())), 4);
        let tri = SMatrix::from_columns(&[[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]].map(|p| p.into()));
        check::<Triangle, 3, 1>(tri, 3);
        let element = Triangle::reference(&tri, 2.0);
        let volume = 1.9 * 1.9 - 0.6 * 0.3;
        assert!((Triangle::mass(&element)[(0, 0)] - volume / 6.0).abs() < 1e-14);
    }
}
