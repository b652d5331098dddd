//! Writes the part of the deck before the steps: nodes, elements, sets and surfaces, materials and sections,
//! amplitudes, contacts with their interactions, rigid bodies and equations.

use super::lines::{DeckWriter, name, named, number, set};
use crate::deck::Text;
use crate::diagnostics::Span;
use crate::materials::{Expansion, Law};
use crate::model::{
    ALL_EXTERIOR, Adjust, Amplitude, Circle, Connector, ConnectorDirection, ConnectorLaw, Contact,
    Curve, Damping, Element, Equation, Face, ForceCurve, Friction, FrictionLaw, Heat, Interaction,
    Material, Mesh, Model, Reach, RigidBody, RigidPart, RigidProfile, Section, Set, Signal,
    Smoothing, SurfaceKind, Tie, TieReach, TimeBase, Wear,
};
use std::collections::BTreeSet;

/// Number of terms of an equation on a data line.
const TERMS: usize = 4;

/// Writes everything that stands before the initial velocities and the steps.
pub(super) fn write(model: &Model, lines: &mut DeckWriter) {
    write_mesh(model, lines);
    write_properties(model, lines);
    write_connectors(model, lines);
    write_amplitudes(&model.amplitudes, lines);
    write_contacts(model, lines);
}

/// Writes contacts, rigid bodies and equations.
fn write_contacts(model: &Model, lines: &mut DeckWriter) {
    let interactions = Interactions::write(&model.contacts, lines);
    let all_exterior = all_exterior(model);
    let is_general = |contact: &&Contact| Some(contact.slave) == all_exterior;
    for contact in model.contacts.iter().filter(|contact| !is_general(contact)) {
        pair(contact, &interactions, model, lines);
    }
    if let Some(general) = model.contacts.iter().find(is_general) {
        let interaction = interactions.name(&general.interaction);
        lines.card("CONTACT", []);
        lines.card("CONTACT INCLUSIONS", ["ALL EXTERIOR".to_owned()]);
        lines.card("CONTACT PROPERTY ASSIGNMENT", []);
        lines.row([String::new(), String::new(), interaction]);
        if general.lying_faces.is_none() {
            let formulation = set("TYPE", general.formulation.name());
            lines.card("CONTACT FORMULATION", [formulation]);
        }
        let reach = match general.adjust {
            Some(Adjust::Within(reach)) => Some(reach),
            _ => None,
        };
        initialization(reach, general.is_interference_fit, lines);
        general_smoothing(general, model, lines);
    }
    for body in &model.rigid_bodies {
        if body.is_coupling {
            let labels = |node: usize| model.mesh.node_labels[node].to_string();
            lines.card(
                "KINEMATIC COUPLING",
                [
                    named("NAME", &body.name),
                    set("REF NODE", labels(body.reference)),
                ],
            );
            for &node in &body.nodes {
                lines.row([labels(node), "1".to_owned(), "2".to_owned()]);
            }
            continue;
        }
        let label = model.mesh.node_labels[body.reference];
        for part in &body.parts {
            let part = match part {
                RigidPart::Surface(index) => {
                    named("ANALYTICAL SURFACE", &model.surfaces[*index].name)
                }
                RigidPart::Elements(set) => named("ELSET", set),
                RigidPart::Nodes(set) => named("NSET", set),
            };
            lines.card("RIGID BODY", [part, set("REF NODE", label)]);
        }
    }
    let riders: Vec<[usize; 2]> = (model.rigid_bodies.iter())
        .flat_map(|body| riders(body, model).map(|node| [node, body.reference]))
        .collect();
    if !riders.is_empty() || !model.hinges.is_empty() {
        lines.card("MPC", []);
    }
    for nodes in riders {
        let [a, b] = nodes.map(|node| model.mesh.node_labels[node].to_string());
        lines.row(["BEAM".to_owned(), a, b]);
    }
    for hinge in &model.hinges {
        let [a, b] = hinge
            .nodes
            .map(|node| model.mesh.node_labels[node].to_string());
        lines.row(["PIN".to_owned(), a, b]);
    }
    point_elements(model, lines);
    for tie in &model.ties {
        write_tie(tie, model, lines);
    }
    let mut of_ties: Vec<usize> = (model.ties.iter())
        .flat_map(|tie| tie.nodes.iter().map(|tied| tied.node))
        .collect();
    of_ties.sort_unstable();
    let is_own = |equation: &&Equation| of_ties.binary_search(&(equation.dof / 2)).is_err();
    for equation in model.equations.iter().filter(is_own) {
        write_equation(equation, model, lines);
    }
}

