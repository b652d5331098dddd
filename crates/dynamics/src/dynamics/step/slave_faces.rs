//! Faces of the slave surfaces, and the area of a slave node on these faces. See docs/theory/impacts.md, Ledger.

use std::collections::BTreeSet;

use crate::model::{ContactFormulation, Face, Model, Segment, SurfaceKind, Thickness};

/// A segment of a face on which a slave node has a part of the pressure.
struct SlaveFace {
    node: usize,
    segment: Segment,
    thickness: Thickness,
    /// Place along the segment, from the node (0) to the other end (1), where the distance from the axis is evaluated
    /// for the node's part.
    place: f64,
    /// Part of the segment that belongs to the node.
    part: f64,
}

/// The slave nodes of all contacts with their faces.
pub(crate) struct SlaveFaces {
    /// Marks for the nodes, `N` entries: 0 at slave nodes and at master nodes of contact from surface to surface, NaN
    /// at other nodes.
    pub start: Vec<f64>,
    /// The faces of all nodes, with increasing nodes.
    faces: Vec<SlaveFace>,
}

impl SlaveFaces {
    /// Faces of the slave surfaces; slave nodes without a slave face get the exterior faces of their elements. Master
    /// nodes of contact from surface to surface that are not slave nodes get the faces of the master surfaces.
    pub fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        let (mut start, mut own) = (vec![f64::NAN; mesh.node_count()], BTreeSet::new());
        for contact in &model.contacts {
            let slave = &model.surfaces[contact.slave];
            if let SurfaceKind::Faces(faces) = &slave.kind {
                own.extend(faces.iter().copied());
            }
            for node in slave.nodes(mesh) {
                start[node] = 0.0;
            }
        }
        let mut is_bare: Vec<bool> = start.iter().map(|start| !start.is_nan()).collect();
        for node in own.iter().flat_map(|face| face.nodes(mesh)) {
            is_bare[node] = false;
        }
        let slave_faces = |face: &Face, counts: &dyn Fn(usize) -> bool| -> Vec<SlaveFace> {
            let thickness = model.thickness(&mesh.elements[face.element]);
            let side = face.of(mesh);
            let (ends, is_linear) = (side.ends(), side.nodes().len() == 2);
            let part = |node: usize| match (is_linear, ends.contains(&node)) {
                (true, _) => 0.5,
                (false, true) => 1.0 / 3.0,
                (false, false) => 2.0 / 3.0,
            };
            let at_nodes = side.segments().flat_map(|segment| {
                segment.map(|node| SlaveFace {
                    node,
                    segment,
                    thickness,
                    place: if is_linear { 1.0 / 3.0 } else { 0.0 },
                    part: part(node),
                })
            });
            at_nodes.filter(|face| counts(face.node)).collect()
        };
        let mut faces: Vec<SlaveFace> = (own.iter())
            .flat_map(|face| slave_faces(face, &|_| true))
            .collect();
        if is_bare.contains(&true) {
            let exterior = mesh.exterior_faces().into_iter();
            faces.extend(exterior.flat_map(|face| slave_faces(&face, &|node| is_bare[node])));
        }
        let is_slave: Vec<bool> = start.iter().map(|start| !start.is_nan()).collect();
        let mut of_masters = BTreeSet::new();
        for contact in &model.contacts {
            let master = &model.surfaces[contact.master].kind;
            if let (ContactFormulation::SurfaceToSurface, SurfaceKind::Faces(faces)) =
                (contact.formulation, master)
            {
                of_masters.extend(faces.iter().copied());
            }
        }
        let of_masters =
            (of_masters.iter()).flat_map(|face| slave_faces(face, &|node| !is_slave[node]));
        for face in of_masters {
            start[face.node] = 0.0;
            faces.push(face);
        }
        faces.sort_by_key(|face| face.node);
        SlaveFaces { start, faces }
    }

    /// Area of a node for a force N on the node, at the given positions of nodes.
    ///
    /// ```text
    /// A = sum over its segments max(-n.N/|N|, 0) t l w    eq. (9.8)
    /// ```
    ///
    /// Here n, l and t are the outward normal, current length and thickness of a segment, and w is the node's part of
    /// the segment: 1/2, or on a side with a mid-side node 1/3 at a corner and 2/3 at the mid-side node. The area is
    /// defined so that the nodal forces of a uniform pressure give back this pressure. In a body of revolution the
    /// thickness t is 2 pi r, evaluated at a third of the segment from the node, eq. (2.35). On a side with a mid-side
    /// node the thickness is evaluated at the node itself.
    pub fn area(&self, node: usize, force: [f64; 2], at: impl Fn(usize) -> [f64; 2]) -> f64 {
        let size = force[0].hypot(force[1]);
        // n l = (e_y, -e_x): on the right of the direction from a to b
        self.sum(node, at, |e| {
            (force[1] * e[0] - force[0] * e[1]).max(0.0) / size
        })
    }

    /// Area of a node, whatever the direction of its faces.
    pub fn whole_area(&self, node: usize, at: impl Fn(usize) -> [f64; 2]) -> f64 {
        self.sum(node, at, |e| e[0].hypot(e[1]))
    }

    /// Whether a node has faces.
    pub fn has_faces(&self, node: usize) -> bool {
        self.of(node).next().is_some()
    }

    fn of(&self, node: usize) -> impl Iterator<Item = &SlaveFace> {
        let from = self.faces.partition_point(|face| face.node < node);
        let all = self.faces[from..].iter();
        all.take_while(move |face| face.node == node)
    }

    /// Sum of t w l over the segments of a node, where `length` gives l for the vector from one end to the other.
    fn sum(
        &self,
        node: usize,
        at: impl Fn(usize) -> [f64; 2],
        length: impl Fn([f64; 2]) -> f64,
    ) -> f64 {
        let mut area = 0.0;
        for face in self.of(node) {
            let [a, b] = face.segment.map(&at);
            let length = length([b[0] - a[0], b[1] - a[1]]);
            if length > 0.0 {
                let (own, other) = if face.segment[0] == node {
                    (a, b)
                } else {
                    (b, a)
                };
                let radius = own[0] + (other[0] - own[0]) * face.place;
                area += face.thickness.at(radius) * length * face.part;
            }
        }
        area
    }
}
