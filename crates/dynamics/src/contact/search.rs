//! Candidate search between slave nodes and segments, after Zhong & Nilsson (1989), with lists that
//! stay valid over several increments. See docs/theory/geometry.md, Candidate search.

use std::sync::{Mutex, PoisonError};

use smallvec::SmallVec;

use super::bulge::Lift;
use super::geometry::{ContactSurfaces, Corners};
use super::keys::NodeAtSegment;
use super::keys::{ConstraintKey, SlaveKey};
use super::lists::{Recycled, entries};
use super::positions::{Positions, position};
use super::slave_segments::Edge;
use super::tolerances::{
    NEAR_PER_MOTION, NEAR_REACH, PAIRING_REACH, PAIRING_REACH_WITHOUT_VELOCITIES,
    PROJECTION_BEYOND_ENDS, SEARCH_MARGIN, SEARCH_MARGIN_PER_MOTION,
};
use crate::archive::{Archive, ArchiveError};
use crate::vectors::{Circle, CircleTree, difference, dot, length};

/// A segment that a slave node may pair with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Index of the segment in its contact.
    pub segment: usize,
    /// Distance up to which the segment pairs with the node (length).
    pub reach: f64,
}

/// All segments of a contact as candidates at any distance: the exhaustive search.
pub fn all_segments(surfaces: &ContactSurfaces) -> impl Iterator<Item = Candidate> + Clone {
    (0..surfaces.segments.len()).map(|segment| Candidate {
        segment,
        reach: f64::INFINITY,
    })
}

/// Contact search with hierarchies of circular territories.
///
/// Each slave node and each segment has a circle that is grown by a margin; each contact has two hierarchies of such
/// circles. Entities with overlapping circles are candidates; the lists of candidates are valid until an entity has
/// moved further than its margin. Positions and motions are relative to the mean of the contact's nodes, since a common
/// motion of two bodies brings no pair together.
pub struct Search<'m> {
    x: &'m [[f64; 2]],
    territories: Vec<Territory<'m>>,
    searches: usize,
}

impl<'m> Search<'m> {
    /// A search among some contacts of nodes with the reference coordinates `x`; velocities tell how far nodes go in an
    /// increment.
    pub fn new(contacts: &'m [ContactSurfaces], x: &'m [[f64; 2]]) -> Self {
        Search::within(PAIRING_REACH, contacts, x)
    }

    /// A search for static and quasi-static steps. In static and quasi-static steps no velocity tells how far a node
    /// will go, so the search looks farther.
    pub fn without_velocities(contacts: &'m [ContactSurfaces], x: &'m [[f64; 2]]) -> Self {
        Search::within(PAIRING_REACH_WITHOUT_VELOCITIES, contacts, x)
    }

    /// A search up to the distance `reach`, in mean segment lengths of each contact.
    fn within(reach: f64, contacts: &'m [ContactSurfaces], x: &'m [[f64; 2]]) -> Self {
        Search {
            x,
            territories: (contacts.iter().enumerate())
                .flat_map(|(contact, surfaces)| {
                    Territory::of_contact(contact, (surfaces, reach), x)
                })
                .collect(),
            searches: 0,
        }
    }

    /// Sets the overlaps that fits allow the slave nodes of every contact at the start and at the end of an increment
    /// (length); the list is empty for a contact without a fit.
    pub fn allow(&mut self, allowed: Vec<Vec<[f64; 2]>>) {
        for territory in &mut self.territories {
            territory.allow(&allowed[territory.key.contact]);
        }
    }

    /// Lets nodes of a contact pair with segments behind which they lie by a further `overlap` (length).
    pub fn reach_into(&mut self, contact: usize, overlap: f64) {
        let own = |territory: &&mut Territory| territory.key.contact == contact;
        for territory in self.territories.iter_mut().filter(own) {
            territory.reach += overlap;
        }
    }

    /// Starts an increment of length `dt` with the velocities `v`: the reach of a pair grows by the
    /// displacements dt |v| of its node and its segment.
    pub fn start(&mut self, v: &[f64], dt: f64) {
        for territory in &mut self.territories {
            let v = territory.about_mean(|node| [v[2 * node], v[2 * node + 1]]);
            for side in [&mut territory.slaves, &mut territory.segments] {
                side.set_travel(|node| dt * length(v(node)));
            }
            territory.forget_faced();
        }
    }

