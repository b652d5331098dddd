//! Errors and warnings with their place in the deck.
//!
//! All code that reads a deck adds [`Diagnostic`]s to one [`Diagnostics`] and goes on reading, so one run reports every
//! fault. The text of the diagnostics is made once, by [`Diagnostics::render`].

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
