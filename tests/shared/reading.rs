//! Models read from decks in a text.

use stickslip::diagnostics::{Diagnostics, Sources};
use stickslip::model::Model;
use stickslip::{deck, reader};

/// The model of a deck, which must have no errors.
pub fn read(text: &str) -> Model {
    let (model, _, messages) = try_read(text);
    model.unwrap_or_else(|| panic!("{messages}\n{text}"))
}

/// The model of a deck, if it has no errors, and its messages, also as they are shown.
pub fn try_read(text: &str) -> (Option<Model>, Diagnostics, String) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("deck.inp", text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    let messages = d.render(&sources, false);
    (model, d, messages)
}