/// Nodes of a rigid body that belong neither to its elements, its node sets nor its surfaces: a constraint makes these
/// nodes move with the body.
fn riders<'m>(body: &'m RigidBody, model: &'m Model) -> impl Iterator<Item = usize> + 'm {
    let elements = body.elements.iter();
    let mut own: BTreeSet<usize> = elements
        .flat_map(|&element| &model.mesh.elements[element].nodes)
        .copied()
        .collect();
    let key = |text: &str| {
        let span = Span::default();
        Text { text, span }.name_key()
    };
    for part in &body.parts {
        match part {
            RigidPart::Surface(surface) => own.extend(model.surfaces[*surface].nodes(&model.mesh)),
            RigidPart::Nodes(name) => {
                let mut sets = model.sets.nodes.iter();
                let set = sets.find(|set| key(&set.name) == key(name));
                own.extend(set.iter().flat_map(|set| &set.members));
            }
            RigidPart::Elements(_) => {}
        }
    }
    let is_whole = body.is_coupling;
    let nodes = body.nodes.iter().copied();
    nodes.filter(move |node| !is_whole && !own.contains(node))
}

/// Masses at nodes and rotary inertia of rigid bodies, written as elements with numbers above the largest number of the
/// model.
fn point_elements(model: &Model, lines: &mut DeckWriter) {
    let elements = model.mesh.elements.iter().map(|element| element.label);
    let connectors = model.connectors.iter().map(|connector| connector.label);
    let mut label = elements.chain(connectors).max().unwrap_or(0);
    let mut write = |element_type: &str, keyword: &str, node: usize, row: Vec<String>| {
        label += 1;
        let name = format!("{element_type}-{label}");
        let parameters = [set("TYPE", element_type), set("ELSET", &name)];
        lines.card("ELEMENT", parameters);
        lines.row([label.to_string(), model.mesh.node_labels[node].to_string()]);
        lines.card(keyword, [set("ELSET", &name)]);
        lines.row(row);
    };
    for &(node, mass) in &model.point_masses {
        write("MASS", "MASS", node, vec![number(mass)]);
    }
    for body in &model.rigid_bodies {
        for &(node, mass) in &body.masses {
            write("MASS", "MASS", node, vec![number(mass)]);
        }
        if body.rotary_inertia > 0.0 {
            let row = vec![String::new(), String::new(), number(body.rotary_inertia)];
            write("ROTARYI", "ROTARY INERTIA", body.reference, row);
        }
    }
}

/// The different interactions in the order of the contacts.
pub(super) struct Interactions(Vec<Interaction>);

impl Interactions {
    /// The interactions of the contacts.
    pub fn new(contacts: &[Contact]) -> Self {
        let mut all = Vec::new();
        for contact in contacts {
            if !all.contains(&contact.interaction) {
                all.push(contact.interaction.clone());
            }
        }
        Interactions(all)
    }

    fn write(contacts: &[Contact], lines: &mut DeckWriter) -> Self {
        let interactions = Interactions::new(contacts);
        for interaction in &interactions.0 {
            lines.card(
                "SURFACE INTERACTION",
                [set("NAME", interactions.name(interaction))],
            );
            lines.card("SURFACE BEHAVIOR", [set("PRESSURE-OVERCLOSURE", "HARD")]);
            friction(&interaction.friction, lines);
            if let Some(Wear { rate, by_friction }) = interaction.wear {
                let dependent = set("FRIC COEF DEPENDENT", "YES");
                let parameters = by_friction.then_some(dependent);
                lines.card("WEAR SURFACE PROPERTIES", parameters);
                lines.row([number(rate)]);
            }
            if let Some(Heat { part, to_slave }) = interaction.heat {
                lines.card("GAP HEAT GENERATION", []);
                lines.row([part, to_slave].map(number));
            }
        }
        interactions
    }

