//! A language server for decks: diagnostics while typing, completion, explanations, definitions and uses of names, outline,
//! change of names and quick fixes.
//!
//! The texts of the editor are `document`s, which change in place. After every change, `cards` and `symbols` find cards
//! and names again from the keyword lines and the data lines with words, without the reader. When the typing pauses,
//! `checks` lets the reader check whole decks in a thread of its own.

mod cards;
mod checks;
mod completion;
mod document;
mod files;
mod hover;
mod navigation;
mod outline;
mod server;
mod symbols;
#[cfg(test)]
mod testing;
mod workspace;

pub use checks::Check;
pub use server::{Program, serve};
