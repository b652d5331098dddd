//! `*INITIAL CONDITIONS, TYPE=VELOCITY`.

use super::boundary::{Targets, row_direction};
use crate::deck::Row;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Rate, Support, SupportMotion};
use crate::reader::context::Context;
use crate::reader::mesh::{MeshIndex, Outline};
use std::collections::BTreeMap;

/// Reads initial velocities, `2 N` entries; `supports` hold at the start.
pub(crate) fn read(
    outline: &Outline,
    targets: Targets,
    supports: &[Support],
    cx: &mut Context,
) -> Vec<f64> {
    let mut velocity = vec![0.0; targets.mesh_index.mesh.dof_count()];
    let mut places = BTreeMap::new();
    for card in outline.model_cards("INITIAL CONDITIONS") {
        card.required("TYPE", cx.d);
        if card.choice("TYPE") != Some("VELOCITY") {
            continue;
        }
        for row in card.rows.iter() {
            for (dof, value) in velocity_row(row, targets, cx) {
                if let Some(entry) = velocity.get_mut(dof) {
                    *entry = value;
                    places.insert(dof, row.span());
                }
            }
        }
    }
    report_supported(&velocity, &places, supports, targets.mesh_index, cx);
    velocity
}

/// Whether a support has its velocity at the start from what is prescribed; an acceleration leaves it.
fn is_given(support: &Support) -> bool {
    let SupportMotion::Rate { rate, .. } = support.motion else {
        return true;
    };
    rate == Rate::Velocity
}

/// `node or set, direction, velocity`
fn velocity_row(row: Row, targets: Targets, cx: &mut Context) -> Vec<(usize, f64)> {
    row.at_most(3, cx.d);
    let target = row.required(0, "a node or node set", cx.d);
    let nodes = target.map(|field| targets.sets.nodes_of(field, targets.mesh_index, cx));
    let value = row.real(2, "the velocity", cx.d);
    let direction = row_direction(row, value.unwrap_or(0.0), cx);
    match (nodes, direction, value) {
        (Some(nodes), Some(direction), Some(value)) => nodes
            .into_iter()
            .map(|node| (2 * node + direction, value))
            .collect(),
        _ => Vec::new(),
    }
}

/// Reports initial velocities of supported dofs, which move as prescribed from the start.
fn report_supported(
    velocity: &[f64],
    places: &BTreeMap<usize, Span>,
    supports: &[Support],
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    let mut rows: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for dof in supports
        .iter()
        .filter(|s| is_given(s))
        .map(|support| support.dof)
    {
        if let (Some(&value), Some(&span)) = (velocity.get(dof), places.get(&dof))
            && value != 0.0
        {
            rows.entry(span).or_default().push(dof);
        }
    }
    for (span, dofs) in rows {
        let Some(first) = dofs.first() else { continue };
        let label = mesh_index.node_name(first / 2);
        let message = format!(
            "{} degrees of freedom with this velocity are prescribed, the first is node {label} \
             direction {}",
            dofs.len(),
            first % 2 + 1
        );
        let error = Diagnostic::error(Code::VelocityOnSupport, span, message);
        cx.d.push(error.help("give the velocity to free nodes only"));
    }
}
