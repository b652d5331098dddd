//! The reader makes a model from cards: it knows the meaning of each keyword, and makes checks across keywords.
//!
//! One file per family of keywords. Names and numbers are collected before they are looked up, so the order of a deck
//! never matters. Names that a faulty card defines are marked, so that their uses are not reported as undefined.

mod actions;
mod amplitudes;
mod boundary;
mod checks;
mod collapsed;
mod connectors;
mod contact;
mod contact_changes;
mod context;
mod couplings;
mod equations;
mod formulation;
mod interference;
mod label;
mod loads;
mod materials;
mod mesh_index;
mod names;
mod nearest;
mod nodes_elements;
mod orientations;
mod outline;
mod output;
mod owners;
mod pretension;
mod rigid_bodies;
mod rigid_motion;
mod sections;
mod sets;
mod smoothing;
mod steps;
mod surfaces;
mod temperatures;
mod tied_sides;
mod ties;

pub(crate) use loads::carried_loads;
pub(crate) use steps::{
    CONTACT_MASS, FACTORIZATION, IMPACT, IMPACT_TIME, LANDING, LCP, SOLVER, TRUNCATION_ERROR,
    tolerance_of_factor,
};
pub(crate) use temperatures::carried_temperatures;

use crate::deck::{self, Card, Deck};
use crate::diagnostics::{Code, Diagnostics, Sources};
use crate::model::{EdgeScales, ElementsAtNodes, Equation, Instance, Model, NamedSets};
use boundary::Targets;
use context::Context;
use outline::Outline;
use output::Histories;
use owners::Constraints;
use rigid_bodies::Lookup;
use sets::Sets;
use std::path::Path;

/// Reads a deck file into a model; `None` if there are errors.
pub fn read_model(path: &Path, sources: &mut Sources, d: &mut Diagnostics) -> Option<Model> {
    let deck = deck::read(path, sources, d);
    build(&deck, d)
}

/// The model that a deck describes; `None` if there are errors.
pub fn build(deck: &Deck, d: &mut Diagnostics) -> Option<Model> {
    if deck.cards.is_empty() {
        if !d.has_errors() {
            let message = "nothing is left of the deck: all of its cards are left out";
            d.error_without_place(Code::EmptyMesh, message);
        }
        return None;
    }
    let model = read(&mut Context::new(deck, d));
    if !d.has_errors() {
        report_unused(deck, d);
    }
    (!d.has_errors()).then_some(model)
}

