//! Shapes of the elements.

use super::magnitudes::unusable;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{ElementsAtNodes, Mesh, sides};
use crate::reader::context::Context;
use crate::reader::mesh::MeshIndex;
use crate::vectors::{cross, difference, distance, dot};
use smallvec::SmallVec;

/// Smallest cross product of two sides, relative to the square of the longest side.
const FLAT: f64 = 1e-10;

/// Reports elements that are clockwise, degenerate, not convex or defined twice.
pub(crate) fn mesh(mesh_index: &MeshIndex, at_nodes: &ElementsAtNodes, cx: &mut Context) {
    for (index, &span) in mesh_index.element_spans.iter().enumerate() {
        shape(index, mesh_index, span, cx);
        if let Some(first) = same_nodes(index, &mesh_index.mesh, at_nodes) {
            let [element, first] = [index, first].map(|e| mesh_index.element_name(e));
            let message = format!("element {element} has the nodes of element {first}");
            cx.error(Code::RepeatedElement, span, message);
        }
    }
}

/// The last element before element `index` that has the same nodes.
fn same_nodes(index: usize, mesh: &Mesh, at_nodes: &ElementsAtNodes) -> Option<usize> {
    let nodes = &mesh.elements[index].nodes;
    let is_same = |&other: &usize| {
        let others = &mesh.elements[other].nodes;
        others.len() == nodes.len() && nodes[1..].iter().all(|node| others.contains(node))
    };
    let before = at_nodes.of(nodes[0]).take_while(|&other| other < index);
    before.filter(is_same).last()
}

fn shape(index: usize, mesh_index: &MeshIndex, span: Span, cx: &mut Context) {
    let corners = mesh_index.mesh.corners(&mesh_index.mesh.elements[index]);
    let mut vectors: SmallVec<[[f64; 2]; 4]> = SmallVec::from_slice(&corners);
    for (vector, [a, b]) in vectors.iter_mut().zip(sides(&corners)) {
        *vector = difference(a, b);
    }
    let square = vectors.iter().map(|&s| dot(s, s)).fold(0.0, f64::max);
    let mut flat = FLAT * square;
    if !square.is_normal() {
        let lengths = vectors.iter().map(|&side| distance([0.0; 2], side));
        let longest = lengths.fold(0.0, f64::max);
        if !longest.is_finite() {
            let name = mesh_index.element_name(index);
            let what = format!("the longest side of element {name}");
            return unusable(&what, longest, span, cx);
        }
        for x in vectors.as_flattened_mut() {
            *x /= longest;
        }
        flat = FLAT;
    }
    let (mut left, mut right) = (0, 0);
    for [s, t] in sides(&vectors) {
        let turn = cross(s, t);
        left += usize::from(turn > flat);
        right += usize::from(turn < -flat);
    }
    let count = corners.len();
    if left == count {
        return;
    }
    let label = mesh_index.element_name(index);
    let (fault, help) = if right == count {
        (
            format!("element {label} is numbered clockwise"),
            "reverse its node order",
        )
    } else if left + right < count {
        (
            format!("element {label} is degenerate: three of its nodes lie on one line"),
            "mend the mesh",
        )
    } else if left == right {
        (
            format!("the sides of element {label} cross"),
            "list its nodes in order around it",
        )
    } else {
        (format!("element {label} is not convex"), "mend the mesh")
    };
    cx.d.push(Diagnostic::error(Code::BadShape, span, fault).help(help));
}
