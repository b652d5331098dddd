//! The bilinear isoparametric quadrilateral Q4, fully integrated. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, SMatrix, SVector};

use super::displacement::Displacement;
use super::integration_point::{Point, Reference};
use super::solid::Solid;

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

/// Four-node quadrilateral with 2 x 2 Gauss points and thickness `t`.
///
/// `x`: reference coordinates, column a for node a (length), counter-clockwise.
pub fn reference(x: &SMatrix<f64, 2, 4>, t: f64) -> Reference<4, 4> {
    let gauss = 1.0 / 3.0_f64.sqrt();
    let points = NODES.map(|[r, s]| point(x, t, r * gauss, s * gauss));
    // m_ab = int h_a h_b dOmega; exact at 2 x 2 points, det(dX/dr) being linear.
    let mass = points
        .iter()
        .map(|p| p.shape * p.shape.transpose() * p.volume)
        .sum();
    Reference { points, mass }
}

/// Bilinear shape functions at (r, s): h_a = (1 + r_a r)(1 + s_a s)/4.
fn point(x: &SMatrix<f64, 2, 4>, t: f64, r: f64, s: f64) -> Point<4> {
    let shape = SVector::from_fn(|a, _| {
        let [ra, sa] = NODES[a];
        (1.0 + ra * r) * (1.0 + sa * s) / 4.0
    });
    let natural = SMatrix::<f64, 4, 2>::from_fn(|a, i| {
        let [ra, sa] = NODES[a];
        if i == 0 {
            ra * (1.0 + sa * s) / 4.0
        } else {
            sa * (1.0 + ra * r) / 4.0
        }
    });
    // J = dX/dr, dh/dX = dh/dr J^-1
    let j: Matrix2<f64> = x * natural;
    let det = j.determinant();
    let inverse = Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det;
    Point {
        shape,
        gradient: natural * inverse,
        volume: t * det,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!((element.mass.sum() - 0.25 * area).abs() < 1e-15);
        assert!((element.nodal_volume().sum() - 0.25 * area).abs() < 1e-15);
    }
}
