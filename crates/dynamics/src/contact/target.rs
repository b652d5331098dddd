//! Targets of slave nodes: the part of the master that is selected for a node, from which a constraint of each kind is
//! made. See docs/theory/contact.md and docs/theory/geometry.md.
//!
//! Constraints of each kind are made in a file of their own; the module `kinds` chooses among them.

use smallvec::SmallVec;

use super::arcs::MasterArc;
use super::bulge::Bulge;
use super::keys::{ConstraintKey, NodeAtSegment};
use super::lists::{Recycled, entries};
use super::projection::project;
use super::slave_segments::Vertex;

/// A slave node and its target, from which a constraint is made.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PairTarget {
    /// The slave node, with the data that all kinds share.
    pub pair: Pair,
    /// Part of the master that the slave node must not penetrate.
    pub target: Target,
}

/// Data that the pairs of all kinds share.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pair {
    /// Key of the constraint.
    pub key: ConstraintKey,
    /// The slave node that names the constraint.
    pub slave: usize,
    /// Overlap that a fit allows the node at the start of the increment and at its end (length), eq. (3.15).
    pub allowed: [f64; 2],
    /// Whether the slave node is a corner of the contact's master.
    pub is_of_master: bool,
}

/// Part of the master that a slave node must not penetrate.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Target {
    /// A segment of the master.
    Segment(SegmentContact),
    /// A corner of the master, or the vertex of a face.
    Corner(CornerContact),
    /// Segments of the master under points of slave faces, whose mean gap must not become negative.
    Mean(MeanContact),
    /// A segment, an arc or a vertex of the master, for a slave node that is the centre of a disc.
    Disc(DiscContact),
}

/// A segment with the shape of its face.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Segment {
    /// Number of the segment in its contact.
    pub number: usize,
    /// Ends a and b of the segment.
    pub ends: [usize; 2],
    /// Bulge of the face over the chord.
    pub bulge: Bulge,
}

/// A segment that a slave node must not penetrate.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SegmentContact {
    /// The segment.
    pub segment: Segment,
    /// The segment on which the node was closed at the start, if the node has slid on from there to this segment.
    pub from: Option<Segment>,
}

/// A corner of the master, or the vertex of a face, that a slave node must not penetrate.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CornerContact {
    /// The segment from a to the corner b.
    pub before: Segment,
    /// The segment from the corner b to c.
    pub behind: Segment,
    /// Weight of the normal of the segment behind, between 0 and 1; the segment before has the weight 1 - weight.
    pub weight: f64,
}

/// Points of slave faces whose mean gap must not become negative, and the segments of the master under them.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MeanContact {
    /// Ends a and b of the segment under the point with the largest hat function; messages name this segment.
    pub nearest: [usize; 2],
    /// The points.
    pub points: Recycled<SurfacePoint>,
}

/// A point of a slave face at the line of a master segment.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SurfacePoint {
    /// Ends of the slave face, and ends a and b of the master segment.
    pub vertices: [Vertex; 4],
    /// Place on the slave face, 0 at its first end and 1 at its second.
    pub eta: f64,
    /// Bulge of the slave face at the place of the point (length).
    pub rise: f64,
    /// Bulge of the master segment under the point.
    pub bulge: Bulge,
    /// Part of the gap of the point in the gap of the constraint, w N/c of eq. (3.18).
    pub weight: f64,
    /// Segment of the point at the start of the increment.
    pub from: StartSegment,
}

entries!(SurfacePoint, (usize, SurfacePoint));

/// The master segment under a point at the start of the increment.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum StartSegment {
    /// The point was over the same segment as at the end.
    Same,
    /// The point was over another segment, with the given ends and bulge.
    Other([Vertex; 2], Bulge),
    /// The point was over no segment: it has come in over the end of the master surface.
    Outside,
}

/// A segment, an arc or a vertex of the master that a disc must not penetrate.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DiscContact {
    /// Radius of the slave disc (length).
    pub radius: f64,
    /// The node that turns with the disc about its centre.
    pub arm: usize,
    /// Number of the segment, or of one segment at the arc or vertex.
    pub segment: usize,
    /// The segment, arc or vertex under the centre of the disc.
    pub feature: MasterFeature,
    /// The segment, arc or vertex under the centre at the start, if it was another feature.
    pub from: Option<MasterFeature>,
}

/// A segment or an arc of the master, by its nodes.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MasterFeature {
    /// Ends a and b of the segment; the nodes p and q that move the arc.
    pub nodes: [usize; 2],
    /// The arc, or the vertex p as an arc of radius 0; `None` for a segment.
    pub arc: Option<MasterArc>,
}

