//! Checks of bodies of revolution: all elements must be rings and lie on one side of the axis, and supports must hold
//! nodes of the axis on the axis. See docs/theory/elements.md, Bodies of revolution.

use std::collections::BTreeSet;

use crate::diagnostics::{Code, Span};
use crate::model::{Mesh, Model};
use crate::reader::context::Context;
use crate::reader::mesh_index::MeshIndex;

/// Reports plane elements in a model with bodies of revolution, and nodes beyond the axis.
pub(crate) fn half_plane(mesh_index: &MeshIndex, cx: &mut Context) {
    let elements = &mesh_index.mesh.elements;
    let is_ring = |element: usize| elements[element].element_type.is_ring();
    let rings = (0..elements.len()).filter(|&element| is_ring(element));
    let Some(ring) = rings.clone().next() else {
        return;
    };
    if let Some(plane) = (0..elements.len()).find(|&element| !is_ring(element)) {
        let name = |element: usize| {
            let element_type = elements[element].element_type;
            format!("{} is {element_type}", mesh_index.element_name(element))
        };
        let message = format!("element {}, and element {}", name(plane), name(ring));
        cx.error(Code::Revolution, mesh_index.places[plane], message)
            .help(
                "a model is plane or axisymmetric: write CAX for all of its elements, or for none",
            );
    }
    let beyond = |&element: &usize| {
        let mut nodes = elements[element].nodes.iter().copied();
        nodes.find(|&node| mesh_index.mesh.coordinates[node][0] < 0.0)
    };
    let found = rings.filter_map(|element| Some((element, beyond(&element)?)));
    if let Some((element, node)) = found.into_iter().next() {
        let message = format!(
            "node {} of element {} lies beyond the axis of revolution, x = 0",
            mesh_index.node_name(node),
            mesh_index.element_name(element)
        );
        cx.error(Code::Revolution, mesh_index.places[element], message)
            .help("x is the distance from the axis, y the place along it");
    }
}

/// Warns about nodes on the axis that may leave the axis in a step.
pub(crate) fn axis(model: &Model, places: &[Span], cx: &mut Context) {
    let mesh = &model.mesh;
    if !mesh.is_axisymmetric() {
        return;
    }
    for (number, step) in model.steps.iter().enumerate() {
        let supports = step.supports.iter().map(|support| support.dof);
        let ruled = model.equations.iter().map(|equation| equation.dof);
        let mut held: BTreeSet<usize> = supports.chain(ruled).collect();
        // rigid bodies do not turn here: their nodes are held with the reference node
        for body in &model.rigid_bodies {
            if held.contains(&(2 * body.reference)) {
                held.extend(body.nodes.iter().map(|node| 2 * node));
            }
        }
        let free = free_on_axis(mesh, &held);
        let Some(&(element, node)) = free.first() else {
            continue;
        };
        let name = model.node_name(node);
        let message = match free.len() {
            1 => format!(
                "node {name} on the axis of revolution is free across it in step {}",
                number + 1
            ),
            n => format!(
                "{n} nodes on the axis of revolution are free across it in step {}, the first is {name}",
                number + 1
            ),
        };
        cx.warning(Code::AxisNode, places[element], message)
            .help("hold them in direction 1 with *BOUNDARY: a hole opens there, or the body passes the axis");
        return;
    }
}

/// Nodes on the axis that are not in the list `held`, each with an element that has the node.
fn free_on_axis(mesh: &Mesh, held: &BTreeSet<usize>) -> Vec<(usize, usize)> {
    let mut seen = BTreeSet::new();
    let elements = mesh.elements.iter().enumerate();
    let nodes = elements.flat_map(|(index, e)| e.nodes.iter().map(move |&node| (index, node)));
    let is_free = |&(_, node): &(usize, usize)| {
        mesh.coordinates[node][0] == 0.0 && !held.contains(&(2 * node)) && seen.insert(node)
    };
    nodes.filter(is_free).collect()
}
