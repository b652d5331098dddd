//! Projection of a node on a segment: gap, projection point and local frame. Section 3 of
//! docs/theory.md.

use crate::vectors::{difference, dot, length};

/// A point in the local frame of a segment from a to b, which has its body on the left.
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

/// Positions of all nodes in a configuration: reference coordinates plus displacements.
#[derive(Debug, Clone, Copy)]
pub struct Positions<'a> {
    x: &'a [[f64; 2]],
    u: &'a [[f64; 2]],
}

impl<'a> Positions<'a> {
    /// Reference coordinates of the nodes and displacements over all dofs (length).
    pub fn new(x: &'a [[f64; 2]], u: &'a [f64]) -> Self {
        let u = u.as_chunks().0;
        Positions { x, u }
    }

    /// Position of a node.
    #[inline]
    pub fn of(&self, node: usize) -> [f64; 2] {
        let ([x, y], [u, v]) = (self.x[node], self.u[node]);
        [x + u, y + v]
    }
}

/// Position of a node: reference coordinates plus displacement.
pub(crate) fn position(x: &[[f64; 2]], u: &[f64], node: usize) -> [f64; 2] {
    [x[node][0] + u[2 * node], x[node][1] + u[2 * node + 1]]
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
