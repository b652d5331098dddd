//! Selection of contact targets: the segments and convex corners that constrain a slave node, with
//! rules for convex and concave corners and for thin bodies. Section 10 of docs/theory.md, Sites.

use super::corner::{Vertex, common_normal};
use super::slave_node::{Look, NEAR, TOUCHING};
use crate::contact::geometry::{ContactSurfaces, project};
use crate::contact::search::Candidate;

/// How far beyond its ends a segment still takes a projection (in its lengths): what round-off and
/// the tolerance of many increments make of a node that sticks at the end of a surface.
pub(crate) const ROUND_OFF: f64 = 1e-6;
/// Sine of the turn at a vertex below which its two segments count as one face.
const STRAIGHT: f64 = 1e-3;
/// Distance sideways from a vertex (in segment lengths) at which a node meets the vertex itself.
const TIP: f64 = 1e-5;

/// What a slave node may not go through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Index of the segment in its contact.
    pub segment: usize,
    /// The vertex at the segment's end b, if it is that which the node meets.
    pub vertex: Option<Vertex>,
}

impl Site {
    fn face(segment: usize) -> Self {
        Site {
            segment,
            vertex: None,
        }
    }

    /// Segments it is made of.
    pub fn segments(&self) -> impl Iterator<Item = usize> + use<> {
        [Some(self.segment), self.vertex.map(|v| v.next)]
            .into_iter()
            .flatten()
    }
}