    /// Transfers the lists, and the positions for which they are valid.
    ///
    /// # Errors
    /// The archive belongs to other contacts.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        for territory in &mut self.territories {
            let Territory {
                contact,
                slaves,
                segments,
                candidates,
                starts,
                ..
            } = territory;
            for side in [slaves, segments] {
                archive.transfer_values(&mut side.travel)?;
                archive.transfer(&mut side.reference)?;
                archive.transfer(&mut side.margin)?;
                let sizes = [side.reference.len(), side.margin.len()];
                if sizes != [0; 2] && sizes != [side.ends.len(); 2] {
                    return Err(ArchiveError::Size);
                }
            }
            archive.transfer(candidates)?;
            archive.transfer(starts)?;
            let last = starts.last().map_or(0, |last| *last);
            let segments = contact.segments.len();
            let fit = last == candidates.len()
                && starts.is_sorted()
                && candidates
                    .iter()
                    .all(|&segment| (segment as usize) < segments);
            if !fit {
                return Err(ArchiveError::Size);
            }
        }
        archive.transfer(&mut self.searches)
    }

    /// Searches the contacts whose lists are not valid for the displacements `u`.
    pub fn cover(&mut self, u: &[f64]) {
        let x = self.x;
        for territory in &mut self.territories {
            let at = territory.about_mean(|node| position(x, u, node));
            if !territory.covers(&at) {
                territory.search(at);
                self.searches += 1;
            }
        }
    }

    /// Searches the contacts whose lists are not valid on the whole straight path from `u0` to
    /// `u1`.
    pub fn cover_path(&mut self, u0: &[f64], u1: &[f64]) {
        let x = self.x;
        for territory in &mut self.territories {
            let [at_start, at_end] =
                [u0, u1].map(|u| territory.about_mean(move |node| position(x, u, node)));
            if !territory.reaches(&at_start) || !territory.reaches(&at_end) {
                territory.extend_travel(&at_start, &at_end);
                territory.search(|node| {
                    let (p, q) = (at_start(node), at_end(node));
                    [0, 1].map(|i| p[i] + (q[i] - p[i]) / 2.0)
                });
                self.searches += 1;
            }
        }
    }

    /// Distance up to which nodes at rest pair with segments at rest: the smallest over all contacts (length); infinite
    /// without a contact. Contacts that a step has removed do not count.
    pub fn reach(&self) -> f64 {
        let acts = |territory: &&Territory| {
            let ContactSurfaces {
                slaves, segments, ..
            } = territory.contact;
            !slaves.is_empty() && !segments.is_empty()
        };
        let reaches = self.territories.iter().filter(acts);
        reaches
            .map(|territory| territory.reach)
            .fold(f64::INFINITY, f64::min)
    }

    /// The contacts with their candidates, one after the other; with surface to surface also their corners.
    pub fn territories(&self) -> &[Territory<'m>] {
        &self.territories
    }

    /// The slave nodes of all contacts with their candidates, in the order of their numbers.
    pub fn slaves(&self) -> impl Iterator<Item = ListedSlave<'_, 'm>> {
        self.territories.iter().flat_map(|territory| {
            let surfaces = territory.contact;
            (0..surfaces.slaves.len()).map(move |number| ListedSlave {
                key: territory.key.plus(number),
                number,
                surfaces,
                territory,
            })
        })
    }

    /// Surfaces of the contacts between nodes and segments in which no node may overlap.
    pub(super) fn surfaces_of_nodes(&self) -> impl Iterator<Item = &'m ContactSurfaces> {
        let territories = self.territories.iter();
        let of_nodes = territories.filter(|territory| {
            let surfaces = territory.contact;
            let meets_segments = surfaces.slave_segments.is_none() && surfaces.disc.is_none();
            meets_segments && territory.corners.is_none() && !territory.is_fitted
        });
        of_nodes.map(|territory| territory.contact)
    }

    /// Reference coordinates of the nodes.
    pub fn coordinates(&self) -> &'m [[f64; 2]] {
        self.x
    }

    /// Number of searches so far, counted for every contact on its own.
    pub fn searches(&self) -> usize {
        self.searches
    }
}

