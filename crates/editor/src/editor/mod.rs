//! A language server for decks: diagnostics while typing, completion, explanations, definitions and uses of names, outline,
//! change of names and quick fixes.
//!
//! The texts of the editor are `document`s, which change in place. What they say about cards and names is made anew from
//! their keyword lines and lines of words after every change, without the reader: `cards`, `symbols`. Whole decks are read
//! by the reader in a thread of its own when the typing pauses: `checks`.

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
