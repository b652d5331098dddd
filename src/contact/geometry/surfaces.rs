//! Contact surfaces: slave nodes and oriented master segments, with their neighbours and sharp
//! corners. Section 10 of docs/theory.md.

use crate::contact::tolerances::SHARP_TURN_COSINE;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::interior::Interior;
use super::projection::project;
use crate::model::{Contact, Element, Friction, Mesh, Model, SurfaceKind};
use crate::vectors::{cross, dot};

/// The two sides of a contact of the model, as nodes and segments.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurfaces {
    /// Slave nodes.
    pub slaves: Vec<usize>,
    /// Faces of the slave surface; of a surface that is made of nodes the exterior faces at them.
    pub slave_faces: Vec<[usize; 2]>,
    /// For every slave node the nodes before and after it on its own surface, if it has both.
    pub adjacent: Vec<Option<[usize; 2]>>,
    /// Master segments [a, b] with the body on the left of the direction from a to b.
    pub segments: Vec<[usize; 2]>,
    /// For every segment the one that starts where it ends, if any.
    pub next: Vec<Option<usize>>,
    /// For every segment the one that ends where it starts, if any.
    pub previous: Vec<Option<usize>>,
    /// For every segment whether the body has a sharp corner at its end b in the reference
    /// configuration: an angle below 120 degrees. Folded legs of any other corner are a closed
    /// concave corner.
    pub sharp_corners: Vec<bool>,
    /// Coulomb friction.
    pub friction: Friction,
    /// Interior of the bodies; behind a segment without an element everything is inside.
    pub interior: Arc<Interior>,
}

impl ContactSurfaces {
    /// Slave nodes against master segments; `own` are the segments of the slave surface, none if it
    /// is made of nodes.
    pub fn new(
        slaves: Vec<usize>,
        own: &[[usize; 2]],
        segments: Vec<[usize; 2]>,
        friction: Friction,
    ) -> Self {
        // node at the other end of the segment that starts or ends at a node
        let following: HashMap<usize, usize> = own.iter().map(|&[a, b]| (a, b)).collect();
        let preceding: HashMap<usize, usize> = own.iter().map(|&[a, b]| (b, a)).collect();
        let neighbours = |slave: &usize| Some([*preceding.get(slave)?, *following.get(slave)?]);
        // segment that starts or ends at a node
        let numbered = || segments.iter().enumerate();
        let starting: HashMap<usize, usize> = numbered().map(|(i, &[a, _])| (a, i)).collect();
        let ending: HashMap<usize, usize> = numbered().map(|(i, &[_, b])| (b, i)).collect();
        let at = |of: &HashMap<usize, usize>, node: usize| of.get(&node).copied();
        ContactSurfaces {
            adjacent: slaves.iter().map(neighbours).collect(),
            slave_faces: own.to_vec(),
            next: segments.iter().map(|&[_, b]| at(&starting, b)).collect(),
            previous: segments.iter().map(|&[a, _]| at(&ending, a)).collect(),
            sharp_corners: vec![false; segments.len()],
            slaves,
            segments,
            friction,
            interior: Arc::default(),
        }
    }

    /// With the interior of the bodies behind the segments.
    pub fn with_interior(mut self, interior: Arc<Interior>) -> Self {
        self.interior = interior;
        self
    }

    /// With the exterior faces at the slave nodes, for a slave surface that is made of nodes.
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

    /// With the sharp corners of the surfaces at the positions `x`.
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
        self
    }
}

/// Direction along a chain of segments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// From a segment to the one that starts where it ends.
    Forward,
    /// From a segment to the one that ends where it starts.
    Backward,
}

impl ContactSurfaces {
    /// Follows a chain of segments: the segments after `from`, then `None` where an open chain ends.
    ///
    /// The walk ends once the segments left behind, `from` not counted, are longer in sum than
    /// `farthest`, and where it is back at `from`.
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

/// The contacts of a model; `bodies` holds the body of every node.
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
    let of_contact = |contact: &Contact| {
        let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i]);
        let mut slaves = slave.nodes(&model.mesh);
        slaves.retain(|node| contact.left_out.binary_search(node).is_err());
        let surfaces = ContactSurfaces::new(
            slaves,
            &slave.segments(&model.mesh),
            master.segments(&model.mesh),
            contact.interaction.friction,
        )
        .with_sharp_corners(&model.mesh.coordinates)
        .with_interior(Arc::clone(&interior));
        match slave.kind {
            SurfaceKind::Nodes(_) => surfaces.with_exterior_faces(&model.mesh),
            _ => surfaces,
        }
    };
    model.contacts.iter().map(of_contact).collect()
}