/// Which sites hold a node.
///
/// The body lies behind each of its segments near a hollow (concave) vertex, and behind one of them
/// near a convex vertex; a node outside is therefore held by all segments that it faces, but only by
/// one of those that follow each other round convex vertices. It was outside at the start, and is
/// held by segments that it was in front of then: such contact never adds energy.
impl Look<'_> {
    /// The sites of the node, with increasing segments; the candidates come with increasing segments
    /// too.
    pub fn sites(&self, candidates: impl Iterator<Item = Candidate>) -> Vec<Site> {
        let faced = self.faced(candidates);
        if faced.is_empty() {
            return Vec::new();
        }
        let mut sites = Vec::new();
        for run in self.runs(&faced) {
            let Some(segment) = self.choose(&run) else {
                continue;
            };
            if self.is_far(segment) {
                sites.push(Site::face(segment));
                continue;
            }
            let segment = self.beside_faced_away(segment).unwrap_or(segment);
            sites.push(self.vertex_site(segment).unwrap_or(Site::face(segment)));
            sites.extend(self.across_hollows(segment).map(Site::face));
        }
        sites.sort_by_key(|site| site.segment);
        sites.dedup_by_key(|site| site.segment);
        sites
    }

    /// Whether the node is not beyond the ends of a site of a pass before by more than `beyond` (in
    /// segment lengths).
    pub fn is_over(&self, site: &Site, beyond: f64) -> bool {
        site.segments().any(|i| {
            let p = self.place(i);
            (-beyond..=1.0 + beyond).contains(&p.xi) && p.gap >= -p.length
        })
    }

    /// Whether two sites belong to one run round convex vertices, so that one is enough.
    pub fn same_face(&self, one: &Site, other: &Site) -> bool {
        one.segments().any(|i| {
            other.segments().any(|j| {
                i == j
                    || (self.surfaces.next[i] == Some(j) && self.turn(i, j) >= 0.0)
                    || (self.surfaces.next[j] == Some(i) && self.turn(j, i) >= 0.0)
            })
        })
    }

    /// Segments into which the node projects, and the two at a vertex where it projects into neither.
    fn faced(&self, candidates: impl Iterator<Item = Candidate>) -> Vec<usize> {
        let mut faced = Vec::new();
        for Candidate { segment: i, reach } in candidates {
            let along = self.along(i);
            if along < -ROUND_OFF || self.is_own(i) {
                continue;
            }
            if along <= 1.0 + ROUND_OFF {
                let p = self.place(i);
                if p.gap.abs() <= reach && (p.gap >= -p.length || self.enters(i)) {
                    faced.push(i);
                }
            } else if let Some(j) = self.surfaces.next[i]
                && self.along(j) < 0.0
                && !self.is_own(j)
            {
                let p = self.place(i);
                // between the segments of a hollow there is nothing but the body
                let near = match self.turn(i, j) < 0.0 {
                    true => reach.min(self.near(i)),
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
        faced
    }

    /// The faced segments in runs round vertices that are not hollow.
    fn runs(&self, faced: &[usize]) -> Vec<Vec<usize>> {
        if faced.len() == 1 {
            return vec![faced.to_vec()];
        }
        let is_faced = |i: &usize| faced.binary_search(i).is_ok();
        let next = |i: usize| {
            let j = self.surfaces.next[i].filter(is_faced)?;
            (self.turn(i, j) >= -STRAIGHT).then_some(j)
        };
        let has_previous = |i: &usize| {
            self.surfaces.previous[*i].is_some_and(|h| next(h) == Some(*i) && is_faced(&h))
        };
        let mut seen = vec![false; faced.len()];
        let mut runs = Vec::new();
        // first the runs with a head, then those all around a body
        let heads = faced.iter().filter(|i| !has_previous(i));
        for &head in heads.chain(faced) {
            let mut run = Vec::new();
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

    /// The segment of a run that holds the node: of those that it was in front of at the start the
    /// one that it is in front of now.
    fn choose(&self, run: &[usize]) -> Option<usize> {
        let gap = |i: usize| self.place(i).gap;
        let mut best: Option<usize> = None;
        for &i in run.iter().filter(|&&i| self.was_in_front(i)) {
            best = match best {
                None => Some(i),
                Some(h) => {
                    let is_hollow = self.surfaces.next[h] == Some(i) && self.turn(h, i) < 0.0;
                    Some(if (gap(i) > gap(h)) != is_hollow { i } else { h })
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

    /// The segment beside one that the surface of the node does not face, round a convex vertex that the
    /// node is near: where a corner slides over a corner, one face of it holds the node and not the
    /// other, behind which the node's own body would lie.
    fn beside_faced_away(&self, i: usize) -> Option<usize> {
        if self.is_opposite(i)? {
            return None;
        }
        let (p, near) = (self.place(i), self.near(i));
        let before = self.surfaces.previous[i]
            .filter(|&h| p.xi * p.length <= near && self.turn(h, i) > STRAIGHT);
        let behind = self.surfaces.next[i]
            .filter(|&j| (1.0 - p.xi) * p.length <= near && self.turn(i, j) > STRAIGHT);
        let holds = |&j: &usize| {
            let start = self.start(j);
            let was_near = (-near..=start.length + near).contains(&(start.xi * start.length));
            was_near && self.was_in_front(j) && !self.is_own(j) && self.is_opposite(j) == Some(true)
        };
        before.filter(holds).or(behind.filter(holds))
    }

    /// The segment before or behind a run from which the node came round convex vertices.
    fn came_from(&self, run: &[usize]) -> Option<usize> {
        let (&first, &last) = (run.first()?, run.last()?);
        let before = || self.walk(first, false);
        let behind = || self.walk(last, true);
        match self.start(first).xi < 0.5 {
            true => before().or_else(behind),
            false => behind().or_else(before),
        }
    }

    /// The first segment before or behind another that the node was over at the start, round convex
    /// vertices and not farther than twice its way.
    fn walk(&self, from: usize, forward: bool) -> Option<usize> {
        let ContactSurfaces { next, previous, .. } = self.surfaces;
        let farthest = 2.0 * self.way(from);
        let (mut i, mut between) = (from, 0.0);
        loop {
            let j = if forward { next[i]? } else { previous[i]? };
            let turn = if forward {
                self.turn(i, j)
            } else {
                self.turn(j, i)
            };
            if j == from || turn < -STRAIGHT || between > farthest {
                return None;
            }
            let is_over = (-NEAR..=1.0 + NEAR).contains(&self.start(j).xi);
            if is_over && self.was_in_front(j) && !self.is_own(j) {
                return Some(j);
            }
            between += self.place(j).length;
            i = j;
        }
    }

    /// The other sides of the hollows at the ends of a segment, where the node is near them.
    fn across_hollows(&self, i: usize) -> impl Iterator<Item = usize> {
        let p = self.place(i);
        let near = self.near(i);
        let at_a = self.surfaces.previous[i].filter(|&h| {
            p.xi * p.length <= near && self.turn(h, i) < -STRAIGHT && self.place(h).xi >= 0.0
        });
        let at_b = self.surfaces.next[i].filter(|&j| {
            let is_near = (1.0 - p.xi) * p.length <= near;
            is_near && self.turn(i, j) < -STRAIGHT && self.place(j).xi <= 1.0
        });
        [at_a, at_b]
            .map(|j| j.filter(|&j| !self.is_own(j) && self.was_in_front(j)))
            .into_iter()
            .flatten()
    }

    /// The vertex at an end of a segment, if the node meets it.
    fn vertex_site(&self, i: usize) -> Option<Site> {
        let xi = self.along(i);
        let before = self.surfaces.previous[i].filter(|_| xi < NEAR);
        let behind = self.surfaces.next[i].filter(|_| xi > 1.0 - NEAR);
        before
            .and_then(|h| self.vertex_between(h, i))
            .or_else(|| behind.and_then(|j| self.vertex_between(i, j)))
    }

    /// The vertex between a segment and the next, if the node meets it: node against node.
    fn vertex_between(&self, i: usize, j: usize) -> Option<Site> {
        let (p, q) = (self.place(i), self.place(j));
        // along the bisector of both tangents, times its length, which is 2 at most
        let aside = (p.xi - 1.0) * p.length + q.xi * q.length;
        let length = p.length.min(q.length);
        if aside.abs() > 2.0 * TIP * length || self.turn(i, j) <= STRAIGHT {
            return None;
        }
        let node = self.surfaces.slaves[self.slave];
        let [before, behind] = self.surfaces.beside[self.slave]?;
        let at = |n: usize| self.now[n];
        let own =
            [[before, node], [node, behind]].map(|[a, b]| project(at(a), at(a), at(b)).normal);
        let vertex = Vertex {
            next: j,
            weight: common_normal([p.normal, q.normal], own)?,
        };
        if vertex.weight == 0.0 {
            return self.was_in_front(i).then(|| Site::face(i));
        }
        if vertex.weight == 1.0 {
            return self.was_in_front(j).then(|| Site::face(j));
        }
        let start_gap = vertex.blend(self.start(i).gap, self.start(j).gap);
        (start_gap >= -TOUCHING * length).then_some(Site {
            segment: i,
            vertex: Some(vertex),
        })
    }
}
