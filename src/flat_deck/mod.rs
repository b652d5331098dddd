//! The model written back as a flat deck: one file without includes and assembly, every card and
//! setting in full, numbers in the shortest form that reads as the same number.
//!
//! The deck reads as the same model but for the places of its contacts in the text and the instances
//! of parts, whose nodes and elements have the numbers of the mesh. Two kinds of names are made up, as the model does not keep those of the deck: of interactions and of time points.

mod lines;
mod model;
mod steps;

use crate::deck;
use crate::diagnostics::{Diagnostics, Sources, Span};
use crate::model::Model;
use crate::reader;
use lines::DeckWriter;

/// The deck of a model.
pub fn flat_deck(model: &Model) -> String {
    let mut lines = DeckWriter::default();
    title(&model.title, &mut lines);
    model::write(model, &mut lines);
    steps::write(model, &mut lines);
    lines.text()
}

/// Whether a deck reads as this model but for the places of its contacts and the instances of parts.
pub fn reads_as(text: &str, model: &Model) -> bool {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("flat.inp", text, &mut sources, &mut d);
    let read = reader::build(&deck, &mut d);
    read.is_some_and(|read| flat(read) == flat(model.clone()))
}

/// A model without what a flat deck does not hold.
fn flat(mut model: Model) -> Model {
    model.sets.instances.clear();
    for contact in &mut model.contacts {
        contact.span = Span::default();
        contact.interaction.name.clear();
    }
    model
}

/// The title on lines of at most 80 characters, cut at single blanks: the reader joins them by these.
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
