//! `*PRE-TENSION SECTION`: a body is cut along a surface, and equations let the two sides of the cut overlap by one
//! additional displacement. A force tightens the overlap, and a support locks it. See docs/theory/contact.md,
//! Pre-tension.

use super::context::Context;
use super::mesh_index::MeshIndex;
use super::outline::Outline;
use super::sets::Sets;
use super::surfaces::named_faces_of;
use crate::deck::{Card, Line};
use crate::diagnostics::{Code, Span, shown};
use crate::model::{ElementsAtNodes, Equation, Face};
use crate::vectors::{distance, dot};
use std::collections::{BTreeMap, BTreeSet};

/// A body that is cut.
pub(crate) struct Cut {
    /// Pre-tension node.
    pub node: usize,
    /// Direction in which the side of the surface moves: a unit vector that points out of its elements.
    normal: [f64; 2],
    /// Pairs of a node of the surface and the node, at the same place, of the elements behind the surface.
    pairs: Vec<[usize; 2]>,
    /// Place of the card.
    pub span: Span,
}

impl Cut {
    /// Equations u_b = u_a - q n of the nodes b behind the cut, eq. (3.16).
    pub fn equations(&self) -> impl Iterator<Item = Equation> + '_ {
        let of_pair = |&[a, b]: &[usize; 2]| {
            [0, 1].map(|i| {
                let tightening = (2 * self.node, -self.normal[i]);
                let terms = [(2 * a + i, 1.0), tightening].into_iter();
                Equation {
                    dof: 2 * b + i,
                    terms: terms.filter(|term| term.1 != 0.0).collect(),
                }
            })
        };
        self.pairs.iter().flat_map(of_pair)
    }
}

/// Reads all sections and cuts the mesh.
pub(super) fn read(
    outline: &Outline,
    mesh_index: &mut MeshIndex,
    sets: &Sets,
    cx: &mut Context,
) -> Vec<Cut> {
    let mut cuts = Vec::new();
    for card in outline.model_cards("PRE-TENSION SECTION") {
        let other = (Code::PreTension, "a section has one node of its own");
        let node = card
            .required("NODE", cx.d)
            .and_then(|field| sets.single_node(field, mesh_index, other, cx));
        let at_nodes = ElementsAtNodes::new(&mesh_index.mesh);
        let faces = faces(card, outline, mesh_index, sets, &at_nodes, cx);
        let (Some(node), Some(faces)) = (node, faces) else {
            continue;
        };
        if at_nodes.of(node).next().is_some() {
            let message = "the node of a section belongs to an element";
            cx.error(Code::PreTension, card.span_of("NODE"), message)
                .help("take a node of its own: its displacement in direction 1 is the tightening");
            continue;
        }
        let normal = normal(card, &faces, mesh_index, cx);
        let Some(normal) = normal else { continue };
        if let Some(pairs) = cut(&faces, mesh_index, &at_nodes, card.span, cx) {
            cuts.push(Cut {
                node,
                normal,
                pairs,
                span: card.span,
            });
        }
    }
    cuts
}

