//! Tunnelling check of a converged increment: slave nodes that pass into or through a body on
//! their straight paths from U0 to U1. See docs/theory/geometry.md, Penetration check.
//!
//! Edges of slave surfaces that cross segments, as at corners, although no slave node is inside. See
//! docs/theory/geometry.md, Penetration check.

use super::bulge::Bulge;
use super::closed_pairs::ClosedPairs;
use super::crossing::{Crossing, CrossingSense, QuadraticMotion, crossings};
use super::geometry::{Along, ContactSurfaces};
use super::keys::NodeAtSegment;
use super::keys::SlaveKey;
use super::positions::position;
use super::projection::{Projection, between, project};
use super::search::{ListedSlave, Search};
use super::slave_node::raised;
use super::tolerances::{
    CORNER_CLIP_DEPTH, CORNER_DEPTH, CORNER_PATH_DEPTH, DEPTH_ROUND_OFF, NODE_DEPTH, SEGMENT_END,
};
use crate::linear::{larger, largest};
use crate::vectors::{Circle, CircleTree, cross, difference, length};
use std::collections::HashSet;

/// Returns the first slave node that penetrates a body on its straight path from the displacements `u0` to `u1`, with
/// the segment through which it has entered, or `None`. The search must cover the paths. `closed` are the pairs in
/// contact before the increment and at its end. `unsolved` is the error of every node's displacement that the tolerance
/// of the increment allows (length); a depth up to this error does not count.
///
/// A node may enter through a segment at which it carries a force, or leave again in contact: its
/// straight path cuts the corner that the node slides round.
pub fn find_penetration(
    search: &Search,
    [u0, u1]: [&[f64]; 2],
    closed: [&ClosedPairs; 2],
    unsolved: &[f64],
) -> Option<NodeAtSegment> {
    let x = search.coordinates();
    let mut events = Vec::new();
    for listed in search.slaves() {
        let path = NodePath {
            contact: listed.surfaces,
            x,
            u: [u0, u1],
            slave: listed.node(),
            ends: [u0, u1].map(|u| position(x, u, listed.node())),
            key: listed.key,
            closed,
            unsolved,
            // between its ends the path of a corner may be deeper in a face than the constraint
            // allows at the ends
            allowed: match listed.is_corner() {
                true => (listed.allowed()).map(|depth| depth / CORNER_DEPTH * CORNER_PATH_DEPTH),
                false => listed.allowed(),
            },
            is_corner: listed.is_corner(),
            depth: match listed.surfaces.slave_segments {
                Some(_) => NODE_DEPTH,
                None => DEPTH_ROUND_OFF,
            },
        };
        events.clear();
        for candidate in listed.candidates() {
            let found = crossings(&path.motions(candidate.segment), 1.0);
            events.extend(found.into_iter().map(|c| (candidate.segment, c)));
        }
        let ends_inside = || path.ends_inside(listed.candidates().map(|c| c.segment));
        if let Some(segment) = path.entry(&mut events).or_else(ends_inside) {
            return Some(listed.at(segment));
        }
    }
    None
}

