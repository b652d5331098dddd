//! Contact surfaces: slave nodes and oriented master segments, with their neighbours and sharp
//! corners. See docs/theory/geometry.md.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::arcs::SurfaceArc;
use super::bulge::Bulge;
use super::curves::{Chain, FaceShapes};
use super::interior::Interior;
use super::projection::project;
use super::slave_segments::{SlaveSegments, Vertex};
use super::tolerances::{CORNER_COSINE, CORNER_DEPTH, SHARP_TURN_COSINE, VERTEX_COSINE};
use crate::linear::larger;
use crate::model::{
    Contact, ContactFormulation, Disc, Element, Mesh, Model, Smoothing, SurfaceKind,
};
use crate::vectors::{cross, difference, dot, length};

/// Nodes at one place that equations join, for example at both ends of a pre-tension section. Joined nodes are one
/// vertex of the surface; this vertex does not touch the segments at its place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JoinedNodes(HashMap<usize, Vec<usize>>);

impl JoinedNodes {
    /// The joined nodes of a model.
    pub fn new(model: &Model) -> Self {
        let mut others: HashMap<usize, Vec<usize>> = HashMap::new();
        for [a, b] in model.joined_nodes() {
            others.entry(a).or_default().push(b);
            others.entry(b).or_default().push(a);
        }
        JoinedNodes(others)
    }

    /// A node, and the nodes joined with it.
    fn of(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::once(node).chain(self.0.get(&node).into_iter().flatten().copied())
    }
}

/// The two sides of a contact of the model, as nodes and segments.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurfaces {
    /// Slave nodes.
    pub slaves: Vec<usize>,
    /// Faces of the slave surface; if the surface is made of nodes, the exterior faces at these nodes.
    pub slave_faces: Vec<[usize; 2]>,
    /// For every slave node the nodes before and after it on its own surface, if both exist.
    pub adjacent: Vec<Option<[usize; 2]>>,
    /// Master segments [a, b] with the body on the left of the direction from a to b.
    pub segments: Vec<[usize; 2]>,
    /// For every segment the segment that starts at its end, if any.
    pub next: Vec<Option<usize>>,
    /// For every segment the segment that ends at its start, if any.
    pub previous: Vec<Option<usize>>,
    /// For every segment whether the body has a sharp corner at its end b in the reference
    /// configuration: an angle below 120 degrees. At a corner that is not sharp, legs that fold onto each other are a
    /// closed concave corner.
    pub sharp_corners: Vec<bool>,
    /// Bulge of every segment, for nodes.
    pub bulges: Vec<Bulge>,
    /// Bulge of every face of the slave surface.
    pub face_bulges: Vec<Bulge>,
    /// Bulges of the faces before and after every slave node on its own surface.
    pub own_bulges: Vec<[Bulge; 2]>,
    /// Interior of the bodies; behind a segment without an element everything is inside.
    pub interior: Arc<Interior>,
    /// Faces at the slave nodes, in contact from surface to surface.
    pub slave_segments: Option<SlaveSegments>,
    /// In contact from surface to surface: the corners of both surfaces as nodes against the
    /// segments of the other.
    pub corners: Vec<Corners>,
    /// The disc whose centre is the slave node.
    pub disc: Option<Disc>,
    /// Arcs of a rigid master, with increasing segments.
    pub arcs: Vec<SurfaceArc>,
    /// Nodes that are one vertex.
    pub joined: Arc<JoinedNodes>,
}

/// Corners of one surface against the segments of the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Corners {
    /// Contact surfaces with the corners as slave nodes.
    pub surfaces: ContactSurfaces,
    /// Allowed overlap of each corner (length).
    pub allowed: Vec<f64>,
    /// For every corner whether it belongs to a rigid body.
    pub are_rigid: Vec<bool>,
    /// Whether the corners belong to the contact's master.
    pub are_of_master: bool,
}

