//! `*RIGID BODY`: rigid surfaces move with their reference nodes.

use crate::deck::{Card, Text};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{RigidBody, Support, SurfaceKind};
use crate::reader::context::Context;
use crate::reader::mesh::{MeshIndex, Outline, Sets, Surfaces, surface};
use std::collections::BTreeMap;

/// A rigid surface and the node that it moves with.
pub(crate) struct RigidSurface {
    /// Index of the surface.
    surface: usize,
    /// Name of the surface.
    name: String,
    /// Its nodes.
    nodes: Vec<usize>,
    /// Reference node.
    reference: usize,
    /// Number of the reference node in the deck.
    label: String,
    /// Place of `*RIGID BODY`.
    span: Span,
}

/// Reads the reference nodes of all rigid surfaces.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Vec<RigidSurface> {
    let mut rigid_surfaces = BTreeMap::new();
    let mut incomplete = cx.may_lack_cards();
    for card in outline.model_cards("RIGID BODY") {
        let Some((index, rigid)) = rigid(card, mesh_index, sets, surfaces, cx) else {
            incomplete = true;
            continue;
        };
        if rigid_surfaces.contains_key(&index) {
            let message = format!("surface {} has a reference node already", rigid.name);
            cx.error(Code::RigidSurface, card.span, message);
        }
        rigid_surfaces.insert(index, rigid);
    }
    let lone = |(index, _): &&(usize, Span)| !rigid_surfaces.contains_key(index);
    for &(index, span) in surfaces.rigid.iter().filter(lone) {
        if let Some(surface) = surfaces.all.get(index).filter(|_| !incomplete) {
            let message = format!("the rigid surface {} has no reference node", surface.name);
            let error = Diagnostic::error(Code::RigidSurface, span, message);
            cx.d.push(error.help("add *RIGID BODY, ANALYTICAL SURFACE=, REF NODE="));
        }
    }
    rigid_surfaces.into_values().collect()
}

fn rigid(
    card: &Card,
    mesh_index: &MeshIndex,
    sets: &Sets,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Option<(usize, RigidSurface)> {
    let reference = card.required("REF NODE", cx.d);
    let reference = reference.and_then(|field| reference_node(field, mesh_index, sets, cx));
    let field = card.required("ANALYTICAL SURFACE", cx.d)?;
    let (index, surface, span) = surface::find(surfaces, field, cx)?;
    let SurfaceKind::Rigid(_) = surface.kind else {
        let message = format!("surface {} is no rigid surface", surface.name);
        let error = Diagnostic::error(Code::RigidSurface, span, message);
        cx.d.push(error.help("define it with *SURFACE, TYPE=SEGMENTS"));
        return None;
    };
    let reference = reference?;
    Some((
        index,
        RigidSurface {
            surface: index,
            name: surface.name.clone(),
            nodes: surface.nodes(&mesh_index.mesh),
            reference,
            label: mesh_index.node_name(reference),
            span: card.span,
        },
    ))
}

/// The node that a field names, or the only node of the set.
fn reference_node(
    field: Text,
    mesh_index: &MeshIndex,
    sets: &Sets,
    cx: &mut Context,
) -> Option<usize> {
    let errors = cx.errors();
    match sets.nodes_of(field, mesh_index, cx)[..] {
        [node] => Some(node),
        _ if cx.errors() > errors || cx.may_lack_cards() || mesh_index.nodes.incomplete => None,
        ref nodes => {
            let message = format!("{} holds {} nodes", field.text, nodes.len());
            let error = Diagnostic::error(Code::RigidSurface, field.span, message);
            cx.d.push(error.help("a rigid surface moves with one node"));
            None
        }
    }
}

/// The rigid surfaces with their reference nodes, as the model holds them.
pub(crate) fn bodies(rigid_surfaces: &[RigidSurface]) -> Vec<RigidBody> {
    let body = |rigid: &RigidSurface| RigidBody {
        surface: rigid.surface,
        reference: rigid.reference,
    };
    rigid_surfaces.iter().map(body).collect()
}

/// Adds the supports of the nodes of rigid surfaces to those of a step: they move as their
/// reference nodes.
pub(crate) fn follow(
    rigid_surfaces: &[RigidSurface],
    step: usize,
    supports: &mut Vec<Support>,
    cx: &mut Context,
) {
    for rigid in rigid_surfaces {
        for direction in 0..2 {
            let dof = 2 * rigid.reference + direction;
            match supports.iter().find(|support| support.dof == dof) {
                Some(&Support { motion, .. }) => {
                    let dofs = rigid.nodes.iter().map(|node| 2 * node + direction);
                    supports.extend(dofs.map(|dof| Support { dof, motion }));
                }
                None => report_free(rigid, direction, step, cx),
            }
        }
    }
    supports.sort_by_key(|support| support.dof);
}

fn report_free(rigid: &RigidSurface, direction: usize, step: usize, cx: &mut Context) {
    let message = format!(
        "the reference node {} of {} is free in direction {} in step {step}",
        rigid.label,
        rigid.name,
        direction + 1
    );
    let error = Diagnostic::error(Code::RigidSurface, rigid.span, message);
    cx.d.push(error.help("prescribe its directions 1 and 2 with *BOUNDARY"));
}
