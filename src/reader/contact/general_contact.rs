//! `*CONTACT`: every exterior face against every other and against the rigid surfaces.

use super::assignment::of_all_surfaces;
use super::initialization;
use super::interactions::Interactions;
use crate::deck::{Card, Name, Row};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{ALL_EXTERIOR, Contact, Face, Interaction, Mesh, Surface, SurfaceKind};
use crate::reader::context::Context;
use crate::reader::mesh::{Block, MeshIndex, Outline, Surfaces};
use std::collections::HashMap;

/// Reads general contact and adds its surface: contact of the surface with itself and with every
/// rigid surface, there without the slave nodes of contact pairs.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    (surfaces, pairs): (&mut Surfaces, &[Contact]),
    interactions: &Interactions,
    cx: &mut Context,
) -> Vec<Contact> {
    let mut all = Vec::new();
    if let Some(general) = general(outline, mesh_index, surfaces, interactions, cx) {
        for &(master, _) in &surfaces.rigid {
            let left_out = paired(master, pairs, surfaces, mesh_index);
            all.push(Contact {
                master,
                left_out,
                ..general.clone()
            });
        }
        all.insert(0, general);
    }
    all
}

/// Slave nodes of the contact pairs with a rigid surface, increasing.
fn paired(
    rigid: usize,
    pairs: &[Contact],
    surfaces: &Surfaces,
    mesh_index: &MeshIndex,
) -> Vec<usize> {
    let pairs = pairs.iter().filter(|pair| pair.master == rigid);
    let slaves = pairs.filter_map(|pair| surfaces.all.get(pair.slave));
    let mut nodes: Vec<usize> = slaves
        .flat_map(|slave| slave.nodes(&mesh_index.mesh))
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The contact of all exterior faces with each other.
fn general(
    outline: &Outline,
    mesh_index: &MeshIndex,
    surfaces: &mut Surfaces,
    interactions: &Interactions,
    cx: &mut Context,
) -> Option<Contact> {
    let blocks: Vec<&Block> = outline.blocks("CONTACT").collect();
    let heads: Vec<&Card> = blocks.iter().map(|block| block.head).collect();
    cx.only_once(&heads);
    let block = blocks.first()?;
    let span = inclusions(block, cx);
    let assigned = assignment(block, interactions, cx);
    let adjust = initialization::read(outline, block, cx);
    let span = span?;
    if surfaces.names.is_defined(&Name::plain(ALL_EXTERIOR)) {
        let message = format!("the deck has a surface {ALL_EXTERIOR} of its own");
        let error = Diagnostic::error(Code::RepeatedName, span, message);
        cx.d.push(error.help("rename it: general contact makes a surface of this name"));
        return None;
    }
    let surface = surfaces.all.len();
    surfaces.all.push(Surface {
        name: ALL_EXTERIOR.to_string(),
        kind: SurfaceKind::Faces(exterior(&mesh_index.mesh)),
    });
    Some(Contact {
        slave: surface,
        master: surface,
        interaction: assigned.ok()?,
        adjust: adjust.ok()?,
        left_out: Vec::new(),
        span,
    })
}

/// Reports contact pairs of faces, which general contact includes; pairs with a rigid surface take
/// precedence for their nodes.
pub(crate) fn report_pairs(pairs: &[Contact], surfaces: &Surfaces, cx: &mut Context) {
    let is_rigid = |pair: &Contact| {
        let master = surfaces.all.get(pair.master);
        master.is_some_and(|master| matches!(master.kind, SurfaceKind::Rigid(_)))
    };
    for pair in pairs.iter().filter(|pair| !is_rigid(pair)) {
        let message = "general contact holds between these surfaces already";
        let error = Diagnostic::error(Code::GeneralContact, pair.span, message);
        cx.d.push(error.help("leave out the pair or *CONTACT: their forces would add up"));
    }
}

/// Place of `ALL EXTERIOR`; `None` after a reported error.
fn inclusions(block: &Block, cx: &mut Context) -> Option<Span> {
    let cards = block.parts_of("CONTACT INCLUSIONS");
    cx.only_once(&cards);
    let help = "write *CONTACT INCLUSIONS, ALL EXTERIOR";
    let (span, message) = match cards.first() {
        None if cx.may_lack_cards() => return None,
        None => (block.head.span, "*CONTACT includes no surfaces"),
        Some(card) if card.faulty => return None,
        Some(card) if !card.has("ALL EXTERIOR") => (card.span, "only ALL EXTERIOR can be included"),
        Some(card) => match card.rows.first() {
            None => return Some(card.span),
            Some(row) => (row.span(), "only ALL EXTERIOR can be included"),
        },
    };
    cx.d.push(Diagnostic::error(Code::GeneralContact, span, message).help(help));
    None
}

/// The interaction of all surfaces, the last one assigned; an error is reported.
fn assignment(
    block: &Block,
    interactions: &Interactions,
    cx: &mut Context,
) -> Result<Interaction, ()> {
    let mut assigned = Ok(Interaction::default());
    for card in block.parts_of("CONTACT PROPERTY ASSIGNMENT") {
        for row in card.rows.iter() {
            assigned = assigned_in(row, interactions, cx).ok_or(());
        }
    }
    assigned
}

/// `, , interaction`
fn assigned_in(row: Row, interactions: &Interactions, cx: &mut Context) -> Option<Interaction> {
    let name = of_all_surfaces(row, "the interaction", cx)?;
    interactions.find(name, cx)
}

/// All faces that belong to one element only, chain by chain along the boundaries.
fn exterior(mesh: &Mesh) -> Vec<Face> {
    let free = mesh.exterior_faces();
    let mut starts: HashMap<usize, Vec<usize>> = HashMap::new();
    for (i, face) in free.iter().enumerate() {
        starts.entry(face.nodes(mesh)[0]).or_default().push(i);
    }
    let mut taken = vec![false; free.len()];
    let mut chained = Vec::with_capacity(free.len());
    for first in 0..free.len() {
        let mut next = Some(first).filter(|&i| !taken[i]);
        while let Some(i) = next {
            taken[i] = true;
            chained.push(free[i]);
            let at_end = starts.get(&free[i].nodes(mesh)[1]).into_iter().flatten();
            next = at_end.copied().find(|&face| !taken[face]);
        }
    }
    chained
}