impl ContactSurfaces {
    /// Slave nodes against master segments; `own` are the segments of the slave surface, empty if
    /// it is made of nodes.
    pub fn new(slaves: Vec<usize>, own: &[[usize; 2]], segments: Vec<[usize; 2]>) -> Self {
        Self::with_joined(slaves, own, segments, &Arc::default())
    }

    /// Surfaces as from [`Self::new`], where some nodes are one vertex.
    fn with_joined(
        slaves: Vec<usize>,
        own: &[[usize; 2]],
        segments: Vec<[usize; 2]>,
        joined: &Arc<JoinedNodes>,
    ) -> Self {
        // node at the other end of the segment that starts or ends at a node
        let following: HashMap<usize, usize> = own.iter().map(|&[a, b]| (a, b)).collect();
        let preceding: HashMap<usize, usize> = own.iter().map(|&[a, b]| (b, a)).collect();
        let at = |of: &HashMap<usize, usize>, node: usize| {
            joined.of(node).find_map(|node| of.get(&node).copied())
        };
        let neighbours = |&slave: &usize| Some([at(&preceding, slave)?, at(&following, slave)?]);
        // segment that starts or ends at a node
        let numbered = || segments.iter().enumerate();
        let starting: HashMap<usize, usize> = numbered().map(|(i, &[a, _])| (a, i)).collect();
        let ending: HashMap<usize, usize> = numbered().map(|(i, &[_, b])| (b, i)).collect();
        ContactSurfaces {
            adjacent: slaves.iter().map(neighbours).collect(),
            slave_faces: own.to_vec(),
            next: segments.iter().map(|&[_, b]| at(&starting, b)).collect(),
            previous: segments.iter().map(|&[a, _]| at(&ending, a)).collect(),
            sharp_corners: vec![false; segments.len()],
            bulges: vec![Bulge::FLAT; segments.len()],
            face_bulges: vec![Bulge::FLAT; own.len()],
            own_bulges: vec![[Bulge::FLAT; 2]; slaves.len()],
            slaves,
            segments,
            interior: Arc::default(),
            slave_segments: None,
            corners: Vec::new(),
            disc: None,
            arcs: Vec::new(),
            joined: Arc::clone(joined),
        }
    }

    /// Whether a node, or a node of the same vertex, is an end of a segment.
    pub fn is_end(&self, node: usize, segment: usize) -> bool {
        let ends = self.segments[segment];
        self.joined.of(node).any(|node| ends.contains(&node))
    }

    /// Radius of the disc whose centre is the slave node (length); 0 for nodes.
    pub fn radius(&self) -> f64 {
        self.disc.map_or(0.0, |disc| disc.radius)
    }

    /// The arc of which a segment is a chord.
    pub fn arc_of(&self, segment: usize) -> Option<&SurfaceArc> {
        let at = self.arcs.partition_point(|arc| arc.segments.end <= segment);
        self.arcs
            .get(at)
            .filter(|arc| arc.segments.contains(&segment))
    }

