//! Errors and warnings with their place in the deck.
//!
//! Everything that reads a deck pushes [`Diagnostic`]s into one [`Diagnostics`] and carries on, so
//! that one run names every fault. Text is made once, by [`Diagnostics::render`].

mod code;
mod diagnostic;
mod lines;
mod list;
mod number;
mod render;
mod sources;
mod span;
mod suggestion;

pub use code::Code;
pub use diagnostic::{Diagnostic, Severity};
pub(crate) use lines::wrapped;
pub use list::{Diagnostics, Strictness};
pub use number::shown;
pub use sources::{Source, Sources};
pub use span::{FileId, Span};
pub use suggestion::closest;
