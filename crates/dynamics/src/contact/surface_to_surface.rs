//! Constraints from surface to surface: a slave node has one for each side, whose gap is a weighted mean of the gaps of
//! points inside the slave faces. See docs/theory/geometry.md, From surface to surface.
//!
//! A point moves like a node: x_q = (1 - eta) x_1 + eta x_2 with constant eta is linear in the positions of the nodes,
//! so the point has the rows and the stiffness of a node on a segment.

use std::array::from_fn;

use nalgebra::{DMatrix, DVector, Matrix6, SMatrix, Vector6};
use smallvec::SmallVec;

use super::bulge::Bulge;
use super::constraint::sum_of;
use super::constraint::{Configurations, Constraint, RowForm, Rows};
use super::geometry::ContactSurfaces;
use super::keys::ConstraintKey;
use super::lists::{PerDof, Recycled};
use super::node_to_segment::{SegmentRows, couple, rows_between};
use super::positions::Positions;
use super::projection::{Projection, between, project};
use super::search::{Cells, Faced, FacedRun, Territory};
use super::slave_segments::{Edge, SlaveSegments, Vertex};
use super::stiffness::{changes_between, changes_of_face};
use super::target::{MeanContact, Pair, PairTarget, StartSegment, SurfacePoint, Target};
use super::tolerances::{
    CLOSED_GAP, FACING_COSINE, LEAST_CELL, LEAST_COVER, NEARER_DEPTH, POINT_TILT, SIDE_BY_SIDE,
    SLIVER, STRAIGHT_SINE,
};
use crate::vectors::{cross, difference, dot, length};

/// The points of one side of a slave node over one run of the master.
struct Mean {
    run: usize,
    /// Segment of the point with the largest hat function, and the value of the hat function there.
    nearest: (usize, f64),
    covered: f64,
    points: Recycled<SurfacePoint>,
}

/// Adds the pairs of all slave nodes of a contact between start and iterate: one constraint for each side of a node
/// over each run of master segments that covers this side.
///
/// ```text
/// g_j = (1/c_j) sum_q w_q N_j(eta_q) g_q,   c_j = sum_q w_q N_j(eta_q)    eq. (3.18)
/// ```
///
/// A cell has two Gauss points where N_j g_q is quadratic, or cubic with the radius. The weight w_q is then half the
/// reference length of the cell, times the radius of the point in bodies of revolution. Cells end on the bisectors of
/// the master's vertices in the iterate. With discrete gradients the cells also end on the bisectors at the start,
/// since rows are exact differences between the two configurations.
pub(super) fn find_points(
    territory: &Territory,
    positions: [Positions; 2],
    form: RowForm,
    pairs: &mut Vec<PairTarget>,
) {
    let surfaces = territory.surfaces();
    let Some(slave) = &surfaces.slave_segments else {
        return;
    };
    let [start, now] = positions.map(|positions| slave.edges(positions));
    let place = positions[0];
    let of_faces = territory.with_faced(
        start,
        |start| Finder::new(territory, slave, start, place).all_faced(),
        |start, faced| {
            let finder = Finder::new(territory, slave, start, place);
            PointsOfFaces::new(&finder, faced, &now, form)
        },
    );
    for (number, (&node, sides)) in surfaces.slaves.iter().zip(&slave.at_nodes).enumerate() {
        let key = territory.key().plus(number);
        let mut of_sides: SmallVec<[SmallVec<[Mean; 2]>; 2]> = (sides.iter())
            .map(|faces| of_faces.means(slave, faces, place))
            .collect();
        leave_out_slivers(&mut of_sides, slave, place);
        for (side, means) in of_sides.into_iter().enumerate() {
            for mut mean in means {
                mean.points
                    .iter_mut()
                    .for_each(|q| q.weight /= mean.covered);
                let pair = Pair {
                    key: ConstraintKey {
                        slave: key,
                        segment: side * surfaces.segments.len() + mean.run,
                    },
                    slave: node,
                    allowed: territory.allowed(number),
                    is_of_master: false,
                };
                let target = Target::Mean(MeanContact {
                    nearest: surfaces.segments[mean.nearest.0],
                    points: mean.points,
                });
                pairs.push(PairTarget { pair, target });
            }
        }
    }
}

/// Gauss points of a cell of length h as (sign, k, share): the place is sign h/sqrt(k) from the middle, the weight is
/// share h. Two points are enough where gap times hat function, in rings also times radius, is at most a cubic; three
/// for the degrees four and five.
fn gauss_points<'b>(
    mut bulges: impl Iterator<Item = &'b Bulge>,
    are_rings: bool,
) -> &'static [(f64, f64, f64)] {
    const TWO: [(f64, f64, f64); 2] = [(-1.0, 12.0, 0.5), (1.0, 12.0, 0.5)];
    const THREE: [(f64, f64, f64); 3] = [
        (-1.0, 20.0 / 3.0, 5.0 / 18.0),
        (0.0, 1.0, 8.0 / 18.0),
        (1.0, 20.0 / 3.0, 5.0 / 18.0),
    ];
    let needs_three = |bulge: &Bulge| !bulge.is_flat() && (bulge.is_cubic() || are_rings);
    match bulges.any(needs_three) {
        true => &THREE,
        false => &TWO,
    }
}

/// Removes mean gaps of a slave node that cover only a sliver beyond a convex vertex: their weight c_j is below 1e-2 of
/// the largest weight of the node.
///
/// At a vertex of the master both ends of the segment of a sliver are behind the line of the segment whose mean gap has
/// the largest weight. At a vertex of the slave the face of a sliver leads away from the segment with the largest
/// weight. The gap of a sliver is the gap of the node alone; the mean gap with the largest weight already keeps the
/// faces apart there.
fn leave_out_slivers(
    of_sides: &mut [SmallVec<[Mean; 2]>],
    slave: &SlaveSegments,
    positions: Positions,
) {
    let all = || of_sides.iter().flatten();
    let Some(largest) = all().max_by(|m, n| m.covered.total_cmp(&n.covered)) else {
        return;
    };
    let least = SLIVER * largest.covered;
    if all().all(|mean| mean.covered >= least) {
        return;
    }
    let at = |vertex: Vertex| vertex.place(|node| positions.of(node));
    let [a, b] = slave.segment(largest.nearest.0).map(at);
    let gap = |x: [f64; 2]| project(x, a, b).gap;
    let is_beyond = |point: &SurfacePoint| {
        let [x1, x2, c, d] = point.vertices.map(at);
        if [c, d] == [a, b] {
            // from the end of the face at the node to the other end
            let ends = if point.eta < 0.5 { [x1, x2] } else { [x2, x1] };
            let [near, far] = ends.map(gap);
            return far >= near;
        }
        let round = STRAIGHT_SINE * length(difference(c, d));
        [c, d].map(gap).iter().all(|gap| *gap <= round)
    };
    for means in of_sides {
        means.retain(|mean| mean.covered >= least || !mean.points.iter().all(is_beyond));
    }
}

