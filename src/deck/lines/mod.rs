//! Lines of deck files, their fields, and the numbers, names and words in these.

mod content;
mod lexer;
mod name;
mod number;
mod text;
pub(crate) mod word;

pub(crate) use content::Content;
pub(crate) use lexer::{Fields, Kind, Line, assignment, span_in};
pub use name::Name;
pub use text::Text;
pub(crate) use word::Match;
