//! Errors and warnings with their place in the deck.

mod span;

pub use span::{FileId, Span};
