//! Line elements: each names the side of a plane element with the same nodes, as the boundary curves
//! do that a mesh generator writes. They have no stiffness and no section.

use super::mesh_index::MeshIndex;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Face, Mesh, Nodes, Plane};
use crate::reader::context::Context;
use crate::reader::names::Labelled;
use std::collections::HashMap;

/// A line element as the deck gives it.
pub(super) struct RawLine {
    pub label: u64,
    pub nodes: Nodes,
    pub span: Span,
}

/// Numbers the line elements after the plane ones; leaves out those that are no side. `used` tells
/// which nodes are not left out.
pub(super) fn add(lines: &[RawLine], used: &[bool], mesh_index: &mut MeshIndex, cx: &mut Context) {
    if lines.is_empty() {
        return;
    }
    let faces = faces_by_nodes(&mesh_index.mesh);
    let mut strays = Vec::new();
    for line in lines {
        let mut nodes = line.nodes.clone();
        nodes.retain(|node| used[*node]);
        nodes.sort_unstable();
        let labelled = match faces.get(&nodes) {
            Some(&face) => {
                mesh_index.lines.push(face);
                Labelled::new(mesh_index.mesh.elements.len() + mesh_index.lines.len() - 1)
            }
            None => {
                strays.push(line);
                Labelled::LEFT_OUT
            }
        };
        mesh_index.elements.insert(line.label, labelled);
    }
    if !cx.d.has_errors() {
        report_strays(&strays, cx);
        report_plane_stress(mesh_index, cx);
    }
}

/// A face for the nodes of every side, in increasing order; the first of two elements.
fn faces_by_nodes(mesh: &Mesh) -> HashMap<Nodes, Face> {
    let mut faces = HashMap::new();
    for (element, e) in mesh.elements.iter().enumerate() {
        for (side, nodes) in e.sides().enumerate() {
            let mut nodes = Nodes::from_slice(&nodes);
            nodes.sort_unstable();
            faces.entry(nodes).or_insert(Face { element, side });
        }
    }
    faces
}

fn report_strays(strays: &[&RawLine], cx: &mut Context) {
    let Some(first) = strays.first() else { return };
    let label = cx.named(first.label);
    let message = match strays.len() {
        1 => format!("line element {label} is no side of a plane element"),
        n => format!("{n} line elements are no sides of plane elements, the first is {label}"),
    };
    let warning = Diagnostic::warning(Code::LineElement, first.span, message);
    cx.d.push(warning.help("left out: line elements only name sides of plane elements"));
}

/// Notes that a mesh generator's triangles and quadrilaterals are in plane stress.
fn report_plane_stress(mesh_index: &MeshIndex, cx: &mut Context) {
    let mut elements = mesh_index.mesh.elements.iter();
    let found = elements.position(|element| element.element_type.plane == Plane::Stress);
    if let Some(index) = found {
        let name = mesh_index.mesh.elements[index].element_type.name();
        let span = mesh_index.places.get(index);
        let message = format!("{name} elements are in plane stress");
        let note = Diagnostic::note(Code::LineElement, span, message);
        cx.d.push(note.help(
            "mesh generators write CPS3 and CPS4 for every mesh: write CPE3 and CPE4 for plane strain",
        ));
    }
}
