//! Lines of deck files, their fields, and the numbers, names and words in these.

mod content;
mod lexer;
mod lines_of_file;
mod name;
mod number;
pub(crate) mod plain;
mod text;
pub(crate) mod word;

pub(crate) use content::{Content, LONGEST_USUAL_LINE};
pub(crate) use lexer::{Fields, Kind, Line, assignment, span_in, trimmed};
pub(crate) use lines_of_file::Lines;
pub use name::Name;
pub use text::Text;
pub(crate) use word::Match;
