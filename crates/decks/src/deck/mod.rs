//! From text to cards: files, logical lines, keyword lines and data fields.
//!
//! A *card* is a keyword line with the data lines under it. [`read`] turns a file and its includes into a [`Deck`] of
//! cards with known keywords and parameters (see [`keywords`]). The cards of parts stand in the places of their
//! instances. The reader finds the meaning of the cards.

mod assembly;
mod card;
mod change;
mod collect;
mod content;
mod expression;
mod keywords;
mod lines;
mod number;
mod parameters;
mod resolve;
mod text;

pub use card::{Card, DataLines, Instance, Param, Placement};
pub use change::first_change;
pub use collect::Deck;
pub use content::{not_regular, open_regular};
pub use keywords::{
    Data, DataLineForm, Field, Keyword, Kind, Level, Levels, Parameter, Quantity, Scope, Status,
    Takes, Value, Word, dimensions_json, find_keyword, find_word, keyword_reference, keywords,
    words,
};
pub use lines::{Line, LineKind};
pub use resolve::keyword_read_as;
pub use text::{Name, Text};

use crate::diagnostics::{Diagnostics, Sources};
use std::path::Path;

/// Reads a deck and the files that it includes; the cards of parts are copied to the instances of these parts.
pub fn read(path: &Path, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let deck = collect::read(path, sources, d);
    assembly::flatten(deck, sources, d)
}

/// Reads a deck from text, which cannot include files.
pub fn parse_str(name: &str, text: &str, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let deck = collect::parse_str(name, text, sources, d);
    assembly::flatten(deck, sources, d)
}
