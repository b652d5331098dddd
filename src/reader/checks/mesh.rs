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
    let mesh = &mesh_index.mesh;
    for index in 0..mesh.elements.len() {
        if !is_convex(index, mesh) {
            shape(index, mesh_index, mesh_index.places.get(index), cx);
        }
        if let Some(first) = same_nodes(index, mesh, at_nodes) {
            let span = mesh_index.places.get(index);
            let [element, first] = [index, first].map(|e| mesh_index.element_name(e));
            let message = format!("element {element} has the nodes of element {first}");
            cx.error(Code::RepeatedElement, span, message);
        }
    }
}

/// The last element before element `index` that has the same nodes.
fn same_nodes(index: usize, mesh: &Mesh, at_nodes: &ElementsAtNodes) -> Option<usize> {
    let nodes = mesh.elements[index].nodes.as_slice();
    // most others differ in the sum of their nodes, the first of which is the same
    let sum = |nodes: &[usize]| nodes.iter().sum::<usize>();
    let own = sum(nodes);
    let is_same = |&other: &usize| {
        let others = mesh.elements[other].nodes.as_slice();
        let may_be = others.len() == nodes.len() && sum(others) == own;
        may_be && nodes[1..].iter().all(|node| others.contains(node))
    };
    let before = at_nodes.of(nodes[0]).take_while(|&other| other < index);
    before.filter(is_same).last()
}

/// Whether an element surely turns left at all of its corners.
fn is_convex(index: usize, mesh: &Mesh) -> bool {
    let at = |node: usize| mesh.coordinates[node];
    match *mesh.elements[index].nodes.as_slice() {
        [a, b, c] => turns_left([a, b, c].map(at)),
        [a, b, c, d] => turns_left([a, b, c, d].map(at)),
        _ => false,
    }
}

fn turns_left<const N: usize>(corners: [[f64; 2]; N]) -> bool {
    let sides: [[f64; 2]; N] =
        std::array::from_fn(|i| difference(corners[i], corners[(i + 1) % N]));
    let square = sides
        .map(|side| dot(side, side))
        .into_iter()
        .fold(0.0, f64::max);
    let turn = |i: usize| cross(sides[i], sides[(i + 1) % N]);
    square.is_normal() && (0..N).all(|i| turn(i) > FLAT * square)
}

/// Reports an element that does not turn left at all of its corners.
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
