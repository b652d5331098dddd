//! Shapes of the elements.

use super::magnitudes::unusable;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Element, Mesh};
use crate::reader::context::Context;
use crate::reader::mesh::MeshIndex;
use std::collections::HashMap;

/// Smallest cross product of two sides, relative to the square of the longest side.
const FLAT: f64 = 1e-10;

/// Reports elements that are clockwise, degenerate, not convex or defined twice.
pub(crate) fn mesh(mesh_index: &MeshIndex, cx: &mut Context) {
    let mut known: HashMap<Vec<usize>, u64> = HashMap::new();
    for (element, &span) in mesh_index
        .mesh
        .elements
        .iter()
        .zip(&mesh_index.element_spans)
    {
        shape(element, &mesh_index.mesh, span, cx);
        let mut nodes = element.nodes.clone();
        nodes.sort_unstable();
        if let Some(first) = known.insert(nodes, element.label) {
            let message = format!("element {} has the nodes of element {first}", element.label);
            cx.error(Code::RepeatedElement, span, message);
        }
    }
}

fn shape(element: &Element, mesh: &Mesh, span: Span, cx: &mut Context) {
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
        let what = format!("the longest side of element {}", element.label);
        return unusable(&what, longest, span, cx);
    }
    let turn = |i: usize| {
        let (s, t) = (side(i), side(i + 1));
        s[0] / longest * (t[1] / longest) - s[1] / longest * (t[0] / longest)
    };
    let left = (0..count).filter(|&i| turn(i) > FLAT).count();
    let right = (0..count).filter(|&i| turn(i) < -FLAT).count();
    let label = element.label;
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