/// The points of all slave faces, each with its segment and its weight w_q (length).
struct PointsOfFaces {
    points: Recycled<(usize, SurfacePoint)>,
    /// Start of the points of every face, and the number of all points.
    starts: Recycled<usize>,
}

impl PointsOfFaces {
    /// Points of the slave faces for the runs that they face at the start; `now` are the edges in the iterate.
    fn new(finder: &Finder, faced: &[FacedRun], now: &[Edge], form: RowForm) -> Self {
        let faces = finder.slave.ends.len();
        let mut all = PointsOfFaces {
            points: Recycled::with_room(),
            starts: Recycled::with_room(),
        };
        // room for the points of later increments too
        all.points.reserve(16 * faced.len());
        let mut faced = faced.iter().peekable();
        for face in 0..faces {
            all.starts.push(all.points.len());
            while let Some(run) = faced.next_if(|run| run.face == face) {
                finder.add_points(run, now, form, &mut all.points);
            }
        }
        all.starts.push(all.points.len());
        all
    }

    fn of(&self, face: usize) -> &[(usize, SurfacePoint)] {
        &self.points[self.starts[face]..self.starts[face + 1]]
    }

    /// The mean gaps of one side of a slave node, whose `faces` are given, with increasing runs.
    fn means(
        &self,
        slave: &SlaveSegments,
        faces: &[[usize; 2]],
        positions: Positions,
    ) -> SmallVec<[Mean; 2]> {
        let mut means: SmallVec<[Mean; 2]> = SmallVec::new();
        if faces.iter().all(|&[face, _]| self.of(face).is_empty()) {
            return means;
        }
        let mut whole = 0.0;
        for &[face, end] in faces {
            whole += slave.reference_weight(face, positions, 0.5, 0.5);
            for (segment, point) in self.of(face) {
                let hat = if end == 0 { 1.0 - point.eta } else { point.eta };
                let run = slave.runs[*segment];
                let weight = point.weight * hat;
                let place = means.iter().position(|mean| mean.run == run);
                let place = place.unwrap_or_else(|| {
                    means.push(Mean {
                        run,
                        nearest: (*segment, 0.0),
                        covered: 0.0,
                        points: Recycled::with_room(),
                    });
                    means.len() - 1
                });
                let mean = &mut means[place];
                mean.covered += weight;
                if hat > mean.nearest.1 {
                    mean.nearest = (*segment, hat);
                }
                mean.points.push(SurfacePoint { weight, ..*point });
            }
        }
        means.retain(|mean| mean.covered > LEAST_COVER * whole);
        means.sort_by_key(|mean| mean.run);
        means
    }
}

/// Finds the segments that slave faces face at the start of an increment, and the points of the
/// faces.
struct Finder<'a> {
    territory: &'a Territory<'a>,
    surfaces: &'a ContactSurfaces,
    slave: &'a SlaveSegments,
    /// Edges of the surfaces and positions of the nodes at the start.
    start: &'a [Edge],
    positions: Positions<'a>,
}

impl<'a> Finder<'a> {
    fn new(
        territory: &'a Territory<'a>,
        slave: &'a SlaveSegments,
        start: &'a [Edge],
        positions: Positions<'a>,
    ) -> Self {
        Finder {
            surfaces: territory.surfaces(),
            territory,
            slave,
            start,
            positions,
        }
    }

    /// For every face one entry for each run of the master, with the segments of the run that the face faces, and the
    /// cells of the face over these segments.
    fn all_faced(&self) -> Vec<FacedRun> {
        let mut all = Vec::new();
        for face in 0..self.slave.ends.len() {
            let faced = self.faced(face);
            for run in faced.chunk_by(|&i, &j| self.slave.runs[i] == self.slave.runs[j]) {
                all.push(FacedRun {
                    face,
                    segments: run.into(),
                    cells: self.cells(face, run, self.start),
                });
            }
        }
        all
    }

    /// Adds the points of a face over one run of the master.
    fn add_points(
        &self,
        faced: &FacedRun,
        edges: &[Edge],
        form: RowForm,
        points: &mut Vec<(usize, SurfacePoint)>,
    ) {
        let face = faced.face;
        let [start, now] = [&faced.cells, &self.cells(face, &faced.segments, edges)];
        let mut cuts = Recycled::with_room();
        let of_start = start.iter().filter(|_| form == RowForm::DiscreteGradient);
        for &(low, high, _) in now.iter().chain(of_start) {
            cuts.extend([low, high]);
        }
        cuts.sort_unstable_by(f64::total_cmp);
        for cell in cuts.windows(2) {
            let (part, middle) = (cell[1] - cell[0], f64::midpoint(cell[0], cell[1]));
            if part <= LEAST_CELL {
                continue;
            }
            let Some(j) = self.over(face, now, middle, edges) else {
                continue;
            };
            let i = match form {
                RowForm::End => Some(j),
                RowForm::DiscreteGradient => self.over(face, start, middle, self.start),
            };
            let of_segments = [Some(j), i].into_iter().flatten();
            let bulges = of_segments.map(|i| self.slave.segment_bulge(i));
            let bulges = bulges.chain([self.slave.face_bulge(face)]);
            for &(side, square, share) in gauss_points(bulges, self.slave.are_rings) {
                let eta = middle + side * part / f64::sqrt(square);
                let share = part * share;
                let weight = (self.slave).reference_weight(face, self.positions, eta, share);
                points.push(self.point(face, eta, weight, (i, j)));
            }
        }
    }