/// The straight path of one slave node in an increment.
struct NodePath<'a> {
    contact: &'a ContactSurfaces,
    x: &'a [[f64; 2]],
    u: [&'a [f64]; 2],
    slave: usize,
    /// Positions of the node at the start and at the end.
    ends: [[f64; 2]; 2],
    key: SlaveKey,
    /// Closed pairs before the increment and at its end.
    closed: [&'a ClosedPairs; 2],
    unsolved: &'a [f64],
    /// Overlap that a fit allows the node at the start and at the end (length).
    allowed: [f64; 2],
    /// Whether the slave node is a corner of contact from surface to surface.
    is_corner: bool,
    /// Depth up to which the node does not count as inside (segment lengths).
    depth: f64,
}

impl NodePath<'_> {
    /// Whether the node was in contact before the increment, or is a corner of a face whose mean gap was closed.
    fn was_closed(&self) -> bool {
        let before = self.closed[0];
        !before.of_slave(self.key).is_empty() || self.is_corner && before.means_have(self.slave)
    }

    /// Segments on which the node is closed at the end.
    fn closed_on(&self) -> impl Iterator<Item = usize> {
        let pairs = self.closed[1].of_slave(self.key).iter();
        pairs.flat_map(|pair| pair.source.target.segments())
    }

    fn motions(&self, segment: usize) -> [QuadraticMotion; 3] {
        let of_end = |node: usize| {
            let [from, to] = self.u.map(|u| position(self.x, u, node));
            QuadraticMotion::straight(from, to)
        };
        let [a, b] = self.contact.segments[segment].map(of_end);
        raised(
            [QuadraticMotion::straight(self.ends[0], self.ends[1]), a, b],
            (&self.contact.bulges[segment], self.allowed),
        )
    }

    /// Projection on a segment at a fraction of the path.
    fn project(&self, segment: usize, part: f64) -> Projection {
        let [s, a, b] = self.motions(segment).map(|m| m.at(part));
        project(s, a, b)
    }

    /// The segment through which the node enters a body without permission, if any.
    fn entry(&self, events: &mut [(usize, Crossing)]) -> Option<usize> {
        events.sort_by(|(_, c), (_, d)| c.time.total_cmp(&d.time));
        for (n, (segment, entering)) in events.iter().enumerate() {
            if entering.direction != CrossingSense::Entering {
                continue;
            }
            let is_out = |c: &Crossing| match c.direction {
                CrossingSense::Leaving => true,
                // the path ends on the surface
                CrossingSense::Touching => c.time >= 1.0,
                CrossingSense::Entering => false,
            };
            let leaving = events[n..].iter().find(|(_, c)| is_out(c));
            let is_harmless = match leaving {
                Some((exit, leaving)) => {
                    self.may_leave((*segment, entering.time), (*exit, leaving.time))
                }
                None => self.may_stay(*segment, entering.xi),
            };
            if !is_harmless {
                return Some(*segment);
            }
        }
        None
    }

    /// The nearest segment at the end, if the node is behind it without a force although it was outside at the start.
    /// A node that is behind a segment without a force has come round a corner that has turned concave.
    fn ends_inside(&self, segments: impl Iterator<Item = usize> + Clone) -> Option<usize> {
        let is_own = |i: &usize| self.contact.is_end(self.slave, *i);
        let others = segments.filter(|i| !is_own(i));
        let is_behind = |&i: &usize| {
            if self.ends_in_front(i) {
                return false;
            }
            let p = self.project(i, 1.0);
            (0.0..=1.0).contains(&p.xi)
                && p.gap < 0.0
                && !self.is_round_off(i, -p.gap, p.length)
                && -p.gap <= 2.0 * self.relative_displacement(i)
                && !self.is_far_side(i)
                && !self.is_before_corner(i, &p)
        };
        let depth = |i: usize| -self.project(i, 1.0).gap;
        let nearest = |i: &usize, j: &usize| depth(*i).total_cmp(&depth(*j));
        let i = others.clone().filter(is_behind).min_by(nearest)?;
        let is_nearest = others.clone().all(|j| self.distance(j) >= depth(i));
        let was_outside = |j: usize| {
            let p = self.project(j, 0.0);
            self.is_round_off(j, -p.gap, p.length) && self.are_near(i, j)
        };
        let is_closed_on = self.closed_on().any(|own| own == i);
        (is_nearest && !is_closed_on && others.clone().any(was_outside)).then_some(i)
    }

    /// Whether the node is clearly in front of a segment at the end, and no fit lets it overlap
    /// there.
    fn ends_in_front(&self, i: usize) -> bool {
        let [a, b] = self.contact.segments[i].map(|node| position(self.x, self.u[1], node));
        let is_plain = self.allowed == [0.0; 2] && self.contact.bulges[i].is_flat();
        is_plain && cross(difference(a, self.ends[1]), difference(a, b)) > 0.0
    }

    /// Whether the node belongs to the body behind a segment at the end.
    fn is_far_side(&self, i: usize) -> bool {
        let at = |node: usize| position(self.x, self.u[1], node);
        let ContactSurfaces {
            interior, segments, ..
        } = self.contact;
        interior.joins(segments[i], self.slave, at)
    }

    /// Distance of the node from a segment at the end.
    fn distance(&self, i: usize) -> f64 {
        let p = self.project(i, 1.0);
        let beyond = (p.xi - p.xi.clamp(0.0, 1.0)) * p.length;
        beyond.hypot(p.gap)
    }

    /// Whether a node that enters through one segment may leave through another. A node that leaves through the segment
    /// of its entry returns to the side from which it came.
    fn may_leave(&self, (i, entered): (usize, f64), (j, left): (usize, f64)) -> bool {
        if i == j {
            return true;
        }
        let middle = entered + (left - entered) / 2.0;
        let (p, q) = (self.project(i, middle), self.project(j, middle));
        let depth = (-p.gap).min(-q.gap);
        let slides = || {
            let is_closed_on = |k| self.are_near(i, k);
            self.was_closed() || self.closed_on().any(is_closed_on)
        };
        self.is_round_off(i, depth, p.length)
            || (self.are_near(i, j) && (depth <= CORNER_CLIP_DEPTH * p.length || slides()))
    }

    /// Whether a node that enters through a segment, and leaves through no segment, is outside the body nevertheless.
    fn may_stay(&self, i: usize, xi: f64) -> bool {
        let p = self.project(i, 1.0);
        if self.is_round_off(i, -p.gap, p.length)
            || self.closed_on().any(|own| own == i)
            || self.is_outside_corner(i, xi, &p)
        {
            return true;
        }
        let is_on = |j: usize| (0.0..=1.0).contains(&self.project(j, 1.0).xi);
        self.closed_on().any(|j| is_on(j) && self.are_near(i, j))
            || (self.was_closed() && self.has_slid_off(i, &p))
    }

    /// Whether a depth behind segment `i`, whose length is given, is within the tolerance of the
    /// solution.
    fn is_round_off(&self, i: usize, depth: f64, length: f64) -> bool {
        let [a, b] = self.contact.segments[i];
        let unsolved = [self.slave, a, b].map(|node| self.unsolved[node]);
        // discs touch the arcs, not their chords
        let is_chord = self.contact.disc.is_some() && self.contact.arc_of(i).is_some();
        let part = if is_chord { NODE_DEPTH } else { self.depth };
        depth <= largest(&unsolved) + part * length
    }

    /// Whether the node has crossed a segment near its end and lies outside the corner there: behind the line of this
    /// segment and in front of the line of its neighbour. If the node has only clipped the corner, it need not leave
    /// the body through the neighbour.
    fn is_outside_corner(&self, i: usize, xi: f64, p: &Projection) -> bool {
        let (is_end_b, from_end) = (xi > 0.5, xi.min(1.0 - xi));
        let neighbour = if is_end_b {
            self.contact.next[i]
        } else {
            self.contact.previous[i]
        };
        let Some(j) = neighbour else {
            return from_end <= SEGMENT_END && !(0.0..=1.0).contains(&p.xi);
        };
        let q = self.project(j, 1.0);
        let is_convex = if is_end_b {
            turns_left(p, &q)
        } else {
            turns_left(&q, p)
        };
        from_end <= CORNER_CLIP_DEPTH && is_convex && self.is_round_off(j, -q.gap, q.length)
    }

    /// Whether a node that may overlap segment `i` is still in front of the line of a neighbour at a convex corner,
    /// when raised by the allowed overlap. A node raised in front of the neighbour is, near the corner, outside the
    /// body reduced by the overlap.
    fn is_before_corner(&self, i: usize, p: &Projection) -> bool {
        let is_before = |(j, is_next): (Option<usize>, bool)| {
            let Some(q) = j.map(|j| self.project(j, 1.0)) else {
                return false;
            };
            let [first, second] = if is_next { [p, &q] } else { [&q, p] };
            turns_left(first, second) && q.gap >= 0.0
        };
        let neighbours = [
            (self.contact.next[i], true),
            (self.contact.previous[i], false),
        ];
        self.allowed != [0.0; 2] && neighbours.into_iter().any(is_before)
    }

    /// Whether the node has slid off the end of an open surface.
    fn has_slid_off(&self, i: usize, p: &Projection) -> bool {
        (p.xi > 1.0 && self.leads(i, Along::Forward, None))
            || (p.xi < 0.0 && self.leads(i, Along::Backward, None))
    }

    /// Whether two segments are neighbours on the surface, or the surface between them is at most
    /// twice as long as the displacement of the node. The bound on the length excludes the far side of a thin body.
    fn are_near(&self, i: usize, j: usize) -> bool {
        let leads = |i: usize, j: usize| self.leads(i, Along::Forward, Some(j));
        i == j || leads(i, j) || leads(j, i)
    }

    /// Displacement of the node relative to the start a of a segment (length).
    fn relative_displacement(&self, segment: usize) -> f64 {
        let [start, end] = [0.0, 1.0].map(|part| {
            let [s, a, _] = self.motions(segment).map(|m| m.at(part));
            difference(a, s)
        });
        (end[0] - start[0]).hypot(end[1] - start[1])
    }

    /// Whether the chain leads from a segment to another, or to the end of the surface, within
    /// twice the displacement of the node.
    fn leads(&self, from: usize, along: Along, to: Option<usize>) -> bool {
        let farthest = 2.0 * self.relative_displacement(from);
        let length = |i: usize| self.project(i, 1.0).length;
        let mut chain = self.contact.walk(from, along, farthest, length);
        chain.any(|following| following == to)
    }
}