/// A slave node with the segments that the search lists for it.
#[derive(Clone, Copy)]
pub struct ListedSlave<'a, 'm> {
    /// Key of the slave node.
    pub key: SlaveKey,
    /// Number of the slave node on the surfaces.
    pub(super) number: usize,
    /// Surfaces of the contact of the slave node.
    pub surfaces: &'m ContactSurfaces,
    territory: &'a Territory<'m>,
}

impl<'a, 'm> ListedSlave<'a, 'm> {
    /// Candidates of the contact of the slave node.
    pub(super) fn territory(&self) -> &'a Territory<'m> {
        self.territory
    }

    /// The node.
    pub fn node(&self) -> usize {
        self.surfaces.slaves[self.number]
    }

    /// The node with a segment of its contact.
    pub fn at(&self, segment: usize) -> NodeAtSegment {
        let [a, b] = self.surfaces.segments[segment];
        NodeAtSegment {
            key: ConstraintKey {
                slave: self.key,
                segment,
            },
            nodes: [self.node(), a, b],
        }
    }

    /// Overlap that a fit allows the slave node at the start and at the end of the increment
    /// (length).
    pub fn allowed(&self) -> [f64; 2] {
        self.territory.allowed(self.number)
    }

    /// The allowed overlap at start and end; `lies` tells whether the node belongs to a mean gap that was closed before
    /// the increment. A corner of a rigid body may not sink in outside all closed mean gaps: the body rocks and lands
    /// on its corners.
    pub fn allowed_where(&self, lies: impl Fn(usize) -> bool) -> [f64; 2] {
        let allowed = self.allowed();
        let rocks = |corners: &&Corners| corners.are_rigid[self.number] && !lies(self.node());
        match self.territory.corners.filter(rocks) {
            Some(corners) => allowed.map(|depth| depth - corners.allowed[self.number]),
            None => allowed,
        }
    }

    /// Lift of the gap of the slave node over the chord of the segment of a pair at the start of the increment.
    pub fn lift(&self, pair: &NodeAtSegment) -> Lift {
        Lift {
            allowed: self.allowed()[0],
            bulge: self.surfaces.bulges[pair.key.segment],
        }
    }

    /// Whether the slave node is a corner of the contact's master.
    pub fn is_of_master(&self) -> bool {
        (self.territory.corners).is_some_and(|corners| corners.are_of_master)
    }

    /// Whether the slave node meets segments by itself and not in a mean gap: this holds with node to surface, and for
    /// corners with surface to surface.
    pub fn meets_segments(&self) -> bool {
        self.surfaces.slave_segments.is_none()
    }

    /// Whether the slave node is a corner of contact from surface to surface.
    pub fn is_corner(&self) -> bool {
        self.territory.corners.is_some()
    }

    /// Whether nodes of the contact may overlap at the end of the increment.
    pub fn is_fitted(&self) -> bool {
        self.territory.is_fitted
    }

    /// Whether no correction can bring the slave node to a segment: its distance from all segments is larger than a
    /// part of the pairing distance plus twice its expected motion.
    pub(super) fn is_far(&self, now: Positions) -> bool {
        let Territory {
            contact,
            slaves,
            segments,
            reach,
            ..
        } = self.territory;
        if contact.disc.is_some() || !self.meets_segments() || self.allowed() != [0.0; 2] {
            return false;
        }
        let s = now.of(self.node());
        self.territory.listed(self.number).iter().all(|&i| {
            let travel = slaves.travel[self.number] + segments.travel[i as usize];
            let near = NEAR_REACH * reach + NEAR_PER_MOTION * travel;
            let [a, b] = contact.segments[i as usize];
            let (a, b) = (now.of(a), now.of(b));
            let (r, e) = (difference(a, s), difference(a, b));
            let (along, whole) = (dot(r, e), dot(e, e));
            // |r - xi e|^2 e.e, with xi = r.e/e.e limited to [0, 1]
            let on = along.max(0.0).min(whole);
            dot(r, r) * whole - on * (2.0 * along - on) > near * near * whole
        })
    }

