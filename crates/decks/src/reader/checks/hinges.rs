//! Finds hinges whose motion other hinges or supports hold already. See docs/theory/bodies.md, Hinges.

use nalgebra::DVector;

use crate::diagnostics::{Code, Span};
use crate::model::{Model, RigidBody, Step};
use crate::reader::context::Context;
use crate::vectors::{difference, length};

/// Relative size of the part of a row of C that is independent of earlier rows; below this size the row follows from
/// earlier rows. The square of the relative size is the bound below which a run counts an eigenvalue as zero.
const FOLLOWS: f64 = 1e-6;

/// Reports hinges whose rows of C in eq. (11.8) follow from earlier rows and the supports of a step: with such hinges
/// the step would stop. A row whose two nodes are held alike by supports has no effect and is not checked. `spans`
/// holds the places of the hinges.
pub(crate) fn hinges(model: &Model, spans: &[Span], cx: &mut Context) {
    for (number, step) in model.steps.iter().enumerate() {
        let mut independent: Vec<DVector<f64>> = Vec::new();
        for (hinge, &span) in model.hinges.iter().zip(spans) {
            let acts = |axis: &usize| !model.are_held_alike(step, hinge.nodes, *axis);
            for axis in (0..2).filter(acts) {
                let mut row = row(model, step, hinge.nodes, axis);
                let size = row.norm();
                for other in &independent {
                    row -= other * other.dot(&row);
                }
                if row.norm() <= FOLLOWS * size {
                    let [a, b] = hinge.nodes.map(|node| model.node_name(node));
                    let message = format!(
                        "the hinge of nodes {a} and {b} holds in step {} what other hinges or supports hold already",
                        number + 1
                    );
                    cx.error(Code::Coupling, span, message).help(
                        "leave out this hinge, or another one or a support that holds the same motion",
                    );
                    return;
                }
                independent.push(row.normalize());
            }
        }
    }
}

/// Row of C of a hinge along an axis. The columns of the row belong to the displacements of the reference nodes of all
/// bodies, and to the angles times the largest arm; columns of prescribed dofs are zero.
fn row(model: &Model, step: &Step, nodes: [usize; 2], axis: usize) -> DVector<f64> {
    let mut row = DVector::zeros(3 * model.rigid_bodies.len());
    let is_free = |dof: usize| step.motion_of(dof).is_none();
    let x = &model.mesh.coordinates;
    for (node, sign) in nodes.into_iter().zip([1.0, -1.0]) {
        let has =
            |body: &RigidBody| body.reference == node || body.nodes.binary_search(&node).is_ok();
        let Some(number) = model.rigid_bodies.iter().position(has) else {
            continue;
        };
        let body = &model.rigid_bodies[number];
        let arm = |node: usize| difference(x[body.reference], x[node]);
        let longest = body.nodes.iter().map(|&node| length(arm(node)));
        let longest = longest.fold(0.0, f64::max);
        if is_free(2 * body.reference + axis) {
            row[3 * number + axis] += sign;
        }
        if is_free(model.angle_of(body)) && longest > 0.0 {
            let [rx, ry] = arm(node);
            row[3 * number + 2] += sign * [-ry, rx][axis] / longest;
        }
    }
    row
}
