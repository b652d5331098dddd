//! `*CONTACT PAIR` and `*CONTACT`: contact pairs, and general contact of every exterior face with every other and with
//! the rigid surfaces. Also interactions of contacts, and the nodes that general contact moves before the start.

use super::context::Context;
use super::mesh_index::MeshIndex;
use super::names::Named;
use super::outline::{CardBlock, Outline};
use super::sets::Sets;
use super::smoothing;
use super::surfaces::{Found, Surfaces};
use crate::deck::{Card, Line, Name, Text};
use crate::diagnostics::{Code, Span};
use crate::model::{
    ALL_EXTERIOR, Adjust, Contact, ContactFormulation, Face, Friction, FrictionCurve, FrictionLaw,
    Heat, Interaction, Mesh, Model, Reach, RigidProfile, Segment, Surface, SurfaceKind, Wear,
};
use crate::vectors::cross;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Reads the contacts with their interactions.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    surfaces: &mut Surfaces,
    cx: &mut Context,
) -> Vec<Contact> {
    let interactions = interactions(outline, cx);
    let smoothings = smoothing::read(outline, surfaces, cx);
    let mut contacts = Vec::new();
    for card in outline.model_cards("CONTACT PAIR") {
        let name = card.required("INTERACTION", cx.d);
        let interaction = name.and_then(|name| interactions.find(name, cx).cloned());
        let adjust = adjust(card, sets, cx);
        let formulation = formulation(card);
        let smoothing = smoothing::of_pair(card, &smoothings, cx).unwrap_or_default();
        for row in card.rows.iter() {
            let contact = contact(row, interaction.clone(), surfaces, cx);
            report_adjusted_self_contact(contact.as_ref(), card, cx);
            contacts.extend(contact.map(|contact| Contact {
                adjust,
                formulation,
                smoothing: smoothing.clone(),
                lying_faces: (!card.has("TYPE") && !contact.is_self_contact()).then_some(0),
                ..contact
            }));
        }
    }
    report_repeated(&contacts, cx);
    for card in outline.model_cards("CLEARANCE") {
        clearance(card, surfaces, &mut contacts, cx);
    }
    let general = general_contacts(
        outline,
        mesh_index,
        (surfaces, &contacts),
        &interactions,
        cx,
    );
    if !general.is_empty() {
        report_pairs(&contacts, surfaces, cx);
    }
    contacts.extend(general);
    contacts
}

/// Formulation of contact that the parameter `TYPE` asks for.
fn formulation(card: &Card) -> ContactFormulation {
    match card.choice("TYPE") {
        Some("SURFACE TO SURFACE") => ContactFormulation::SurfaceToSurface,
        _ => ContactFormulation::NodeToSegment,
    }
}

/// Reads `ADJUST`, which is a clearance or a node set.
fn adjust(card: &Card, sets: &Sets, cx: &mut Context) -> Option<Adjust> {
    let value = card.value("ADJUST")?;
    if value.as_real().is_none() {
        return sets.node_names.find(value, cx).map(Adjust::Nodes);
    }
    let rule = "the clearance must not be negative";
    Some(Adjust::Within(Reach {
        above: value.real_that(|x| x >= 0.0, rule, Code::BadValue, cx.d)?,
        below: f64::INFINITY,
        clearance: 0.0,
    }))
}

/// Gives the clearance of `*CLEARANCE` to the contact that the card names.
fn clearance(card: &Card, surfaces: &Surfaces, contacts: &mut [Contact], cx: &mut Context) {
    let rule = "the clearance must not be negative";
    let value = card.required("VALUE", cx.d);
    let value = value.and_then(|value| value.real_that(|x| x >= 0.0, rule, Code::BadValue, cx.d));
    let mut surface = |name: &'static str| {
        let field = card.required(name, cx.d)?;
        Some(surfaces.find(field, cx)?.0)
    };
    let (slave, master) = (surface("SLAVE"), surface("MASTER"));
    let (Some(value), Some(slave), Some(master)) = (value, slave, master) else {
        return;
    };
    let is_meant = |contact: &&mut Contact| (contact.slave, contact.master) == (slave, master);
    let fault = match contacts.iter_mut().find(is_meant) {
        None if cx.may_lack_cards() => return,
        None => "there is no contact pair of this slave and this master",
        Some(contact) if contact.is_self_contact() => {
            "the nodes of a surface that touches itself cannot be moved by a pair"
        }
        Some(contact) if contact.adjust.is_some() => {
            "the nodes of this contact pair are moved already"
        }
        Some(contact) => {
            contact.adjust = Some(Adjust::Clearance(value));
            return;
        }
    };
    cx.error(Code::SurfaceUse, card.span, fault)
        .help("*CLEARANCE gives one *CONTACT PAIR without ADJUST= its clearance");
}

