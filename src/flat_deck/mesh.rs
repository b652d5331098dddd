//! Nodes, elements, sets and surfaces.

use super::lines::{Lines, name, named, number, set};
use crate::model::{ALL_EXTERIOR, Contact, Element, Face, Mesh, Model, Set, SurfaceKind};

/// Writes nodes, elements, sets and surfaces.
pub(super) fn write(model: &Model, lines: &mut Lines) {
    let mesh = &model.mesh;
    nodes(model, lines);
    for block in mesh
        .elements
        .chunk_by(|a, b| a.element_type.name() == b.element_type.name())
    {
        elements(block, mesh, lines);
    }
    let node_label = |&node: &usize| mesh.node_labels[node];
    let element_label = |&element: &usize| mesh.elements[element].label;
    sets("NSET", &model.sets.nodes, node_label, lines);
    sets("ELSET", &model.sets.elements, element_label, lines);
    surfaces(model, lines);
}

/// Index of the first node that belongs to a rigid surface: these nodes come with the surfaces.
pub(super) fn first_of_rigid(model: &Model) -> usize {
    let nodes = model.rigid_segments().into_iter().flatten();
    nodes.min().unwrap_or(model.mesh.node_count())
}

/// The surface of general contact: the last one, by its name, which touches itself.
pub(super) fn all_exterior(model: &Model) -> Option<usize> {
    let last = model.surfaces.len().checked_sub(1)?;
    let touches_itself = |contact: &Contact| contact.slave == last && contact.master == last;
    let is_named = model.surfaces[last].name == ALL_EXTERIOR;
    (is_named && model.contacts.iter().any(touches_itself)).then_some(last)
}

fn nodes(model: &Model, lines: &mut Lines) {
    lines.card("NODE", []);
    let nodes = model.mesh.node_labels.iter().zip(&model.mesh.coordinates);
    for (label, x) in nodes.take(first_of_rigid(model)) {
        lines.row([label.to_string(), number(x[0]), number(x[1])]);
    }
}

fn elements(elements: &[Element], mesh: &Mesh, lines: &mut Lines) {
    let Some(first) = elements.first() else {
        return;
    };
    lines.card("ELEMENT", [set("TYPE", first.element_type.name())]);
    for element in elements {
        let nodes = element.nodes.iter().map(|&node| mesh.node_labels[node]);
        lines.row(
            [element.label]
                .into_iter()
                .chain(nodes)
                .map(|label| label.to_string()),
        );
    }
}

fn sets(keyword: &str, sets: &[Set], label: impl Fn(&usize) -> u64, lines: &mut Lines) {
    for set in sets {
        lines.card(keyword, [named(keyword, &set.name)]);
        let labels: Vec<u64> = set.members.iter().map(&label).collect();
        lines.list(&labels);
    }
}

/// Surfaces but that of general contact, which its card makes.
fn surfaces(model: &Model, lines: &mut Lines) {
    let mesh = &model.mesh;
    let own = all_exterior(model).unwrap_or(model.surfaces.len());
    for surface in &model.surfaces[..own] {
        let kind = match surface.kind {
            SurfaceKind::Faces(_) => "ELEMENT",
            SurfaceKind::Nodes(_) => "NODE",
            SurfaceKind::Rigid(_) => "SEGMENTS",
        };
        lines.card("SURFACE", [named("NAME", &surface.name), set("TYPE", kind)]);
        match &surface.kind {
            SurfaceKind::Faces(faces) => faces
                .iter()
                .for_each(|face| lines.row(face_fields(face, mesh))),
            SurfaceKind::Nodes(nodes) => {
                for &node in nodes {
                    lines.row([mesh.node_labels[node].to_string()]);
                }
            }
            SurfaceKind::Rigid(segments) => profile(segments, mesh, lines),
        }
    }
}

fn face_fields(face: &Face, mesh: &Mesh) -> [String; 2] {
    let label = mesh.elements[face.element].label;
    [label.to_string(), format!("S{}", face.side + 1)]
}

/// A rigid profile from its last segment to its first, as the deck gives it.
fn profile(segments: &[[usize; 2]], mesh: &Mesh, lines: &mut Lines) {
    let mut end = None;
    for &[to, from] in segments.iter().rev() {
        if end != Some(from) {
            lines.row(point("START", from, mesh));
        }
        lines.row(point("LINE", to, mesh));
        end = Some(to);
    }
}

fn point(word: &str, node: usize, mesh: &Mesh) -> [String; 3] {
    let [x, y] = mesh.coordinates[node].map(number);
    [word.to_owned(), x, y]
}

/// The set of exactly these elements.
pub(super) fn set_of<'m>(elements: &[usize], model: &'m Model) -> Option<&'m str> {
    let mut sets = model.sets.elements.iter();
    let found = sets.find(|set| set.members == elements)?;
    Some(&found.name)
}

/// A field that names elements: nothing for all of them, a set, or `None` where they make none.
pub(super) fn elements_field(elements: &[usize], model: &Model) -> Option<String> {
    match elements.len() == model.mesh.elements.len() {
        true => Some(String::new()),
        false => set_of(elements, model).map(name),
    }
}