    pub fn name(&self, interaction: &Interaction) -> String {
        let index = self.0.iter().position(|known| known == interaction);
        format!("INTERACTION-{}", index.map_or(0, |index| index + 1))
    }
}

/// Writes the friction of a contact.
pub(super) fn friction(friction: &Friction, lines: &mut DeckWriter) {
    let mut parameters = Vec::new();
    if friction.has_limit() {
        parameters.push(set("TAUMAX", number(friction.shear_limit)));
    }
    let rows: Vec<Vec<f64>> = match &friction.law {
        FrictionLaw::Decay {
            at_rest,
            sliding,
            decay,
        } if at_rest == sliding && *decay == 0.0 => vec![vec![*at_rest]],
        FrictionLaw::Decay {
            at_rest,
            sliding,
            decay,
        } => {
            parameters.push("EXPONENTIAL DECAY".to_owned());
            vec![vec![*at_rest, *sliding, *decay]]
        }
        FrictionLaw::Table(curves) => {
            let rows = curves.iter().flat_map(|curve| {
                let of_curve = |[rate, mu]: &[f64; 2]| vec![*mu, *rate, curve.pressure];
                curve.points.iter().map(of_curve)
            });
            rows.collect()
        }
        FrictionLaw::Rough => {
            parameters.push("ROUGH".to_owned());
            Vec::new()
        }
    };
    lines.card("FRICTION", parameters);
    for row in rows {
        lines.row(row.into_iter().map(number));
    }
}

/// Writes slave and master of a pair.
pub(super) fn pair_row(contact: &Contact, model: &Model, lines: &mut DeckWriter) {
    let surface = |index: usize| name(&model.surfaces[index].name);
    match contact.is_self_contact() {
        true => lines.row([surface(contact.slave)]),
        false => lines.row([contact.slave, contact.master].map(surface)),
    }
}

/// Writes the shape of the faces of general contact.
fn general_smoothing(general: &Contact, model: &Model, lines: &mut DeckWriter) {
    let rows = match &general.smoothing {
        Smoothing::Straight => vec![vec![String::new(), "NONE".to_owned()]],
        Smoothing::Curved(circles) => {
            let row = |circle: &Circle| {
                let surface = name(&model.surfaces[circle.surface].name);
                let mut row = vec![surface, "CIRCUMFERENTIAL".to_owned()];
                row.extend(circle.centre.map(number));
                row
            };
            circles.iter().map(row).collect()
        }
    };
    if !rows.is_empty() {
        let property = set("PROPERTY", "GEOMETRIC CORRECTION");
        lines.card("SURFACE PROPERTY ASSIGNMENT", [property]);
    }
    rows.into_iter().for_each(|row| lines.row(row));
}

/// Writes the circles of a contact pair, and the parameter of its card that names these circles.
fn smoothing(contact: &Contact, model: &Model, lines: &mut DeckWriter) -> Option<String> {
    let circles = match &contact.smoothing {
        Smoothing::Straight => return Some(set("GEOMETRIC CORRECTION", "NONE")),
        Smoothing::Curved(circles) if circles.is_empty() => return None,
        Smoothing::Curved(circles) => circles,
    };
    let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i].name);
    let own = format!("{slave}-{master}-SMOOTHING");
    lines.card("SURFACE SMOOTHING", [named("NAME", &own)]);
    for circle in circles {
        let surface = name(&model.surfaces[circle.surface].name);
        let [x, y] = circle.centre.map(number);
        lines.row([surface, String::new(), "CIRCUMFERENTIAL".to_owned(), x, y]);
    }
    Some(named("GEOMETRIC CORRECTION", &own))
}

fn pair(contact: &Contact, interactions: &Interactions, model: &Model, lines: &mut DeckWriter) {
    let correction = smoothing(contact, model, lines);
    let mut parameters = vec![
        set("INTERACTION", interactions.name(&contact.interaction)),
        set("TYPE", contact.formulation.name()),
    ];
    parameters.extend(correction);
    parameters.extend(contact.adjust.and_then(|adjust| match adjust {
        Adjust::Within(reach) => Some(set("ADJUST", number(reach.above))),
        Adjust::Nodes(set) => Some(named("ADJUST", &model.sets.nodes[set].name)),
        Adjust::Clearance(_) => None,
    }));
    lines.card("CONTACT PAIR", parameters);
    pair_row(contact, model, lines);
    if let Some(Adjust::Clearance(clearance)) = contact.adjust {
        let surface = |index: usize| &model.surfaces[index].name;
        let parameters = [
            named("SLAVE", surface(contact.slave)),
            named("MASTER", surface(contact.master)),
            set("VALUE", number(clearance)),
        ];
        lines.card("CLEARANCE", parameters);
    }
}

