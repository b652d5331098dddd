//! From a file or a text to the cards of a flat deck.

use super::assembly::flatten;
use super::cards::{self, Deck};
use crate::diagnostics::{Diagnostics, Sources};
use std::path::Path;

/// Reads a deck and the files it includes; parts are copied to their instances.
pub fn read(path: &Path, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let deck = cards::read(path, sources, d);
    flatten(deck, sources, d)
}

/// Reads a deck from text; it cannot include files.
pub fn parse_str(name: &str, text: &str, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let deck = cards::parse_str(name, text, sources, d);
    flatten(deck, sources, d)
}
