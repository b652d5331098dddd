//! `*SURFACE`.

use super::mesh_index::MeshIndex;
use super::outline::Outline;
use super::profile::Profile;
use super::sets::Sets;
use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic, Span, closest};
use crate::model::{ElementsAtNodes, Face, Mesh, Surface, SurfaceKind};
use crate::reader::context::Context;
use crate::reader::names::Names;
use std::collections::{BTreeSet, HashSet};

/// All surfaces.
pub(crate) struct Surfaces {
    /// Their names.
    pub names: Names,
    /// Surfaces in the order of their names.
    pub all: Vec<Surface>,
    /// Rigid surfaces and their places.
    pub rigid: Vec<(usize, Span)>,
    /// Points of the rigid surfaces: nodes that follow those of the mesh.
    pub rigid_points: Vec<[f64; 2]>,
}

/// Reads all surfaces.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Surfaces {
    let mut surfaces = Surfaces {
        names: Names::of_parts("surface"),
        all: Vec::new(),
        rigid: Vec::new(),
        rigid_points: Vec::new(),
    };
    for card in outline.model_cards("SURFACE") {
        let Some(name) = surfaces.names.new_name(card, cx) else {
            continue;
        };
        let errors = cx.errors();
        let kind = match card.choice("TYPE") {
            Some("NODE") => SurfaceKind::Nodes(nodes(card, mesh_index, sets, cx)),
            Some("SEGMENTS") => {
                let first = mesh_index.mesh.node_count() + surfaces.rigid_points.len();
                let profile = Profile::read(card, cx);
                surfaces.rigid_points.extend(&profile.points);
                SurfaceKind::Rigid(profile.segments(first))
            }
            _ => SurfaceKind::Faces(faces(card, mesh_index, sets, at_nodes, cx)),
        };
        if card.faulty || cx.errors() > errors {
            surfaces.names.spoil(&name);
            continue;
        }
        report_empty(&kind, card, cx);
        let typed = name.typed.clone();
        if let SurfaceKind::Rigid(_) = kind {
            surfaces
                .rigid
                .push((surfaces.all.len(), card.span_of("NAME")));
        }
        surfaces.names.define(name);
        surfaces.all.push(Surface { name: typed, kind });
    }
    surfaces
}

fn report_empty(kind: &SurfaceKind, card: &Card, cx: &mut Context) {
    let empty = match kind {
        SurfaceKind::Faces(faces) => faces.is_empty(),
        SurfaceKind::Nodes(nodes) => nodes.is_empty(),
        SurfaceKind::Rigid(segments) => segments.is_empty(),
    };
    if empty && !card.rows.is_empty() && !cx.d.has_errors() && !cx.deck.incomplete {
        cx.error(
            Code::EmptySurface,
            card.span_of("NAME"),
            "this surface has no members",
        );
    }
}

/// `node or node set[, area]`
fn nodes(card: &Card, mesh_index: &MeshIndex, sets: &Sets, cx: &mut Context) -> Vec<usize> {
    let mut nodes = Vec::new();
    let mut seen = HashSet::new();
    for row in card.rows.iter() {
        row.at_most(2, cx.d);
        let Some(field) = row.required(0, "a node or node set", cx.d) else {
            continue;
        };
        let area = row.real_or(1, 1.0, cx.d);
        if area.is_some_and(|area| area != 1.0) {
            let help = "contact forces of nodes need no area";
            row.without_effect(1, "this area has no effect", help, cx.d);
        }
        let found = sets.nodes_of(field, mesh_index, cx);
        nodes.extend(found.into_iter().filter(|&node| seen.insert(node)));
    }
    nodes
}