/// Whether the corner between two successive segments turns left, so it is convex.
fn turns_left(first: &Projection, second: &Projection) -> bool {
    cross(first.tangent, second.tangent) > 0.0
}

/// Largest depth by which a face of a slave surface and a segment cross at the displacements `u`; 0 if no face crosses
/// a segment:
///
/// ```text
/// min(|h_p|, |h_q|)/|b - a|, min(|h_a|, |h_b|)/|q - p|   the smaller    eq. (10.6)
/// ```
///
/// The symbols h are the distances of the ends p and q of the face from the line of the segment from a to b, and of a
/// and b from the line of the face. Edges with a common node do not count, nor do edges of contact from surface to
/// surface, whose gaps are means.
pub fn crossed_edges(search: &Search, u: &[f64]) -> f64 {
    let at = |node: usize| position(search.coordinates(), u, node);
    let (mut most, mut found) = (0.0, Vec::new());
    for surfaces in search.surfaces_of_nodes() {
        let is_slave: HashSet<usize> = surfaces.slaves.iter().copied().collect();
        let faces = surfaces.slave_faces.iter().copied();
        let faces: Vec<([usize; 2], Bulge)> = (faces.zip(surfaces.face_bulges.iter().copied()))
            .filter(|(face, _)| face.iter().all(|node| is_slave.contains(node)))
            .collect();
        let circle = |edge: [usize; 2]| {
            let [a, b] = edge.map(at);
            Circle {
                centre: between(a, b, 0.5),
                radius: length(difference(a, b)) / 2.0,
            }
        };
        let own = CircleTree::new(
            faces
                .iter()
                .map(|(face, _)| circle(*face))
                .collect::<Vec<_>>(),
        );
        let others = surfaces.segments.iter().map(|segment| circle(*segment));
        let others = CircleTree::new(others.collect::<Vec<_>>());
        found.clear();
        own.overlaps(&others, &mut found);
        for &[face, segment] in &found {
            let ((face, bulge), segment) = (faces[face as usize], segment as usize);
            if !face.iter().any(|&node| surfaces.is_end(node, segment)) {
                let own = (face.map(at), bulge);
                let other = (surfaces.segments[segment].map(at), surfaces.bulges[segment]);
                let depth = crossed_by(own, other);
                most = larger(most, depth.unwrap_or(0.0));
            }
        }
    }
    most
}

