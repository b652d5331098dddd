//! The constant-strain triangle T3, its mass in closed form. Section 2 of docs/theory.md.

use nalgebra::{SMatrix, SVector};

use super::displacement::Displacement;
use super::integration_point::{Point, Reference};
use super::solid::Solid;

/// T3 in the displacement formulation (CPE3, CPS3).
pub type Tri3 = Solid<3, 1, 6, Displacement>;

/// Three-node triangle with one integration point and thickness `t`.
///
/// `x`: reference coordinates, column a for node a (length), counter-clockwise.
pub fn reference(x: &SMatrix<f64, 2, 3>, t: f64) -> Reference<3, 1> {
    // dh_a/dX = (Y_b - Y_c, X_c - X_b) / 2A for (a, b, c) in cyclic order
    let double_area = (x[(0, 1)] - x[(0, 0)]) * (x[(1, 2)] - x[(1, 0)])
        - (x[(0, 2)] - x[(0, 0)]) * (x[(1, 1)] - x[(1, 0)]);
    let gradient = SMatrix::from_fn(|a, i| {
        let (b, c) = ((a + 1) % 3, (a + 2) % 3);
        let difference = if i == 0 {
            x[(1, b)] - x[(1, c)]
        } else {
            x[(0, c)] - x[(0, b)]
        };
        difference / double_area
    });
    let volume = t * double_area / 2.0;
    let point = Point {
        shape: SVector::repeat(1.0 / 3.0),
        gradient,
        volume,
    };
    // m_ab = V (1 + delta_ab) / 12
    let mass = (SMatrix::repeat(1.0) + SMatrix::identity()) * (volume / 12.0);
    Reference {
        points: [point],
        mass,
    }
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
        assert!((element.mass.sum() - volume).abs() < 1e-14);
        assert!((element.mass[(0, 0)] - volume / 6.0).abs() < 1e-14);
    }
}
