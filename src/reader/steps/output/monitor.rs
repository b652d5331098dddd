//! `*MONITOR`: displacements of nodes as columns of the status file.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic};
use crate::reader::context::Context;
use crate::reader::steps::boundary::{Direction, Targets, direction};

/// The dof that a card names.
pub(super) fn monitored(card: &Card, targets: Targets, cx: &mut Context) -> Option<usize> {
    let node = card.required("NODE", cx.d);
    let dof = card.required("DOF", cx.d);
    let help = "a column shows one node; give *MONITOR for each";
    let node = node.and_then(|field| {
        let Targets {
            sets, mesh_index, ..
        } = targets;
        sets.single_node(field, mesh_index, (Code::BadValue, help), cx)
    });
    let dof = dof?;
    match (node, direction(dof, cx)?) {
        (node, Direction::Plane(direction)) => Some(2 * node? + direction),
        (_, Direction::OutOfPlane) => {
            let message = format!("direction {} is not in the status file", dof.text);
            let warning = Diagnostic::warning(Code::IgnoredVariable, dof.span, message);
            cx.d.push(warning.help("1 is x, 2 is y"));
            None
        }
    }
}
