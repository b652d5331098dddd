//! `*RIGID BODY`: rigid surfaces and rigid elements move with their reference nodes.

use super::context::Context;
use super::mesh_index::MeshIndex;
use super::outline::Outline;
use super::sets::Sets;
use super::surfaces::Surfaces;
use crate::deck::{Card, Text};
use crate::diagnostics::{Code, Span};
use crate::model::{RigidBody, Support, SupportMotion, SurfaceKind};
use std::collections::{BTreeMap, BTreeSet};

/// A rigid surface, or a set of rigid elements, and the node that it moves with.
pub(crate) struct Rigid {
    /// Index of the surface; none of elements.
    surface: Option<usize>,
    /// Name of the surface or set.
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

/// The mesh, its sets and surfaces, among which a card names.
#[derive(Clone, Copy)]
struct Lookup<'a> {
    mesh_index: &'a MeshIndex,
    sets: &'a Sets,
    surfaces: &'a Surfaces,
}

/// Reads all rigid surfaces with their reference nodes, by the index of the surface, and all sets of
/// rigid elements.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Vec<Rigid> {
    let lookup = Lookup {
        mesh_index,
        sets,
        surfaces,
    };
    let mut of_surfaces = BTreeMap::new();
    let mut of_elements = Vec::new();
    let mut incomplete = cx.may_lack_cards();
    for card in outline.model_cards("RIGID BODY") {
        let Some(rigid) = rigid(card, lookup, cx) else {
            incomplete = true;
            continue;
        };
        let Some(index) = rigid.surface else {
            of_elements.push(rigid);
            continue;
        };
        if of_surfaces.contains_key(&index) {
            let message = format!("surface {} has a reference node already", rigid.name);
            cx.error(Code::RigidSurface, card.span, message);
        }
        of_surfaces.insert(index, rigid);
    }
    let lone = |(index, _): &&(usize, Span)| !of_surfaces.contains_key(index);
    for &(index, span) in surfaces.rigid.iter().filter(lone) {
        if let Some(surface) = surfaces.all.get(index).filter(|_| !incomplete) {
            let message = format!("the rigid surface {} has no reference node", surface.name);
            cx.error(Code::RigidSurface, span, message)
                .help("add *RIGID BODY, ANALYTICAL SURFACE=, REF NODE=");
        }
    }
    of_surfaces.into_values().chain(of_elements).collect()
}

fn rigid(card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Rigid> {
    let reference = card.required("REF NODE", cx.d);
    let reference = reference.and_then(|field| {
        let other = (Code::RigidSurface, "a rigid surface moves with one node");
        lookup.sets.single_node(field, lookup.mesh_index, other, cx)
    });
    let (surface, name, nodes) = match card.value("ELSET") {
        Some(field) => of_elements(field, card, lookup, cx)?,
        None => of_surface(card, lookup, cx)?,
    };
    let reference = reference?;
    Some(Rigid {
        surface,
        name,
        nodes: nodes
            .into_iter()
            .filter(|&node| node != reference)
            .collect(),
        reference,
        label: lookup.mesh_index.node_name(reference),
        span: card.span,
    })
}

/// Index, name and nodes of a rigid surface.
type Members = (Option<usize>, String, Vec<usize>);

/// Those of the surface that a card names.
fn of_surface(card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Members> {
    let field = card.required("ANALYTICAL SURFACE", cx.d)?;
    let (index, surface, span) = lookup.surfaces.find(field, cx)?;
    let SurfaceKind::Rigid(_) = surface.kind else {
        let message = format!("surface {} is no rigid surface", surface.name);
        cx.error(Code::RigidSurface, span, message)
            .help("define it with *SURFACE, TYPE=SEGMENTS");
        return None;
    };
    let nodes = surface.nodes(&lookup.mesh_index.mesh);
    Some((Some(index), surface.name.clone(), nodes))
}

/// Those of the elements of a set, without surface.
fn of_elements(field: Text, card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Members> {
    if card.has("ANALYTICAL SURFACE") {
        let span = card.span_of("ANALYTICAL SURFACE");
        cx.error(Code::RigidSurface, span, "a rigid body of two kinds")
            .help("give the surface and the elements a *RIGID BODY each");
        return None;
    }
    let elements = lookup.sets.elements_of(field, lookup.mesh_index, cx);
    let mesh = &lookup.mesh_index.mesh;
    let elements = elements.iter().filter_map(|&e| mesh.elements.get(e));
    let nodes: BTreeSet<usize> = elements.flat_map(|e| &e.nodes).copied().collect();
    Some((None, field.text.to_string(), nodes.into_iter().collect()))
}

/// The rigid surfaces with their reference nodes, as the model holds them; rigid elements are known by
/// the supports of their nodes.
pub(crate) fn bodies(rigid_bodies: &[Rigid]) -> Vec<RigidBody> {
    let body = |rigid: &Rigid| {
        Some(RigidBody {
            surface: rigid.surface?,
            reference: rigid.reference,
        })
    };
    rigid_bodies.iter().filter_map(body).collect()
}

/// Adds the supports of the nodes of rigid bodies to those of a step: they move as their reference
/// nodes.
pub(crate) fn follow(
    rigid_bodies: &[Rigid],
    mesh_index: &MeshIndex,
    step: usize,
    supports: &mut Vec<Support>,
    cx: &mut Context,
) {
    let mut motions: BTreeMap<usize, SupportMotion> = BTreeMap::new();
    motions.extend(supports.iter().map(|support| (support.dof, support.motion)));
    for rigid in rigid_bodies {
        for direction in 0..2 {
            let Some(&motion) = motions.get(&(2 * rigid.reference + direction)) else {
                report_free(rigid, direction, step, cx);
                continue;
            };
            for &node in &rigid.nodes {
                let other = motions.insert(2 * node + direction, motion);
                if other.is_some_and(|other| other != motion) {
                    return report_other_motion(rigid, &mesh_index.node_name(node), cx);
                }
            }
        }
    }
    let all = motions.into_iter();
    *supports = all.map(|(dof, motion)| Support { dof, motion }).collect();
}

fn report_other_motion(rigid: &Rigid, node: &str, cx: &mut Context) {
    let message = format!(
        "node {node} of {} is prescribed otherwise than the reference node {}",
        rigid.name, rigid.label
    );
    cx.error(Code::RigidSurface, rigid.span, message)
        .help("a rigid body moves as its reference node, which *BOUNDARY prescribes");
}

fn report_free(rigid: &Rigid, direction: usize, step: usize, cx: &mut Context) {
    let message = format!(
        "the reference node {} of {} is free in direction {} in step {step}",
        rigid.label,
        rigid.name,
        direction + 1
    );
    cx.error(Code::RigidSurface, rigid.span, message)
        .help("prescribe its directions 1 and 2 with *BOUNDARY");
}