    /// A point that was over segment i at the start and is over segment j in the iterate; the number is j.
    fn point(
        &self,
        face: usize,
        eta: f64,
        weight: f64,
        (i, j): (Option<usize>, usize),
    ) -> (usize, SurfacePoint) {
        let [x1, x2] = self.slave.face(face);
        let [a, b] = self.slave.segment(j);
        let from = match i {
            Some(i) if i == j => StartSegment::Same,
            Some(i) => StartSegment::Other(self.slave.segment(i), *self.slave.segment_bulge(i)),
            None => StartSegment::Outside,
        };
        let point = SurfacePoint {
            vertices: [x1, x2, a, b],
            eta,
            rise: self.slave.face_bulge(face).at(eta),
            bulge: *self.slave.segment_bulge(j),
            weight,
            from,
        };
        (j, point)
    }

    /// Segments within reach that a face faces at the start, one run after the other.
    fn faced(&self, face: usize) -> Faced {
        let mut faced = Faced::new();
        let x = self.slave.edge_of_face(self.start, face).ends;
        for number in self.slave.ends[face].into_iter().flatten() {
            for candidate in self.territory.candidates(number) {
                let i = candidate.segment;
                if faced.contains(&i) || !self.may_meet(face, i) || !self.faces(face, i) {
                    continue;
                }
                let [a, b] = self.slave.edge_of_segment(self.start, i).ends;
                let [p, q] = x.map(|x| project(x, a, b));
                let is_near =
                    [p, q].iter().any(|p| p.gap.abs() <= candidate.reach) || p.gap * q.gap < 0.0;
                if is_near && self.is_in_front((face, i), [p, q]) {
                    faced.push(i);
                }
            }
        }
        faced.sort_unstable_by_key(|&i| (self.slave.runs[i], i));
        faced
    }

    /// Whether a face may be the slave of a segment: they have no common node, and on a surface that touches itself the
    /// face has the lower rank.
    fn may_meet(&self, face: usize, segment: usize) -> bool {
        let ends = self.surfaces.slave_faces[face];
        let has_own = (ends.into_iter()).any(|node| self.surfaces.is_end(node, segment));
        let ranks = self.slave.ranks.as_ref();
        !has_own && ranks.is_none_or(|ranks| ranks[face] < ranks[segment])
    }

    /// Whether a face was in front of a segment at the start, or in front of another segment from which it may slide on
    /// to this segment, or has penetrated the body through this segment. `p` and `q` are the projections of the ends of
    /// the face. The result is false for the far side of a thin body or of a body behind it, for a face that has
    /// entered through another segment, and for a face that lies on another segment.
    fn is_in_front(&self, (face, segment): (usize, usize), [p, q]: [Projection; 2]) -> bool {
        // the gaps at the ends of the part of the face over the segment decide: beyond this part a face of a bent thin
        // body may be in front of the line of a segment on the other side
        let part = |xi: f64| (xi.clamp(0.0, 1.0) - p.xi) / (q.xi - p.xi);
        let bulges = [
            self.slave.face_bulge(face),
            self.slave.segment_bulge(segment),
        ];
        let is_curved = bulges.iter().any(|bulge| !bulge.is_flat());
        let gap = |eta: f64| {
            let of_chords = p.gap + eta * (q.gap - p.gap);
            match is_curved {
                true => of_chords - bulges[0].at(eta) - bulges[1].at(p.xi + eta * (q.xi - p.xi)),
                false => of_chords,
            }
        };
        let [first, last] = [part(p.xi), part(q.xi)];
        let is_open = |eta: f64| gap(eta) >= -CLOSED_GAP * p.length;
        // between curved faces the gap may be larger within the part than at its ends
        if is_open(first) || is_open(last) || (is_curved && is_open(f64::midpoint(first, last))) {
            return true;
        }
        // the middle of the part of the face that is over the segment
        let xi = f64::midpoint(p.xi.clamp(0.0, 1.0), q.xi.clamp(0.0, 1.0));
        let eta = ((xi - p.xi) / (q.xi - p.xi)).clamp(0.0, 1.0);
        let [x1, x2] = self.slave.edge_of_face(self.start, face).ends;
        let x = between(x1, x2, eta);
        let at = |segment: usize| {
            let [a, b] = self.slave.edge_of_segment(self.start, segment).ends;
            let over = self.slave.segment_bulge(segment).below(project(x, a, b));
            over.raised(-bulges[0].at(eta))
        };
        let place = at(segment);
        let depth = -place.gap;
        let is_nearer = |other: usize| {
            let p = at(other);
            let on_it = CLOSED_GAP * p.length;
            (-CLOSED_GAP..=1.0 + CLOSED_GAP).contains(&p.xi)
                && (-NEARER_DEPTH * depth..=on_it).contains(&p.gap)
        };
        // whether this segment lies behind the line of another, as beyond convex vertices; on the other side of a bent
        // thin body it does not
        let leads_behind = |other: usize| {
            let [a, b] = self.slave.edge_of_segment(self.start, other).ends;
            let ends = self.slave.edge_of_segment(self.start, segment).ends;
            let mut places = ends.iter().map(|&end| project(end, a, b));
            places.all(|p| p.gap <= CLOSED_GAP * p.length)
        };
        // whether the face is in front of a segment before or after, from which it may slide on to
        // this one
        let is_beside = |other: usize| {
            let p = at(other);
            self.slave.runs[other] == self.slave.runs[segment]
                && (-SIDE_BY_SIDE..=1.0 + SIDE_BY_SIDE).contains(&p.xi)
                && p.gap >= -CLOSED_GAP * p.length
                && self.faces(face, other)
                && leads_behind(other)
        };
        let numbers = || self.slave.ends[face].into_iter().flatten();
        let others = || numbers().flat_map(|number| self.territory.candidates(number));
        let ends = self.surfaces.slave_faces[face];
        let own = self.surfaces.segments[segment];
        let node_at = |node: usize| self.positions.of(node);
        let is_inside = || {
            let place = [place.xi, place.gap];
            (self.surfaces.interior).takes_in_point(own, (place, ends), node_at)
        };
        others().any(|other| is_beside(other.segment))
            || (is_inside() && !others().any(|other| is_nearer(other.segment)))
    }

