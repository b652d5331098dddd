//! Nodes of contact surfaces whose mass may go to the nodes behind them. Section 2 of docs/theory.md,
//! Redistributed mass.

use std::collections::HashMap;

use crate::contact::ContactSurfaces;
use crate::model::{Face, Mesh, Model};
use crate::vectors::cross;

/// Nodes of the contact surfaces of deformable bodies, increasing, each with whether it may be without
/// mass: nodes at the edge of a hole may not, nor those that equations tie.
pub(super) fn contact_nodes(model: &Model, contacts: &[ContactSurfaces]) -> Vec<(usize, bool)> {
    let mesh = &model.mesh;
    let mut may = outer_nodes(mesh);
    for dof in model.equations.iter().flat_map(|equation| equation.dofs()) {
        if let Some(may) = &mut may[dof / 2] {
            *may = false;
        }
    }
    let of_contact = |contact: &ContactSurfaces| {
        let masters = contact.segments.as_flattened().to_vec();
        contact
            .slaves
            .iter()
            .copied()
            .chain(masters)
            .collect::<Vec<_>>()
    };
    let mut nodes: Vec<usize> = contacts.iter().flat_map(of_contact).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let on_body = |node: usize| Some((node, may[node]?));
    nodes.into_iter().filter_map(on_body).collect()
}

/// Whether a node of an exterior face is only on outer edges of bodies; none inside and without elements.
fn outer_nodes(mesh: &Mesh) -> Vec<Option<bool>> {
    let mut outer = vec![None; mesh.node_count()];
    for edge in edges(mesh) {
        let x = |node: usize| mesh.coordinates[node];
        // twice the area within a closed edge, negative round a hole: the body is on the left
        let area: f64 = edge.iter().map(|&[a, b]| cross(x(a), x(b))).sum();
        for &[a, _] in &edge {
            outer[a] = Some(area > 0.0 && outer[a] != Some(false));
        }
    }
    outer
}

/// Closed edges of the bodies, as their faces in order.
fn edges(mesh: &Mesh) -> Vec<Vec<[usize; 2]>> {
    let sides = |face: &Face| face.nodes(mesh);
    let faces: Vec<[usize; 2]> = mesh.exterior_faces().iter().map(sides).collect();
    let mut starting: HashMap<usize, Vec<usize>> = HashMap::new();
    for (face, &[a, _]) in faces.iter().enumerate().rev() {
        starting.entry(a).or_default().push(face);
    }
    let mut edges = Vec::new();
    for &[first, _] in &faces {
        let mut edge = Vec::new();
        let mut at = first;
        while let Some(face) = starting.get_mut(&at).and_then(Vec::pop) {
            edge.push(faces[face]);
            at = faces[face][1];
        }
        if !edge.is_empty() {
            edges.push(edge);
        }
    }
    edges
}
