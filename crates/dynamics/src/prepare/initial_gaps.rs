//! Initial gaps of a contact by closest-point projection of the slave nodes in the reference
//! configuration, with branch and bound over the bounding circles of the segments and the fans of their
//! normals. See docs/theory/geometry.md, Initial gaps.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use crate::contact::tolerances::{COORDINATE_ROUND_OFF, FACING_SINE, PROJECTION_BEYOND_ENDS};
use crate::contact::{ContactSurfaces, Projection, project, shortest_faces};
use crate::vectors::{Circle, CircleTree, difference, distance, dot, length};

/// Gap of a slave node to the segment that it faces in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InitialGap {
    /// Slave node (index).
    pub slave: usize,
    /// Nodes [a, b] of the segment.
    pub segment: [usize; 2],
    /// Foot of the perpendicular on the segment, 0 at a and 1 at b.
    pub xi: f64,
    /// Gap (length), negative when the node is inside the body.
    pub gap: f64,
    /// Bulge of the face over its chord at the foot (length).
    pub rise: f64,
    /// Length of the segment.
    pub length: f64,
    /// The smallest of the lengths of the segment and of the faces of the slave node; depths are relative to this
    /// length.
    pub edge: f64,
}

impl InitialGap {
    /// Whether the node is inside the body, or between a chord of its surface and the curved face.
    pub(super) fn is_inside(&self, contact: &ContactSurfaces, x: &[[f64; 2]]) -> bool {
        let in_element = || {
            contact
                .interior
                .contains(self.segment, self.slave, |node| x[node])
        };
        self.gap < 0.0 && (self.gap + self.rise >= 0.0 || in_element())
    }
}

/// Gaps of the slave nodes of a contact at the positions `x`, without nodes that face no segment. If a contact removes
/// its overlap at the start, nodes may lie deeper behind a segment that their own surface faces.
pub(super) fn gaps(
    contact: &ContactSurfaces,
    x: &[[f64; 2]],
    bodies: &[usize],
    shrinks: bool,
) -> Vec<InitialGap> {
    let start = Start::new(contact, x, bodies, shrinks);
    let found = contact.slaves.iter().filter_map(|&slave| start.gap(slave));
    let of_circle = |of_centre: InitialGap| InitialGap {
        gap: of_centre.gap - contact.radius(),
        ..of_centre
    };
    found.map(of_circle).collect()
}

/// Circle about a segment, including the ends beyond which a projection is still accepted.
fn circle(a: [f64; 2], b: [f64; 2]) -> Circle {
    Circle {
        centre: [0, 1].map(|i| a[i] + (b[i] - a[i]) / 2.0),
        radius: (b[0] - a[0]).hypot(b[1] - a[1]) * (0.5 + 2.0 * PROJECTION_BEYOND_ENDS),
    }
}

/// The surfaces of a contact in the reference configuration.
struct Start<'m> {
    contact: &'m ContactSurfaces,
    x: &'m [[f64; 2]],
    bodies: &'m [usize],
    /// Circles about the segments.
    tree: CircleTree,
    /// Normals of the segments of every group of the tree.
    fans: Vec<Option<NormalFan>>,
    /// Length of the shortest face at every slave node that has one.
    shortest: HashMap<usize, f64>,
    /// Nodes before and after every slave node on its own surface, if the contact removes its overlap at the start.
    adjacent: Option<HashMap<usize, [usize; 2]>>,
    /// Depth behind a segment up to which a node may face the segment (segment lengths).
    deepest: f64,
}

/// Depth behind a segment up to which a node may lie if the contact removes its overlap (segment lengths).
const DEEPEST_FIT: f64 = 8.0;

impl<'m> Start<'m> {
    fn new(
        contact: &'m ContactSurfaces,
        x: &'m [[f64; 2]],
        bodies: &'m [usize],
        shrinks: bool,
    ) -> Self {
        let circles = contact.segments.iter().map(|&[a, b]| circle(x[a], x[b]));
        let tree = CircleTree::new(circles);
        let ends = |i: usize| contact.segments[i].map(|node| x[node]);
        let deepest = if shrinks { DEEPEST_FIT } else { 1.0 };
        let fan = |i: usize| NormalFan {
            deepest: deepest * distance(ends(i)[0], ends(i)[1]),
            ..NormalFan::new(ends(i), contact.next[i].map(ends))
        };
        let own = contact.slaves.iter().zip(&contact.adjacent);
        let own = own.filter_map(|(&slave, adjacent)| Some((slave, (*adjacent)?)));
        Start {
            adjacent: shrinks.then(|| own.collect()),
            deepest,
            fans: tree.of_groups(fan, NormalFan::join),
            shortest: shortest_faces(&contact.slave_faces, x),
            contact,
            x,
            bodies,
            tree,
        }
    }

