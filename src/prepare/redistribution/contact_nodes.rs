//! Nodes of contact surfaces whose mass may go to the nodes behind them. Section 2 of docs/theory.md,
//! Redistributed mass.

use std::collections::HashMap;
use std::f64::consts::TAU;

use crate::contact::ContactSurfaces;
use crate::model::{Face, Mesh, Model};
use crate::vectors::{angle, difference, polygon_area};

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
        // the area within a closed edge, negative round a hole: the body is on the left
        let area = polygon_area(edge.iter().map(|&[a, _]| x(a)));
        for &[a, _] in &edge {
            outer[a] = Some(area > 0.0 && outer[a] != Some(false));
        }
    }
    outer
}

/// Closed edges of the bodies, as their faces in order. Where elements meet in a node only, the edge goes on
/// along the element that it has come by.
fn edges(mesh: &Mesh) -> Vec<Vec<[usize; 2]>> {
    let segments = |face: &Face| face.segments(mesh);
    let faces: Vec<[usize; 2]> = mesh.exterior_faces().iter().flat_map(segments).collect();
    let mut starting: HashMap<usize, Vec<usize>> = HashMap::new();
    for (face, &[a, _]) in faces.iter().enumerate() {
        starting.entry(a).or_default().push(face);
    }
    let mut is_left = vec![true; faces.len()];
    let mut edges = Vec::new();
    for first in 0..faces.len() {
        let mut edge = Vec::new();
        let mut next = Some(first).filter(|&face| is_left[face]);
        while let Some(face) = next {
            is_left[face] = false;
            let [a, b] = faces[face];
            edge.push([a, b]);
            // of the faces that go on from b the first clockwise from the way back
            let arm = |node: usize| difference(mesh.coordinates[b], mesh.coordinates[node]);
            let clockwise = |&face: &usize| match angle(arm(faces[face][1]), arm(a)) {
                turn if turn > 0.0 => turn,
                turn => turn + TAU,
            };
            let going_on = starting.get(&b).into_iter().flatten().copied();
            let nearest = going_on.min_by(|p, q| clockwise(p).total_cmp(&clockwise(q)));
            next = nearest.filter(|&face| is_left[face]);
        }
        if !edge.is_empty() {
            edges.push(edge);
        }
    }
    edges
}