    /// Candidates of the slave node, with increasing segments.
    pub fn candidates(&self) -> impl Iterator<Item = Candidate> + Clone + use<'a> {
        self.territory.candidates(self.number)
    }
}

/// The candidates of one contact, or of the corners of one contact.
pub struct Territory<'m> {
    contact: &'m ContactSurfaces,
    /// Key of the first slave node.
    key: SlaveKey,
    /// The corners, if the slave nodes are corners.
    corners: Option<&'m Corners>,
    /// Distance up to which a node at rest pairs with a segment at rest (length).
    reach: f64,
    /// Margin of an entity at rest (length).
    skin: f64,
    slaves: SearchedSide,
    segments: SearchedSide,
    /// Candidate segments of all slave nodes, one node after the other, increasing for each.
    candidates: Vec<u32>,
    /// Start of the list of each slave node, and the end of the last list.
    starts: Vec<usize>,
    /// The candidates as pairs of slave node and segment, in the order in which they are found.
    found: Vec<[u32; 2]>,
    /// Overlaps that a fit allows the slave nodes at the start and at the end of the increment (length); empty without
    /// a fit.
    allowed: Vec<[f64; 2]>,
    /// Whether some of the allowed overlaps at the end of the increment are not zero.
    is_fitted: bool,
    /// With surface to surface, the segments that slave faces face at the start of the increment.
    faced: Mutex<FacedAtStart>,
}

/// Segments that a slave face faces.
pub(super) type Faced = SmallVec<[usize; 8]>;

/// Parts [low, high] of a slave face, each with the master segment under it.
pub(super) type Cells = Recycled<(f64, f64, usize)>;

entries!((f64, f64, usize));

/// Segments of one run of the master that a slave face faces at the start of the increment, and the parts of the face
/// over these segments.
pub(super) struct FacedRun {
    pub face: usize,
    pub segments: Faced,
    pub cells: Cells,
}

/// Segments that the slave faces face, with the edges and candidates for which they were found.
#[derive(Default)]
struct FacedAtStart {
    edges: Recycled<Edge>,
    runs: Vec<FacedRun>,
}

impl<'m> Territory<'m> {
    /// The territories of a contact and of its corners; the numbers of the corners follow the numbers of the slave
    /// nodes.
    fn of_contact(
        contact: usize,
        (surfaces, reach): (&'m ContactSurfaces, f64),
        x: &[[f64; 2]],
    ) -> Vec<Self> {
        let mut key = SlaveKey { contact, slave: 0 };
        let mut all = vec![Territory::new(key, (surfaces, None), reach, x)];
        let mut before = surfaces;
        for corners in &surfaces.corners {
            key = key.plus(before.slaves.len());
            before = &corners.surfaces;
            all.push(Territory::new(key, (before, Some(corners)), reach, x));
        }
        all
    }

    fn new(
        key: SlaveKey,
        (contact, corners): (&'m ContactSurfaces, Option<&'m Corners>),
        reach: f64,
        x: &[[f64; 2]],
    ) -> Self {
        let lengths = || {
            let segments = contact.segments.iter();
            segments.map(|&[a, b]| distance(x[a], x[b]))
        };
        let mean = lengths().sum::<f64>() / contact.segments.len().max(1) as f64;
        Territory {
            contact,
            key,
            corners,
            // the reach covers all points of a slave face, although only its ends are listed
            reach: reach * mean + contact.half_longest_face(x),
            skin: SEARCH_MARGIN * mean,
            slaves: SearchedSide::new(contact.slaves.iter().map(|&s| [s, s]).collect()),
            segments: SearchedSide::new(contact.segments.clone()),
            candidates: Vec::new(),
            starts: Vec::new(),
            found: Vec::new(),
            allowed: Vec::new(),
            is_fitted: false,
            faced: Mutex::default(),
        }
    }

    /// Calls a function with the segments that the slave faces face at the start of the increment. The segments are
    /// found once for all passes of an increment, as long as faces and candidates stay the same.
    pub(super) fn with_faced<T>(
        &self,
        edges: Recycled<Edge>,
        find: impl FnOnce(&[Edge]) -> Vec<FacedRun>,
        then: impl FnOnce(&[Edge], &[FacedRun]) -> T,
    ) -> T {
        let mut faced = self.faced.lock().unwrap_or_else(PoisonError::into_inner);
        if faced.edges != edges {
            let runs = find(&edges);
            *faced = FacedAtStart { edges, runs };
        }
        then(&faced.edges, &faced.runs)
    }

    /// Sets the overlaps that a fit allows the slave nodes of the contact; corners, which a fit does not name, get the
    /// largest of these overlaps.
    fn allow(&mut self, allowed: &[[f64; 2]]) {
        self.is_fitted = allowed.iter().any(|[_, end]| *end != 0.0);
        self.allowed = match self.corners {
            None => allowed.to_vec(),
            Some(_) if allowed.is_empty() => Vec::new(),
            Some(corners) => {
                let largest = |end: usize| allowed.iter().map(|a| a[end]).fold(0.0, f64::max);
                vec![[largest(0), largest(1)]; corners.allowed.len()]
            }
        };
    }

    /// Allowed overlap of a slave node at the start and at the end of the increment (length), less the radius of a
    /// disc.
    pub(super) fn allowed(&self, number: usize) -> [f64; 2] {
        let of_fit = self.allowed.get(number).copied().unwrap_or_default();
        let of_corner = self.corners.map_or(0.0, |corners| corners.allowed[number]);
        let always = of_corner - self.contact.radius();
        of_fit.map(|allowed| allowed + always)
    }

    /// Key of the first slave node.
    pub(super) fn key(&self) -> SlaveKey {
        self.key
    }

    /// The surfaces.
    pub fn surfaces(&self) -> &'m ContactSurfaces {
        self.contact
    }

