//! Where the raised node crosses the segment, the unraised node crosses the face. See docs/theory/geometry.md, From
//! surface to surface.

use super::bulge::Bulge;
use super::lists::{Recycled, entries};
use super::positions::Positions;
use super::projection::between;
use crate::vectors::{difference, length};

/// Slave faces and slave nodes of a contact from surface to surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SlaveSegments {
    /// Numbers of the slave nodes at the ends of every face; `None` for a node that takes no part
    /// in the contact.
    pub ends: Vec<[Option<usize>; 2]>,
    /// For every slave node the faces on its sides, each with the end (0 or 1) at which the node lies. A slave node at
    /// a corner has two lists of faces, one for each side.
    pub at_nodes: Vec<Vec<Vec<[usize; 2]>>>,
    /// Number of the run of every master segment; a run is a chain of segments without a corner.
    pub runs: Vec<usize>,
    /// Rank of every segment of a surface that touches itself: of two faces the face with the lower rank is the slave.
    pub ranks: Option<Vec<usize>>,
    /// Ends of every slave face, followed by the ends of every master segment.
    pub vertices: Vec<[Vertex; 2]>,
    /// Bulges, for points of faces, of all slave faces and then of all master segments.
    pub bulges: Vec<Bulge>,
    /// Whether the bodies are bodies of revolution, so faces are rings.
    pub are_rings: bool,
}

/// A slave face or a master segment in one configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Positions of the ends.
    pub ends: [[f64; 2]; 2],
    /// Unit vector from the first end to the second.
    pub tangent: [f64; 2],
}

entries!(Edge);

impl SlaveSegments {
    /// Edges of all slave faces, then of all master segments, at some positions.
    pub fn edges(&self, positions: Positions) -> Recycled<Edge> {
        let edge = |vertices: &[Vertex; 2]| {
            let ends = vertices.map(|vertex| vertex.place(|node| positions.of(node)));
            let e = difference(ends[0], ends[1]);
            let length = length(e);
            Edge {
                ends,
                tangent: e.map(|e| e / length),
            }
        };
        self.vertices.iter().map(edge).collect()
    }

    /// Ends of a slave face.
    pub fn face(&self, face: usize) -> [Vertex; 2] {
        self.vertices[face]
    }

    /// Ends of a master segment.
    pub fn segment(&self, segment: usize) -> [Vertex; 2] {
        self.vertices[self.ends.len() + segment]
    }

    /// Bulge of a slave face.
    pub fn face_bulge(&self, face: usize) -> &Bulge {
        &self.bulges[face]
    }

    /// Bulge of a master segment.
    pub fn segment_bulge(&self, segment: usize) -> &Bulge {
        &self.bulges[self.ends.len() + segment]
    }

    /// The edge of a slave face.
    pub fn edge_of_face<'e>(&self, edges: &'e [Edge], face: usize) -> &'e Edge {
        &edges[face]
    }

    /// The edge of a master segment.
    pub fn edge_of_segment<'e>(&self, edges: &'e [Edge], segment: usize) -> &'e Edge {
        &edges[self.ends.len() + segment]
    }

    /// Weight of a part of a face in the reference configuration: its length, times the radius at eta if the face is a
    /// ring.
    pub fn reference_weight(&self, face: usize, positions: Positions, eta: f64, part: f64) -> f64 {
        let x = positions.reference();
        let [a, b] = self.face(face).map(|vertex| vertex.place(|node| x[node]));
        let radius = match self.are_rings {
            true => between(a, b, eta)[0],
            false => 1.0,
        };
        length(difference(a, b)) * part * radius
    }
}

/// A vertex of the straight edges of the surfaces: a node, or the point x_v that stands for a mid-side node. With x_v a
/// pressure that is linear along the side gives the right forces on all nodes of the side.
///
/// ```text
/// x_v = 4/3 x_m - (x_a + x_b)/6    eq. (3.21)
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Vertex {
    /// The node.
    pub node: usize,
    /// Corners of the side if the node is a mid-side node.
    pub corners: Option<[usize; 2]>,
}

impl Vertex {
    /// Calls `take` with each node of the vertex and the node's part in its position.
    #[inline]
    pub fn each_share(self, mut take: impl FnMut(usize, f64)) {
        match self.corners {
            None => take(self.node, 1.0),
            Some([a, b]) => {
                take(self.node, 4.0 / 3.0);
                take(a, -1.0 / 6.0);
                take(b, -1.0 / 6.0);
            }
        }
    }

    /// Its nodes.
    pub fn nodes(self) -> impl Iterator<Item = usize> {
        std::iter::once(self.node).chain(self.corners.into_iter().flatten())
    }

    /// Its position.
    #[inline]
    pub fn place(self, at: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let x = at(self.node);
        match self.corners {
            None => x,
            Some(corners) => {
                let [a, b] = corners.map(at);
                [0, 1].map(|i| 4.0 / 3.0 * x[i] - (a[i] + b[i]) / 6.0)
            }
        }
    }
}
