//! Node-to-node contact: the common normal of a slave node and a convex corner, from the
//! intersection of their normal cones. See docs/theory/geometry.md, Corner against corner.

use super::tolerances::CONE_MISS;
use crate::vectors::angle;

/// Weight of the second of the `normals` in the common normal of a slave node and a convex corner.
///
/// `normals` are the normals of the segments before and after a convex corner; `own` are the normals before and after
/// the slave node on its own surface. A normal that separates slave node and corner lies in the normal cone between
/// `normals` and in the cone between the opposites of `own`. The common normal is the middle of the intersection of
/// both cones. Flush blocks meet with the normal of their faces, two corners with the normal between their bisectors. A
/// node in a concave corner has no common normal.
pub fn common_normal(normals: [[f64; 2]; 2], own: [[f64; 2]; 2]) -> Option<f64> {
    let [n, m] = normals;
    let opposite = own.map(|n| [-n[0], -n[1]]);
    // angles from the first normal
    let width = angle(n, m);
    if width.is_nan() || width <= 0.0 {
        return None;
    }
    let from = angle(n, opposite[0]);
    let to = from + angle(opposite[0], opposite[1]);
    if to < from - CONE_MISS {
        return None; // the slave node is in a concave corner
    }
    let (low, high) = (from.max(0.0), to.min(width));
    if low > high + CONE_MISS {
        return None;
    }
    let middle = ((low + high) / 2.0).clamp(0.0, width);
    // w = sin psi/(sin(phi - psi) + sin psi), eq. (10.4)
    let (first, second) = ((width - middle).sin(), middle.sin());
    Some(second / (first + second))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: [f64; 2] = [1.0, 0.0];
    const UP: [f64; 2] = [0.0, 1.0];
    const LEFT: [f64; 2] = [-1.0, 0.0];
    const DOWN: [f64; 2] = [0.0, -1.0];

    #[test]
    fn flush_blocks_meet_with_the_normal_of_their_faces() {
        // the right upper corner of a block below and the right lower corner of one above
        assert_eq!(common_normal([RIGHT, UP], [DOWN, RIGHT]), Some(1.0));
        // the left corners
        assert_eq!(common_normal([UP, LEFT], [LEFT, DOWN]), Some(0.0));
    }

    #[test]
    fn corners_meet_with_the_normal_of_their_bisectors() {
        let weight = common_normal([RIGHT, UP], [LEFT, DOWN]);
        assert!((weight.unwrap_or(f64::NAN) - 0.5).abs() < 1e-15);
        let c = 0.5_f64.sqrt();
        let weight = common_normal([[c, c], [-c, c]], [[-c, -c], [c, -c]]);
        assert!((weight.unwrap_or(f64::NAN) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_corner_meets_a_flat_face_with_the_normal_of_the_face() {
        let c = 0.5_f64.sqrt();
        let weight = common_normal([[c, c], [-c, c]], [DOWN, DOWN]);
        assert!((weight.unwrap_or(f64::NAN) - 0.5).abs() < 1e-15);
        // weights in proportion to the sines of the angles to the other normal
        let weight = common_normal([RIGHT, UP], [[-0.8, -0.6], [-0.8, -0.6]]);
        assert!((weight.unwrap_or(f64::NAN) - 0.6 / 1.4).abs() < 1e-15);
    }

    #[test]
    fn corners_that_cannot_separate_have_none() {
        assert_eq!(common_normal([RIGHT, UP], [RIGHT, UP]), None);
        assert_eq!(
            common_normal([RIGHT, UP], [DOWN, LEFT]),
            None,
            "a concave corner"
        );
        assert_eq!(common_normal([UP, RIGHT], [LEFT, DOWN]), None, "not convex");
        let nowhere = [f64::NAN; 2];
        assert_eq!(common_normal([RIGHT, nowhere], [LEFT, DOWN]), None);
    }
}
