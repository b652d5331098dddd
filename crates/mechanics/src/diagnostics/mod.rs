//! Errors and warnings with their place in the deck.
//!
//! Everything that reads a deck pushes [`Diagnostic`]s into one [`Diagnostics`] and carries on, so
//! that one run names every fault. Text is made once, by [`Diagnostics::render`].

mod code;
mod diagnostic;
mod json;
mod render;
mod sources;
mod words;

pub use code::Code;
pub use diagnostic::{Added, Diagnostic, Diagnostics, FileId, Severity, Span, Strictness};
pub use sources::{EarlierDeck, Interrupt, Replaced, Source, Sources, whole_path};
pub use words::{WIDTH, in_lines, list_of, wrapped};
pub use words::{closest, shown};
