//! The constant-strain triangle T3, its mass in closed form. Section 2 of docs/theory.md.

use nalgebra::SMatrix;

use super::block::Shape;
use super::displacement::Displacement;
use super::formulation::{Reference, ShapeFunctions};
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
}

/// Three-node triangle with one integration point and thickness `t`.
///
/// `x`: reference coordinates, column a for node a (length), counter-clockwise.
pub fn reference(x: &SMatrix<f64, 2, 3>, t: f64) -> Reference<3, 1> {
    let functions = Triangle::FUNCTIONS;
    functions.reference(&functions.jacobians(x, t))
}

/// Consistent mass per density, m_ab = V (1 + delta_ab) / 12 (length^3).
pub fn mass(element: &Reference<3, 1>) -> SMatrix<f64, 3, 3> {
    (SMatrix::repeat(1.0) + SMatrix::identity()) * (element.volume() / 12.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix2;

    #[test]
    fn linear_field_volume_and_mass() {
        let x = SMatrix::from_columns(&[[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]].map(|p| p.into()));
        let element = reference(&x, 2.0);
        let identity: Matrix2<f64> = x * element.points[0].gradient;
        assert!((identity - Matrix2::identity()).norm() < 1e-14);
        let volume = 1.9 * 1.9 - 0.6 * 0.3;
        assert!((element.volume() - volume).abs() < 1e-14);
        assert!((mass(&element).sum() - volume).abs() < 1e-14);
        assert!((mass(&element)[(0, 0)] - volume / 6.0).abs() < 1e-14);
    }
}
