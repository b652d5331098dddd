//! Selection of contact targets: the segments and convex corners that constrain a slave node, with
//! rules for convex and concave corners and for thin bodies. Section 10 of docs/theory.md, Contact targets.
//!
//! Kinematics of a slave node relative to nearby segments, at the start of the increment and at
//! the iterate: the tests by which its contact targets are selected. Section 10 of docs/theory.md, Contact targets.
//!
//! Node-to-node contact: the common normal of a slave node and a convex corner, from the
//! intersection of their normal cones. Section 10 of docs/theory.md, Corner against corner.

use smallvec::{SmallVec, smallvec};

use super::bulge::Bulge;
use super::crossing::{Crossing, CrossingSense, QuadraticMotion, crossings};
use super::geometry::{Along, ContactSurfaces, MasterArc, Positions, Vertex};
use super::keys::ConstraintKey;
use super::lists::{Recycled, entries};
use super::projection::{Projection, project};
use super::search::Candidate;
use super::tolerances::{
    CLOSED_GAP, CONE_MISS, CORNER_TIP, CORNER_ZONE, FACING_SINE, FOLDED_CORNER_SINE, GENTLE_SINE,
    INITIAL_DEPTH, POSITION_ROUND_OFF, PROJECTION_BEYOND_ENDS, SLID, SLIDING_SINE, SOLVED_GAP,
    STRAIGHT_SINE,
};
use crate::linear::largest;
use crate::vectors::{angle, cross, difference, dot, length};

/// What a slave node must not penetrate: a segment, or the corner at its end.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactTarget {
    /// Index of the segment in its contact.
    pub segment: usize,
    /// The corner at the segment's end b, if the node meets the corner.
    pub corner: Option<Corner>,
    /// The segment that held the node at the start, if the node has slid on from there to this one.
    pub from: Option<usize>,
}

impl ContactTarget {
    /// A segment that is met between its ends.
    pub fn face(segment: usize) -> Self {
        ContactTarget {
            segment,
            corner: None,
            from: None,
        }
    }

    /// Takes the weight that the same corner has in another iterate.
    pub fn take_weight(&mut self, other: &ContactTarget) {
        if let (Some(corner), Some(now)) = (&mut self.corner, other.corner)
            && [self.segment, corner.next] == [other.segment, now.next]
        {
            corner.weight = now.weight;
        }
    }

    /// Segments it is made of.
    pub fn segments(&self) -> impl Iterator<Item = usize> + use<> {
        [Some(self.segment), self.corner.map(|v| v.next)]
            .into_iter()
            .flatten()
    }
}

/// A point of a slave face at the line of a master segment.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SurfacePoint {
    /// Ends of the slave face, and ends a and b of the master segment.
    pub vertices: [Vertex; 4],
    /// Place on the slave face, 0 at its first end and 1 at its second.
    pub eta: f64,
    /// How far the slave face is outside of its chord there (length).
    pub rise: f64,
    /// Bulge of the master segment.
    pub bulge: Bulge,
    /// Part of its gap in that of the constraint, w N/c of eq. (3.18).
    pub weight: f64,
    /// Where it was at the start of the increment.
    pub origin: Origin,
}

entries!(SurfacePoint, (usize, SurfacePoint));

impl SurfacePoint {
    /// Nodes whose positions it depends on; some may come twice.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.vertices.into_iter().flat_map(Vertex::nodes)
    }
}

/// The master segment that a point was over at the start of the increment.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Origin {
    /// The same.
    Same,
    /// Another one, with these ends and this bulge.
    Other([Vertex; 2], Bulge),
    /// None: it has come in over the end of the master surface.
    Outside,
}

/// How a disc meets the master.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Round {
    /// Radius of the slave disc (length).
    pub radius: f64,
    /// The arc of the master that the nodes a and b move, or the vertex a, an arc without radius; none of a segment.
    pub arc: Option<MasterArc>,
    /// What the centre was over at the start, where that was something else.
    pub from: Option<Feature>,
}