/// `element or element set[, face]`
fn faces(
    card: &Card,
    mesh_index: &MeshIndex,
    sets: &Sets,
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Vec<Face> {
    let mut faces = Vec::new();
    let mut seen = BTreeSet::new();
    for row in card.rows.iter() {
        row.at_most(2, cx.d);
        let Some(field) = row.required(0, "an element or element set", cx.d) else {
            continue;
        };
        let found = match row.get(1) {
            Some(face) => {
                let elements = sets.elements_of(field, mesh_index, cx);
                named_faces(&elements, face, mesh_index, cx)
            }
            None => unnamed_faces(field, (mesh_index, sets), at_nodes, cx),
        };
        report_interior(&found, at_nodes, row, mesh_index, cx);
        let before = faces.len();
        faces.extend(found.iter().copied().filter(|&face| seen.insert(face)));
        if faces.len() - before < found.len() {
            let message = "faces of this row are in the surface already";
            cx.warning(Code::RepeatedFace, row.span(), message);
        }
    }
    faces
}

/// Exterior sides of the elements that a field names, and the faces that its line elements name.
fn unnamed_faces(
    field: Text,
    (mesh_index, sets): (&MeshIndex, &Sets),
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Vec<Face> {
    let (elements, lines) = sets.elements_and_lines_of(field, mesh_index, cx);
    let mut faces = exterior_faces(&elements, at_nodes, &mesh_index.mesh);
    let known: HashSet<Face> = faces.iter().copied().collect();
    faces.extend(lines.into_iter().filter(|face| !known.contains(face)));
    faces
}

/// Side `face` of each element.
fn named_faces(
    elements: &[usize],
    face: Text,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) -> Vec<Face> {
    let Some(side) = side_number(face, cx) else {
        return Vec::new();
    };
    let mut faces = Vec::new();
    for &element in elements {
        match side < side_count(&mesh_index.mesh, element) {
            true => faces.push(Face { element, side }),
            false => return no_such_face(element, face, mesh_index, cx),
        }
    }
    faces
}

fn no_such_face(element: usize, face: Text, mesh_index: &MeshIndex, cx: &mut Context) -> Vec<Face> {
    let label = mesh_index.element_name(element);
    let sides = side_count(&mesh_index.mesh, element);
    let message = format!(
        "element {label} has faces S1 to S{sides}, not {}",
        face.text
    );
    cx.error(Code::NoSuchFace, face.span, message);
    Vec::new()
}

/// Side, from 0, of a face name S1 to S4.
fn side_number(face: Text, cx: &mut Context) -> Option<usize> {
    match face.name_key().as_str() {
        "S1" => Some(0),
        "S2" => Some(1),
        "S3" => Some(2),
        "S4" => Some(3),
        other => {
            let message = format!("unknown face {}", face.text);
            let error = Diagnostic::error(Code::NoSuchFace, face.span, message);
            let meant = closest(other, ["S1", "S2", "S3", "S4"]);
            let help = "the faces of plane elements are S1, S2, S3 and S4";
            cx.d.push(error.suggest(meant).help(help));
            None
        }
    }
}

/// Number of sides of an element.
pub(crate) fn side_count(mesh: &Mesh, element: usize) -> usize {
    mesh.elements.get(element).map_or(0, |e| e.sides().len())
}

/// Exterior sides of these elements, in order.
fn exterior_faces(elements: &[usize], at_nodes: &ElementsAtNodes, mesh: &Mesh) -> Vec<Face> {
    let sides =
        |&element: &usize| (0..side_count(mesh, element)).map(move |side| Face { element, side });
    let all = elements.iter().flat_map(sides);
    all.filter(|&face| !at_nodes.share(face, mesh)).collect()
}

/// Warns about faces between two elements.
fn report_interior(
    faces: &[Face],
    at_nodes: &ElementsAtNodes,
    row: Row,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    let mesh = &mesh_index.mesh;
    let interior = || faces.iter().filter(|&&face| at_nodes.share(face, mesh));
    let Some(first) = interior().next().filter(|_| !cx.d.has_errors()) else {
        return;
    };
    let label = mesh_index.element_name(first.element);
    let side = first.side + 1;
    let message = match interior().count() {
        1 => format!("face S{side} of element {label} lies between two elements"),
        n => {
            format!("{n} of these faces lie between two elements, the first is S{side} of {label}")
        }
    };
    cx.warning(Code::InteriorFace, row.span(), message);
}

/// A surface with its index and the place of its name.
pub(crate) type Found<'a> = (usize, &'a Surface, Span);

/// The surface that a field names.
pub(crate) fn find<'a>(surfaces: &'a Surfaces, field: Text, cx: &mut Context) -> Option<Found<'a>> {
    let index = surfaces.names.find(field, cx)?;
    Some((index, surfaces.all.get(index)?, field.span))
}