    /// The master segments with their neighbours.
    pub(super) fn chain(&self) -> Chain<'_> {
        Chain {
            segments: &self.segments,
            next: &self.next,
            previous: &self.previous,
        }
    }

    /// Adds the shapes of curved faces at the reference coordinates `x`: the arcs of a rigid surface, else the bulges
    /// that follow from the turns of slave faces and segments.
    pub fn with_bulges(mut self, x: &[[f64; 2]], shapes: &FaceShapes, is_rigid: bool) -> Self {
        self.bulges = match is_rigid {
            true => self.bulges_of_arcs(x),
            false => self.chain().bulges(x, shapes),
        };
        let faces = self.slave_faces.clone();
        let own = ContactSurfaces::with_joined(Vec::new(), &[], faces, &self.joined);
        self.face_bulges = own.chain().bulges(x, shapes);
        let numbered = || self.slave_faces.iter().zip(&self.face_bulges);
        let before: HashMap<usize, Bulge> =
            numbered().map(|(&[_, b], &bulge)| (b, bulge)).collect();
        let after: HashMap<usize, Bulge> = numbered().map(|(&[a, _], &bulge)| (a, bulge)).collect();
        let at = |of: &HashMap<usize, Bulge>, node: usize| {
            let found = self.joined.of(node).find_map(|node| of.get(&node).copied());
            found.unwrap_or(Bulge::FLAT)
        };
        let own = self
            .slaves
            .iter()
            .map(|&node| [at(&before, node), at(&after, node)]);
        self.own_bulges = own.collect();
        self
    }

    /// Whether any master segment or slave face bends.
    pub fn bends(&self) -> bool {
        let mut all = self.bulges.iter().chain(&self.face_bulges);
        all.any(|bulge| !bulge.is_flat())
    }

    /// Number of master segments and slave faces that bend, and the largest angle between a face and its chord at an end, at the
    /// reference coordinates `x`.
    pub fn bent(&self, x: &[[f64; 2]]) -> (usize, f64) {
        let segments = self.segments.iter().zip(&self.bulges);
        let all = segments.chain(self.slave_faces.iter().zip(&self.face_bulges));
        let bent = all.filter(|(_, bulge)| !bulge.is_flat());
        bent.fold((0, 0.0), |(count, most), (&[a, b], bulge)| {
            let size = length(difference(x[a], x[b]));
            let angles = [0.0, 1.0].map(|end| (bulge.slope(end) / size).atan().abs());
            (count + 1, larger(most, larger(angles[0], angles[1])))
        })
    }

    /// Bulges of the segments of a rigid surface, from its arcs.
    fn bulges_of_arcs(&self, x: &[[f64; 2]]) -> Vec<Bulge> {
        let of_arc = |i: usize| {
            let arc = self.arc_of(i)?;
            Some(Bulge::of_arc(self.length(x, i), arc.arc.radius))
        };
        (0..self.segments.len())
            .map(|i| of_arc(i).unwrap_or(Bulge::FLAT))
            .collect()
    }

    /// Adds the interior of the bodies behind the segments.
    pub fn with_interior(mut self, interior: Arc<Interior>) -> Self {
        self.interior = interior;
        self
    }

    /// Makes the contact surface to surface; `middles` gives the ends of a side for each mid-side node.
    pub fn from_surface_to_surface(
        mut self,
        mesh: &Mesh,
        middles: HashMap<usize, [usize; 2]>,
    ) -> Self {
        let x = &mesh.coordinates;
        let numbered = self.slaves.iter().enumerate();
        let numbers: HashMap<usize, usize> = numbered.map(|(k, &node)| (node, k)).collect();
        let mut at_nodes = vec![Vec::new(); self.slaves.len()];
        let ends: Vec<[Option<usize>; 2]> = (self.slave_faces.iter())
            .map(|face| face.map(|node| numbers.get(&node).copied()))
            .collect();
        for (face, ends) in ends.iter().enumerate() {
            for (end, number) in ends.iter().enumerate() {
                if let Some(k) = *number {
                    at_nodes[k].push([face, end]);
                }
            }
        }
        let of_sides = |faces: Vec<[usize; 2]>| -> Vec<Vec<[usize; 2]>> {
            let tangent = |face: usize| {
                let [a, b] = self.slave_faces[face].map(|node| x[node]);
                project(a, a, b).tangent
            };
            match faces[..] {
                [[f, _], [g, _]] if dot(tangent(f), tangent(g)) >= CORNER_COSINE => vec![faces],
                _ => faces.into_iter().map(|face| vec![face]).collect(),
            }
        };
        let is_self_contact = self.slave_faces == self.segments;
        self.corners = self.corners_of_both(x, is_self_contact);
        let vertex = |node: usize| Vertex {
            node,
            corners: middles.get(&node).copied(),
        };
        let edges = self.slave_faces.iter().chain(&self.segments);
        let vertices = edges.map(|ends| ends.map(vertex)).collect();
        let edges = self.slave_faces.iter().chain(&self.segments);
        let bulges = self.face_bulges.iter().chain(&self.bulges);
        let bulges = (edges.zip(bulges)).map(|(ends, bulge)| {
            let half = ends.map(|end| middles.contains_key(&end));
            bulge.of_points(half)
        });
        let bulges = bulges.collect();
        self.slave_segments = Some(SlaveSegments {
            bulges,
            ends,
            at_nodes: at_nodes.into_iter().map(of_sides).collect(),
            runs: self.runs(x),
            ranks: is_self_contact.then(|| self.ranks(x)),
            vertices,
            are_rings: mesh.is_axisymmetric(),
        });
        self
    }

    /// Whether the surface has a corner between the segment `i` and the next segment `j`, at the positions `x`.
    fn has_corner(&self, x: &[[f64; 2]], i: usize, j: usize) -> bool {
        let [e, f] = [i, j].map(|i| {
            let [a, b] = self.segments[i].map(|node| x[node]);
            project(a, a, b).tangent
        });
        dot(e, f) < CORNER_COSINE
    }

    /// Number of the run of every segment: the first segment of the run. The number of a closed run without corners is
    /// its least segment.
    fn runs(&self, x: &[[f64; 2]]) -> Vec<usize> {
        let mut runs = vec![usize::MAX; self.segments.len()];
        let before = |j: usize| self.previous[j].filter(|&i| !self.has_corner(x, i, j));
        let after = |i: usize| self.next[i].filter(|&j| !self.has_corner(x, i, j));
        let heads = (0..runs.len()).filter(|&i| before(i).is_none());
        for head in heads.chain(0..self.segments.len()) {
            let mut following = Some(head);
            while let Some(i) = following.filter(|&i| runs[i] == usize::MAX) {
                runs[i] = head;
                following = after(i);
            }
        }
        runs
    }

    /// Ranks of the segments of a surface that touches itself: segments of chains with shorter segments come first;
    /// within a chain they are in the order of the chain.
    fn ranks(&self, x: &[[f64; 2]]) -> Vec<usize> {
        let mut seen = vec![false; self.segments.len()];
        let mut chains: Vec<(f64, Vec<usize>)> = Vec::new();
        let heads = (0..seen.len()).filter(|&i| self.previous[i].is_none());
        for head in heads.chain(0..self.segments.len()) {
            let (mut chain, mut following) = (Vec::new(), Some(head));
            while let Some(i) = following.filter(|&i| !seen[i]) {
                seen[i] = true;
                chain.push(i);
                following = self.next[i];
            }
            let lengths = chain.iter().map(|&i| self.length(x, i));
            let sum: f64 = lengths.sum();
            if !chain.is_empty() {
                chains.push((sum / chain.len() as f64, chain));
            }
        }
        chains.sort_by(|(l, p), (m, q)| l.total_cmp(m).then(p.cmp(q)));
        let mut ranks = vec![0; self.segments.len()];
        for (rank, i) in chains.into_iter().flat_map(|(_, chain)| chain).enumerate() {
            ranks[i] = rank;
        }
        ranks
    }

    fn length(&self, x: &[[f64; 2]], i: usize) -> f64 {
        let [a, b] = self.segments[i];
        length(difference(x[a], x[b]))
    }

    /// The corners of both surfaces; if a surface touches itself, its corners are listed once.
    fn corners_of_both(&self, x: &[[f64; 2]], is_self_contact: bool) -> Vec<Corners> {
        let chains = |faces: &[[usize; 2]]| {
            ContactSurfaces::with_joined(Vec::new(), &[], faces.to_vec(), &self.joined)
        };
        let [mut slave, mut master] =
            [&self.slave_faces, &self.segments].map(|faces| chains(faces));
        (slave.bulges, master.bulges) = (self.face_bulges.clone(), self.bulges.clone());
        let mut both = vec![(&slave, &master, false)];
        if !is_self_contact {
            both.push((&master, &slave, true));
        }
        let is_slave: HashSet<usize> = self.slaves.iter().copied().collect();
        let corners = both.into_iter().map(|(own, against, are_of_master)| {
            let mut nodes = own.corner_nodes(x);
            nodes.retain(|node| are_of_master || is_slave.contains(node));
            let shortest = shortest_faces(&own.segments, x);
            let lengths = (0..against.segments.len()).map(|i| against.length(x, i));
            let least = lengths.fold(f64::INFINITY, f64::min);
            let allowed = |node: &usize| CORNER_DEPTH * shortest[node].min(least);
            let allowed: Vec<f64> = nodes.iter().map(allowed).collect();
            let segments = against.segments.clone();
            let mut surfaces =
                ContactSurfaces::with_joined(nodes, &own.segments, segments, &self.joined);
            surfaces.bulges = against.bulges.clone();
            Corners {
                surfaces: surfaces
                    .with_sharp_corners(x)
                    .with_interior(Arc::clone(&self.interior)),
                are_rigid: vec![false; allowed.len()],
                allowed,
                are_of_master,
            }
        });
        corners
            .filter(|corners| !corners.allowed.is_empty())
            .collect()
    }

    /// Ends of the surface of the segments, and the nodes at its convex vertices that turn by more than 20 degrees, in
    /// increasing order.
    fn corner_nodes(&self, x: &[[f64; 2]]) -> Vec<usize> {
        let mut nodes = Vec::new();
        for (i, &[a, b]) in self.segments.iter().enumerate() {
            if self.previous[i].is_none() {
                nodes.push(a);
            }
            let tangent = |i: usize| {
                let [a, b] = self.segments[i].map(|node| x[node]);
                project(a, a, b).tangent
            };
            let is_corner = self.next[i].is_none_or(|j| {
                let (e, f) = (tangent(i), tangent(j));
                dot(e, f) < VERTEX_COSINE && cross(e, f) > 0.0
            });
            if is_corner {
                nodes.push(b);
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// With surface to surface, half the length of the longest slave face at the positions `x`; else 0.
    pub fn half_longest_face(&self, x: &[[f64; 2]]) -> f64 {
        if self.slave_segments.is_none() {
            return 0.0;
        }
        let half = |&[a, b]: &[usize; 2]| length(difference(x[a], x[b])) / 2.0;
        self.slave_faces.iter().map(half).fold(0.0, f64::max)
    }

    /// Adds the exterior faces at the slave nodes, for a slave surface that is made of nodes.
    pub fn with_exterior_faces(mut self, mesh: &Mesh) -> Self {
        let is_slave: HashSet<usize> = self.slaves.iter().copied().collect();
        let faces = mesh
            .exterior_faces()
            .into_iter()
            .flat_map(|face| face.segments(mesh));
        self.slave_faces = faces
            .filter(|face| face.iter().any(|node| is_slave.contains(node)))
            .collect();
        self
    }

    /// Adds the sharp corners of the surfaces at the positions `x`.
    pub fn with_sharp_corners(mut self, x: &[[f64; 2]]) -> Self {
        let tangent = |i: usize| {
            let [a, b] = self.segments[i].map(|node| x[node]);
            project(a, a, b).tangent
        };
        let is_sharp = |i: usize| {
            self.next[i].is_some_and(|j| {
                let (e, f) = (tangent(i), tangent(j));
                cross(e, f) > 0.0 && dot(e, f) < SHARP_TURN_COSINE
            })
        };
        self.sharp_corners = (0..self.segments.len()).map(is_sharp).collect();
        let corners = self.corners.into_iter();
        self.corners = corners
            .map(|corners| Corners {
                surfaces: corners.surfaces.with_sharp_corners(x),
                ..corners
            })
            .collect();
        self
    }
}

/// For every node the length of the shortest of the given faces at it.
pub fn shortest_faces(faces: &[[usize; 2]], x: &[[f64; 2]]) -> HashMap<usize, f64> {
    let mut shortest = HashMap::new();
    for &[a, b] in faces {
        let length = length(difference(x[a], x[b]));
        for node in [a, b] {
            let least = shortest.entry(node).or_insert(length);
            *least = length.min(*least);
        }
    }
    shortest
}

/// Direction of a walk along a chain of segments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// From a segment to the next, which starts at its end.
    Forward,
    /// From a segment to the previous one, which ends at its start.
    Backward,
}

impl ContactSurfaces {
    /// Follows a chain of segments: the segments after `from`, then `None` where an open chain ends.
    ///
    /// The walk ends once the segments left behind, without `from`, have a total length over
    /// `farthest`, and when it is back at `from`.
    pub fn walk(
        &self,
        from: usize,
        along: Along,
        farthest: f64,
        length: impl Fn(usize) -> f64,
    ) -> impl Iterator<Item = Option<usize>> {
        let (mut at, mut between) = (Some(from), 0.0);
        std::iter::from_fn(move || {
            let segment = at?;
            if segment != from {
                between += length(segment);
            }
            if between > farthest {
                return None;
            }
            at = match along {
                Along::Forward => self.next[segment],
                Along::Backward => self.previous[segment],
            };
            (at != Some(from)).then_some(at)
        })
    }
}

/// The contacts of a model; `bodies` is the body of every node.
pub fn contact_surfaces(model: &Model, bodies: &[usize]) -> Vec<ContactSurfaces> {
    if model.contacts.is_empty() {
        return Vec::new();
    }
    let mut has_segments = vec![false; bodies.len()];
    for contact in &model.contacts {
        let segments = model.surfaces[contact.master].segments(&model.mesh);
        segments
            .iter()
            .for_each(|&[a, _]| has_segments[bodies[a]] = true);
    }
    let is_behind = |element: &Element| has_segments[bodies[element.nodes[0]]];
    let interior = Arc::new(Interior::new(&model.mesh, is_behind));
    let joined = Arc::new(JoinedNodes::new(model));
    let rigid = model.rigid_bodies.iter().flat_map(|body| &body.nodes);
    let rigid: HashSet<usize> = rigid.copied().collect();
    let of_contact = |contact: &Contact| {
        let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i]);
        let (disc, x) = (model.disc(contact), &model.mesh.coordinates);
        let own = match disc {
            Some(_) => Vec::new(),
            None => slave.segments(&model.mesh),
        };
        let segments = master.segments(&model.mesh);
        let slaves = model.slave_nodes(contact);
        let mut surfaces = ContactSurfaces::with_joined(slaves, &own, segments, &joined)
            .with_sharp_corners(x)
            .with_interior(Arc::clone(&interior));
        surfaces.disc = disc;
        if let SurfaceKind::Rigid(profile) = &master.kind {
            let arcs = profile.arcs.iter();
            surfaces.arcs = arcs.map(|arc| SurfaceArc::new(profile, arc, x)).collect();
        }
        if let SurfaceKind::Nodes(_) = slave.kind {
            surfaces = surfaces.with_exterior_faces(&model.mesh);
        }
        let both = [slave, master].into_iter();
        let middles = both.flat_map(|surface| surface.middles(&model.mesh));
        let mut shapes = FaceShapes {
            middles: middles.collect(),
            ..FaceShapes::default()
        };
        if let Smoothing::Curved(circles) = &contact.smoothing {
            for circle in circles {
                let segments = model.surfaces[circle.surface].segments(&model.mesh);
                let centres = segments.into_iter().map(|ends| (ends, circle.centre));
                shapes.centres.extend(centres);
            }
            let is_rigid = matches!(master.kind, SurfaceKind::Rigid(_));
            surfaces = surfaces.with_bulges(x, &shapes, is_rigid);
        }
        match contact.formulation {
            ContactFormulation::SurfaceToSurface => {
                let mut surfaces = surfaces.from_surface_to_surface(&model.mesh, shapes.middles);
                for corners in &mut surfaces.corners {
                    let nodes = corners.surfaces.slaves.iter();
                    corners.are_rigid = nodes.map(|node| rigid.contains(node)).collect();
                }
                surfaces
            }
            ContactFormulation::NodeToSegment => surfaces,
        }
    };
    model.contacts.iter().map(of_contact).collect()
}