/// A segment or an arc of the master, by its nodes.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Feature {
    /// Ends of the segment; the nodes p and q of an arc.
    pub nodes: [usize; 2],
    /// The arc; none of a segment.
    pub arc: Option<MasterArc>,
}

impl Feature {
    /// Distance of a point out of the body (length).
    pub(super) fn gap(&self, s: [f64; 2], at: impl Fn(usize) -> [f64; 2]) -> f64 {
        let [a, b] = self.nodes.map(at);
        match self.arc {
            None => project(s, a, b).gap,
            Some(arc) => arc.gap(s, [a, b]),
        }
    }
}

/// A segment with the shape of its face.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Segment {
    /// Its ends a and b.
    pub ends: [usize; 2],
    /// How far the face is outside of the chord.
    pub bulge: Bulge,
}

/// Which slave node meets which segment, or which corner, or what the points of its faces meet.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PairTarget {
    /// Key of their constraint.
    pub key: ConstraintKey,
    /// Segment in its contact, or corner.
    pub target: ContactTarget,
    /// Nodes: slave s, segment ends a and b, and c, the end of the next segment behind a corner;
    /// without corner it is b again.
    pub nodes: [usize; 4],
    /// Bulges of the faces from a to b and from b to c; of points, each has its own.
    pub bulges: [Bulge; 2],
    /// The segment that held the node at the start, where it has slid on from there.
    pub from: Option<Segment>,
    /// Overlap that a fit allows the node at the start of the increment and at its end (length), eq. (3.15).
    pub allowed: [f64; 2],
    /// Points whose gaps are averaged, from surface to surface; none of a node that meets a segment or corner.
    pub points: Recycled<SurfacePoint>,
    /// Whether the slave node is a corner of the contact's master.
    pub is_of_master: bool,
    /// How a disc meets the master, if the slave is the centre of one; its nodes are s, a, b and one that turns with it.
    pub round: Option<Round>,
}

impl PairTarget {
    /// The same target, whatever held the node at the start.
    pub(super) fn untilted(self) -> Self {
        let mut points = self.points;
        for point in points.iter_mut() {
            point.origin = Origin::Same;
        }
        PairTarget {
            from: None,
            points,
            round: self.round.map(|round| Round {
                from: None,
                ..round
            }),
            ..self
        }
    }

    /// The same target in one configuration, with the overlap that is allowed at the start of the increment (0) or at
    /// its end (1).
    pub(super) fn allowing(self, end: usize) -> Self {
        PairTarget {
            allowed: [self.allowed[end]; 2],
            ..self
        }
    }
}

/// The targets of a node, mostly one.
pub type ContactTargets = SmallVec<[ContactTarget; 4]>;

/// Segments near a node, mostly few.
type Segments = SmallVec<[usize; 8]>;

/// Round-off of gaps and slips of a node at `s` (length).
pub fn position_round_off(s: [f64; 2]) -> f64 {
    POSITION_ROUND_OFF * largest(&s)
}

/// Rise g0 - h0 of eq. (7.6): the gap at the start of the segment that a node at `s` has slid on to, above what it
/// counts as, the gap `before` of the segment that the node came from, and no overlap. What is round-off of closed
/// gaps and positions is zero: over the slip of a node that has come back it would tilt the force at random.
pub fn rise(start: &Projection, before: f64, s: [f64; 2]) -> f64 {
    let rise = start.gap - start.gap.min(before).max(0.0);
    let round_off = (SOLVED_GAP * start.length).max(position_round_off(s));
    if rise.abs() <= round_off { 0.0 } else { rise }
}