    /// Visits the segments that a point may face, approximately in the order of their distance, up to the limit
    /// (length) that the last visit returned.
    fn visit_faced(&self, point: [f64; 2], visit: impl FnMut(usize) -> f64) {
        let may_face = |group: usize, circle: &Circle| {
            self.fans[group].is_some_and(|fan| fan.may_face(point, circle))
        };
        self.tree.visit_near(point, may_face, visit);
    }

    /// Gap to the closest segment into which the node projects, or in whose wedge with the next segment the node lies.
    fn gap(&self, slave: usize) -> Option<InitialGap> {
        let mut closest: Option<(f64, usize)> = None;
        self.visit_faced(self.x[slave], |i| {
            let found = [self.over(slave, i), self.in_wedge(slave, i)];
            for (distance, segment) in found.into_iter().flatten() {
                let is_closer = |(d, other)| distance < d || (distance == d && segment < other);
                if closest.is_none_or(is_closer) {
                    closest = Some((distance, segment));
                }
            }
            closest.map_or(f64::INFINITY, |(distance, _)| distance)
        });
        let segment = closest?.1;
        let p = self.project(slave, segment);
        Some(InitialGap {
            slave,
            segment: self.contact.segments[segment],
            xi: p.xi,
            gap: p.gap,
            rise: self.contact.bulges[segment].at(p.xi),
            length: p.length,
            edge: (self.shortest.get(&slave)).map_or(p.length, |own| own.min(p.length)),
        })
    }

    fn project(&self, slave: usize, segment: usize) -> Projection {
        let [a, b] = self.contact.segments[segment];
        let on_chord = project(self.x[slave], self.x[a], self.x[b]);
        self.contact.bulges[segment].below(on_chord)
    }

    /// Distance of the node from segment `i`, if the node projects into this segment.
    fn over(&self, slave: usize, i: usize) -> Option<(f64, usize)> {
        let p = self.faced(slave, i)?;
        let is_over = (-PROJECTION_BEYOND_ENDS..=1.0 + PROJECTION_BEYOND_ENDS).contains(&p.xi);
        is_over.then_some((p.gap.abs(), i))
    }

    /// Distance of the node from the end of segment `i`, if the node lies between the normals of `i` and the next
    /// segment. The function returns the segment with the larger gap outside a convex corner, and the segment with the
    /// smaller gap inside a concave corner.
    fn in_wedge(&self, slave: usize, i: usize) -> Option<(f64, usize)> {
        let j = self.contact.next[i]?;
        let (p, q) = (self.faced(slave, i)?, self.faced(slave, j)?);
        let is_between = p.xi > 1.0 && q.xi < 0.0;
        let outside = p.gap.max(q.gap) > 0.0;
        let segment = if (p.gap >= q.gap) == outside { i } else { j };
        let distance = ((p.xi - 1.0) * p.length).hypot(p.gap);
        is_between.then_some((distance, segment))
    }

    /// Projection of a node on a segment that the node may face. The segment must not contain the node, and must be
    /// penetrated by less than its length. If node and segment belong to the same body, the node must be in front.
    fn faced(&self, slave: usize, i: usize) -> Option<Projection> {
        let [a, b] = self.contact.segments[i];
        let p = self.project(slave, i);
        let interior = &self.contact.interior;
        let at = |node: usize| self.x[node];
        // deeper nodes must belong to a fit and lie in the body, nearer to this side than to the far side
        let may_face = || {
            p.gap >= -p.length
                || (p.gap >= -self.deepest * p.length && interior.takes_in([a, b], slave, at))
        };
        let is_own_body = self.bodies[a] == self.bodies[slave];
        let is_behind = || p.gap + self.contact.bulges[i].at(p.xi) < 0.0;
        let is_back = || is_own_body && is_behind() && !interior.contains([a, b], slave, at);
        let is_meant = ![a, b].contains(&slave) && may_face() && !is_back();
        (is_meant && (p.gap > COORDINATE_ROUND_OFF * p.length || self.is_opposite(slave, &p)))
            .then_some(p)
    }

    /// Whether the surface of a node whose overlap the contact removes faces a segment, that is, lies in front of the
    /// parallel to the segment through the node.
    fn is_opposite(&self, slave: usize, p: &Projection) -> bool {
        let adjacent = self.adjacent.as_ref().and_then(|all| all.get(&slave));
        adjacent.into_iter().flatten().all(|&adjacent| {
            let r = difference(self.x[slave], self.x[adjacent]);
            dot(r, p.normal) >= -FACING_SINE * length(r)
        })
    }
}