/// Writes which nodes of general contact are moved before the start, and whether the remaining overlaps are removed in
/// the first step.
fn initialization(reach: Option<Reach>, is_fit: bool, lines: &mut DeckWriter) {
    const NAME: &str = "INITIALIZATION-1";
    if reach.is_none() && !is_fit {
        return;
    }
    let mut parameters = vec![set("NAME", NAME)];
    if let Some(reach) = reach {
        parameters.push(set("SEARCH ABOVE", number(reach.above)));
        if reach.below.is_finite() {
            parameters.push(set("SEARCH BELOW", number(reach.below)));
        }
        parameters.push(match is_fit {
            true => set("INTERFERENCE FIT", number(-reach.clearance)),
            false => set("INITIAL CLEARANCE", number(reach.clearance)),
        });
    } else {
        parameters.push("INTERFERENCE FIT".to_owned());
    }
    lines.card("CONTACT INITIALIZATION DATA", parameters);
    lines.card("CONTACT INITIALIZATION ASSIGNMENT", []);
    lines.row([String::new(), String::new(), NAME.to_owned()]);
}

/// Writes a tie without adjusting its nodes, which the model has already moved.
fn write_tie(tie: &Tie, model: &Model, lines: &mut DeckWriter) {
    let mut parameters = vec![
        named("NAME", &tie.name),
        set("TYPE", tie.formulation.name()),
        set("ADJUST", "NO"),
    ];
    parameters.extend(match tie.reach {
        TieReach::Near => None,
        TieReach::Within(tolerance) => Some(set("POSITION TOLERANCE", number(tolerance))),
        TieReach::Nodes(set) => Some(named("TIED NSET", &model.sets.nodes[set].name)),
    });
    lines.card("TIE", parameters);
    lines.row([tie.slave, tie.master].map(|surface| name(&model.surfaces[surface].name)));
}

/// Writes the equation -u_dof + sum c_k u_k = 0.
fn write_equation(equation: &Equation, model: &Model, lines: &mut DeckWriter) {
    let Equation { dof, terms } = equation;
    let mut all = vec![(*dof, -1.0)];
    all.extend(terms);
    if terms.is_empty() {
        all.extend(any_other_dof(*dof, model).map(|other| (other, 0.0)));
    }
    lines.card("EQUATION", []);
    lines.row([all.len().to_string()]);
    for terms in all.chunks(TERMS) {
        lines.row(terms.iter().flat_map(|&(dof, coefficient)| {
            let label = model.mesh.node_labels[dof / 2];
            [
                label.to_string(),
                (dof % 2 + 1).to_string(),
                number(coefficient),
            ]
        }));
    }
}

/// A dof that no equation eliminates, as the second term of equations that have only one term.
fn any_other_dof(dof: usize, model: &Model) -> Option<usize> {
    let eliminated = |other: &usize| model.equations.iter().any(|e| e.dof == *other);
    (0..model.mesh.dof_count()).find(|other| *other != dof && !eliminated(other))
}

/// Writes nodes, elements, sets and surfaces.
fn write_mesh(model: &Model, lines: &mut DeckWriter) {
    let mesh = &model.mesh;
    nodes(model, lines);
    for block in mesh
        .elements
        .chunk_by(|a, b| a.element_type.name() == b.element_type.name())
    {
        elements(block, mesh, lines);
    }
    let node_label = |&node: &usize| mesh.node_labels[node];
    let element_label = |&element: &usize| mesh.elements[element].label;
    sets("NSET", &model.sets.nodes, node_label, lines);
    sets("ELSET", &model.sets.elements, element_label, lines);
    surfaces(model, lines);
}