impl Pair {
    /// The same pair in one configuration, the start of the increment (0) or its end (1), with the overlap that is
    /// allowed then.
    fn in_one(self, configuration: usize) -> Self {
        Pair {
            allowed: [self.allowed[configuration]; 2],
            ..self
        }
    }
}

impl PairTarget {
    /// The pair at the start of the increment, with the target on which the slave node was closed there.
    pub(super) fn at_start(self) -> Self {
        PairTarget {
            pair: self.pair.in_one(0),
            target: self.target.at_start(),
        }
    }

    /// The pair at the end of the increment, as if it had been closed on its target since the
    /// start.
    pub(super) fn at_end(self) -> Self {
        PairTarget {
            pair: self.pair.in_one(1),
            target: self.target.untilted(),
        }
    }

    /// The slave node and its segment, which messages name; at a corner this is the segment before the corner.
    pub(super) fn named(&self) -> NodeAtSegment {
        self.at_ends(self.target.ends())
    }

    /// The slave node at the segment with the given ends.
    pub(super) fn at_ends(&self, [a, b]: [usize; 2]) -> NodeAtSegment {
        NodeAtSegment {
            key: self.pair.key,
            nodes: [self.pair.slave, a, b],
        }
    }

    /// Whether the condition is true for any of the nodes.
    pub fn any_node(&self, holds: impl Fn(usize) -> bool) -> bool {
        let named = self.named().nodes;
        named.into_iter().any(&holds)
            || match &self.target {
                Target::Segment(_) => false,
                Target::Corner(corner) => holds(corner.behind.ends[1]),
                Target::Mean(mean) => mean.points.iter().flat_map(SurfacePoint::nodes).any(holds),
                Target::Disc(disc) => holds(disc.arm),
            }
    }

    /// The slave node and the node of the corner of the master that it meets, if any.
    pub(super) fn at_corner(&self) -> Option<[usize; 2]> {
        match &self.target {
            Target::Corner(corner) => Some([self.pair.slave, corner.tip()]),
            Target::Segment(_) | Target::Mean(_) | Target::Disc(_) => None,
        }
    }
}

impl Target {
    /// The same target without the target on which the slave node was closed at the start.
    pub(super) fn untilted(self) -> Self {
        match self {
            Target::Segment(contact) => Target::Segment(SegmentContact::new(contact.segment)),
            Target::Corner(corner) => Target::Corner(corner),
            Target::Mean(mean) => Target::Mean(mean.untilted()),
            Target::Disc(disc) => Target::Disc(DiscContact { from: None, ..disc }),
        }
    }

    /// The target on which the slave node was closed at the start.
    fn at_start(self) -> Self {
        match self {
            // the number of the segment stays, since the key of the constraint contains it
            Target::Segment(SegmentContact { segment, from }) => {
                Target::Segment(SegmentContact::new(Segment {
                    number: segment.number,
                    ..from.unwrap_or(segment)
                }))
            }
            Target::Corner(corner) => Target::Corner(corner),
            Target::Mean(mean) => Target::Mean(mean.at_start()),
            Target::Disc(disc) => Target::Disc(DiscContact {
                feature: disc.from.unwrap_or(disc.feature),
                from: None,
                ..disc
            }),
        }
    }

    /// Ends of the segment of the target: at a corner the segment before the corner, for a mean gap the segment that
    /// counts most, for a disc the nodes of the segment or arc.
    fn ends(&self) -> [usize; 2] {
        match self {
            Target::Segment(contact) => contact.segment.ends,
            Target::Corner(corner) => corner.before.ends,
            Target::Mean(mean) => mean.nearest,
            Target::Disc(disc) => disc.feature.nodes,
        }
    }

    /// Numbers of the segments out of which the slave node is kept; empty for a mean gap, which keeps out no single
    /// node.
    pub(super) fn segments(&self) -> impl Iterator<Item = usize> {
        let numbers = match self {
            Target::Segment(contact) => [Some(contact.segment.number), None],
            Target::Corner(corner) => [corner.before, corner.behind].map(|s| Some(s.number)),
            Target::Mean(_) => [None; 2],
            Target::Disc(disc) => [Some(disc.segment), None],
        };
        numbers.into_iter().flatten()
    }

    /// The target as it was selected for the node; `None` for mean gaps and discs, whose targets do not depend on the
    /// last pass.
    pub(super) fn selected(&self) -> Option<ContactTarget> {
        match self {
            Target::Segment(SegmentContact { segment, from }) => Some(ContactTarget {
                from: from.map(|from| from.number),
                ..ContactTarget::face(segment.number)
            }),
            Target::Corner(corner) => Some(ContactTarget {
                corner: Some(corner.corner()),
                ..ContactTarget::face(corner.before.number)
            }),
            Target::Mean(_) | Target::Disc(_) => None,
        }
    }