/// Angle (rad) that covers the round-off of directions, and projections beyond the ends of a segment.
const ANGLE_ROUND_OFF: f64 = 1e-5;

/// Fan of the normals of some segments and of the corners at their ends: all directions within some angle from a middle
/// direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NormalFan {
    /// Middle direction (rad).
    middle: f64,
    /// Largest angle from the middle direction (rad); pi for all directions.
    half: f64,
    /// Depth up to which a node may lie behind the segments: the length of the longest segment, or
    /// more.
    deepest: f64,
}

impl NormalFan {
    /// The fan of a segment with the ends `[a, b]` and of the corner to the `next` segment.
    pub fn new([a, b]: [[f64; 2]; 2], next: Option<[[f64; 2]; 2]>) -> Self {
        let of = |[a, b]: [[f64; 2]; 2]| {
            let normal = project(a, a, b).normal;
            normal[1].atan2(normal[0])
        };
        let middle = of([a, b]);
        let turn = next.map_or(0.0, |next| turn(middle, of(next)));
        // legs that lie on each other may fold either way; a segment without length has no normal
        let is_clear = middle.is_finite() && turn.abs() < PI - ANGLE_ROUND_OFF;
        NormalFan {
            middle: if is_clear { middle + turn / 2.0 } else { 0.0 },
            half: if is_clear { turn.abs() / 2.0 } else { PI },
            deepest: length(difference(a, b)),
        }
    }

    /// The fan of two groups of segments together.
    pub fn join(self, other: Self) -> Self {
        let apart = turn(self.middle, other.middle);
        let low = f64::min(-self.half, apart - other.half);
        let high = f64::max(self.half, apart + other.half);
        NormalFan {
            middle: self.middle + (low + high) / 2.0,
            half: f64::min((high - low) / 2.0, PI),
            deepest: self.deepest.max(other.deepest),
        }
    }

    /// Whether a point may face one of the segments, which all lie within a circle.
    ///
    /// A point p may face a segment if p lies along a normal of the fan from a point of the circle, in front of this
    /// point or behind it by at most the length h of the longest segment. With the circle's centre c and radius r and
    /// the angle alpha of the fan, let phi be the angle between p - c and the middle of the fan, and sin beta = r/|p -
    /// c|. Then phi is at most alpha + beta, or it is at least pi - alpha - beta with |p - c| cos(phi - alpha) + r >=
    /// -h.
    pub fn may_face(&self, point: [f64; 2], circle: &Circle) -> bool {
        let d = difference(circle.centre, point);
        let distance = length(d);
        let beta = (circle.radius / distance).asin();
        if !(circle.radius < distance && beta.is_finite()) {
            return true;
        }
        let phi = turn(self.middle, d[1].atan2(d[0])).abs();
        let reach = self.half + beta + ANGLE_ROUND_OFF;
        let nearest = (phi - self.half - ANGLE_ROUND_OFF).max(0.0);
        let is_shallow = || distance * nearest.cos() + circle.radius >= -self.deepest;
        phi <= reach || (PI - phi <= reach && is_shallow())
    }
}

