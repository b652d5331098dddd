//! Projection of a point on a segment: gap, projection point, local frame, and the round-off of gaps and slips. See
//! docs/theory/geometry.md.

use super::tolerances::{POSITION_ROUND_OFF, SOLVED_GAP};
use crate::linear::largest;
use crate::vectors::{difference, dot, length};

/// A point in the local frame of a segment from a to b, whose body is on the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Coordinate of the projection on the segment: 0 at a, 1 at b.
    pub xi: f64,
    /// Gap: distance along the normal, positive outside the body (length).
    pub gap: f64,
    /// Length of the segment.
    pub length: f64,
    /// Unit vector from a to b.
    pub tangent: [f64; 2],
    /// Unit normal out of the body.
    pub normal: [f64; 2],
}

/// Projects the point `s` on the segment from `a` to `b`.
///
/// ```text
/// e_t = (x_b - x_a)/l,  e_n = (e_t,y, -e_t,x),  l = |x_b - x_a|    eq. (3.2)
/// xi = r.e_t/l,  g = r.e_n,  r = x_s - x_a                         eq. (3.3)
/// ```
#[inline]
pub fn project(s: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Projection {
    let e = difference(a, b);
    let length = length(e);
    let tangent = [e[0] / length, e[1] / length];
    let normal = [tangent[1], -tangent[0]];
    let r = difference(a, s);
    Projection {
        xi: dot(r, tangent) / length,
        gap: dot(r, normal),
        length,
        tangent,
        normal,
    }
}

impl Projection {
    /// The same projection with a gap that is larger by the overlap `allowed` (length).
    pub fn raised(self, allowed: f64) -> Self {
        Projection {
            gap: self.gap + allowed,
            ..self
        }
    }
}

/// The point (1 - eta) x_1 + eta x_2.
pub(super) fn between(x1: [f64; 2], x2: [f64; 2], eta: f64) -> [f64; 2] {
    [0, 1].map(|i| (1.0 - eta) * x1[i] + eta * x2[i])
}

/// Round-off of gaps and slips of a node at `s` (length).
pub(super) fn position_round_off(s: [f64; 2]) -> f64 {
    POSITION_ROUND_OFF * largest(&s)
}

/// Rise g0 - h0 of eq. (7.6) (length) for a node at `s` that has slid on to another segment. The rise is the node's gap
/// at the start to the new segment (of the given length) less h0: the smaller of this gap and the gap `before` to the
/// old segment, but at least 0. A rise within the round-off of closed gaps and positions is set to zero: divided by the
/// slip of a node that has come back, such a rise would tilt the force at random.
pub(super) fn rise((gap, length): (f64, f64), before: f64, s: [f64; 2]) -> f64 {
    let rise = gap - gap.min(before).max(0.0);
    let round_off = (SOLVED_GAP * length).max(position_round_off(s));
    if rise.abs() <= round_off { 0.0 } else { rise }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_points_out_of_the_body_on_the_left() {
        // The top of a body runs from right to left, with the body below it on its left.
        let p = project([1.0, 3.0], [4.0, 2.0], [0.0, 2.0]);
        assert_eq!((p.xi, p.gap, p.length), (0.75, 1.0, 4.0));
        assert_eq!((p.tangent, p.normal), ([-1.0, 0.0], [0.0, 1.0]));
    }
}
