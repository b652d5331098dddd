//! `*CONTACT PAIR`; joins the pairs and general contact.

use super::general_contact;
use super::interactions::Interactions;
use crate::deck::{Card, Row};
use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Adjust, Contact, Interaction, Reach, SurfaceKind};
use crate::reader::context::Context;
use crate::reader::mesh::{Found, MeshIndex, Outline, Sets, Surfaces, surface};
use std::collections::HashSet;

/// Reads the contacts with their interactions.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    surfaces: &mut Surfaces,
    cx: &mut Context,
) -> Vec<Contact> {
    let interactions = Interactions::read(outline, cx);
    let mut contacts = Vec::new();
    for card in outline.model_cards("CONTACT PAIR") {
        let name = card.required("INTERACTION", cx.d);
        let interaction = name.and_then(|name| interactions.find(name, cx));
        let adjust = adjust(card, sets, cx);
        for row in card.rows.iter() {
            let contact = contact(row, interaction, surfaces, cx);
            report_adjusted_self_contact(contact.as_ref(), card, cx);
            contacts.extend(contact.map(|contact| Contact { adjust, ..contact }));
        }
    }
    report_repeated(&contacts, cx);
    let general = general_contact::read(
        outline,
        mesh_index,
        (surfaces, &contacts),
        &interactions,
        cx,
    );
    if !general.is_empty() {
        general_contact::report_pairs(&contacts, surfaces, cx);
    }
    contacts.extend(general);
    contacts
}

/// A clearance or a node set.
fn adjust(card: &Card, sets: &Sets, cx: &mut Context) -> Option<Adjust> {
    let value = card.value("ADJUST")?;
    match value.as_real() {
        None => sets.node_names.find(value, cx).map(Adjust::Nodes),
        Some(clearance) if clearance >= 0.0 => Some(Adjust::Within(Reach {
            above: clearance,
            below: f64::INFINITY,
            clearance: 0.0,
        })),
        Some(_) => {
            let message = format!("the clearance must not be negative, found {}", value.text);
            cx.error(Code::BadValue, value.span, message);
            None
        }
    }
}

fn report_adjusted_self_contact(contact: Option<&Contact>, card: &Card, cx: &mut Context) {
    if card.has("ADJUST") && contact.is_some_and(Contact::is_self_contact) {
        let message =
            "the nodes of a surface that touches itself cannot be moved onto it by a pair";
        let error = Diagnostic::error(Code::SurfaceUse, card.span_of("ADJUST"), message);
        cx.d.push(error.help("general contact can: *CONTACT INITIALIZATION DATA"));
    }
}

/// Reports a second pair of the same slave and master, which would double the contact forces.
fn report_repeated(contacts: &[Contact], cx: &mut Context) {
    let mut seen = HashSet::new();
    for contact in contacts {
        if !seen.insert((contact.slave, contact.master)) {
            let message = "this slave and this master are paired already";
            cx.error(Code::SurfaceUse, contact.span, message);
        }
    }
}

/// `slave, master`; a single surface is in contact with itself.
fn contact(
    row: Row,
    interaction: Option<Interaction>,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Option<Contact> {
    row.at_most(2, cx.d);
    let slave = row.required(0, "the slave surface", cx.d);
    let slave = slave.and_then(|field| surface::find(surfaces, field, cx));
    let master = match row.get(1) {
        Some(field) => surface::find(surfaces, field, cx),
        None => slave,
    };
    let (slave, master) = (slave?, master?);
    check_use(row, slave, master, cx)?;
    Some(Contact {
        slave: slave.0,
        master: master.0,
        interaction: interaction?,
        adjust: None,
        left_out: Vec::new(),
        span: row.span(),
    })
}

/// Reports surfaces that cannot be slave or master.
fn check_use(row: Row, slave: Found, master: Found, cx: &mut Context) -> Option<()> {
    let once = row.get(1).is_none();
    let name = &master.1.name;
    let is_of_nodes = matches!(master.1.kind, SurfaceKind::Nodes(_));
    let (message, help) = if once && is_of_nodes {
        (
            format!("surface {name} is made of nodes and cannot touch itself"),
            "self-contact needs element faces",
        )
    } else if !once && slave.0 == master.0 {
        (
            format!("surface {name} is slave and master at once"),
            "for self-contact write its name once",
        )
    } else if let SurfaceKind::Rigid(_) = slave.1.kind {
        (
            format!("the rigid surface {} cannot be slave", slave.1.name),
            "a rigid surface is a master: write the other surface first",
        )
    } else if is_of_nodes {
        (
            format!("the master surface {name} is made of nodes"),
            "a master is made of element faces; the slave may be made of nodes",
        )
    } else {
        return Some(());
    };
    cx.d.push(Diagnostic::error(Code::SurfaceUse, master.2, message).help(help));
    None
}
