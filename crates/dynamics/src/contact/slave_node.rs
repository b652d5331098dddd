//! Kinematics of a slave node relative to nearby segments, at the start of the increment and at
//! the iterate: the tests by which its contact targets are selected. See docs/theory/geometry.md, Contact targets.

use super::bulge::Bulge;
use super::crossing::{Crossing, CrossingSense, QuadraticMotion, crossings};
use super::geometry::ContactSurfaces;
use super::positions::Positions;
use super::projection::{Projection, project};
use super::target::ContactTarget;
use super::tolerances::{
    CLOSED_GAP, CORNER_ZONE, FACING_SINE, FOLDED_CORNER_SINE, GENTLE_SINE, INITIAL_DEPTH,
};
use crate::vectors::{cross, difference, dot, length};

/// A slave node at the start of an increment and at the iterate of a pass, with the segments around
/// it.
#[derive(Clone, Copy)]
pub struct SlaveNode<'a> {
    /// Surfaces of the contact.
    pub surfaces: &'a ContactSurfaces,
    /// Positions of all nodes at the start.
    pub start: Positions<'a>,
    /// Positions of all nodes in the iterate.
    pub now: Positions<'a>,
    /// Index of the slave node in its contact.
    pub slave: usize,
    /// Targets of the pairs of the node that were closed at the start.
    pub closed_on: &'a [ContactTarget],
    /// Overlap that a fit allows the node at the start and in the iterate (length); it is added to the gaps, eq.
    /// (3.15).
    pub allowed: [f64; 2],
}

