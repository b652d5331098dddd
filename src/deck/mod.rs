//! From text to cards: files, logical lines, keyword lines and data fields.
//!
//! A *card* is a keyword line with the data lines under it. [`read`] turns a file and its includes
//! into a [`Deck`] of cards whose keywords and parameters are known ones, see [`keywords`]; what
//! they mean is left to the reader.

mod card;
mod collect;
mod content;
mod dimensions;
mod keyword;
mod lexer;
mod name;
mod number;
mod reference;
mod resolve;
mod source;
mod table_dimensions;
mod table_model;
mod table_others;
mod table_steps;
mod text;
mod word;

pub use card::{Card, Param, Row};
pub use collect::Deck;
pub use dimensions::{dimension_faults, dimensions_json};
pub use keyword::{Data, Keyword, Parameter, Scope, Status, Takes, Value, keywords};
pub use name::Name;
pub use reference::keyword_reference;
pub use source::{parse_str, read};
pub use text::Text;