    /// Candidates of the slave node number `k` of the contact, with increasing segments.
    pub fn candidates(&self, k: usize) -> impl Iterator<Item = Candidate> + Clone + use<'_> {
        self.listed(k).iter().map(move |&i| Candidate {
            segment: i as usize,
            reach: self.reach(k, i as usize),
        })
    }

    /// Segments that are listed for the slave node number `k`.
    fn listed(&self, k: usize) -> &[u32] {
        &self.candidates[self.starts[k]..self.starts[k + 1]]
    }

    /// Positions or velocities of nodes, less their mean over the ends of all slaves and segments
    /// of the contact.
    fn about_mean<F: Fn(usize) -> [f64; 2]>(&self, of: F) -> impl Fn(usize) -> [f64; 2] + use<F> {
        let ends = || self.slaves.ends.iter().chain(&self.segments.ends).flatten();
        let sum = ends()
            .map(|&node| of(node))
            .fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
        let count = (2 * (self.slaves.ends.len() + self.segments.ends.len())).max(1) as f64;
        let mean = sum.map(|sum| sum / count);
        move |node| difference(mean, of(node))
    }

    /// Distance up to which the slave node number `k` pairs with a segment (length).
    pub fn reach(&self, k: usize, segment: usize) -> f64 {
        self.reach + self.slaves.travel[k] + self.segments.travel[segment]
    }

    /// Whether the lists are valid at the given positions for the travel of the increment: for
    /// every entity, its distance from its position at the search plus its travel is within its
    /// margin.
    fn covers(&self, at: impl Fn(usize) -> [f64; 2]) -> bool {
        self.slaves.is_within(&at, true) && self.segments.is_within(&at, true)
    }

    /// Whether the lists contain all pairs that may touch at the given positions.
    fn reaches(&self, at: impl Fn(usize) -> [f64; 2]) -> bool {
        self.slaves.is_within(&at, false) && self.segments.is_within(&at, false)
    }

    fn forget_faced(&mut self) {
        let faced = self.faced.get_mut().unwrap_or_else(PoisonError::into_inner);
        faced.edges.clear();
    }

    fn extend_travel(&mut self, from: impl Fn(usize) -> [f64; 2], to: impl Fn(usize) -> [f64; 2]) {
        for side in [&mut self.slaves, &mut self.segments] {
            side.extend_travel(|node| distance(from(node), to(node)));
        }
    }

    /// Lists the segments that each slave node can approach while all entities are within their
    /// margins.
    fn search(&mut self, at: impl Fn(usize) -> [f64; 2]) {
        self.forget_faced();
        self.slaves.draw(&at, self.skin, self.contact.radius());
        self.segments.draw(&at, self.skin, self.reach);
        let Self {
            contact,
            candidates,
            starts,
            found,
            ..
        } = self;
        found.clear();
        self.slaves.circles.overlaps(&self.segments.circles, found);
        found.retain(|&[k, i]| !contact.is_end(contact.slaves[k as usize], i as usize));

        starts.clear();
        starts.resize(contact.slaves.len() + 1, 0);
        for [k, _] in &*found {
            starts[*k as usize + 1] += 1;
        }
        for k in 0..contact.slaves.len() {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        candidates.resize(found.len(), 0);
        for [k, i] in found {
            let place = &mut next[*k as usize];
            candidates[*place] = *i;
            *place += 1;
        }
        for list in starts.windows(2) {
            candidates[list[0]..list[1]].sort_unstable();
        }
    }
}