impl SlaveNode<'_> {
    /// Whether the node enters the body through the segment, on its straight path from start to
    /// iterate.
    pub(crate) fn enters(&self, segment: usize) -> bool {
        let [a, b] = self.surfaces.segments[segment];
        let motions = [self.node(), a, b]
            .map(|node| QuadraticMotion::straight(self.start.of(node), self.now.of(node)));
        let motions = raised(motions, (&self.surfaces.bulges[segment], self.allowed));
        let is_entering = |c: &Crossing| c.direction == CrossingSense::Entering;
        crossings(&motions, 1.0).iter().any(is_entering)
    }

    /// Whether the node is so far in front of a segment that its neighbour segments do not matter.
    pub(crate) fn is_far(&self, segment: usize) -> bool {
        let p = self.project(segment);
        p.gap > p.length && p.gap > 2.0 * self.displacement_at(segment, &p)
    }

    /// Whether the node's own surface faces the segment, that is, lies in front of the parallel to
    /// the segment through the node. `None` for a node without neighbours.
    pub(crate) fn is_opposite(&self, segment: usize) -> Option<bool> {
        let node = self.node();
        let normal = self.project(segment).normal;
        let is_in_front = |&adjacent: &usize| {
            let r = difference(self.now.of(node), self.now.of(adjacent));
            let (height, least) = (dot(r, normal), r[0].abs().max(r[1].abs()));
            height >= -FACING_SINE * least || height >= -FACING_SINE * r[0].hypot(r[1])
        };
        let adjacent = self.surfaces.adjacent[self.slave]?;
        Some(adjacent.iter().all(is_in_front))
    }

    /// Sine of the least angle by which the neighbours of the node were, at the start, in front of the parallel to a
    /// segment through the node. The sine is larger for the segment that the node's surface faced better.
    pub(crate) fn faced_at_start(&self, segment: usize) -> f64 {
        let (node, normal) = (self.start_position(), self.project_at_start(segment).normal);
        let sine = |adjacent: usize| {
            let r = difference(node, self.start.of(adjacent));
            dot(r, normal) / r[0].hypot(r[1])
        };
        let adjacent = self.surfaces.adjacent[self.slave].into_iter().flatten();
        adjacent.map(sine).fold(1.0, f64::min)
    }

    /// Whether the node was in front of the line of a segment at the start.
    pub(crate) fn was_in_front(&self, segment: usize) -> bool {
        let p = self.project_at_start(segment);
        p.gap >= -CLOSED_GAP * p.length
    }

    /// Whether the node started with a penetration so small that it may come from the mesh.
    pub(crate) fn was_pushed_in(&self, segment: usize) -> bool {
        let p = self.project_at_start(segment);
        let is_shallow = p.gap >= -INITIAL_DEPTH * p.length
            && (-CORNER_ZONE..=1.0 + CORNER_ZONE).contains(&p.xi);
        let (surfaces, start) = (self.surfaces, |node: usize| self.start.of(node));
        let node = self.node();
        let is_outside_chord =
            || p.gap - self.allowed[0] + surfaces.bulges[segment].at(p.xi) >= 0.0;
        is_shallow
            && (is_outside_chord()
                || (surfaces.interior).takes_in(surfaces.segments[segment], node, start))
    }

    /// Whether the node belongs to the body behind the segment, so it lies on the far side of a
    /// thin body.
    pub(crate) fn was_far_side(&self, segment: usize) -> bool {
        let (surfaces, start) = (self.surfaces, |node: usize| self.start.of(node));
        let node = self.node();
        (surfaces.interior).joins(surfaces.segments[segment], node, start)
    }

    /// Whether the node is an end of the segment, or the same vertex as an end.
    pub(crate) fn is_own(&self, segment: usize) -> bool {
        self.surfaces.is_end(self.node(), segment)
    }

    /// Distance from the end of a segment, on which the node has the projection `p`, within which the other segment of
    /// a concave corner also constrains the node (length).
    pub(crate) fn corner_reach(&self, segment: usize, p: &Projection) -> f64 {
        CORNER_ZONE * p.length + 2.0 * self.displacement_at(segment, p)
    }

    /// Whether the node was over a segment at the start, or nearer to an end of the segment than `near` (length) with
    /// half of one of the node's own faces over the segment.
    pub(crate) fn was_over(&self, segment: usize, near: f64) -> bool {
        let [a, b] = self.surfaces.segments[segment].map(|n| self.start.of(n));
        let is_over =
            |s: [f64; 2], reach: f64| (-reach..=1.0 + reach).contains(&project(s, a, b).xi);
        let node = self.start_position();
        let middle = |n: usize| {
            let [x, y] = self.start.of(n);
            [f64::midpoint(node[0], x), f64::midpoint(node[1], y)]
        };
        let mut adjacent = self.surfaces.adjacent[self.slave].into_iter().flatten();
        // the tolerance covers round-off: nodes of matching meshes are at the ends of segments
        is_over(node, CLOSED_GAP)
            || (is_over(node, near / length(difference(a, b)))
                && adjacent.any(|n| is_over(middle(n), CLOSED_GAP)))
    }

    /// Displacement of the node relative to a segment since the start (length).
    pub(crate) fn relative_displacement(&self, segment: usize) -> f64 {
        self.displacement_at(segment, &self.project(segment))
    }

    /// Displacement of the node relative to the foot of its projection `p` on a segment (length).
    fn displacement_at(&self, segment: usize, p: &Projection) -> f64 {
        let [a, b] = self.surfaces.segments[segment];
        let xi = p.xi.clamp(0.0, 1.0);
        let [s, a, b] = [self.node(), a, b].map(|n| difference(self.start.of(n), self.now.of(n)));
        let relative = |i: usize| s[i] - (1.0 - xi) * a[i] - xi * b[i];
        (relative(0).powi(2) + relative(1).powi(2)).sqrt()
    }

    /// Sine of the turn to the left from one segment to the next: positive at a convex corner,
    /// negative at a concave corner; beyond a right angle it is 1 or -1.
    pub(crate) fn corner_sine(&self, i: usize, j: usize) -> f64 {
        self.corner_sine_at(self.now, i, j)
    }

    /// Sine of the turn to the left from one segment to the next, at the start.
    pub(crate) fn corner_sine_at_start(&self, i: usize, j: usize) -> f64 {
        self.corner_sine_at(self.start, i, j)
    }

    fn corner_sine_at(&self, at: Positions, i: usize, j: usize) -> f64 {
        let [e, f] = self.corner_tangents(at, i, j);
        let [sin, cos] = [cross(e, f), dot(e, f)];
        if cos >= 0.0 {
            sin
        } else if sin.abs() > FOLDED_CORNER_SINE {
            sin.signum()
        } else if self.surfaces.sharp_corners[i] {
            1.0
        } else {
            -1.0
        }
    }

    /// Unit tangents of the faces of two successive segments where they meet.
    pub(crate) fn corner_tangents(&self, at: Positions, i: usize, j: usize) -> [[f64; 2]; 2] {
        [(i, 1.0), (j, 0.0)].map(|(i, end)| {
            let [a, b] = self.surfaces.segments[i].map(|n| at.of(n));
            self.surfaces.bulges[i].tangent(&project(a, a, b), end)
        })
    }

    /// Whether there is a concave corner between two segments, with more than a gentle turn.
    pub(crate) fn is_concave(&self, i: usize, j: usize) -> bool {
        if [i, j].iter().any(|&i| !self.surfaces.bulges[i].is_flat()) {
            return self.corner_sine(i, j) < -GENTLE_SINE;
        }
        let [e, f] = [i, j].map(|i| {
            let [a, b] = self.surfaces.segments[i].map(|n| self.now.of(n));
            difference(a, b)
        });
        // |sin| <= |tan|, so the sine need not be computed in most cases
        let has_gentle_tangent = cross(e, f) > -0.5 * GENTLE_SINE * dot(e, f);
        !(has_gentle_tangent && dot(e, f) > 0.0) && self.corner_sine(i, j) < -GENTLE_SINE
    }

    /// Coordinate xi of the projection on a segment in the iterate.
    #[inline]
    pub(crate) fn xi(&self, segment: usize) -> f64 {
        self.xi_of(self.position(), segment)
    }

    /// Coordinate xi of the projection of the position `s` on a segment in the iterate.
    #[inline(always)]
    pub(crate) fn xi_of(&self, s: [f64; 2], segment: usize) -> f64 {
        let [a, b] = self.surfaces.segments[segment].map(|n| self.now.of(n));
        let [r, e] = [difference(a, s), difference(a, b)];
        dot(r, e) / dot(e, e)
    }

    /// Position of the node in the iterate.
    #[inline]
    pub(crate) fn position(&self) -> [f64; 2] {
        self.now.of(self.node())
    }

    /// Position of the node at the start.
    pub(crate) fn start_position(&self) -> [f64; 2] {
        self.start.of(self.node())
    }

    /// Projection on a segment in the iterate.
    #[inline]
    pub(crate) fn project(&self, segment: usize) -> Projection {
        self.project_at((self.now, self.allowed[1]), segment)
    }

    /// Projection on a segment at the start.
    pub(crate) fn project_at_start(&self, segment: usize) -> Projection {
        self.project_at((self.start, self.allowed[0]), segment)
    }

    #[inline]
    fn project_at(&self, (at, allowed): (Positions, f64), segment: usize) -> Projection {
        let [a, b] = self.surfaces.segments[segment];
        let p = project(at.of(self.node()), at.of(a), at.of(b));
        self.surfaces.bulges[segment].below(p).raised(allowed)
    }

    /// The node.
    #[inline]
    pub(crate) fn node(&self) -> usize {
        self.surfaces.slaves[self.slave]
    }
}