/// Angle from one direction to another, between -pi and pi.
fn turn(from: f64, to: f64) -> f64 {
    let turn = (to - from).rem_euclid(TAU);
    if turn > PI { turn - TAU } else { turn }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::contact::Interior;
    use crate::model::{Element, ElementType, Mesh};

    /// Gap of a node at `s` to the roof over the nodes 1, 2, 3 at the heights 0, `top`, 0; the roof belongs to the body
    /// `body`.
    fn gap(top: f64, s: [f64; 2], body: usize) -> Option<f64> {
        let contact = ContactSurfaces::new(vec![0], &[], vec![[1, 2], [2, 3]]);
        let x = [s, [2.0, 0.0], [0.0, top], [-2.0, 0.0]];
        let found = gaps(&contact, &x, &[0, body, body, body], false);
        found.first().map(|found| found.gap)
    }

    #[test]
    fn the_closest_segment_that_the_node_projects_into() {
        assert_eq!(gap(0.0, [1.0, 0.5], 1), Some(0.5));
        assert_eq!(gap(0.0, [-1.0, -0.5], 1), Some(-0.5));
        assert_eq!(gap(0.0, [3.0, 0.5], 1), None);
        assert_eq!(gap(0.0, [1.0, -2.5], 1), None, "too deep");
        assert!(gap(1.0, [0.01, 1.5], 1).is_some_and(|g| g > 0.0));
        assert!(gap(-1.0, [0.01, -1.1], 1).is_some_and(|g| g < 0.0));
    }

    /// Gaps to the top of a plate of two elements with the thickness `t`: of a node at `s` of the same body but of
    /// neither element, and of a node on the lower side of the plate.
    fn own_gaps(t: f64, s: [f64; 2]) -> [Option<f64>; 2] {
        let x = [[2.0, 0.0], [0.0, 0.0], [-2.0, 0.0]];
        let below = x.map(|[x, y]| [x, y - t]);
        let coordinates: Vec<[f64; 2]> = [&[s], &x[..], &below].concat();
        let element = |nodes: [usize; 4]| Element {
            label: 1,
            element_type: ElementType::CPS4,
            nodes: nodes.into(),
            section: 0,
        };
        let mesh = Mesh {
            elements: [[1, 2, 5, 4], [2, 3, 6, 5]].map(element).into(),
            coordinates: coordinates.clone(),
            ..Mesh::default()
        };
        let contact = ContactSurfaces::new(vec![0, 5], &[], vec![[1, 2], [2, 3]])
            .with_interior(Arc::new(Interior::new(&mesh, |_| true)));
        let found = gaps(&contact, &coordinates, &[0; 7], false);
        let of = |slave| found.iter().find(|g| g.slave == slave).map(|g| g.gap);
        [of(0), of(5)]
    }

    #[test]
    fn the_back_of_the_own_body_is_no_contact() {
        for t in [1.0, 1e-2, 1e-4] {
            assert_eq!(own_gaps(t, [1.0, 0.5]), [Some(0.5), None]);
            assert_eq!(own_gaps(t, [1.0, -t / 8.0]), [Some(-t / 8.0), None]);
            assert_eq!(own_gaps(t, [1.0, -1.5 * t]), [None, None]);
        }
    }

    /// Largest number of segments visited per node for a closed outline.
    fn visits_per_node(outline: impl Fn(f64) -> [f64; 2], count: usize) -> f64 {
        let at = |i: usize| outline(i as f64 / count as f64);
        let x: Vec<[f64; 2]> = (0..count).map(at).collect();
        let segments = (0..count).map(|i| [i, (i + 1) % count]).collect();
        let contact = ContactSurfaces::new((0..count).collect(), &[], segments);
        let bodies = vec![0; count];
        let start = Start::new(&contact, &x, &bodies, false);
        let mut visits = 0;
        for &point in &x {
            start.visit_faced(point, |_| {
                visits += 1;
                f64::INFINITY
            });
        }
        visits as f64 / count as f64
    }

    #[test]
    fn nodes_of_one_outline_visit_few_of_its_segments() {
        let square = |t: f64| {
            let (side, along) = ((4.0 * t).floor() as usize, (4.0 * t).fract());
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
            let [a, b] = [corners[side], corners[side + 1]];
            [0, 1].map(|i| a[i] + along * (b[i] - a[i]))
        };
        let disc = |t: f64| {
            [
                (std::f64::consts::TAU * t).cos(),
                (std::f64::consts::TAU * t).sin(),
            ]
        };
        for count in [400, 1600, 6400] {
            let visits = [visits_per_node(square, count), visits_per_node(disc, count)];
            assert!(visits.iter().all(|v| *v < 60.0), "{count}: {visits:?}");
        }
    }

    #[test]
    fn the_tree_finds_what_all_segments_give() {
        let at = |i: usize| {
            let t = 0.7 * i as f64;
            [t.cos() * (1.0 + 0.1 * t), (1.3 * t).sin() * 2.0]
        };
        let x: Vec<[f64; 2]> = (0..60).map(at).collect();
        let segments = (20..59).map(|i| [i, i + 1]).collect();
        let contact = ContactSurfaces::new((0..60).collect(), &[], segments);
        let bodies: Vec<usize> = (0..60).map(|i| usize::from(i > 30)).collect();
        let start = Start::new(&contact, &x, &bodies, false);
        let expected = |slave: usize| {
            let all = (0..39).flat_map(|i| [start.over(slave, i), start.in_wedge(slave, i)]);
            let closest = all
                .flatten()
                .min_by(|a, b| a.partial_cmp(b).expect("finite"));
            closest.map(|(_, i)| (slave, contact.segments[i]))
        };
        let expected: Vec<(usize, [usize; 2])> = (0..60).filter_map(expected).collect();
        let found = gaps(&contact, &x, &bodies, false);
        let found: Vec<(usize, [usize; 2])> = found.iter().map(|g| (g.slave, g.segment)).collect();
        assert_eq!(found, expected);
    }
}
