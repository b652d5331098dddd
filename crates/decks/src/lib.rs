//! Decks: read into a model, and written from it.

#![deny(missing_docs)]

pub mod deck;
pub mod flat_deck;
pub mod reader;

use stickslip_mechanics::{diagnostics, materials, model, vectors};
use stickslip_system::system;