    /// The mean gap, if the target has one (surface to surface).
    pub(super) fn mean(&self) -> Option<&MeanContact> {
        match self {
            Target::Mean(mean) => Some(mean),
            Target::Segment(_) | Target::Corner(_) | Target::Disc(_) => None,
        }
    }
}

impl SegmentContact {
    /// A segment on which the node has been closed since the start.
    pub fn new(segment: Segment) -> Self {
        SegmentContact {
            segment,
            from: None,
        }
    }
}

impl CornerContact {
    /// The node at the corner.
    pub(super) fn tip(&self) -> usize {
        self.before.ends[1]
    }

    /// The corner in the form in which the selection returns it.
    pub(super) fn corner(&self) -> Corner {
        Corner {
            next: self.behind.number,
            weight: self.weight,
        }
    }

    /// The segment whose normal has the larger weight.
    pub(super) fn nearer(&self) -> &Segment {
        match self.weight > 0.5 {
            true => &self.behind,
            false => &self.before,
        }
    }
}

impl MeanContact {
    /// Whether one of the points depends on the position of a node.
    pub(super) fn has(&self, node: usize) -> bool {
        let mut nodes = self.points.iter().flat_map(SurfacePoint::nodes);
        nodes.any(|other| other == node)
    }

    /// The same points as if each had been over its present segment at the start.
    pub(super) fn untilted(mut self) -> Self {
        for point in self.points.iter_mut() {
            point.from = StartSegment::Same;
        }
        self
    }

    /// The points at the start of the increment, without those that have come in later.
    fn at_start(mut self) -> Self {
        let is_inside = |q: &SurfacePoint| q.from != StartSegment::Outside;
        if self.points.iter().any(is_inside) {
            self.points.retain(is_inside);
        }
        for point in self.points.iter_mut() {
            if let StartSegment::Other([a, b], bulge) = point.from {
                (point.vertices[2], point.vertices[3], point.bulge) = (a, b, bulge);
            }
        }
        let sum: f64 = self.points.iter().map(|q| q.weight).sum();
        self.points.iter_mut().for_each(|q| q.weight /= sum);
        self.untilted()
    }
}

impl SurfacePoint {
    /// Nodes on whose positions the feature depends; a node may come twice.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.vertices.into_iter().flat_map(Vertex::nodes)
    }
}

impl MasterFeature {
    /// Distance of a point from the body of the feature (length).
    pub(super) fn gap(&self, s: [f64; 2], at: impl Fn(usize) -> [f64; 2]) -> f64 {
        let [a, b] = self.nodes.map(at);
        match self.arc {
            None => project(s, a, b).gap,
            Some(arc) => arc.gap(s, [a, b]),
        }
    }
}

/// Part of the master that a slave node must not penetrate: a segment, or the corner at its end.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactTarget {
    /// Index of the segment in its contact.
    pub segment: usize,
    /// The corner at the segment's end b, if the node meets the corner.
    pub corner: Option<Corner>,
    /// The segment on which the node was closed at the start, if the node has slid on from there to this segment.
    pub from: Option<usize>,
}

impl ContactTarget {
    /// The target of a node that meets a segment between its ends.
    pub fn face(segment: usize) -> Self {
        ContactTarget {
            segment,
            corner: None,
            from: None,
        }
    }

    /// Sets the weight to the weight that the same corner has in another iterate.
    pub fn take_weight(&mut self, other: &ContactTarget) {
        if let (Some(corner), Some(now)) = (&mut self.corner, other.corner)
            && [self.segment, corner.next] == [other.segment, now.next]
        {
            corner.weight = now.weight;
        }
    }

    /// Segments of the target: one segment, or at a corner both segments.
    pub fn segments(&self) -> impl Iterator<Item = usize> + use<> {
        [Some(self.segment), self.corner.map(|v| v.next)]
            .into_iter()
            .flatten()
    }
}

/// A convex corner or the vertex of a face, between a segment and the next, as the target of a slave node.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Corner {
    /// The segment that starts at the corner.
    pub next: usize,
    /// Weight of the normal of the segment after the corner, between 0 and 1; the segment before
    /// the corner has the weight 1 - weight.
    pub weight: f64,
}

impl Corner {
    /// The sum of two quantities of the segments before and after, with the weights of the corner.
    pub fn blend(&self, before: f64, after: f64) -> f64 {
        (1.0 - self.weight) * before + self.weight * after
    }
}

/// The targets of a node; usually there is one target.
pub type ContactTargets = SmallVec<[ContactTarget; 4]>;