    /// Whether a face and a segment faced each other at the start.
    fn faces(&self, face: usize, segment: usize) -> bool {
        let e = self.slave.edge_of_face(self.start, face).tangent;
        let f = self.slave.edge_of_segment(self.start, segment).tangent;
        dot(e, f) < -FACING_COSINE
    }

    /// The parts of a face over some segments of a run, for the given edges. The parts of the face end at the bisectors
    /// of the master's vertices and at the normals of the ends of the run.
    ///
    /// ```text
    /// eta = -((x_1 - x_v) x m)/((x_2 - x_1) x m),   m = n_i + n_j    eq. (3.19)
    /// ```
    fn cells(&self, face: usize, segments: &[usize], edges: &[Edge]) -> Cells {
        let [x1, x2] = self.slave.edge_of_face(edges, face).ends;
        let edge = |i: usize| self.slave.edge_of_segment(edges, i);
        let normal = |i: usize| {
            let [x, y] = edge(i).tangent;
            [y, -x]
        };
        let eta = |i: usize, v: [f64; 2], neighbour: Option<usize>| {
            let is_next = |j: &usize| {
                self.slave.runs[i] == self.slave.runs[*j]
                    && self.may_meet(face, *j)
                    && self.faces(face, *j)
            };
            let (n, other) = (
                normal(i),
                neighbour.filter(is_next).map_or([0.0; 2], normal),
            );
            let m = [n[0] + other[0], n[1] + other[1]];
            -cross(difference(v, x1), m) / cross(difference(x1, x2), m)
        };
        let mut cells = Cells::with_room();
        for &i in segments {
            let [a, b] = edge(i).ends;
            let at_a = eta(i, a, self.surfaces.previous[i]);
            let at_b = eta(i, b, self.surfaces.next[i]);
            // the face runs against the segment
            let (low, high) = (at_b.max(0.0), at_a.min(1.0));
            if low < high {
                cells.push((low, high, i));
            }
        }
        cells
    }

    /// The nearest segment under a place of a face, for the given edges.
    fn over(&self, face: usize, cells: &Cells, eta: f64, edges: &[Edge]) -> Option<usize> {
        let mut over = (cells.iter())
            .filter(|(low, high, _)| (*low..=*high).contains(&eta))
            .map(|&(_, _, i)| i);
        let first = over.next()?;
        let [x1, x2] = self.slave.edge_of_face(edges, face).ends;
        let x = between(x1, x2, eta);
        let distance = |i: usize| {
            let [a, b] = self.slave.edge_of_segment(edges, i).ends;
            project(x, a, b).gap.abs()
        };
        let mut nearest = first;
        for i in over {
            if distance(i) < distance(nearest) {
                nearest = i;
            }
        }
        Some(nearest)
    }
}

impl SurfacePoint {
    /// Positions of the point and of the ends a and b of its segment.
    fn places(&self, at: impl Fn(usize) -> [f64; 2]) -> [[f64; 2]; 3] {
        let [x1, x2, a, b] = self.vertices.map(|vertex| vertex.place(&at));
        [between(x1, x2, self.eta), a, b]
    }

    fn configurations(&self, at: &Configurations) -> [[[f64; 2]; 3]; 2] {
        [
            self.places(|node| at.start([node])[0]),
            self.places(|node| at.iterate([node])[0]),
        ]
    }

    /// Tilt of the force at a point that was over another segment i at the start; the given positions are those of the
    /// point and of the ends a and b, at start and end of the increment.
    fn tilt(&self, [start, end]: [[[f64; 2]; 3]; 2], at_start: impl Fn(usize) -> [f64; 2]) -> Tilt {
        if let StartSegment::Same = self.from {
            return Tilt::default();
        }
        let over = |bulge: &Bulge, [s, a, b]: [[f64; 2]; 3]| {
            bulge.below(project(s, a, b)).raised(-self.rise)
        };
        let [p, q] = [start, end].map(|places| over(&self.bulge, places));
        let (before, turn) = match self.from {
            StartSegment::Same => return Tilt::default(),
            StartSegment::Other(segment, bulge) => {
                let [a, b] = segment.map(|vertex| vertex.place(&at_start));
                let from = over(&bulge, [start[0], a, b]);
                (from.gap, cross(from.tangent, p.tangent).abs())
            }
            // the point may slide along its face over the end of the master
            StartSegment::Outside => {
                let [x1, x2] = [0, 1].map(|i| self.vertices[i].place(&at_start));
                let face = project(x1, x1, x2).tangent;
                (p.gap.max(0.0), cross(face, p.tangent).abs())
            }
        };
        Tilt::new(p.gap - before, slip(&p, &q), POINT_TILT.max(2.0 * turn))
    }

    /// Gaps of the point in the iterate, between the faces and between their chords:
    ///
    /// ```text
    /// G_q = g_q - b_m(xi_q) - b_s(eta_q)    eq. (3.32)
    /// ```
    fn gaps(&self, at: &Configurations) -> [f64; 2] {
        let p = self.projection(at);
        [self.bulge.below(p).raised(-self.rise).gap, p.gap]
    }

    /// Projection of the point onto the chord of its segment in the iterate.
    fn projection(&self, at: &Configurations) -> Projection {
        let [s, a, b] = self.places(|node| at.iterate([node])[0]);
        project(s, a, b)
    }

    /// Rotation (e_n.d_e)/l of the segment in the increment.
    fn turn(&self, p: &Projection, at: &Configurations) -> f64 {
        let [start, end] = self.configurations(at).map(|[_, a, b]| difference(a, b));
        dot(p.normal, difference(start, end)) / p.length
    }