/// Motions of a node and of the ends of a segment. At both ends of the path the node is raised along the normal by the
/// overlap that a fit allows, and lowered by the bulge of the face (length). Where the raised node crosses the segment,
/// the node crosses the face.
pub(super) fn raised(
    [mut s, a, b]: [QuadraticMotion; 3],
    (bulge, allowed): (&Bulge, [f64; 2]),
) -> [QuadraticMotion; 3] {
    if allowed != [0.0; 2] || !bulge.is_flat() {
        let raised = |part: f64, by: f64| {
            let [x, a, b] = [&s, &a, &b].map(|motion| motion.at(part));
            let p = project(x, a, b);
            let by = by - bulge.at(p.xi);
            [0, 1].map(|i| x[i] + by * p.normal[i])
        };
        s = QuadraticMotion::straight(raised(0.0, allowed[0]), raised(1.0, allowed[1]));
    }
    [s, a, b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_deep_a_node_still_touches_is_a_part_of_the_length_of_the_segment() {
        let surfaces = ContactSurfaces::new(vec![2], &[], vec![[0, 1]]);
        let was_in_front = |length: f64, depth: f64| {
            // the segment runs from right to left, with the body below it
            let x = [[length, 0.0], [0.0, 0.0], [0.5 * length, -depth * length]];
            let at = Positions::new(&x, &[0.0; 6]);
            let node = SlaveNode {
                surfaces: &surfaces,
                start: at,
                now: at,
                slave: 0,
                closed_on: &[],
                allowed: [0.0; 2],
            };
            node.was_in_front(0)
        };
        for length in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            assert!(was_in_front(length, 0.5 * CLOSED_GAP), "{length:e}");
            assert!(!was_in_front(length, 2.0 * CLOSED_GAP), "{length:e}");
        }
    }
}
