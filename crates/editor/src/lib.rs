//! Decks in an editor: a language server for them.

#![deny(missing_docs)]

pub mod editor;

use stickslip_decks::deck;
use stickslip_mechanics::diagnostics;