    /// Projection and rows over the point, a and b, with the tilted force row of eq. (7.8), and the tilt. `gap` is the
    /// gap of the constraint: when the constraint closes, the point is lower by this gap.
    fn rows(&self, gap: f64, at: &Configurations) -> (SegmentRows, Tilt) {
        let places = self.configurations(at);
        let (height, tilt) = match at.form {
            RowForm::End => (self.gaps(at)[1] - gap, Tilt::default()),
            RowForm::DiscreteGradient => (0.0, self.tilt(places, |node| at.start([node])[0])),
        };
        let mut rows = rows_between(places, (height, &self.bulge), at.form);
        if tilt.kappa != 0.0 {
            let [chord, _] = rows.chord();
            rows.force.normal = sum_of(1.0, &rows.force.normal, tilt.kappa, &chord.tangential);
        }
        (rows, tilt)
    }

    /// Calls `take` for each node of the point, with the place of the node in `nodes`, the number (0, 1 or 2) of its
    /// vertex s, a or b, and its part of this vertex.
    #[inline]
    fn each_share(&self, nodes: &[usize], mut take: impl FnMut(usize, usize, f64)) {
        let own = [(0, 1.0 - self.eta), (0, self.eta), (1, 1.0), (2, 1.0)];
        for (vertex, (own, part)) in self.vertices.into_iter().zip(own) {
            vertex.each_share(|node, share| {
                let place = nodes.iter().position(|&n| n == node);
                take(place.unwrap_or_default(), own, part * share);
            });
        }
    }
}

/// Tilt of the force at a point, and its derivative with respect to the slip (1/length).
#[derive(Debug, Clone, Copy, Default)]
struct Tilt {
    kappa: f64,
    slope: f64,
}

impl Tilt {
    /// Tilt for a rise g0_j - g0_i over a slip s, at most `most`.
    ///
    /// ```text
    /// kappa = (g0_j - g0_i)/s,   kappa <- most^2/kappa   where |kappa| > most    eq. (7.8)
    /// ```
    fn new(rise: f64, slip: f64, most: f64) -> Self {
        match rise.abs() <= most * slip.abs() {
            true if rise == 0.0 => Tilt::default(),
            true => Tilt {
                kappa: rise / slip,
                slope: -rise / (slip * slip),
            },
            false => {
                let slope = most * most / rise;
                let kappa = slope * slip;
                Tilt { kappa, slope }
            }
        }
    }
}

/// The slip L (xi1 - xi0) of a point.
fn slip(start: &Projection, end: &Projection) -> f64 {
    (start.length + end.length) / 2.0 * (end.xi - start.xi)
}

impl MeanContact {
    /// Nodes of a constraint and the number of slave nodes; the first node is the one that names the constraint, and
    /// slave nodes come before master nodes.
    fn nodes(&self, slave: usize) -> (Recycled<usize>, usize) {
        let mut nodes = Recycled::with_room();
        nodes.push(slave);
        let mut slaves = 1;
        for ends in [0..2, 2..4] {
            for point in self.points.iter() {
                for vertex in &point.vertices[ends.clone()] {
                    vertex.each_share(|node, _| {
                        if !nodes.contains(&node) {
                            nodes.push(node);
                        }
                    });
                }
            }
            if ends.start == 0 {
                slaves = nodes.len();
            }
        }
        (nodes, slaves)
    }

    /// The constraint of a slave node: gaps and rows of its points, summed with their weights,
    ///
    /// ```text
    /// Bn_j = sum_q C_jq Bn_q,  Gn_j = sum_q C_jq Gn_q,  s_j = Bt_j d,   C_jq = w_q N_j/c_j    eq. (3.20)
    /// ```
    ///
    /// When the constraint is closed a point is at the height g_q - g_j, which depends on both gaps:
    ///
    /// ```text
    /// Gt_j = sum_q C_jq (Gt_q + (e_n.d_e)/l (Gn_q - Gn_j))   of end rows, Gt_q with constant heights
    /// ```
    pub(super) fn constraint(self, pair: Pair, at: &Configurations) -> Constraint {
        let (nodes, slaves) = self.nodes(pair.slave);
        // force rows n, t and derivative rows n, t
        let mut sums: [PerDof<f64>; 4] = from_fn(|_| PerDof::zeros(2 * nodes.len()));
        let mut at_nodes = sums.each_mut().map(|row| row.as_chunks_mut::<2>().0);
        let [allowed_before, allowed] = pair.allowed;
        let mean: f64 = (self.points.iter().map(|q| q.weight * q.gaps(at)[0])).sum();
        let (mut gap, mut scale, mut turn) = (mean + allowed, 0.0, 0.0);
        let mut stretch = 0.0;
        for point in self.points.iter() {
            let (mut rows, _) = point.rows(gap, at);
            scale += point.weight * rows.projection.length;
            stretch += point.weight * rows.stretch();
            if at.form == RowForm::End {
                let turned = point.turn(&rows.projection, at) / rows.stretch();
                let [_, chord] = rows.chord();
                let tangential = &mut rows.derivative.tangential;
                *tangential = sum_of(1.0, tangential, turned, &chord.normal);
                turn += point.weight * turned;
            }
            let of_point = [
                &rows.force.normal,
                &rows.force.tangential,
                &rows.derivative.normal,
                &rows.derivative.tangential,
            ];
            point.each_share(&nodes, |place, own, share| {
                let part = point.weight * share;
                for (sums, row) in at_nodes.iter_mut().zip(of_point) {
                    let sum = &mut sums[place];
                    for i in 0..2 {
                        sum[i] += part * row[2 * own + i];
                    }
                }
            });
        }
        let dofs: PerDof<usize> = nodes.iter().flat_map(|n| [2 * n, 2 * n + 1]).collect();
        let product = |row: &[f64]| -> f64 {
            let motions = dofs.iter().map(|&dof| at.u[dof] - at.u0[dof]);
            row.iter().zip(motions).map(|(b, d)| b * d).sum()
        };
        let [n, t, gn, mut gt] = sums;
        gt.iter_mut().zip(&gn).for_each(|(gt, gn)| *gt -= turn * gn);
        let (mut start_gap, slip) = (mean - product(&n) + allowed_before, product(&t));
        // an overlap at the start stays, eq. (7.9)
        if at.form == RowForm::DiscreteGradient && start_gap < 0.0 {
            gap -= start_gap;
            start_gap = 0.0;
        }
        let (force_rows, derivative_rows) = (
            Rows {
                normal: n,
                tangential: t,
            },
            Rows {
                normal: gn,
                tangential: gt,
            },
        );
        Constraint {
            key: pair.key,
            slave_dofs: 2 * slaves,
            other_derivative_rows: (derivative_rows != force_rows).then_some(derivative_rows),
            force_rows,
            gap,
            start_gap,
            slip,
            mu: 0.0,
            mu_varies: false,
            // for straight faces s is exactly 1, without the round-off of the weights
            stretch: match self.points.iter().all(|q| q.bulge.is_flat()) {
                true => 1.0,
                false => stretch,
            },
            shrinkage: allowed_before - allowed,
            scale,
            dofs,
            source: PairTarget {
                pair,
                target: Target::Mean(self),
            },
        }
    }

