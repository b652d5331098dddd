//! Contacts with their interactions, rigid bodies and equations.

use super::lines::{Lines, name, named, number, set};
use super::mesh::{all_exterior, first_of_rigid};
use crate::model::{
    Adjust, Contact, Element, Equation, Friction, Interaction, Model, Reach, RigidBody,
};

/// Terms of an equation on a data line.
const TERMS: usize = 4;

/// Writes contacts, rigid bodies and equations.
pub(super) fn write(model: &Model, lines: &mut Lines) {
    let interactions = Interactions::write(&model.contacts, lines);
    let all_exterior = all_exterior(model);
    let is_general = |contact: &&Contact| Some(contact.slave) == all_exterior;
    for contact in model.contacts.iter().filter(|contact| !is_general(contact)) {
        pair(contact, &interactions, model, lines);
    }
    if let Some(general) = model.contacts.iter().find(is_general) {
        let interaction = interactions.name(general.interaction);
        lines.card("CONTACT", []);
        lines.card("CONTACT INCLUSIONS", ["ALL EXTERIOR".to_owned()]);
        lines.card("CONTACT PROPERTY ASSIGNMENT", []);
        lines.row([String::new(), String::new(), interaction]);
        if let Some(Adjust::Within(reach)) = general.adjust {
            initialization(reach, lines);
        }
    }
    for &RigidBody { surface, reference } in &model.rigid_bodies {
        let surface = named("ANALYTICAL SURFACE", &model.surfaces[surface].name);
        let label = model.mesh.node_labels[reference];
        lines.card("RIGID BODY", [surface, set("REF NODE", label)]);
    }
    rigid_elements(model, lines);
    for equation in &model.equations {
        write_equation(equation, model, lines);
    }
}

/// Rigid bodies of elements whose reference node belongs to nothing else. The model knows them by
/// their supports alone: one element that moves with the node keeps the node in the deck.
fn rigid_elements(model: &Model, lines: &mut Lines) {
    let mut is_kept = vec![false; first_of_rigid(model)];
    let of_elements = model.mesh.elements.iter().flat_map(|e| &e.nodes).copied();
    let of_surfaces = model.rigid_bodies.iter().map(|body| body.reference);
    let of_equations = model.equations.iter().flat_map(Equation::dofs);
    for node in of_elements
        .chain(of_surfaces)
        .chain(of_equations.map(|dof| dof / 2))
    {
        is_kept[node] = true;
    }
    let alone = is_kept.iter().enumerate().filter(|(_, kept)| !**kept);
    for (reference, _) in alone {
        let follows = |element: &&Element| {
            let mut nodes = element.nodes.iter();
            nodes.all(|&node| moves_with(node, reference, model))
        };
        if let Some(element) = model.mesh.elements.iter().find(follows) {
            let label = model.mesh.node_labels[reference];
            lines.card(
                "RIGID BODY",
                [set("ELSET", element.label), set("REF NODE", label)],
            );
        }
    }
}

/// Whether two nodes are prescribed alike in all steps.
fn moves_with(node: usize, other: usize, model: &Model) -> bool {
    model.steps.iter().all(|step| {
        let motion = |dof: usize| {
            let found = step
                .supports
                .binary_search_by_key(&dof, |support| support.dof);
            found.ok().map(|index| step.supports[index].motion)
        };
        (0..2).all(|i| {
            let both = [node, other].map(|node| motion(2 * node + i));
            both[0].is_some() && both[0] == both[1]
        })
    })
}

/// The different interactions in the order of the contacts.
struct Interactions(Vec<Interaction>);

impl Interactions {
    fn write(contacts: &[Contact], lines: &mut Lines) -> Self {
        let mut all = Vec::new();
        for contact in contacts {
            if !all.contains(&contact.interaction) {
                all.push(contact.interaction);
            }
        }
        let interactions = Interactions(all);
        for &interaction in &interactions.0 {
            let Interaction { friction } = interaction;
            lines.card(
                "SURFACE INTERACTION",
                [set("NAME", interactions.name(interaction))],
            );
            lines.card("SURFACE BEHAVIOR", [set("PRESSURE-OVERCLOSURE", "HARD")]);
            if friction == Friction::constant(friction.at_rest) {
                lines.card("FRICTION", []);
                lines.row([number(friction.at_rest)]);
            } else {
                lines.card("FRICTION", ["EXPONENTIAL DECAY".to_string()]);
                let Friction {
                    at_rest,
                    sliding,
                    decay,
                } = friction;
                lines.row([at_rest, sliding, decay].map(number));
            }
        }
        interactions
    }

    fn name(&self, interaction: Interaction) -> String {
        let index = self.0.iter().position(|known| *known == interaction);
        format!("INTERACTION-{}", index.map_or(0, |index| index + 1))
    }
}

fn pair(contact: &Contact, interactions: &Interactions, model: &Model, lines: &mut Lines) {
    let mut parameters = vec![
        set("INTERACTION", interactions.name(contact.interaction)),
        set("TYPE", "NODE TO SURFACE"),
    ];
    parameters.extend(contact.adjust.map(|adjust| match adjust {
        Adjust::Within(reach) => set("ADJUST", number(reach.above)),
        Adjust::Nodes(set) => named("ADJUST", &model.sets.nodes[set].name),
    }));
    lines.card_of("CONTACT PAIR", &parameters);
    let surface = |index: usize| name(&model.surfaces[index].name);
    match contact.is_self_contact() {
        true => lines.row([surface(contact.slave)]),
        false => lines.row([contact.slave, contact.master].map(surface)),
    }
}

/// Writes which nodes of general contact are moved before the start.
fn initialization(reach: Reach, lines: &mut Lines) {
    const NAME: &str = "INITIALIZATION-1";
    let mut parameters = vec![set("NAME", NAME), set("SEARCH ABOVE", number(reach.above))];
    if reach.below.is_finite() {
        parameters.push(set("SEARCH BELOW", number(reach.below)));
    }
    parameters.push(set("INITIAL CLEARANCE", number(reach.clearance)));
    lines.card_of("CONTACT INITIALIZATION DATA", &parameters);
    lines.card("CONTACT INITIALIZATION ASSIGNMENT", []);
    lines.row([String::new(), String::new(), NAME.to_owned()]);
}

/// Writes -u_dof + sum c_k u_k = 0.
fn write_equation(equation: &Equation, model: &Model, lines: &mut Lines) {
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

/// A dof that no equation eliminates: equations have two terms at least.
fn any_other_dof(dof: usize, model: &Model) -> Option<usize> {
    let eliminated = |other: &usize| model.equations.iter().any(|e| e.dof == *other);
    (0..model.mesh.dof_count()).find(|other| *other != dof && !eliminated(other))
}