/// The entities of one side of a contact by their end nodes; both ends of a slave node are the node
/// itself.
struct SearchedSide {
    ends: Vec<[usize; 2]>,
    /// Distance that each entity may travel in the increment (length).
    travel: Vec<f64>,
    /// Positions of the ends at the last search; empty before the first.
    reference: Vec<[[f64; 2]; 2]>,
    /// Distance that the ends may move from their positions at the last search (length).
    margin: Vec<f64>,
    /// Territories of the entities at the last search.
    circles: CircleTree,
}

impl SearchedSide {
    fn new(ends: Vec<[usize; 2]>) -> Self {
        SearchedSide {
            travel: vec![0.0; ends.len()],
            reference: Vec::new(),
            margin: Vec::new(),
            circles: CircleTree::default(),
            ends,
        }
    }

    fn set_travel(&mut self, travel: impl Fn(usize) -> f64) {
        for (own, [a, b]) in self.travel.iter_mut().zip(&self.ends) {
            *own = travel(*a).max(travel(*b));
        }
    }

    fn extend_travel(&mut self, travel: impl Fn(usize) -> f64) {
        for (own, [a, b]) in self.travel.iter_mut().zip(&self.ends) {
            *own = own.max(travel(*a)).max(travel(*b));
        }
    }

    /// Whether the ends are within the margins; with `with_travel` also after the travel of the
    /// increment.
    fn is_within(&self, at: impl Fn(usize) -> [f64; 2], with_travel: bool) -> bool {
        self.reference.len() == self.ends.len()
            && (0..self.ends.len()).all(|i| {
                let left = self.margin[i] - if with_travel { self.travel[i] } else { 0.0 };
                let is_near = |k: usize| {
                    let (p, q) = (self.reference[i][k], at(self.ends[i][k]));
                    let d = difference(p, q);
                    dot(d, d) <= left * left
                };
                let [a, b] = self.ends[i];
                left >= 0.0 && is_near(0) && (a == b || is_near(1))
            })
    }

    /// Sets the reference positions and draws circles about the entities, grown by their margins
    /// and by `more`.
    fn draw(&mut self, at: impl Fn(usize) -> [f64; 2], skin: f64, more: f64) {
        self.reference.clear();
        self.reference
            .extend(self.ends.iter().map(|ends| ends.map(&at)));
        self.margin.clear();
        // margin m = l/2 + 2 w, eq. (10.2), where w is the travel
        self.margin.extend(
            self.travel
                .iter()
                .map(|travel| skin + SEARCH_MARGIN_PER_MOTION * travel),
        );
        // radius length/2 + m, for a segment plus R, eq. (10.1)
        let circle = |([a, b], margin): (&[[f64; 2]; 2], &f64)| Circle {
            centre: [0, 1].map(|i| a[i] + (b[i] - a[i]) / 2.0),
            // a node pairs a little beyond the ends as well
            radius: (distance(*a, *b) / 2.0 + margin + more) * (1.0 + 4.0 * PROJECTION_BEYOND_ENDS),
        };
        self.circles
            .rebuild(self.reference.iter().zip(&self.margin).map(circle));
    }
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    length(difference(p, q))
}