/// Index of the first node that belongs to a rigid surface: the nodes from this index on are written with the surfaces.
fn first_of_rigid(model: &Model) -> usize {
    let nodes = model.rigid_segments().into_iter().flatten();
    nodes.min().unwrap_or(model.mesh.node_count())
}

/// The surface of general contact, if there is one: the last surface, if it has the name of general contact and is in
/// contact with itself.
pub(super) fn all_exterior(model: &Model) -> Option<usize> {
    let last = model.surfaces.len().checked_sub(1)?;
    let touches_itself = |contact: &Contact| contact.slave == last && contact.master == last;
    let is_named = model.surfaces[last].name == ALL_EXTERIOR;
    (is_named && model.contacts.iter().any(touches_itself)).then_some(last)
}

fn nodes(model: &Model, lines: &mut DeckWriter) {
    lines.card("NODE", []);
    let nodes = model.mesh.node_labels.iter().zip(&model.mesh.coordinates);
    for (label, x) in nodes.take(first_of_rigid(model)) {
        lines.row([label.to_string(), number(x[0]), number(x[1])]);
    }
}

fn elements(elements: &[Element], mesh: &Mesh, lines: &mut DeckWriter) {
    let Some(first) = elements.first() else {
        return;
    };
    lines.card("ELEMENT", [set("TYPE", first.element_type.name())]);
    for element in elements {
        let nodes = element.nodes.iter().map(|&node| mesh.node_labels[node]);
        lines.row(
            [element.label]
                .into_iter()
                .chain(nodes)
                .map(|label| label.to_string()),
        );
    }
}

fn sets(keyword: &str, sets: &[Set], label: impl Fn(&usize) -> u64, lines: &mut DeckWriter) {
    for set in sets {
        lines.card(keyword, [named(keyword, &set.name)]);
        let labels: Vec<u64> = set.members.iter().map(&label).collect();
        lines.list(&labels);
    }
}

/// The surfaces without the surface of general contact, which the card of general contact creates.
fn surfaces(model: &Model, lines: &mut DeckWriter) {
    let mesh = &model.mesh;
    let own = all_exterior(model).unwrap_or(model.surfaces.len());
    for surface in &model.surfaces[..own] {
        let kind = match surface.kind {
            SurfaceKind::Faces(_) => "ELEMENT",
            SurfaceKind::Nodes(_) => "NODE",
            SurfaceKind::Rigid(_) => "SEGMENTS",
        };
        lines.card("SURFACE", [named("NAME", &surface.name), set("TYPE", kind)]);
        match &surface.kind {
            SurfaceKind::Faces(faces) => faces
                .iter()
                .for_each(|face| lines.row(face_fields(face, mesh))),
            SurfaceKind::Nodes(nodes) => {
                for &node in nodes {
                    lines.row([mesh.node_labels[node].to_string()]);
                }
            }
            SurfaceKind::Rigid(rigid) => profile(rigid, mesh, lines),
        }
    }
}

fn face_fields(face: &Face, mesh: &Mesh) -> [String; 2] {
    let label = mesh.elements[face.element].label;
    [label.to_string(), format!("S{}", face.side + 1)]
}

/// A rigid profile from its last segment to its first, as the deck gives it.
fn profile(rigid: &RigidProfile, mesh: &Mesh, lines: &mut DeckWriter) {
    let (segments, mut arcs) = (&rigid.segments, rigid.arcs.iter().rev().peekable());
    let (mut end, mut left) = (None, segments.len());
    while let Some(&[_, from]) = segments[..left].last() {
        if end != Some(from) {
            lines.row(point("START", from, mesh));
        }
        let arc = arcs.next_if(|arc| arc.segments.end == left);
        left = arc.map_or(left - 1, |arc| arc.segments.start);
        let [to, _] = segments[left];
        match arc {
            None => lines.row(point("LINE", to, mesh)),
            Some(arc) => {
                let centre = arc.centre.map(number);
                lines.row(point("CIRCL", to, mesh).into_iter().chain(centre));
            }
        }
        end = Some(to);
    }
}

fn point(word: &str, node: usize, mesh: &Mesh) -> [String; 3] {
    let [x, y] = mesh.coordinates[node].map(number);
    [word.to_owned(), x, y]
}

