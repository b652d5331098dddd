//! From text to cards: files, logical lines, keyword lines and data fields.
//!
//! A *card* is a keyword line with the data lines under it. [`read`] turns a file and its includes
//! into a [`Deck`] of cards whose keywords and parameters are known ones, see [`keywords`]; what
//! they mean is left to the reader.

mod assembly;
mod cards;
mod keywords;
mod lines;
mod read;
pub use cards::{Card, Deck, Instance, Param, Placement, Row, Rows};
pub use keywords::{
    Data, Field, Keyword, Parameter, Quantity, RowForm, Scope, Status, Takes, Value,
    dimensions_json, find_keyword, keyword_reference, keywords,
};
pub use lines::{Name, Text};
pub use read::{parse_str, read};
