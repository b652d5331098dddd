//! Selection of contact targets: the segments and convex corners that constrain a slave node, with
//! rules for convex and concave corners and for thin bodies. See docs/theory/geometry.md, Contact targets.

use smallvec::{SmallVec, smallvec};

use super::common_normal::common_normal;
use super::geometry::Along;
use super::projection::{Projection, position_round_off, project, rise};
use super::search::Candidate;
use super::slave_node::SlaveNode;
use super::target::{ContactTarget, ContactTargets, Corner};
use super::tolerances::{
    CLOSED_GAP, CORNER_TIP, CORNER_ZONE, GENTLE_SINE, PROJECTION_BEYOND_ENDS, SLID, SLIDING_SINE,
    STRAIGHT_SINE,
};
use crate::vectors::angle;

/// Segments near a node; usually there are few segments.
type Segments = SmallVec<[usize; 8]>;

/// Selection of the targets of a slave node.
///
/// Near a concave corner a node outside the body is in front of both segments; near a convex corner
/// it is in front of at least one. Every segment that the node faces constrains it, except in a run of segments round
/// convex corners, of which only one constrains it. The node was in front of the segments in its targets at the start
/// of the increment, so the contact never adds energy.
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

    /// Adds the target in a run of segments, and the targets across concave corners near the node.
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

    /// Whether the node still projects on a target of an earlier pass, at most `beyond` segment
    /// lengths beyond its ends. If the node has slid on to the target, the tilt of its force must
    /// still be gentle.
    pub fn is_over(&self, target: &ContactTarget, beyond: f64) -> bool {
        let is_over = target.segments().any(|i| {
            let p = self.project(i);
            (-beyond..=1.0 + beyond).contains(&p.xi) && p.gap >= -p.length
        });
        is_over && (target.from).is_none_or(|i| self.tilts_gently(i, target.segment))
    }

    /// Whether two targets belong to one run of segments round convex corners, so one target is enough.
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

    /// Lists the segments into which the node projects, and both segments at a corner if the node projects into neither
    /// segment.
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

    /// The segments that the node faces, grouped into runs of neighbours with straight or convex corners between
    /// neighbours.
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
        // first the runs with a first segment, then the closed runs around a body
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

    /// The segment of a run that constrains the node: a segment in front of which the node is in the iterate and was at
    /// the start.
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

    /// The segment of a run over which the node lies, if the node has slid there across gentle corners from another
    /// segment over which it was at the start.
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
            // at a vertex round-off may leave a node over neither of the two segments
            let j = over(0.0).or_else(|| over(SLID))?;
            Some(ContactTarget {
                from: Some(i),
                ..ContactTarget::face(j)
            })
        };
        let was_behind = || run.iter().all(|&j| !self.was_in_front(j));
        let came = || was_behind().then(|| self.came_from(run)).flatten();
        // a node that was closed on a corner may be on each of the corner's segments in front of which it was
        let is_left = |target: &&ContactTarget| {
            !(target.segments()).any(|i| is_within(i) && self.was_in_front(i))
        };
        let left = self.closed_on.iter().filter(is_left);
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

    /// Whether the force on a node that has slid from segment i to j stays near the normal of j: its tilt kappa =
    /// (g0_j - g0_i)/s is the slope of the surface between the two segments.
    fn tilts_gently(&self, i: usize, j: usize) -> bool {
        let (start, now) = (self.project_at_start(j), self.project(j));
        let slip = (start.length + now.length) / 2.0 * (now.xi - start.xi);
        let rise = rise(
            (start.gap, start.length),
            self.project_at_start(i).gap,
            self.start_position(),
        );
        rise.abs() <= SLIDING_SINE * slip.abs()
    }

    /// The neighbour of segment `i` round a convex corner near the node, if the surface of the node does not face
    /// segment `i`. Where a corner slides over a corner, only the face that the node's surface faces constrains the
    /// node; behind the other face lies the node's own body. At the start the node must have been over the face of the
    /// neighbour, or near its end with half of one of the node's own faces over this face. So the long line of a punch
    /// does not stop a node beside the punch.
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
            let mut closed_on = self.closed_on.iter().flat_map(ContactTarget::segments);
            let is_faced = self.is_opposite(j) == Some(true)
                || (closed_on.any(|own| own == j)
                    && self.faced_at_start(j) > self.faced_at_start(i) + STRAIGHT_SINE);
            let near = near.min(self.corner_reach(j, &self.project(j)));
            is_faced && self.was_over(j, near) && self.was_in_front(j) && !self.is_own(j)
        };
        before.filter(constrains).or(after.filter(constrains))
    }

    /// The segment before or after a run from which the node has come, round convex corners.
    fn came_from(&self, run: &[usize]) -> Option<usize> {
        let (&first, &last) = (run.first()?, run.last()?);
        let before = || self.walk(first, Along::Backward);
        let after = || self.walk(last, Along::Forward);
        match self.project_at_start(first).xi < 0.5 {
            true => before().or_else(after),
            false => after().or_else(before),
        }
    }

    /// The first segment before or after `from` on which the node projected at the start. The way from `from` to the
    /// returned segment leads round corners that are convex or were so at the start, and is at most twice as long as
    /// the node's displacement.
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
            // a corner that is concave in the iterate was still convex when the node came over it
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

    /// The segments across the concave corners near the node at the ends of segment `i`.
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

    /// The corner at an end of a segment, if the node meets this corner.
    fn corner_target(&self, i: usize) -> Option<ContactTarget> {
        let xi = self.xi(i);
        let before = self.surfaces.previous[i].filter(|_| xi < CORNER_ZONE);
        let after = self.surfaces.next[i].filter(|_| xi > 1.0 - CORNER_ZONE);
        before
            .and_then(|h| self.corner_between(h, i))
            .or_else(|| after.and_then(|j| self.corner_between(i, j)))
    }

    /// The corner between the segments `i` and `j`, if the node meets it as node against node or if it is the vertex of
    /// a face.
    fn corner_between(&self, i: usize, j: usize) -> Option<ContactTarget> {
        let (p, q) = (self.project(i), self.project(j));
        // distance from the corner along the sum of both tangents, which is at most 2 long
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

    /// Weight w of the second segment at a vertex. A vertex belongs to a face, to a gentle hollow, or to a gentle
    /// corner that meets a node in a hollow of the node's own face, as a pin meets a bore. At a vertex the gaps to both
    /// segments are the same; the normal of only one segment would lean to one side, and round-off would choose the
    /// segment. `None` if the gaps differ, if the turn is larger, or if the node was behind one of the segments.
    fn vertex_weight(&self, turn: f64, [(i, p), (j, q)]: [(usize, &Projection); 2]) -> Option<f64> {
        let round_off = position_round_off(self.position());
        let least = (CLOSED_GAP * p.length.min(q.length)).max(round_off);
        let is_vertex = (-GENTLE_SINE..=SLIDING_SINE).contains(&turn)
            && (p.gap - q.gap).abs() <= least
            && [i, j].iter().all(|&i| self.was_in_front(i));
        is_vertex.then_some(0.5)
    }

    /// Whether a target of an earlier pass is the vertex of a hollow that the selection no longer finds: the node has
    /// left the vertex towards one of its segments, and the body lies behind both segments.
    pub fn has_left_hollow(&self, target: &ContactTarget, found: &[ContactTarget]) -> bool {
        let is_hollow = |corner: Corner| {
            let is_same =
                |other: &ContactTarget| other.segment == target.segment && other.corner.is_some();
            self.corner_sine(target.segment, corner.next) < 0.0 && !found.iter().any(is_same)
        };
        target.corner.is_some_and(is_hollow)
    }

    /// Whether a target is a corner with a turn and not the vertex of a face.
    pub fn meets_corner(&self, target: &ContactTarget) -> bool {
        let turns = |corner: Corner| self.corner_sine(target.segment, corner.next) > STRAIGHT_SINE;
        target.corner.is_some_and(turns)
    }
}
