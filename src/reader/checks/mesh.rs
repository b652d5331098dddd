//! Shapes of the elements.

use super::magnitudes::unusable;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::reader::context::Context;
use crate::reader::mesh::MeshIndex;
use std::collections::HashMap;

/// Smallest cross product of two sides, relative to the square of the longest side.
const FLAT: f64 = 1e-10;

/// Reports elements that are clockwise, degenerate, not convex or defined twice.
pub(crate) fn mesh(mesh_index: &MeshIndex, cx: &mut Context) {
    let mut known: HashMap<Vec<usize>, usize> = HashMap::new();
    let elements = mesh_index.mesh.elements.iter().enumerate();
    for ((index, element), &span) in elements.zip(&mesh_index.element_spans) {
        shape(index, mesh_index, span, cx);
        let mut nodes = element.nodes.clone();
        nodes.sort_unstable();
        if let Some(first) = known.insert(nodes, index) {
            let [element, first] = [index, first].map(|e| mesh_index.element_name(e));
            let message = format!("element {element} has the nodes of element {first}");
            cx.error(Code::RepeatedElement, span, message);
        }
    }
}

fn shape(index: usize, mesh_index: &MeshIndex, span: Span, cx: &mut Context) {
    let mesh = &mesh_index.mesh;
    let element = &mesh.elements[index];
    let at: Vec<[f64; 2]> = element.nodes.iter().map(|&n| mesh.coordinates[n]).collect();
    let count = at.len();
    let side = |i: usize| {
        let (a, b) = (at[i % count], at[(i + 1) % count]);
        [b[0] - a[0], b[1] - a[1]]
    };
    let longest = (0..count)
        .map(|i| side(i)[0].hypot(side(i)[1]))
        .fold(0.0, f64::max);
    if !longest.is_finite() {
        let what = format!(
            "the longest side of element {}",
            mesh_index.element_name(index)
        );
        return unusable(&what, longest, span, cx);
    }
    let turn = |i: usize| {
        let (s, t) = (side(i), side(i + 1));
        s[0] / longest * (t[1] / longest) - s[1] / longest * (t[0] / longest)
    };
    let left = (0..count).filter(|&i| turn(i) > FLAT).count();
    let right = (0..count).filter(|&i| turn(i) < -FLAT).count();
    let label = mesh_index.element_name(index);
    let (fault, help) = if left == count {
        return;
    } else if right == count {
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