fn report_adjusted_self_contact(contact: Option<&Contact>, card: &Card, cx: &mut Context) {
    if card.has("ADJUST") && contact.is_some_and(Contact::is_self_contact) {
        let message =
            "the nodes of a surface that touches itself cannot be moved onto it by a pair";
        cx.error(Code::SurfaceUse, card.span_of("ADJUST"), message)
            .help("general contact can: *CONTACT INITIALIZATION DATA");
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

/// Reads a row `slave, master`; a single surface is in contact with itself.
fn contact(
    row: Line,
    interaction: Option<Interaction>,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Option<Contact> {
    row.at_most(2, cx.d);
    let slave = row.required(0, "the slave surface", cx.d);
    let slave = slave.and_then(|field| surfaces.find(field, cx));
    let master = match row.get(1) {
        Some(field) => surfaces.find(field, cx),
        None => slave,
    };
    let (slave, master) = (slave?, master?);
    check_use(row, slave, master, cx)?;
    Some(Contact {
        span: row.span(),
        ..Contact::new([slave.0, master.0], interaction?)
    })
}

/// Reports surfaces that cannot be slave or master.
fn check_use(row: Line, slave: Found, master: Found, cx: &mut Context) -> Option<()> {
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
    } else if is_of_nodes {
        (
            format!("the master surface {name} is made of nodes"),
            "a master is made of element faces; the slave may be made of nodes",
        )
    } else {
        return Some(());
    };
    cx.error(Code::SurfaceUse, master.2, message).help(help);
    None
}

/// Keeps the arcs of rigid surfaces if discs may meet them, because slave nodes that are no discs meet only the chords.
pub(super) fn keep_arcs_for_discs(model: &mut Model) {
    let has_discs = model
        .contacts
        .iter()
        .any(|contact| model.disc(contact).is_some());
    for surface in &mut model.surfaces {
        if let SurfaceKind::Rigid(profile) = &mut surface.kind
            && !has_discs
            && profile.centre.is_none()
        {
            profile.arcs.clear();
        }
    }
}

/// Whether a profile is closed with its body outside, on the left of its segments.
fn is_hole(profile: &RigidProfile, mesh: &Mesh) -> bool {
    let ends = |segment: &Segment| segment.map(|node| mesh.coordinates[node]);
    let doubled_area: f64 = (profile.segments.iter())
        .map(ends)
        .map(|[a, b]| cross(a, b))
        .sum();
    let first = profile.segments.first().map(|segment| segment[0]);
    let last = profile.segments.last().map(|segment| segment[1]);
    first == last && doubled_area < 0.0
}

/// Reports rigid surfaces that are slaves but not discs.
pub(super) fn check_discs(model: &Model, cx: &mut Context) {
    for contact in &model.contacts {
        let SurfaceKind::Rigid(profile) = &model.surfaces[contact.slave].kind else {
            continue;
        };
        let name = &model.surfaces[contact.slave].name;
        let (message, help) = if is_hole(profile, &model.mesh) {
            (
                format!("the rigid surface {name} cannot be slave: it is a hole"),
                "its obstacle lies outside, on the right of the way from START: a disc is a full circle whose CIRCL \
                 rows go clockwise",
            )
        } else if profile.centre.is_none() {
            (
                format!("the rigid surface {name} cannot be slave"),
                "a rigid surface is a master: write the other surface first; only a full circle of \
                 CIRCL rows, which go clockwise, can be slave",
            )
        } else if contact.adjust.is_some() {
            (
                format!("the disc {name} cannot be moved on to the master before the start"),
                "leave ADJUST out and give its place",
            )
        } else {
            continue;
        };
        cx.error(Code::SurfaceUse, contact.span, message).help(help);
    }
}

/// Reads all interactions.
fn interactions(outline: &Outline, cx: &mut Context) -> Named<Interaction> {
    let mut interactions = Named::new("surface interaction");
    for block in outline.blocks("SURFACE INTERACTION") {
        interactions.add(block.head, cx, |name, cx| {
            let friction = friction(block, cx)?;
            let [wear, heat] = ["WEAR SURFACE PROPERTIES", "GAP HEAT GENERATION"].map(|keyword| {
                let cards = block.parts_of(keyword);
                cx.only_once(&cards);
                cards.first().copied().filter(|card| !card.faulty)
            });
            Some(Interaction {
                name: name.key.clone(),
                friction,
                wear: wear.and_then(|card| wear_of(card, cx)),
                heat: heat.and_then(|card| heat_of(card, cx)),
            })
        });
    }
    interactions
}

/// Friction of an interaction; `None` after a reported error.
fn friction(block: &CardBlock, cx: &mut Context) -> Option<Friction> {
    let behaviors = block.parts_of("SURFACE BEHAVIOR");
    cx.only_once(&behaviors);
    behaviors
        .iter()
        .for_each(|card| warn_of_behavior_data(card, cx));
    out_of_plane_thickness(block.head, cx);
    let cards = block.parts_of("FRICTION");
    cx.only_once(&cards);
    match cards.first() {
        None => Some(Friction::default()),
        Some(card) if card.faulty => None,
        Some(card) => friction_of(card, cx),
    }
}

/// Warns that the data of a pressure-overclosure law have no effect, as contact is exact; soft laws have a warning of their
/// own.
fn warn_of_behavior_data(card: &Card, cx: &mut Context) {
    let Some(row) = card.rows.first() else { return };
    match card.choice("PRESSURE-OVERCLOSURE") {
        Some("LINEAR" | "SCALE FACTOR") => return row.at_most(3, cx.d),
        Some("EXPONENTIAL") => return row.at_most(2, cx.d),
        Some("TABULAR") => {
            for row in card.rows.iter() {
                row.at_most(2, cx.d);
                row.real(0, "the pressure", cx.d);
                row.real(1, "the overclosure", cx.d);
            }
            return;
        }
        _ => {}
    }
    let message = "this data line has no effect";
    cx.d.warning_once(Code::IgnoredParameter, row.span(), message)
        .help("contact is enforced exactly: it needs no numbers");
}

/// `[thickness]` under `*SURFACE INTERACTION`; 1 is the default of other codes.
fn out_of_plane_thickness(head: &Card, cx: &mut Context) {
    let Some(row) = head.rows.first() else { return };
    row.at_most(1, cx.d);
    let thickness = row.real_or(0, 1.0, cx.d);
    if thickness.is_some_and(|thickness| thickness != 1.0) {
        let help = "the bodies touch over the thickness of their sections";
        row.without_effect(0, "this thickness has no effect", help, cx.d);
    }
}

/// Friction of a card: the coefficient, and the limit `TAUMAX` of the shear stress.
pub(super) fn friction_of(card: &Card, cx: &mut Context) -> Option<Friction> {
    let limit = card.real("TAUMAX", cx.d).unwrap_or(0.0);
    let span = card.span_of("TAUMAX");
    if limit < 0.0 {
        let message = "the largest shear stress must not be negative";
        cx.error(Code::FrictionRange, span, message);
        return None;
    }
    if card.has("TAUMAX") && card.has("ROUGH") {
        let message = "surfaces that never slip have no largest shear stress";
        cx.error(Code::FrictionRange, span, message)
            .help("leave out ROUGH or TAUMAX");
        return None;
    }
    Some(Friction {
        law: coefficient(card, cx)?,
        shear_limit: if limit > 0.0 { limit } else { f64::INFINITY },
    })
}

/// Reads `mu[, ...]`; with EXPONENTIAL DECAY `mu at rest, mu sliding, decay`; else rows `mu, slip rate, pressure`.
/// A card with ROUGH needs no row.
fn coefficient(card: &Card, cx: &mut Context) -> Option<FrictionLaw> {
    if card.has("ROUGH") {
        if let Some(row) = card.rows.first() {
            let message = "*FRICTION, ROUGH has no data line";
            cx.error(Code::StrayData, row.span(), message);
        }
        return Some(FrictionLaw::Rough);
    }
    let Some(row) = card.rows.first() else {
        cx.error(
            Code::MissingData,
            card.span,
            "*FRICTION needs the coefficient of friction",
        );
        return None;
    };
    if card.has("EXPONENTIAL DECAY") {
        row.at_most(3, cx.d);
        let at_rest = not_negative(row, 0, "the coefficient of friction at rest", cx);
        let sliding = not_negative(row, 1, "the coefficient of sliding friction", cx);
        let decay = not_negative(row, 2, "the decay of friction", cx);
        return Some(FrictionLaw::Decay {
            at_rest: at_rest?,
            sliding: sliding?,
            decay: decay?,
        });
    }
    if card.rows.get(1).is_some() {
        return table(card, cx);
    }
    let friction = not_negative(row, 0, "the coefficient of friction", cx)?;
    let message = "only the coefficient of friction is read here";
    let help = "sticking is exact: it needs no stick slope or slip rate";
    row.without_effect(1, message, help, cx.d);
    Some(Friction::constant(friction).law)
}

/// Reads rows `mu, slip rate, pressure`, pressure by pressure; the pressures increase, and so do the slip rates of each
/// pressure.
fn table(card: &Card, cx: &mut Context) -> Option<FrictionLaw> {
    let mut curves: Vec<FrictionCurve> = Vec::new();
    let mut temperature = None;
    for row in card.rows.iter() {
        row.at_most(4, cx.d);
        let mu = not_negative(row, 0, "the coefficient of friction", cx);
        let rate = not_negative_or_zero(row, 1, "the slip rate", cx);
        let pressure = not_negative_or_zero(row, 2, "the pressure", cx);
        let (mu, rate, pressure) = (mu?, rate?, pressure?);
        let own = row.real_or(3, 0.0, cx.d)?;
        if *temperature.get_or_insert(own) != own {
            let message = "friction that depends on temperature cannot be used";
            cx.error(Code::UnsupportedParameter, row.span_at(3), message);
            return None;
        }
        let fault = match curves.last_mut() {
            Some(curve) if curve.pressure == pressure => {
                let follows = curve.points.last().is_some_and(|last| last[0] < rate);
                curve.points.push([rate, mu]);
                let message = "slip rates must increase from row to row of a pressure";
                (!follows).then_some((1, message))
            }
            last => {
                let follows = last.is_none_or(|curve| curve.pressure < pressure);
                curves.push(FrictionCurve {
                    pressure,
                    points: vec![[rate, mu]],
                });
                let message = "pressures must increase: all rows of one, then those of the next";
                (!follows).then_some((2, message))
            }
        };
        if let Some((field, message)) = fault {
            cx.error(Code::FrictionRange, row.span_at(field), message);
            return None;
        }
    }
    Some(FrictionLaw::Table(curves))
}

/// Reads `k`, or `k/H` without UNITLESS WEAR COEF.
fn wear_of(card: &Card, cx: &mut Context) -> Option<Wear> {
    let row = card.rows.first()?;
    if let Some(extra) = card.rows.get(1) {
        let message = "a coefficient of wear that depends on pressure or depth cannot be used";
        cx.error(Code::UnsupportedParameter, extra.span(), message);
    }
    row.at_most(1, cx.d);
    let coefficient = not_negative(row, 0, "the coefficient of wear", cx)?;
    let hardness = match card.choice("UNITLESS WEAR COEF") {
        Some("YES") => {
            let hardness = card.required("REFERENCE STRESS", cx.d)?;
            let rule = "the hardness must be positive";
            hardness.real_that(|x| x > 0.0, rule, Code::BadValue, cx.d)?
        }
        _ => {
            if card.has("REFERENCE STRESS") {
                let message = "REFERENCE STRESS has no effect without UNITLESS WEAR COEF=YES";
                let span = card.span_of("REFERENCE STRESS");
                cx.error(Code::BadValue, span, message);
            }
            1.0
        }
    };
    Some(Wear {
        rate: coefficient / hardness,
        by_friction: card.choice("FRIC COEF DEPENDENT") == Some("YES"),
    })
}

/// Reads `part of the work of friction that becomes heat, part of this heat that enters the slave`.
fn heat_of(card: &Card, cx: &mut Context) -> Option<Heat> {
    let part = |index: usize, default: f64, cx: &mut Context| {
        let field = card.rows.first().and_then(|row| row.get(index));
        let rule = "parts lie between 0 and 1";
        field.map_or(Some(default), |field| {
            field.real_that(|x| (0.0..=1.0).contains(&x), rule, Code::BadValue, cx.d)
        })
    };
    if let Some(row) = card.rows.first() {
        let help = "heat is that of the work of friction";
        row.without_effect(2, "only the two parts are read here", help, cx.d);
    }
    let (part, to_slave) = (part(0, 1.0, cx), part(1, 0.5, cx));
    Some(Heat {
        part: part?,
        to_slave: to_slave?,
    })
}

/// The number of a field, which must not be negative; 0 if the field is empty; messages call the field `what`.
fn not_negative_or_zero(row: Line, index: usize, what: &str, cx: &mut Context) -> Option<f64> {
    match row.get(index) {
        Some(_) => not_negative(row, index, what, cx),
        None => Some(0.0),
    }
}

/// The number of a field, which must not be negative; messages call the field `what`.
fn not_negative(row: Line, index: usize, what: &str, cx: &mut Context) -> Option<f64> {
    let field = row.required(index, what, cx.d)?;
    let rule = format!("{what} must not be negative");
    field.real_that(|x| x >= 0.0, &rule, Code::FrictionRange, cx.d)
}

/// Reads general contact and adds its surface. The surface is in contact with itself and with every rigid surface;
/// contact with a rigid surface leaves out the slave nodes of contact pairs with this surface.
fn general_contacts(
    outline: &Outline,
    mesh_index: &MeshIndex,
    (surfaces, pairs): (&mut Surfaces, &[Contact]),
    interactions: &Named<Interaction>,
    cx: &mut Context,
) -> Vec<Contact> {
    let mut all = Vec::new();
    if let Some(general) = general(outline, mesh_index, surfaces, interactions, cx) {
        for &(master, _) in &surfaces.rigid {
            let left_out = paired(master, pairs, surfaces, mesh_index);
            all.push(Contact {
                master,
                left_out,
                lying_faces: None,
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
    interactions: &Named<Interaction>,
    cx: &mut Context,
) -> Option<Contact> {
    let blocks: Vec<&CardBlock> = outline.blocks("CONTACT").collect();
    let heads: Vec<&Card> = blocks.iter().map(|block| block.head).collect();
    cx.only_once(&heads);
    let block = blocks.first()?;
    let span = inclusions(block, cx);
    let assigned = assignment(block, interactions, cx);
    let initialization = initialization(outline, block, cx);
    let smoothing = smoothing::of_general(block, surfaces, cx);
    let formulations = block.parts_of("CONTACT FORMULATION");
    cx.only_once(&formulations);
    let span = span?;
    if surfaces.names.is_defined(&Name::plain(ALL_EXTERIOR)) {
        let message = format!("the deck has a surface {ALL_EXTERIOR} of its own");
        cx.error(Code::RepeatedName, span, message)
            .help("rename it: general contact makes a surface of this name");
        return None;
    }
    let (adjust, is_interference_fit) = match initialization.ok()? {
        None => (None, false),
        Some(Initialization { moved, is_fit }) => (moved.map(Adjust::Within), is_fit),
    };
    let surface = surfaces.all.len();
    surfaces.all.push(Surface {
        name: ALL_EXTERIOR.to_string(),
        kind: SurfaceKind::Faces(chained(&mesh_index.mesh.exterior_faces(), &mesh_index.mesh)),
    });
    Some(Contact {
        slave: surface,
        master: surface,
        interaction: assigned.ok()?,
        formulation: formulations
            .first()
            .map_or_else(ContactFormulation::default, |card| formulation(card)),
        lying_faces: formulations.is_empty().then_some(0),
        smoothing: smoothing.ok()?,
        adjust,
        left_out: Vec::new(),
        is_interference_fit,
        span,
    })
}

/// Reports contact pairs of faces, which general contact includes; pairs with a rigid surface are allowed and replace
/// general contact at their nodes.
fn report_pairs(pairs: &[Contact], surfaces: &Surfaces, cx: &mut Context) {
    let is_rigid = |pair: &Contact| {
        let master = surfaces.all.get(pair.master);
        master.is_some_and(|master| matches!(master.kind, SurfaceKind::Rigid(_)))
    };
    for pair in pairs.iter().filter(|pair| !is_rigid(pair)) {
        let message = "general contact holds between these surfaces already";
        cx.error(Code::GeneralContact, pair.span, message)
            .help("leave out the pair or *CONTACT: their forces would add up");
    }
}

/// Place of `ALL EXTERIOR`; `None` after a reported error.
fn inclusions(block: &CardBlock, cx: &mut Context) -> Option<Span> {
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
    cx.error(Code::GeneralContact, span, message).help(help);
    None
}

/// The interaction that was assigned last to all surfaces; `Err` after a reported error.
fn assignment(
    block: &CardBlock,
    interactions: &Named<Interaction>,
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

/// Reads a row `, , interaction`.
fn assigned_in(
    row: Line,
    interactions: &Named<Interaction>,
    cx: &mut Context,
) -> Option<Interaction> {
    let name = of_all_surfaces(row, "the interaction", cx)?;
    interactions.find(name, cx).cloned()
}

/// Leaves out of general contact the faces that equations join to other faces, as at a pre-tension section.
pub(super) fn leave_out_joined(model: &mut Model) {
    let mesh = &model.mesh;
    let partners = model.joined_nodes();
    let is_partner = |a: usize, b: usize| partners.contains(&[a.min(b), a.max(b)]);
    let own: BTreeSet<usize> = partners.iter().flatten().copied().collect();
    let all = mesh.exterior_faces();
    let mut may_be = all.clone();
    may_be.retain(|face| face.nodes(mesh).iter().all(|node| own.contains(node)));
    let is_joined = |face: &Face| {
        may_be.iter().any(|other| {
            let nodes = other.nodes(mesh);
            let mut own = face.nodes(mesh).into_iter();
            other != face && own.all(|node| nodes.iter().any(|&other| is_partner(node, other)))
        })
    };
    let joined: HashSet<Face> = may_be.iter().copied().filter(is_joined).collect();
    let mut surfaces = model.surfaces.iter_mut();
    let general = surfaces.find(|surface| surface.name == ALL_EXTERIOR);
    if let (Some(surface), false) = (general, joined.is_empty()) {
        let rest = all.into_iter().filter(|face| !joined.contains(face));
        let rest: Vec<Face> = rest.collect();
        surface.kind = SurfaceKind::Faces(chained(&rest, mesh));
    }
}

/// The faces, ordered in chains along the boundaries.
fn chained(free: &[Face], mesh: &Mesh) -> Vec<Face> {
    let mut starts: HashMap<usize, Vec<usize>> = HashMap::new();
    for (i, face) in free.iter().enumerate() {
        starts.entry(face.ends(mesh)[0]).or_default().push(i);
    }
    let mut taken = vec![false; free.len()];
    let mut chained = Vec::with_capacity(free.len());
    for first in 0..free.len() {
        let mut next = Some(first).filter(|&i| !taken[i]);
        while let Some(i) = next {
            taken[i] = true;
            chained.push(free[i]);
            let at_end = starts.get(&free[i].ends(mesh)[1]).into_iter().flatten();
            next = at_end.copied().find(|&face| !taken[face]);
        }
    }
    chained
}

/// The contact initialization that was assigned last in the block of `*CONTACT`; `Err` after a reported error.
fn initialization(
    outline: &Outline,
    block: &CardBlock,
    cx: &mut Context,
) -> Result<Option<Initialization>, ()> {
    let all = initializations(outline, block, cx);
    let mut assigned = Ok(None);
    for card in block.parts_of("CONTACT INITIALIZATION ASSIGNMENT") {
        for row in card.rows.iter() {
            let name = of_all_surfaces(row, "the contact initialization", cx);
            let found = name.and_then(|name| all.find(name, cx)).copied();
            assigned = found.map(Some).ok_or(());
        }
    }
    assigned
}

/// All data of contact initialization; the cards may stand in the block of `*CONTACT` or outside it.
fn initializations(
    outline: &Outline,
    block: &CardBlock,
    cx: &mut Context,
) -> Named<Initialization> {
    const KEYWORD: &str = "CONTACT INITIALIZATION DATA";
    let mut all = Named::new("contact initialization");
    for card in [outline.model_cards(KEYWORD), block.parts_of(KEYWORD)].concat() {
        all.add(card, cx, |_, cx| {
            own_initialization(card, cx).filter(|_| !card.faulty)
        });
    }
    all
}

/// Initialization of general contact before the start.
#[derive(Debug, Clone, Copy)]
struct Initialization {
    /// Choice of the nodes that are moved.
    moved: Option<Reach>,
    /// Whether overlaps are removed in the first step.
    is_fit: bool,
}

/// Reads which nodes are moved, or which overlaps stay.
fn own_initialization(card: &Card, cx: &mut Context) -> Option<Initialization> {
    if !card.has("INTERFERENCE FIT") {
        let moved = Some(reach(card, cx)?);
        return Some(Initialization {
            moved,
            is_fit: false,
        });
    }
    let is_moved = card.value("INTERFERENCE FIT").is_some();
    let mut others = ["SEARCH ABOVE", "SEARCH BELOW"].into_iter();
    let not_meant = match card.has("INITIAL CLEARANCE") {
        true => Some("INITIAL CLEARANCE"),
        false => others.find(|name| !is_moved && card.has(name)),
    };
    if let Some(name) = not_meant {
        let message =
            format!("{name} moves nodes, and INTERFERENCE FIT leaves them where they are");
        cx.error(Code::Interference, card.span_of(name), message)
            .help(format!("leave out {name}"));
        return None;
    }
    let moved = match card.value("INTERFERENCE FIT") {
        None => None,
        Some(value) => {
            let rule = "the overlap must be positive";
            let overlap = value.real_that(|x| x > 0.0, rule, Code::BadValue, cx.d)?;
            Some(Reach {
                clearance: -overlap,
                ..reach(card, cx)?
            })
        }
    };
    Some(Initialization {
        moved,
        is_fit: true,
    })
}

/// Choice of the nodes that are moved, and their new places; by default only nodes inside the other body are moved.
fn reach(card: &Card, cx: &mut Context) -> Option<Reach> {
    let mut or = |name: &str, default: f64| {
        let rule = format!("{name} must not be negative");
        match card.has(name) {
            true => card
                .value(name)?
                .real_that(|x| x >= 0.0, &rule, Code::BadValue, cx.d),
            false => Some(default),
        }
    };
    let (above, below) = (or("SEARCH ABOVE", 0.0), or("SEARCH BELOW", f64::INFINITY));
    let clearance = or("INITIAL CLEARANCE", 0.0);
    Some(Reach {
        above: above?,
        below: below?,
        clearance: clearance?,
    })
}

/// Reads the name in a row `, , name`, whose empty fields stand for all surfaces; messages call the name `what`.
fn of_all_surfaces<'a>(row: Line<'a>, what: &str, cx: &mut Context) -> Option<Text<'a>> {
    row.at_most(3, cx.d);
    let mut named = (0..2).filter_map(|i| row.get(i));
    if let Some(field) = named.find(|field| field.name_key() != "ALLEXTERIOR") {
        let message = "only the assignment to all surfaces is supported";
        cx.error(Code::GeneralContact, field.span, message)
            .help("leave the first two fields empty");
        return None;
    }
    row.required(2, what, cx.d)
}
