//! Keyword cards: read from files, checked against the table, collected.

mod card;
mod collect;
mod resolve;
mod source;

pub use card::{Card, Param, Row};
pub use collect::Deck;
pub use source::{parse_str, read};
