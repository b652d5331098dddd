//! Contact surfaces: element faces, nodes or rigid segments. Segments run from a to b with the body
//! on the left, as in docs/theory.md, section 3.

use super::mesh::{Face, Mesh};

/// Name of the surface of general contact: all faces that belong to one element only.
pub const ALL_EXTERIOR: &str = "ALL_EXTERIOR";

/// A named surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name as typed in the deck.
    pub name: String,
    /// Its faces, nodes or rigid segments.
    pub kind: SurfaceKind,
}

/// Element faces, nodes or rigid segments.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceKind {
    /// Faces of elements: can be slave or master.
    Faces(Vec<Face>),
    /// Nodes: can be slave only.
    Nodes(Vec<usize>),
    /// Segments [a, b] between nodes without element, the rigid body on the left of the direction
    /// from a to b: can be master only.
    Rigid(Vec<[usize; 2]>),
}

impl Surface {
    /// Segments [a, b] in order, the body on the left; empty for a node surface.
    pub fn segments(&self, mesh: &Mesh) -> Vec<[usize; 2]> {
        match &self.kind {
            SurfaceKind::Faces(faces) => faces.iter().map(|face| face.nodes(mesh)).collect(),
            SurfaceKind::Nodes(_) => Vec::new(),
            SurfaceKind::Rigid(segments) => segments.clone(),
        }
    }

    /// Nodes of the surface in order of first appearance, without duplicates.
    pub fn nodes(&self, mesh: &Mesh) -> Vec<usize> {
        let all: Vec<usize> = match &self.kind {
            SurfaceKind::Faces(faces) => faces.iter().flat_map(|f| f.nodes(mesh)).collect(),
            SurfaceKind::Nodes(nodes) => nodes.clone(),
            SurfaceKind::Rigid(segments) => segments.as_flattened().to_vec(),
        };
        let mut seen = vec![false; mesh.node_count()];
        all.into_iter()
            .filter(|&n| !std::mem::replace(&mut seen[n], true))
            .collect()
    }
}