    /// Derivative of the contact force of the constraint: the sum over its points at constant weights.
    pub(super) fn change(
        &self,
        constraint: &Constraint,
        [pn, pt]: [f64; 2],
        at: &Configurations,
    ) -> DMatrix<f64> {
        let nodes: SmallVec<[usize; 16]> = constraint.nodes().collect();
        let mut k = DMatrix::zeros(constraint.dofs.len(), constraint.dofs.len());
        // sum for the changes of heights, which only end rows have
        let mut couples = DVector::zeros(constraint.dofs.len());
        for point in self.points.iter() {
            let places = point.configurations(at);
            let (rows, Tilt { kappa, slope }) = point.rows(constraint.gap, at);
            let height = rows.projection.gap - constraint.gap;
            let [pn, pt] = [pn, pt].map(|p| point.weight * p);
            let mut own: Matrix6<f64> = match &rows.bend {
                None => changes_between(places, height, [pn, pt + kappa * pn], at.form),
                Some(bend) => {
                    changes_of_face(places, (height, bend), ([pn, pt], kappa * pn), at.form)
                }
            };
            let [of_force, of_derivative] = rows.chord();
            let [_, along] = (rows.bend.as_ref()).map_or([pn, pt], |bend| bend.at_chord([pn, pt]));
            let column = |row: [f64; 6]| Vector6::from_column_slice(&row);
            let mut lean = Vector6::zeros();
            if at.form == RowForm::End {
                // the couple has a height, which changes with the gap of its point and with the gap of the constraint
                lean = column(couple(&rows.projection)) * along;
                own += lean * column(of_derivative.normal).transpose();
            }
            if slope != 0.0 {
                // dkappa = (dkappa/ds) Gt
                let (force, change) = (
                    column(of_force.tangential),
                    column(of_derivative.tangential),
                );
                own += force * change.transpose() * (pn * slope);
            }
            let mut shares: SmallVec<[(usize, usize, f64); 12]> = SmallVec::new();
            point.each_share(&nodes, |place, own, share| shares.push((place, own, share)));
            for &(row, i, p) in &shares {
                let mut place = couples.fixed_rows_mut::<2>(2 * row);
                place += lean.fixed_rows::<2>(2 * i) * p;
                for &(col, j, q) in &shares {
                    let block: SMatrix<f64, 2, 2> =
                        own.fixed_view::<2, 2>(2 * i, 2 * j).into_owned() * (p * q);
                    let mut place = k.fixed_view_mut::<2, 2>(2 * row, 2 * col);
                    place += block;
                }
            }
        }
        k - couples * DVector::from_column_slice(&constraint.derivative_rows().normal).transpose()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::contact::{Search, find_means, testing};
    use crate::model::Mesh;
    use crate::vectors::COMPARED;

    /// Positions of three slave nodes above the master nodes 3, 4 and 5, through which the surface runs from right to
    /// left.
    const X: [[f64; 2]; 6] = [
        [0.1, 0.3],
        [0.9, 0.2],
        [2.1, 0.3],
        [2.2, 0.1],
        [1.1, -0.1],
        [-0.2, 0.05],
    ];
    const U0: [f64; 12] = [
        0.01, 0.02, -0.03, 0.01, 0.02, 0.03, 0.02, -0.01, 0.01, 0.02, -0.02, 0.01,
    ];
    const U1: [f64; 12] = [
        0.11, -0.05, 0.08, -0.02, 0.15, 0.03, -0.04, 0.06, 0.03, -0.02, 0.05, 0.04,
    ];

    /// The pair of a mean gap that node 1 names.
    fn pair() -> Pair {
        Pair {
            slave: 1,
            ..testing::face().pair
        }
    }

    /// The constraint of node 1 with points over both segments; one point has come from the other segment.
    fn source() -> MeanContact {
        source_of([Bulge::FLAT; 2])
    }

    /// The constraint of node 1 between straight faces and between curved faces; the curved slave faces bulge by a
    /// constant rise.
    fn sources() -> [MeanContact; 2] {
        [Bulge::FLAT, Bulge::steep(1.2)].map(|bulge| source_of([bulge; 2]))
    }

    fn source_of([bulge, own]: [Bulge; 2]) -> MeanContact {
        let vertex = |node: usize| Vertex {
            node,
            corners: None,
        };
        let point = |ends: [usize; 2], eta, weight, [a, b]: [usize; 2], from| SurfacePoint {
            vertices: [ends[0], ends[1], a, b].map(vertex),
            eta,
            rise: own.at(eta),
            bulge: bulge.of_points([false; 2]),
            weight,
            from,
        };
        MeanContact {
            nearest: [4, 5],
            points: [
                point([0, 1], 0.3, 0.1, [4, 5], StartSegment::Same),
                point([0, 1], 0.9, 0.4, [4, 5], StartSegment::Same),
                point(
                    [1, 2],
                    0.15,
                    0.3,
                    [3, 4],
                    StartSegment::Other([4, 5].map(vertex), bulge.of_points([false; 2])),
                ),
                point([1, 2], 0.6, 0.2, [3, 4], StartSegment::Same),
            ]
            .into_iter()
            .collect(),
        }
    }

    fn between_displacements<'a>(form: RowForm, u0: &'a [f64], u: &'a [f64]) -> Configurations<'a> {
        let x = &X;
        Configurations { form, x, u0, u }
    }

    /// The weighted mean of the gaps of the points at some displacements; each point is over its segment of the start
    /// or of the end.
    fn gap(u: &[f64], is_start: bool) -> f64 {
        gap_of(&source(), u, is_start)
    }

    fn gap_of(source: &MeanContact, u: &[f64], is_start: bool) -> f64 {
        let at = |node: usize| [X[node][0] + u[2 * node], X[node][1] + u[2 * node + 1]];
        let gaps = source.points.iter().map(|q| {
            let ([x1, x2, a, b], bulge) = match q.from {
                StartSegment::Other([a, b], bulge) if is_start => {
                    ([q.vertices[0], q.vertices[1], a, b], bulge)
                }
                _ => (q.vertices, q.bulge),
            };
            let [x1, x2, a, b] = [x1, x2, a, b].map(|vertex| vertex.place(at));
            let p = project(between(x1, x2, q.eta), a, b);
            q.weight * (p.gap - bulge.at(p.xi) - q.rise)
        });
        gaps.sum()
    }

    /// Work of a search over two open chains of nodes, or one that touches itself: numbers of compared pairs of
    /// circles, of listed candidates, and of the points that result.
    fn work(chains: &[Vec<[f64; 2]>]) -> [usize; 3] {
        let coordinates: Vec<[f64; 2]> = chains.concat();
        let mut first = 0;
        let faces = chains.iter().map(|chain| {
            let from = first;
            first += chain.len();
            (from..first - 1).map(|a| [a, a + 1]).collect::<Vec<_>>()
        });
        let faces: Vec<_> = faces.collect();
        let [slave, master] = [&faces[0], faces.last().expect("a chain")];
        let slaves = (0..chains[0].len()).collect();
        let u = vec![0.0; 2 * coordinates.len()];
        let mesh = Mesh {
            coordinates,
            ..Mesh::default()
        };
        let surfaces = [ContactSurfaces::new(slaves, slave, master.clone())
            .from_surface_to_surface(&mesh, HashMap::new())];
        let mut search = Search::new(&surfaces, &mesh.coordinates);
        let before = COMPARED.get();
        search.start(&u, 1.0);
        search.cover(&u);
        let compared = COMPARED.get() - before;
        let listed = search.slaves().map(|slave| slave.candidates().count());
        let mut pairs = Vec::new();
        find_means(&search, [&u; 2], RowForm::DiscreteGradient, &mut pairs);
        let points = pairs.iter().filter_map(|source| source.target.mean());
        let points = points.map(|mean| mean.points.len());
        [compared, listed.sum(), points.sum()]
    }

    #[test]
    fn work_grows_as_n_log_n() {
        let row = |count: usize, y: f64, turn: f64| -> Vec<[f64; 2]> {
            let place = |i: usize| turn * (i as f64 / count as f64 - 0.5);
            (0..=count).map(|i| [place(i), y]).collect()
        };
        // unlike meshes face to face, and the legs of one strip
        let unlike = |n: usize| vec![row(n, 0.01 / n as f64, 1.0), row(7 * n / 5, 0.0, -1.0)];
        let folded = |n: usize| vec![[row(n, 0.0, -1.0), row(n, 0.01 / n as f64, 1.0)].concat()];
        for (name, chains) in [
            ("unlike", &unlike as &dyn Fn(usize) -> _),
            ("folded", &folded),
        ] {
            let mut before = [f64::INFINITY; 3];
            for n in [64, 128, 256, 512] {
                let [compared, listed, points] =
                    work(&chains(n)).map(|count| count as f64 / n as f64);
                println!(
                    "{name} {n}: {compared} compared, {listed} listed, {points} points per segment"
                );
                let now = [compared / (n as f64).log2(), listed, points];
                let most = before.map(|count| 1.05 * count);
                assert!(
                    now.iter().zip(most).all(|(now, most)| *now <= most),
                    "{name} {now:?} {before:?}"
                );
                assert!(points > 2.0, "faces are over each other");
                before = now;
            }
        }
    }

    /// Number of runs of the master over which the upper end of a slave face has mean gaps. The slave face has length
    /// 1; its part `over` lies beyond the vertex at which the master turns by the angle `turn`.
    fn runs_over_a_vertex(over: f64, turn: f64) -> usize {
        let (sin, cos) = turn.to_radians().sin_cos();
        // bodies on the left: the master's face looks to the right
        let coordinates = vec![
            [0.0, -1.0],
            [0.0, 0.0],
            [-sin, cos],
            [1e-3, over],
            [1e-3, over - 1.0],
        ];
        let surfaces = ContactSurfaces::new(vec![3, 4], &[[3, 4]], vec![[0, 1], [1, 2]]);
        let mesh = Mesh {
            coordinates,
            ..Mesh::default()
        };
        let surfaces = [surfaces.from_surface_to_surface(&mesh, HashMap::new())];
        let mut search = Search::new(&surfaces, &mesh.coordinates);
        let u = vec![0.0; 2 * mesh.coordinates.len()];
        search.start(&u, 1.0);
        search.cover(&u);
        let mut pairs = Vec::new();
        find_means(&search, [&u; 2], RowForm::DiscreteGradient, &mut pairs);
        pairs.iter().filter(|source| source.pair.slave == 3).count()
    }

    #[test]
    fn slivers_beyond_a_convex_vertex_are_left_out() {
        assert_eq!(runs_over_a_vertex(1e-3, 40.0), 1);
        assert_eq!(runs_over_a_vertex(0.1, 40.0), 2);
        assert_eq!(runs_over_a_vertex(1e-3, -40.0), 2, "a concave one");
    }

    #[test]
    fn rows_are_discrete_gradients_of_the_mean_gap() {
        let at = between_displacements(RowForm::DiscreteGradient, &U0, &U1);
        for source in sources() {
            let constraint = source.clone().constraint(pair(), &at);
            let overlap = gap_of(&source, &U0, true).min(0.0);
            let [gap, start_gap] = [constraint.gap + overlap, constraint.start_gap + overlap];
            assert!((gap - gap_of(&source, &U1, false)).abs() < 1e-14);
            assert!((start_gap - gap_of(&source, &U0, true)).abs() < 1e-13);
            check_momenta(&constraint);
        }
    }

    /// Checks that unit forces of the constraint have neither a resultant nor a moment in the mid
    /// configuration.
    fn check_momenta(constraint: &Constraint) {
        let Rows { normal, tangential } = &constraint.force_rows;
        for row in [normal, tangential] {
            let (mut force, mut moment) = ([0.0; 2], 0.0);
            for (entries, dofs) in row.chunks(2).zip(constraint.dofs.chunks(2)) {
                let middle = |i: usize| X[dofs[0] / 2][i] + (U0[dofs[i]] + U1[dofs[i]]) / 2.0;
                force = [force[0] + entries[0], force[1] + entries[1]];
                moment += middle(0) * entries[1] - middle(1) * entries[0];
            }
            assert!(
                force[0].abs() < 1e-14 && force[1].abs() < 1e-14,
                "{force:?}"
            );
            assert!(moment.abs() < 1e-14, "{moment}");
        }
    }

    #[test]
    fn end_rows_of_a_closed_mean_keep_both_momenta_and_are_those_of_a_body_at_rest() {
        let closed = Pair {
            allowed: [-gap(&U1, false); 2],
            ..pair()
        };
        let source = source().untilted();
        let rows = |form, u0: &[f64]| {
            let at = between_displacements(form, u0, &U1);
            source.clone().constraint(closed, &at).force_rows
        };
        let nodes = source.nodes(1).0;
        let found = rows(RowForm::End, &U0);
        for row in [&found.normal, &found.tangential] {
            let moment: f64 = (row.chunks(2).zip(nodes.iter()))
                .map(|(f, &n)| cross([0, 1].map(|i| X[n][i] + U1[2 * n + i]), [f[0], f[1]]))
                .sum();
            assert!(moment.abs() < 1e-14, "{moment}");
        }
        let (end, halfway) = (found, rows(RowForm::DiscreteGradient, &U1));
        for (p, q) in [
            (end.normal, halfway.normal),
            (end.tangential, halfway.tangential),
        ] {
            assert!(p.iter().zip(&q).all(|(p, q)| (p - q).abs() < 1e-14));
        }
    }

    #[test]
    fn the_parts_of_its_force_on_each_surface_sum_to_one() {
        let at = between_displacements(RowForm::DiscreteGradient, &U0, &U1);
        let surfaces = source().constraint(pair(), &at).surface_parts();
        for (surface, nodes) in surfaces.iter().zip([[0, 1, 2], [3, 4, 5]]) {
            let mut found: Vec<usize> = surface.parts.iter().map(|(node, _)| *node).collect();
            found.sort_unstable();
            assert_eq!(found, nodes);
            let sum: f64 = surface.parts.iter().map(|(_, part)| part).sum();
            assert!((sum - 1.0).abs() < 1e-14, "{sum}");
        }
        let [slave, master] = surfaces.map(|surface| surface.normal);
        assert!((slave[0] + master[0]).abs() < 1e-14 && (slave[1] + master[1]).abs() < 1e-14);
        assert!(slave[1] > 0.9, "out of the master");
    }

    #[test]
    fn an_overlap_at_the_start_stays() {
        // slave nodes below the master at the start, deeper at the end
        let (mut u0, mut u1) = (U0, U1);
        for node in 0..3 {
            u0[2 * node + 1] -= 0.6;
            u1[2 * node + 1] -= 0.7;
        }
        let at = between_displacements(RowForm::DiscreteGradient, &u0, &u1);
        let constraint = source().constraint(pair(), &at);
        let before = gap(&u0, true);
        assert!(before < -0.1, "{before}");
        assert!((constraint.gap - (gap(&u1, false) - before)).abs() < 1e-13);
        assert!(constraint.start_gap.abs() < 1e-13);
    }

    #[test]
    fn derivative_rows_are_the_derivatives_of_the_mean_gap() {
        let forms = [RowForm::End, RowForm::DiscreteGradient];
        for (form, source) in forms
            .map(|form| sources().map(|source| (form, source)))
            .concat()
        {
            let of = |u: &[f64]| {
                let at = between_displacements(form, &U0, u);
                source.clone().constraint(pair(), &at)
            };
            let found = of(&U1);
            let rows = found.derivative_rows();
            for (k, &dof) in found.dofs.iter().enumerate() {
                let moved = |by: f64| {
                    let mut u = U1;
                    u[dof] += by;
                    of(&u)
                };
                let (plus, minus) = (moved(1e-6), moved(-1e-6));
                let slope = (plus.gap - minus.gap) / 2e-6;
                assert!((rows.normal[k] - slope).abs() < 1e-9, "{form:?} {k}");
                let slope = (plus.slip - minus.slip) / 2e-6;
                let error = (rows.tangential[k] - slope).abs();
                assert!(
                    error < 1e-9 || form == RowForm::DiscreteGradient,
                    "{k} {error}"
                );
            }
        }
    }

    #[test]
    fn the_change_of_the_force_is_its_derivative() {
        let force = [1.3, -0.4];
        let forms = [RowForm::End, RowForm::DiscreteGradient];
        for (form, source) in forms
            .map(|form| sources().map(|source| (form, source)))
            .concat()
        {
            let nodal = |u: &[f64]| {
                let mut forces = [0.0; 12];
                let at = between_displacements(form, &U0, u);
                source
                    .clone()
                    .constraint(pair(), &at)
                    .add_force(force, &mut forces);
                forces
            };
            let at = between_displacements(form, &U0, &U1);
            let of_all = source.clone().constraint(pair(), &at);
            let found = source.change(&of_all, force, &at);
            let quotient = |row: usize, column: usize| {
                let [mut plus, mut minus] = [U1; 2];
                (plus[column], minus[column]) = (plus[column] + 1e-6, minus[column] - 1e-6);
                (nodal(&plus)[row] - nodal(&minus)[row]) / 2e-6
            };
            for (i, &row) in of_all.dofs.iter().enumerate() {
                for (j, &column) in of_all.dofs.iter().enumerate() {
                    let error = (found[(i, j)] - quotient(row, column)).abs();
                    assert!(error < 1e-7 * found.amax(), "{form:?} {i} {j} {error}");
                }
            }
        }
    }
}