/// Largest depth of a slave node inside a master, over the listed slave nodes of contact from surface to surface, whose
/// gaps are means, at the displacements `u`; 0 if no node is inside:
///
/// ```text
/// |x_s - x_m|/L    eq. (10.7)
/// ```
///
/// Here x_m is the nearest point of the master, and L the length of the segment there; behind a rigid segment L is the
/// length of the longer edge at the node. The depth of a vertex between two mean gaps is given by eq. (10.8).
pub fn sunk_nodes(search: &Search, u: &[f64]) -> f64 {
    let at = |node: usize| position(search.coordinates(), u, node);
    let is_of_mean = |listed: &ListedSlave| !listed.is_fitted() && !listed.meets_segments();
    let slaves = search.slaves().filter(is_of_mean);
    slaves.fold(0.0, |most, listed| larger(most, depth_of(&listed, at)))
}

/// Depth of one node inside the master, or 0.
fn depth_of(listed: &ListedSlave, at: impl Fn(usize) -> [f64; 2] + Copy) -> f64 {
    let (node, surfaces) = (listed.node(), listed.surfaces);
    let s = at(node);
    let beside = |i: usize| {
        let [a, b] = surfaces.segments[i].map(at);
        let p = project(s, a, b);
        let xi = p.xi.clamp(0.0, 1.0);
        let rise = surfaces.bulges[i].at(xi);
        let [x, y] = between(a, b, xi);
        let [nx, ny] = p.normal;
        let apart = length(difference([x + rise * nx, y + rise * ny], s));
        (i, p.raised(-rise), apart)
    };
    let others = (listed.candidates().map(|candidate| candidate.segment))
        .filter(|&i| !surfaces.is_end(node, i));
    let nearest = others.map(beside).min_by(|p, q| p.2.total_cmp(&q.2));
    let Some((i, p, apart)) = nearest.filter(|(_, p, _)| p.gap < 0.0) else {
        return 0.0;
    };
    let segment = surfaces.segments[i];
    if surfaces.interior.has_body(segment) {
        // between the chord and the face there is no element
        let is_outside_chord = p.gap + surfaces.bulges[i].at(p.xi.clamp(0.0, 1.0)) >= 0.0;
        let is_inside = is_outside_chord || surfaces.interior.takes_in(segment, node, at);
        return if is_inside { apart / p.length } else { 0.0 };
    }
    // beyond the end of a rigid surface nothing is inside
    let is_beyond_end = (p.xi < 0.0 && surfaces.previous[i].is_none())
        || (p.xi > 1.0 && surfaces.next[i].is_none());
    let adjacent = surfaces.adjacent[listed.number].into_iter().flatten();
    let edges = adjacent.map(|other| length(difference(at(other), s)));
    let edge = edges.fold(0.0, larger);
    match is_beyond_end || edge == 0.0 {
        true => 0.0,
        false => apart / edge,
    }
}