/// Faces of the surface that a card names.
fn faces(
    card: &Card,
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Option<Vec<Face>> {
    let field = card.required("SURFACE", cx.d)?;
    let all = outline.model_cards("SURFACE");
    let with_key = |key: &String| {
        let mut all = all.iter();
        all.find(|surface| {
            surface
                .value("NAME")
                .is_some_and(|name| cx.key_of(name) == *key)
        })
    };
    let Some(surface) = cx.keys_of(field).iter().find_map(with_key) else {
        if !cx.may_lack_cards() {
            let message = format!("surface {} is not defined", field.text);
            cx.error(Code::PreTension, field.span, message);
        }
        return None;
    };
    let found = named_faces_of(surface, mesh_index, sets, at_nodes, cx.deck);
    if found.is_empty() {
        let message = format!("surface {} has no faces of elements", field.text);
        cx.error(Code::PreTension, field.span, message)
            .help("name the faces between the elements that are parted: element set, S1 to S4");
        return None;
    }
    Some(found)
}

/// Smallest cosine of the angle between the normal of the data line and the normal of the faces; with a smaller cosine
/// the two sides would slip on each other.
const TANGENT: f64 = 0.01;

/// The normal of a section, out of the elements of its faces: the normal of the data line, with either sign, or else
/// the mean normal of the faces.
fn normal(
    card: &Card,
    faces: &[Face],
    mesh_index: &MeshIndex,
    cx: &mut Context,
) -> Option<[f64; 2]> {
    if let Some(extra) = card.rows.get(1) {
        let message = "*PRE-TENSION SECTION has one data line, the normal";
        cx.error(Code::StrayData, extra.span(), message)
            .help("give a card for each section");
        return None;
    }
    let Some(mean) = mean_normal(faces, mesh_index) else {
        let message = "the faces of the section have no common normal: they close a ring";
        cx.error(Code::PreTension, card.span, message)
            .help("it runs between elements from one side of the body to the other");
        return None;
    };
    let Some(row) = card.rows.first() else {
        return Some(mean);
    };
    let given = given_normal(row, cx)?;
    let cosine = dot(given, mean);
    if cosine.abs() < TANGENT {
        let message = "the normal of the section lies along its faces: nothing is tightened";
        cx.error(Code::PreTension, row.span(), message)
            .help(format!(
                "their mean normal is {}, {}; without a data line it is taken",
                shown(mean[0]),
                shown(mean[1])
            ));
        return None;
    }
    Some(given.map(|x| x * cosine.signum()))
}

/// Reads a row `nx, ny[, nz]` and turns it with the instance of the row.
fn given_normal(row: Line, cx: &mut Context) -> Option<[f64; 2]> {
    row.at_most(3, cx.d);
    let [x, y, z] = [0, 1, 2].map(|i| row.real_or(i, 0.0, cx.d));
    let (x, y, z) = (x?, y?, z?);
    let length = x.hypot(y);
    if z != 0.0 || length == 0.0 || !length.is_finite() {
        let message = "the normal of the section must lie in the plane";
        cx.error(Code::BadDirection, row.span(), message);
        return None;
    }
    Some(cx.turned([x / length, y / length], row))
}

/// Mean normal that points out of the elements of the faces; `None` for faces that close a ring.
fn mean_normal(faces: &[Face], mesh_index: &MeshIndex) -> Option<[f64; 2]> {
    let mesh = &mesh_index.mesh;
    let (mut sum, mut whole) = ([0.0; 2], 0.0);
    for face in faces {
        let [a, b] = face.ends(mesh).map(|node| mesh.coordinates[node]);
        // the body lies on the left
        sum = [sum[0] + b[1] - a[1], sum[1] + a[0] - b[0]];
        whole += distance(a, b);
    }
    let length = sum[0].hypot(sum[1]);
    let unit = |x: f64| match x.abs() < 1e-14 * length {
        true => 0.0,
        false => x / length,
    };
    (length > TANGENT * whole).then(|| sum.map(unit))
}

/// Gives the elements behind the faces new nodes; returns pairs of an old and a new node at the same place.
fn cut(
    faces: &[Face],
    mesh_index: &mut MeshIndex,
    at_nodes: &ElementsAtNodes,
    span: Span,
    cx: &mut Context,
) -> Option<Vec<[usize; 2]>> {
    let mesh = &mesh_index.mesh;
    let sorted = |[a, b]: [usize; 2]| if a < b { [a, b] } else { [b, a] };
    let edges: BTreeSet<[usize; 2]> = faces.iter().map(|face| sorted(face.ends(mesh))).collect();
    let mut front: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for face in faces {
        for node in face.nodes(mesh) {
            front.entry(node).or_default().insert(face.element);
        }
    }
    // the elements at a node that sides other than those of the cut lead to
    let mut behind: Vec<(usize, Vec<usize>)> = Vec::new();
    for (&node, first) in &front {
        let sides = |element: usize| mesh.elements[element].side_ends().map(sorted);
        let mut reached = first.clone();
        let mut open: Vec<usize> = first.iter().copied().collect();
        while let Some(element) = open.pop() {
            let own: Vec<[usize; 2]> = sides(element)
                .filter(|side| side.contains(&node) && !edges.contains(side))
                .collect();
            for other in at_nodes.of(node) {
                if !reached.contains(&other) && sides(other).any(|side| own.contains(&side)) {
                    reached.insert(other);
                    open.push(other);
                }
            }
        }
        let others: Vec<usize> = (at_nodes.of(node).filter(|e| !reached.contains(e))).collect();
        if others.is_empty() {
            let message = format!(
                "the surface does not part the body at node {}",
                mesh_index.node_name(node)
            );
            cx.error(Code::PreTension, span, message)
                .help("it runs between elements from one side of the body to the other");
            return None;
        }
        behind.push((node, others));
    }
    let twins: Vec<Face> = (behind.iter().flat_map(|(_, elements)| elements))
        .flat_map(|&element| {
            let sides = 0..mesh.elements[element].side_count();
            sides.map(move |side| Face { element, side })
        })
        .filter(|face| edges.contains(&sorted(face.ends(mesh))))
        .collect();
    mesh_index
        .cut_faces
        .extend(faces.iter().copied().chain(twins));
    let places: Vec<[f64; 2]> = (behind.iter())
        .map(|(node, _)| mesh_index.mesh.coordinates[*node])
        .collect();
    let first = mesh_index.mesh.node_count();
    mesh_index.add_points(&places);
    let mut pairs = Vec::new();
    for (new, (node, elements)) in (first..).zip(behind) {
        for element in elements {
            let nodes = mesh_index.mesh.elements[element].nodes.iter_mut();
            nodes.filter(|own| **own == node).for_each(|own| *own = new);
        }
        pairs.push([node, new]);
    }
    Some(pairs)
}
