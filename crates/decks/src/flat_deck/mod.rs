//! The model written back as a flat deck: one file without includes and assembly, every card and
//! setting in full, numbers in the shortest form that reads as the same number.
//!
//! The flat deck reads as the same model except in three points: contacts stand at other places of the text, each pair
//! states its formulation, and nodes and elements have the numbers of the mesh, without instances. Names of
//! interactions and of time points are made up, because the model does not keep the names of the deck.

mod lines;
mod model;
mod steps;

use crate::deck;
use crate::diagnostics::{Diagnostics, Severity, Sources, Span};
use crate::model::{Model, Step};
use crate::reader;
use lines::DeckWriter;

/// Text of the flat deck of a model.
pub fn flat_deck(model: &Model) -> String {
    let mut lines = DeckWriter::default();
    title(&model.title, &mut lines);
    model::write(model, &mut lines);
    steps::write(model, &mut lines);
    lines.text()
}

/// The first difference between this model and the model that `deck` reads as, except for places and reasons of
/// contacts, and instances of parts; `None` if there is no difference.
pub fn difference(text: &str, model: &Model) -> Option<String> {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("flat.inp", text, &mut sources, &mut d);
    let Some(read) = reader::build(&deck, &mut d) else {
        let error = d.iter().find(|item| item.severity == Severity::Error);
        return Some(error.map_or(String::new(), |error| error.message.clone()));
    };
    let (a, b) = (flat(read), flat(model.clone()));
    if a == b {
        return None;
    }
    let of_steps = a.steps.iter().zip(&b.steps).zip(1..);
    let of_steps = of_steps.filter_map(|((a, b), number)| {
        let what = difference_of_steps(a, b)?;
        Some(format!("the {what} of step {number}"))
    });
    let of_model = [
        ("nodes and elements", a.mesh != b.mesh),
        ("sets", a.sets != b.sets),
        ("surfaces", a.surfaces != b.surfaces),
        ("materials", a.materials != b.materials),
        ("sections", a.sections != b.sections),
        ("springs and dashpots", a.connectors != b.connectors),
        ("contacts", a.contacts != b.contacts),
        ("amplitudes", a.amplitudes != b.amplitudes),
        ("ties", a.ties != b.ties),
        ("equations", a.equations != b.equations),
        ("hinges", a.hinges != b.hinges),
        ("rigid bodies", a.rigid_bodies != b.rigid_bodies),
        ("point masses", a.point_masses != b.point_masses),
        (
            "initial velocities",
            a.initial_velocity != b.initial_velocity,
        ),
        (
            "initial temperatures",
            a.initial_temperature != b.initial_temperature,
        ),
    ];
    let of_model = of_model.into_iter().filter(|(_, differs)| *differs);
    let mut all = of_model
        .map(|(what, _)| format!("the {what}"))
        .chain(of_steps);
    Some(all.next().unwrap_or("title or checkpoints".to_owned()))
}

/// The first difference between two steps.
fn difference_of_steps(a: &Step, b: &Step) -> Option<&'static str> {
    let loads = a.point_loads != b.point_loads
        || a.body_forces != b.body_forces
        || a.centrifugal_forces != b.centrifugal_forces
        || a.pressures != b.pressures
        || a.tractions != b.tractions;
    if a.temperatures != b.temperatures {
        return Some("temperatures");
    }
    match (a.supports != b.supports, loads) {
        (true, _) => Some("supports"),
        (false, true) => Some("loads"),
        (false, false) => (a != b).then_some("settings"),
    }
}

/// The model without the data that a flat deck does not hold.
fn flat(mut model: Model) -> Model {
    model.sets.instances.clear();
    for contact in &mut model.contacts {
        contact.span = Span::default();
        contact.interaction.name.clear();
        if !contact.is_self_contact() {
            contact.lying_faces = None;
        }
    }
    model
}

/// The title on lines of at most 80 characters, cut at single blanks, because the reader joins the lines with a blank.
fn title(title: &str, lines: &mut DeckWriter) {
    if title.is_empty() {
        return;
    }
    lines.card("HEADING", []);
    let mut line = String::new();
    for word in title.split(' ') {
        // a star would begin a keyword, and blanks at the ends of lines are lost
        let stays =
            line.is_empty() || line.ends_with(' ') || word.is_empty() || word.starts_with('*');
        if !stays && line.chars().count() + word.chars().count() > 79 {
            lines.row([std::mem::take(&mut line)]);
        } else if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.row([line]);
}