/// Depth by which one edge and one segment, each with its bulge, cross, eq. (10.6); `None` if they do not cross.
fn crossed_by(edge: ([[f64; 2]; 2], Bulge), segment: ([[f64; 2]; 2], Bulge)) -> Option<f64> {
    let depth = |ends: [[f64; 2]; 2], ([a, b], bulge): ([[f64; 2]; 2], Bulge)| {
        let [p, q] = ends.map(|end| {
            let p = project(end, a, b);
            // beyond the ends of the segment the bulge is that at the end
            let rise = bulge.at(p.xi.clamp(0.0, 1.0));
            p.raised(-rise)
        });
        (p.gap * q.gap < 0.0).then(|| p.gap.abs().min(q.gap.abs()) / p.length)
    };
    Some(depth(edge.0, segment)?.min(depth(segment.0, edge)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactSurfaces;

    #[test]
    fn edges_cross_by_the_nearest_end() {
        let segment = [[0.0, 0.0], [4.0, 0.0]];
        let by = |p, q| crossed_by(([p, q], Bulge::FLAT), (segment, Bulge::FLAT));
        assert_eq!(by([1.0, 2.0], [1.0, -0.4]), Some(0.1));
        assert_eq!(by([1.0, -0.4], [1.0, 2.0]), Some(0.1));
        assert_eq!(by([1.0, 2.0], [1.0, 0.4]), None, "above");
        assert_eq!(by([5.0, 2.0], [5.0, -2.0]), None, "beside");
        // the end of the segment is nearer to the edge than the ends of the edge are to the segment
        assert_eq!(by([3.75, 2.0], [3.75, -2.0]), Some(0.0625));
        assert_eq!(by([1.0, 0.0], [1.0, -2.0]), None, "an end on the segment");
    }

    #[test]
    fn a_corner_that_an_edge_cuts_is_seen_though_no_node_is_inside() {
        // a roof over (0, 0), and a beam of two nodes that lies across its ridge, both ends outside: as long as the roof, or
        // so long that no end is near it
        for (roof, half) in [(2.0, 1.0), (0.1, 5.0)] {
            let x = [
                [roof, -roof],
                [0.0, 0.0],
                [-roof, -roof],
                [half, -0.25 * roof],
                [-half, -0.25 * roof],
            ];
            let sides = vec![[0, 1], [1, 2]];
            let beam = [[3, 4], [4, 3]];
            let surfaces = ContactSurfaces::new(vec![3, 4], &beam, sides);
            let contacts = [surfaces];
            let mut search = Search::new(&contacts, &x);
            let mut depth = |height: f64| {
                let mut u = [0.0; 10];
                (u[7], u[9]) = (height, height);
                search.cover(&u);
                crossed_edges(&search, &u)
            };
            assert_eq!(depth(0.3 * roof), 0.0);
            // the ridge is an eighth of the roof above the beam
            let right = roof / 8.0 / (2.0 * half);
            let found = depth(roof / 8.0);
            assert!((found - right).abs() < 1e-15, "{found} {right}");
        }
    }
}