/// The set that consists of exactly the given elements.
pub(super) fn set_of<'m>(elements: &[usize], model: &'m Model) -> Option<&'m str> {
    let mut sets = model.sets.elements.iter();
    let found = sets.find(|set| set.members == elements)?;
    Some(&found.name)
}

/// A field that names elements of bodies: empty for all elements, or the name of a set; `None` where no set has exactly
/// these elements. An empty field also names point masses, but the flat deck writes the weights of point masses as
/// forces.
pub(super) fn elements_field(elements: &[usize], model: &Model) -> Option<String> {
    let mut bodies = model.rigid_bodies.iter();
    let has_masses = bodies.any(|body| !body.masses.is_empty());
    match elements.len() == model.mesh.elements.len() && !has_masses {
        true => Some(String::new()),
        false => set_of(elements, model).map(name),
    }
}

/// Writes materials and sections.
fn write_properties(model: &Model, lines: &mut DeckWriter) {
    for material in &model.materials {
        write_material(material, lines);
    }
    for (index, section) in model.sections.iter().enumerate() {
        write_section(index, section, model, lines);
    }
}

fn write_material(material: &Material, lines: &mut DeckWriter) {
    let Material {
        name,
        law,
        density,
        damping,
        expansion,
    } = material;
    lines.card("MATERIAL", [named("NAME", name)]);
    write_law(law, lines);
    // a material that no section names may lack constants
    if *density > 0.0 {
        lines.card("DENSITY", []);
        lines.row([number(*density)]);
    }
    if let Some(Expansion { zero, table }) = expansion {
        lines.card("EXPANSION", [set("ZERO", number(*zero))]);
        for [temperature, alpha] in table {
            lines.row([number(*alpha), number(*temperature)]);
        }
    }
    let Damping { alpha, beta } = *damping;
    if alpha != 0.0 || beta != 0.0 {
        lines.card(
            "DAMPING",
            [set("ALPHA", number(alpha)), set("BETA", number(beta))],
        );
    }
}

fn write_law(law: &Law, lines: &mut DeckWriter) {
    for card in law.cards() {
        lines.card(card.keyword, card.parameter.map(str::to_owned));
        for row in card.rows {
            lines.row(row.into_iter().map(number));
        }
    }
}

fn write_section(index: usize, section: &Section, model: &Model, lines: &mut DeckWriter) {
    let Section {
        material,
        thickness,
    } = *section;
    let elements = model.mesh.elements.iter().enumerate();
    let members: Vec<usize> = elements
        .filter(|(_, e)| e.section == index)
        .map(|(i, _)| i)
        .collect();
    let set_name = set_of(&members, model).map(str::to_owned);
    let set_name = set_name.unwrap_or_else(|| new_set(index, &members, model, lines));
    lines.card(
        "SOLID SECTION",
        [
            named("ELSET", &set_name),
            named("MATERIAL", &model.materials[material].name),
        ],
    );
    let is_ring = |&element: &usize| model.mesh.elements[element].element_type.is_ring();
    if !members.iter().any(is_ring) {
        lines.row([number(thickness)]);
    }
}

/// Writes a set of the elements of a section where the model has no such set.
fn new_set(index: usize, members: &[usize], model: &Model, lines: &mut DeckWriter) -> String {
    let set = Set {
        name: format!("SECTION-{}", index + 1),
        members: members.to_vec(),
    };
    let label = |&element: &usize| model.mesh.elements[element].label;
    sets("ELSET", std::slice::from_ref(&set), label, lines);
    set.name
}