/// Reads the whole model; cards with errors are missing in this model.
fn read(cx: &mut Context) -> Model {
    let outline = Outline::new(cx);
    let mut mesh_index = nodes_elements::read(&outline, cx);
    cx.go_on();
    let at_nodes = ElementsAtNodes::new(&mesh_index.mesh);
    checks::mesh(&mesh_index, &at_nodes, cx);
    checks::half_plane(&mesh_index, cx);
    cx.go_on();
    let sets = sets::read(&outline, &mesh_index, cx);
    let cuts = pretension::read(&outline, &mut mesh_index, &sets, cx);
    let at_nodes = match cuts.is_empty() {
        true => at_nodes,
        false => ElementsAtNodes::new(&mesh_index.mesh),
    };
    cx.go_on();
    let mut surfaces = surfaces::read(&outline, &mesh_index, &sets, &at_nodes, cx);
    drop(at_nodes);
    mesh_index.add_points(&surfaces.rigid_points);
    let lookup = Lookup {
        mesh_index: &mesh_index,
        sets: &sets,
        surfaces: &surfaces,
    };
    let mut rigid_bodies = rigid_bodies::read(&outline, lookup, cx);
    let links = couplings::read(&outline, lookup, &mut rigid_bodies, cx);
    rigid_bodies::find_carried(&mut rigid_bodies, &mesh_index.mesh);
    let moves = couplings::moving_nodes(&links, lookup);
    let masses = rigid_bodies::point_masses(&mut rigid_bodies, &moves, &outline, lookup, cx);
    cx.go_on();
    let properties = sections::read(&outline, &mut mesh_index, &sets, cx);
    checks::magnitudes(&mesh_index, &properties, cx);
    let ties = ties::read(&outline, &mut mesh_index, &sets, &surfaces, cx);
    cx.go_on();
    let mut contacts = contact::read(&outline, &mesh_index, &sets, &mut surfaces, cx);
    ties.leave_out(&mut contacts, &surfaces.all, &mesh_index);
    let constraints = Constraints {
        ties: &ties,
        links: &links,
        cuts: &cuts,
    };
    owners::check_nodes(&rigid_bodies, constraints, &mesh_index, cx);
    owners::check_names(&rigid_bodies, &ties, cx);
    let (sections, mesh) = (&properties.sections, &mesh_index.mesh);
    checks::thickness(&contacts, &surfaces.all, sections, mesh, cx);
    cx.go_on();
    let edges = EdgeScales::new(mesh, sections, &properties.materials);
    let guide = Some(edges.time).filter(|time| time.is_finite() && *time > 0.0);
    let amplitudes = amplitudes::read(cx);
    let targets = Targets {
        mesh_index: &mesh_index,
        sets: &sets,
        amplitudes: &amplitudes,
        masses: &masses.all,
        rigid_bodies: &rigid_bodies,
        has_element: &mesh.has_element(),
    };
    cx.go_on();
    let connectors = connectors::read(&outline, targets, cx);
    let initial_temperature = temperatures::initial(&outline, targets, cx);
    let known = (
        &surfaces,
        contacts.as_slice(),
        initial_temperature.as_slice(),
    );
    let mut steps = steps::read(&outline, targets, known, guide, cx);
    checks::density(&properties, mesh, &steps.all, cx);
    let at_start = (steps.at_start.as_slice(), &steps.supports);
    let velocity = boundary::initial_velocity(&outline, targets, at_start, cx);
    let all = &mut steps.all;
    let known = (&mesh_index, &steps.supports);
    let bodies = rigid_motion::complete(&rigid_bodies, known, all, &velocity, cx);
    let of_steps = (&steps.supports, steps.all.as_slice());
    let equations = equations::read(&outline, targets, (constraints, of_steps), cx);
    let actions = [&steps.supports.actions, &steps.forces, &velocity.actions];
    owners::check_actions(actions, targets, (&connectors, &equations, &cuts), cx);
    rigid_motion::check(&rigid_bodies, &bodies, mesh, (&steps.all, &equations), cx);
    boundary::check_start(&outline, steps.all.first(), cx);
    equations::check_velocities(&equations, &velocity.values, &steps.at_start, targets, cx);
    let equations = equations.into_iter().map(|(equation, _)| equation);
    let equations: Vec<Equation> = equations.collect();
    let (hinges, hinge_places) = couplings::hinges(&links, cx);
    let mut model = Model {
        title: title(&outline),
        mesh: mesh_index.mesh,
        sets: named_sets(sets, steps.histories, mesh_index.instances),
        surfaces: surfaces.all,
        materials: properties.materials,
        sections: properties.sections,
        connectors,
        contacts,
        amplitudes: amplitudes.named.all,
        ties: ties.all,
        equations,
        hinges,
        initial_velocity: velocity.values,
        initial_temperature,
        steps: steps.all,
        rigid_bodies: bodies,
        point_masses: masses.free,
        restarts: steps.restarts,
    };
    contact::leave_out_joined(&mut model);
    formulation::restrict(&mut model, cx);
    formulation::choose(&mut model, cx);
    contact::keep_arcs_for_discs(&mut model);
    let all: [&dyn Fn(&mut Context); 12] = [
        &|cx| checks::hinges(&model, &hinge_places, cx),
        &|cx| contact::check_discs(&model, cx),
        &|cx| checks::axis(&model, &mesh_index.places, cx),
        &|cx| connectors::check(&model, &mesh_index.connectors, cx),
        &|cx| checks::amplitudes(&model, &amplitudes.spans, cx),
        &|cx| checks::braked_flight(&model, &properties.places, cx),
        &|cx| checks::coincident_nodes(&model, edges.shortest, &mesh_index.places, cx),
        &|cx| checks::fixed_slaves(&model, cx),
        &|cx| checks::proportion(&model.steps, &outline.steps, guide, cx),
        &|cx| checks::overlap(&model, &mesh_index.places, cx),
        &|cx| checks::motion(&model, &outline.steps, cx),
        &|cx| temperatures::check(&model, &properties.places, &outline, cx),
    ];
    for check in all {
        if !cx.d.has_errors() {
            cx.go_on();
            check(cx);
        }
    }
    rigid_motion::leave_to_bodies(&mut model);
    model
}

/// The sets of the model; element sets without plane elements are left out.
fn named_sets(sets: Sets, histories: Histories, instances: Vec<Instance>) -> NamedSets {
    let is_kept = |&set: &usize| !sets.holds_others_only(set);
    let kept: Vec<usize> = (0..sets.elements.len()).filter(is_kept).collect();
    let mut element_history = histories.elements;
    for asked in &mut element_history {
        asked.set = kept.partition_point(|&set| set < asked.set);
    }
    let mut elements = sets.elements;
    NamedSets {
        nodes: sets.nodes,
        elements: (kept.into_iter())
            .map(|set| std::mem::take(&mut elements[set]))
            .collect(),
        history: histories.nodes,
        element_history,
        fields: histories.fields,
        monitored: histories.monitored,
        instances,
    }
}

/// Text under `*HEADING`, lines joined by a blank.
fn title(outline: &Outline) -> String {
    let cards = outline.model_cards("HEADING");
    let lines = cards
        .iter()
        .flat_map(|card| card.rows.iter())
        .map(|row| row.text.trim());
    lines.collect::<Vec<_>>().join(" ")
}

/// Warns about parameters that the reader has not used.
fn report_unused(deck: &Deck, d: &mut Diagnostics) {
    for card in &deck.cards {
        Card::report_unused(card, d);
    }
}