/// Selection of the targets of a node.
///
/// Near a concave corner a node outside the body is in front of both segments; near a convex corner
/// it is in front of at least one. A node is therefore constrained by every segment that it faces,
/// but by only one of a run of segments round convex corners. These are segments that it was in
/// front of at the start of the increment: such contact never adds energy.
impl SlaveNode<'_> {
    /// The targets of the node in the order of their segments; the candidates must come in this
    /// order.
    pub fn targets(&self, candidates: impl Iterator<Item = Candidate>) -> ContactTargets {
        let mut targets = ContactTargets::new();
        let mut faced = Segments::new();
        self.list_faced(candidates, &mut faced);
        match faced.as_slice() {
            [] => {}
            [_] => self.add_targets(&faced, &mut targets),
            _ => {
                let runs = self.runs(&faced);
                runs.iter()
                    .for_each(|run| self.add_targets(run, &mut targets));
            }
        }
        if targets.len() > 1 {
            targets.sort_by_key(|target| target.segment);
            targets.dedup_by_key(|target| target.segment);
        }
        targets
    }

    /// Adds the target in a run of segments, and those across concave corners near it.
    fn add_targets(&self, run: &[usize], targets: &mut ContactTargets) {
        let (segment, target) = if let Some(target) = self.slid_on(run) {
            (target.segment, target)
        } else {
            let Some(segment) = self.choose(run) else {
                return;
            };
            if self.is_far(segment) {
                targets.push(ContactTarget::face(segment));
                return;
            }
            let segment = self.adjacent_to_faced_away(segment).unwrap_or(segment);
            let corner = self.corner_target(segment);
            (segment, corner.unwrap_or(ContactTarget::face(segment)))
        };
        targets.push(target);
        for across in self.across_concave_corners(segment) {
            targets.push(ContactTarget::face(across));
        }
    }

    /// Whether the node still projects on a target of an earlier pass, beyond its ends by `beyond`
    /// segment lengths at most, and its force, if it has slid on to the target, still tilts gently.
    pub fn is_over(&self, target: &ContactTarget, beyond: f64) -> bool {
        let is_over = target.segments().any(|i| {
            let p = self.project(i);
            (-beyond..=1.0 + beyond).contains(&p.xi) && p.gap >= -p.length
        });
        is_over && (target.from).is_none_or(|i| self.tilts_gently(i, target.segment))
    }

    /// Whether two targets belong to one run of segments round convex corners, of which one is
    /// enough.
    pub fn is_same_face(&self, one: &ContactTarget, other: &ContactTarget) -> bool {
        one.segment == other.segment
            || one.segments().any(|i| {
                other.segments().any(|j| {
                    i == j
                        || (self.surfaces.next[i] == Some(j) && self.corner_sine(i, j) >= 0.0)
                        || (self.surfaces.next[j] == Some(i) && self.corner_sine(j, i) >= 0.0)
                })
            })
    }

    /// Lists the segments into which the node projects, and the two at a corner where it projects into
    /// neither.
    fn list_faced(&self, candidates: impl Iterator<Item = Candidate>, faced: &mut Segments) {
        let s = self.position();
        for Candidate { segment: i, reach } in candidates {
            let xi = self.xi_of(s, i);
            if xi < -PROJECTION_BEYOND_ENDS || self.is_own(i) {
                continue;
            }
            if xi <= 1.0 + PROJECTION_BEYOND_ENDS {
                let p = self.project(i);
                if p.gap.abs() <= reach && (p.gap >= -p.length || self.enters(i)) {
                    faced.push(i);
                }
            } else if let Some(j) = self.surfaces.next[i]
                && self.xi_of(s, j) < 0.0
                && !self.is_own(j)
            {
                let p = self.project(i);
                // the zone between the segments of a concave corner lies in the body
                let near = match self.corner_sine(i, j) < 0.0 {
                    true => reach.min(self.corner_reach(i, &p)),
                    false => reach,
                };
                let beyond = (p.xi - 1.0) * p.length;
                if p.gap >= -p.length && beyond * beyond + p.gap * p.gap <= near * near {
                    faced.extend([i, j]);
                }
            }
        }
        if faced.len() > 1 {
            faced.sort_unstable();
            faced.dedup();
        }
    }

    /// The faced segments as runs of neighbours with straight or convex corners between them.
    fn runs(&self, faced: &[usize]) -> SmallVec<[Segments; 2]> {
        let is_faced = |i: &usize| faced.binary_search(i).is_ok();
        let next = |i: usize| {
            let j = self.surfaces.next[i].filter(is_faced)?;
            (self.corner_sine(i, j) >= -GENTLE_SINE).then_some(j)
        };
        let has_previous = |i: &usize| {
            self.surfaces.previous[*i].is_some_and(|h| next(h) == Some(*i) && is_faced(&h))
        };
        let mut seen: SmallVec<[bool; 8]> = smallvec![false; faced.len()];
        let mut runs = SmallVec::new();
        // first the runs with a head, then those all around a body
        let heads = faced.iter().filter(|i| !has_previous(i));
        for &head in heads.chain(faced) {
            let mut run = Segments::new();
            let mut following = Some(head);
            while let Some(i) = following
                && let Ok(k) = faced.binary_search(&i)
                && !std::mem::replace(&mut seen[k], true)
            {
                run.push(i);
                following = next(i);
            }
            if !run.is_empty() {
                runs.push(run);
            }
        }
        runs
    }

    /// The segment of a run that constrains the node: among those that it was in front of at the
    /// start, one that it is in front of now.
    fn choose(&self, run: &[usize]) -> Option<usize> {
        let gap = |i: usize| self.project(i).gap;
        let mut best: Option<usize> = None;
        for &i in run.iter().filter(|&&i| self.was_in_front(i)) {
            best = match best {
                None => Some(i),
                Some(h) => {
                    let is_concave =
                        self.surfaces.next[h] == Some(i) && self.corner_sine(h, i) < 0.0;
                    Some(if (gap(i) > gap(h)) != is_concave {
                        i
                    } else {
                        h
                    })
                }
            };
        }
        let came_from = || {
            let is_far_side = |&i: &usize| self.was_far_side(i);
            self.came_from(run).filter(|_| !run.iter().all(is_far_side))
        };
        best.or_else(came_from).or_else(|| {
            let nearest = |i: &&usize, j: &&usize| gap(**i).total_cmp(&gap(**j));
            run.iter()
                .copied()
                .filter(|&i| self.was_pushed_in(i))
                .max_by(|i, j| nearest(&i, &j))
        })
    }

    /// The segment of a run that the node is over, if it has slid there, across corners of gentle turn,
    /// from another that it was over at the start.
    fn slid_on(&self, run: &[usize]) -> Option<ContactTarget> {
        let is_within = |i: usize| (-SLID..=1.0 + SLID).contains(&self.xi(i));
        let slid_from = |i: usize| {
            if is_within(i) {
                return None;
            }
            let gap = |j: usize| self.project(j).gap;
            let is_gentle = |j: &usize| self.leads_gently(i, *j) && self.tilts_gently(i, *j);
            let over = |beyond: f64| {
                let is_over = |j: &usize| (-beyond..=1.0 + beyond).contains(&self.xi(*j));
                let over = run.iter().copied().filter(is_over).filter(is_gentle);
                over.min_by(|j, k| gap(*j).total_cmp(&gap(*k)))
            };
            // at a vertex a node may be over neither of its segments by round-off
            let j = over(0.0).or_else(|| over(SLID))?;
            Some(ContactTarget {
                from: Some(i),
                ..ContactTarget::face(j)
            })
        };
        let was_behind = || run.iter().all(|&j| !self.was_in_front(j));
        let came = || was_behind().then(|| self.came_from(run)).flatten();
        // a node that a corner held may be on either of its segments, in front of which it was
        let is_left = |held: &&ContactTarget| {
            !(held.segments()).any(|i| is_within(i) && self.was_in_front(i))
        };
        let left = self.held_by.iter().filter(is_left);
        left.flat_map(ContactTarget::segments)
            .find_map(slid_from)
            .or_else(|| came().and_then(slid_from))
    }

    /// Whether the surface leads from segment i to segment j without a sharp turn, within twice the
    /// displacement of the node.
    fn leads_gently(&self, i: usize, j: usize) -> bool {
        let farthest = 2.0 * self.relative_displacement(j);
        let length = |i: usize| self.project(i).length;
        [Along::Forward, Along::Backward].into_iter().any(|along| {
            let mut at = i;
            for following in self.surfaces.walk(i, along, farthest, length) {
                let Some(next) = following else { return false };
                let turn = match along {
                    Along::Forward => self.corner_sine(at, next),
                    Along::Backward => self.corner_sine(next, at),
                };
                if turn.abs() > SLIDING_SINE {
                    return false;
                }
                if next == j {
                    return true;
                }
                at = next;
            }
            false
        })
    }

    /// Whether the force on a node that has slid from segment i to j stays near the normal of j: the
    /// tilt kappa = (g0_j - g0_i)/s is that of the surface between them.
    fn tilts_gently(&self, i: usize, j: usize) -> bool {
        let (start, now) = (self.project_at_start(j), self.project(j));
        let slip = (start.length + now.length) / 2.0 * (now.xi - start.xi);
        let rise = rise(&start, self.project_at_start(i).gap, self.start_position());
        rise.abs() <= SLIDING_SINE * slip.abs()
    }

    /// The neighbour, round a convex corner near the node, of a segment that the surface of the
    /// node does not face. Where a corner slides over a corner, only the face that the surface of
    /// the node faces constrains it; behind the other the node's own body would lie. At the start the node was over that
    /// face, or near its end with half of a face of its own over it: a long line of a punch holds no node beside the punch.
    fn adjacent_to_faced_away(&self, i: usize) -> Option<usize> {
        if self.is_opposite(i)? {
            return None;
        }
        let p = self.project(i);
        let near = self.corner_reach(i, &p);
        let before = self.surfaces.previous[i]
            .filter(|&h| p.xi * p.length <= near && self.corner_sine(h, i) > STRAIGHT_SINE);
        let after = self.surfaces.next[i]
            .filter(|&j| (1.0 - p.xi) * p.length <= near && self.corner_sine(i, j) > STRAIGHT_SINE);
        let constrains = |&j: &usize| {
            let mut held = self.held_by.iter().flat_map(ContactTarget::segments);
            let is_faced = self.is_opposite(j) == Some(true)
                || (held.any(|held| held == j)
                    && self.faced_at_start(j) > self.faced_at_start(i) + STRAIGHT_SINE);
            let near = near.min(self.corner_reach(j, &self.project(j)));
            is_faced && self.was_over(j, near) && self.was_in_front(j) && !self.is_own(j)
        };
        before.filter(constrains).or(after.filter(constrains))
    }

    /// The segment before or after a run from which the node has come round convex corners.
    fn came_from(&self, run: &[usize]) -> Option<usize> {
        let (&first, &last) = (run.first()?, run.last()?);
        let before = || self.walk(first, Along::Backward);
        let after = || self.walk(last, Along::Forward);
        match self.project_at_start(first).xi < 0.5 {
            true => before().or_else(after),
            false => after().or_else(before),
        }
    }

    /// The first segment before or after another that the node projected on at the start, round
    /// corners that are convex, or were at the start, and within twice its displacement.
    fn walk(&self, from: usize, direction: Along) -> Option<usize> {
        let farthest = 2.0 * self.relative_displacement(from);
        let length = |i: usize| self.project(i).length;
        let mut at = from;
        for following in (self.surfaces).walk(from, direction, farthest, length) {
            let j = following?;
            let [first, second] = match direction {
                Along::Forward => [at, j],
                Along::Backward => [j, at],
            };
            // a corner that has turned concave since was convex when the node came over it
            let turns = [
                self.corner_sine(first, second),
                self.corner_sine_at_start(first, second),
            ];
            if turns.iter().all(|turn| *turn < -GENTLE_SINE) {
                return None;
            }
            let is_over = (-CORNER_ZONE..=1.0 + CORNER_ZONE).contains(&self.project_at_start(j).xi);
            if is_over && self.was_in_front(j) && !self.is_own(j) {
                return Some(j);
            }
            at = j;
        }
        None
    }

    /// The other segments of the concave corners at the ends of a segment that the node is near.
    fn across_concave_corners(&self, i: usize) -> impl Iterator<Item = usize> {
        let is_near = |from_end: &dyn Fn(f64) -> f64| {
            let p = self.project(i);
            from_end(p.xi) * p.length <= self.corner_reach(i, &p)
        };
        let at_a = self.surfaces.previous[i]
            .filter(|&h| self.is_concave(h, i) && is_near(&|xi| xi) && self.project(h).xi >= 0.0);
        let at_b = self.surfaces.next[i].filter(|&j| {
            self.is_concave(i, j) && is_near(&|xi| 1.0 - xi) && self.project(j).xi <= 1.0
        });
        [at_a, at_b]
            .map(|j| j.filter(|&j| !self.is_own(j) && self.was_in_front(j)))
            .into_iter()
            .flatten()
    }

    /// The corner at an end of a segment, if the node meets it.
    fn corner_target(&self, i: usize) -> Option<ContactTarget> {
        let xi = self.xi(i);
        let before = self.surfaces.previous[i].filter(|_| xi < CORNER_ZONE);
        let after = self.surfaces.next[i].filter(|_| xi > 1.0 - CORNER_ZONE);
        before
            .and_then(|h| self.corner_between(h, i))
            .or_else(|| after.and_then(|j| self.corner_between(i, j)))
    }

    /// The corner between a segment and the next, if the node meets it: node against node; or the vertex of a face.
    fn corner_between(&self, i: usize, j: usize) -> Option<ContactTarget> {
        let (p, q) = (self.project(i), self.project(j));
        // distance from the corner along the sum of both tangents, whose length is 2 at most
        let offset = (p.xi - 1.0) * p.length + q.xi * q.length;
        let length = p.length.min(q.length);
        if offset.abs() > 2.0 * CORNER_TIP * length {
            return None;
        }
        let turn = self.corner_sine(i, j);
        let own = self.own_normals();
        let in_hollow = own.is_some_and(|[before, after]| angle(before, after) < -STRAIGHT_SINE);
        let corner = Corner {
            next: j,
            weight: match turn > STRAIGHT_SINE && !in_hollow {
                true => common_normal(
                    self.corner_tangents(self.now, i, j).map(|[x, y]| [y, -x]),
                    own?,
                )?,
                false => self.vertex_weight(turn, [(i, &p), (j, &q)])?,
            },
        };
        if corner.weight == 0.0 {
            return self.was_in_front(i).then(|| ContactTarget::face(i));
        }
        if corner.weight == 1.0 {
            return self.was_in_front(j).then(|| ContactTarget::face(j));
        }
        let start_gap = corner.blend(self.project_at_start(i).gap, self.project_at_start(j).gap);
        (start_gap >= -CLOSED_GAP * length).then_some(ContactTarget {
            segment: i,
            corner: Some(corner),
            from: None,
        })
    }

    /// Normals before and after the slave node on its own surface.
    fn own_normals(&self) -> Option<[[f64; 2]; 2]> {
        let [before, after] = self.surfaces.adjacent[self.slave]?;
        let at = |n: usize| self.now.of(n);
        let [face, next] = self.surfaces.own_bulges[self.slave];
        let node = at(self.node());
        let before = face.tangent(&project(node, at(before), node), 1.0);
        let after = next.tangent(&project(node, node, at(after)), 0.0);
        Some([before, after].map(|[x, y]| [y, -x]))
    }

    /// Weight w of the second segment at a vertex: of a face, of a gentle hollow, or of a gentle corner that meets a node in a
    /// hollow of its own face, as a pin meets a bore. The gaps to both segments are the same there. The normal of one segment
    /// would lean to its side, and round-off would choose the segment. None where the gaps differ, where the turn is larger,
    /// and where the node was behind one of the segments.
    fn vertex_weight(&self, turn: f64, [(i, p), (j, q)]: [(usize, &Projection); 2]) -> Option<f64> {
        let round_off = position_round_off(self.position());
        let least = (CLOSED_GAP * p.length.min(q.length)).max(round_off);
        let is_vertex = (-GENTLE_SINE..=SLIDING_SINE).contains(&turn)
            && (p.gap - q.gap).abs() <= least
            && [i, j].iter().all(|&i| self.was_in_front(i));
        is_vertex.then_some(0.5)
    }

    /// Whether a target of an earlier pass is the vertex of a hollow, and not found any more: the node has left it towards one
    /// of its segments, and the body lies behind both.
    pub fn has_left_hollow(&self, target: &ContactTarget, found: &[ContactTarget]) -> bool {
        let is_hollow = |corner: Corner| {
            let is_same =
                |other: &ContactTarget| other.segment == target.segment && other.corner.is_some();
            self.corner_sine(target.segment, corner.next) < 0.0 && !found.iter().any(is_same)
        };
        target.corner.is_some_and(is_hollow)
    }

    /// Whether a target is a corner that turns, and no vertex of a face.
    pub fn meets_corner(&self, target: &ContactTarget) -> bool {
        let turns = |corner: Corner| self.corner_sine(target.segment, corner.next) > STRAIGHT_SINE;
        target.corner.is_some_and(turns)
    }
}

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
    pub held_by: &'a [ContactTarget],
    /// Overlap that a fit allows it at the start and in the iterate (length): what its gaps are larger by, eq. (3.15).
    pub allowed: [f64; 2],
}