/// Writes springs and dashpots; neighbouring springs or dashpots of the same kind share a card.
fn write_connectors(model: &Model, lines: &mut DeckWriter) {
    let alike = |a: &Connector, b: &Connector| {
        let what = |c: &Connector| (c.type_name(), c.direction, c.law);
        what(a) == what(b) && a.curve == b.curve
    };
    for (index, group) in model.connectors.chunk_by(alike).enumerate() {
        let Connector {
            direction,
            law,
            curve,
            ..
        } = &group[0];
        let set_name = format!("CONNECTORS-{}", index + 1);
        let (set_of, kind) = (named("ELSET", &set_name), set("TYPE", group[0].type_name()));
        lines.card("ELEMENT", [kind, set_of.clone()]);
        for Connector { label, nodes, .. } in group {
            let nodes = nodes.iter().map(|&node| model.mesh.node_labels[node]);
            lines.row(
                std::iter::once(*label)
                    .chain(nodes)
                    .map(|label| label.to_string()),
            );
        }
        let (directions, axes) = match direction {
            ConnectorDirection::Line => (None, None),
            ConnectorDirection::Angle => (Some([6; 2]), None),
            ConnectorDirection::Fixed(both) => match both.map(axis) {
                [Some(first), Some(second)] => (Some([first, second]), None),
                _ if both[0] == both[1] => (Some([1, 1]), Some(*both)),
                _ => (Some([1, 2]), Some(*both)),
            },
        };
        let mut parameters = vec![set_of];
        if let Some([first, second]) = axes {
            let name = format!("AXES-{}", index + 1);
            parameters.push(named("ORIENTATION", &name));
            let side = match first == second {
                true => [-first[1], first[0]],
                false => second,
            };
            lines.card("ORIENTATION", [named("NAME", &name)]);
            let [[ax, ay], [bx, by]] = [first, side];
            lines.row([ax, ay, 0.0, bx, by, 0.0].map(number));
        }
        if let ForceCurve::Table(_) = curve {
            parameters.push("NONLINEAR".to_owned());
        }
        let keyword = match law {
            ConnectorLaw::Spring => "SPRING",
            ConnectorLaw::Dashpot => "DASHPOT",
        };
        lines.card(keyword, parameters);
        if let Some(both) = directions {
            let count = group[0].nodes.len();
            lines.row(both.iter().take(count).map(usize::to_string));
        }
        match curve {
            ForceCurve::Linear(factor) => lines.row([number(*factor)]),
            ForceCurve::Table(points) => {
                for &[at, force] in points {
                    lines.row([force, at].map(number));
                }
            }
        }
    }
}

/// Number (1 or 2) of the direction along an axis of the plane.
fn axis(direction: [f64; 2]) -> Option<usize> {
    let axes = [[1.0, 0.0], [0.0, 1.0]];
    let found = axes.iter().position(|axis| *axis == direction);
    found.map(|index| index + 1)
}

/// Number of points on a data line.
const POINTS: usize = 4;

/// Writes all amplitudes.
fn write_amplitudes(amplitudes: &[Amplitude], lines: &mut DeckWriter) {
    for Amplitude { name, time, curve } in amplitudes {
        let time = match time {
            TimeBase::Step => "STEP TIME",
            TimeBase::Total => "TOTAL TIME",
        };
        let parameters = [
            named("NAME", name),
            set("TIME", time),
            set("DEFINITION", definition(curve)),
        ];
        lines.card("AMPLITUDE", parameters);
        match curve {
            Curve::Linear(points) | Curve::SmoothStep(points) => pairs(points, lines),
            Curve::Signal {
                start,
                base,
                signal,
            } => write_signal(*start, *base, signal, lines),
        }
    }
}

fn definition(curve: &Curve) -> &'static str {
    match curve {
        Curve::Linear(_) => "TABULAR",
        Curve::SmoothStep(_) => "SMOOTH STEP",
        Curve::Signal { signal, .. } => match signal {
            Signal::Periodic { .. } => "PERIODIC",
            Signal::Decay { .. } => "DECAY",
            Signal::Modulated { .. } => "MODULATED",
        },
    }
}

fn pairs(pairs: &[(f64, f64)], lines: &mut DeckWriter) {
    for pairs in pairs.chunks(POINTS) {
        lines.row(pairs.iter().flat_map(|&(a, b)| [a, b]).map(number));
    }
}

fn write_signal(start: f64, base: f64, signal: &Signal, lines: &mut DeckWriter) {
    match signal {
        Signal::Periodic {
            frequency,
            harmonics,
        } => {
            let numbers = [*frequency, start, base].map(number);
            lines.row([harmonics.len().to_string()].into_iter().chain(numbers));
            pairs(harmonics, lines);
        }
        Signal::Decay { size, time } => lines.row([base, *size, start, *time].map(number)),
        Signal::Modulated {
            size,
            frequencies: [w1, w2],
        } => {
            lines.row([base, *size, start, *w1, *w2].map(number));
        }
    }
}
