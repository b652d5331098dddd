//! Keyword cards: read from files, checked against the keyword table, collected into a deck.

mod card;
mod collect;
mod instance;
mod resolve;
mod rows;
mod source;

pub use card::{Card, Param};
pub use collect::Deck;
pub use instance::{Instance, Placement};
pub use rows::{Row, Rows};
pub(super) use source::{parse_str, read};