impl SlaveNode<'_> {
    /// Whether the node enters the body through the segment on its straight path.
    pub(crate) fn enters(&self, segment: usize) -> bool {
        let [a, b] = self.surfaces.segments[segment];
        let motions = [self.node(), a, b]
            .map(|node| QuadraticMotion::straight(self.start.of(node), self.now.of(node)));
        let motions = raised(motions, (&self.surfaces.bulges[segment], self.allowed));
        let is_entering = |c: &Crossing| c.direction == CrossingSense::Entering;
        crossings(&motions, 1.0).iter().any(is_entering)
    }

    /// Whether the node is so far in front of a segment that the neighbours of the segment do not
    /// matter.
    pub(crate) fn is_far(&self, segment: usize) -> bool {
        let p = self.project(segment);
        p.gap > p.length && p.gap > 2.0 * self.displacement_at(segment, &p)
    }

    /// Whether the node's own surface faces the segment: it lies in front of the parallel to the
    /// segment through the node. None for a node without neighbours.
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

    /// Least sine by which a neighbour of the node was in front of the parallel to a segment through the node at the start:
    /// more for the segment that its surface faced better.
    fn faced_at_start(&self, segment: usize) -> f64 {
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

    /// Whether the node started with a small penetration that the mesh may have.
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

    /// Whether the node belongs to the body behind the segment: it is on the far side of a thin
    /// body.
    pub(crate) fn was_far_side(&self, segment: usize) -> bool {
        let (surfaces, start) = (self.surfaces, |node: usize| self.start.of(node));
        let node = self.node();
        (surfaces.interior).joins(surfaces.segments[segment], node, start)
    }

    /// Whether the node is an end of the segment, or the same vertex as one.
    pub(crate) fn is_own(&self, segment: usize) -> bool {
        self.surfaces.is_end(self.node(), segment)
    }

    /// Distance from the end of a segment with the projection `p` within which the other segment of a
    /// concave corner counts (length).
    pub(crate) fn corner_reach(&self, segment: usize, p: &Projection) -> f64 {
        CORNER_ZONE * p.length + 2.0 * self.displacement_at(segment, p)
    }

    /// Whether the node was over a segment at the start, or near its end (length) with half of a face of its own over it.
    fn was_over(&self, segment: usize, near: f64) -> bool {
        let [a, b] = self.surfaces.segments[segment].map(|n| self.start.of(n));
        let is_over =
            |s: [f64; 2], reach: f64| (-reach..=1.0 + reach).contains(&project(s, a, b).xi);
        let node = self.start_position();
        let middle = |n: usize| {
            let [x, y] = self.start.of(n);
            [f64::midpoint(node[0], x), f64::midpoint(node[1], y)]
        };
        let mut adjacent = self.surfaces.adjacent[self.slave].into_iter().flatten();
        // but for round-off: nodes of matching meshes are at the ends
        is_over(node, CLOSED_GAP)
            || (is_over(node, near / length(difference(a, b)))
                && adjacent.any(|n| is_over(middle(n), CLOSED_GAP)))
    }

    /// Displacement of the node relative to a segment since the start (length).
    pub(crate) fn relative_displacement(&self, segment: usize) -> f64 {
        self.displacement_at(segment, &self.project(segment))
    }

    /// Displacement relative to the projection `p` on a segment (length).
    fn displacement_at(&self, segment: usize, p: &Projection) -> f64 {
        let [a, b] = self.surfaces.segments[segment];
        let xi = p.xi.clamp(0.0, 1.0);
        let [s, a, b] = [self.node(), a, b].map(|n| difference(self.start.of(n), self.now.of(n)));
        let relative = |i: usize| s[i] - (1.0 - xi) * a[i] - xi * b[i];
        (relative(0).powi(2) + relative(1).powi(2)).sqrt()
    }

    /// Sine of the turn to the left from one segment to the next: positive at a convex corner,
    /// negative at a concave one; 1 or -1 beyond a right angle.
    pub(crate) fn corner_sine(&self, i: usize, j: usize) -> f64 {
        self.corner_sine_at(self.now, i, j)
    }

    /// The same at the start.
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

    /// Unit tangents of the faces of a segment and of the next where they meet.
    fn corner_tangents(&self, at: Positions, i: usize, j: usize) -> [[f64; 2]; 2] {
        [(i, 1.0), (j, 0.0)].map(|(i, end)| {
            let [a, b] = self.surfaces.segments[i].map(|n| at.of(n));
            self.surfaces.bulges[i].tangent(&project(a, a, b), end)
        })
    }

    /// Whether there is a concave corner between two segments that is not of gentle turn.
    pub(crate) fn is_concave(&self, i: usize, j: usize) -> bool {
        if [i, j].iter().any(|&i| !self.surfaces.bulges[i].is_flat()) {
            return self.corner_sine(i, j) < -GENTLE_SINE;
        }
        let [e, f] = [i, j].map(|i| {
            let [a, b] = self.surfaces.segments[i].map(|n| self.now.of(n));
            difference(a, b)
        });
        // |sin| <= |tan|: mostly there is no need for the sine
        let has_gentle_tangent = cross(e, f) > -0.5 * GENTLE_SINE * dot(e, f);
        !(has_gentle_tangent && dot(e, f) > 0.0) && self.corner_sine(i, j) < -GENTLE_SINE
    }

    /// Coordinate xi of the projection on a segment in the iterate.
    #[inline]
    pub(crate) fn xi(&self, segment: usize) -> f64 {
        self.xi_of(self.position(), segment)
    }

    /// The same with the position of the node.
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

    #[inline]
    fn node(&self) -> usize {
        self.surfaces.slaves[self.slave]
    }
}

/// Motions of a node and of the ends of a segment, the node being raised along the normal by the overlap that a fit
/// allows it at both ends of the path, and lowered by the bulge of the face (length): where it crosses the segment so, it crosses
/// the face.
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

/// A convex corner or the vertex of a face, between a segment and the next, as the target of a slave node.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Corner {
    /// The segment after the corner.
    pub next: usize,
    /// Weight of its normal, between 0 and 1; that of the segment before the corner is 1 - weight.
    pub weight: f64,
}

impl Corner {
    /// The sum of two quantities with the weights of the corner.
    pub fn blend(&self, before: f64, after: f64) -> f64 {
        (1.0 - self.weight) * before + self.weight * after
    }
}

/// Weight of the second normal in the normal of node against node.
///
/// `normals` are those of the segments before and after a convex corner, `own` those before and
/// after the slave node on its own surface. A normal that separates the two corners lies in the
/// normal cone between `normals` and in the cone between the opposites of `own`; the common normal
/// is the middle of their intersection. Flush blocks meet with the normal of their faces. Two corners meet
/// with the normal between their bisectors. A node in a concave corner has no common normal.
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
                held_by: &[],
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

#[cfg(test)]
mod corner_tests {
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
