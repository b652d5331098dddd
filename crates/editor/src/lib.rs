//! A language server for decks in an editor.

#![deny(missing_docs)]

pub mod editor;

use stickslip_decks::deck;
use stickslip_mechanics::diagnostics;
