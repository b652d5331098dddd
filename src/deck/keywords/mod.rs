//! The table of all keywords with the dimensions of their fields, and the reference made from it.

mod dimensions;
mod explanation;
mod fields;
mod keyword;
mod parameter;
mod reference;
mod tables;
mod words;

pub use dimensions::dimensions_json;
pub use fields::{Field, Quantity, RowForm};
pub use keyword::{Data, Keyword, Scope};
pub use parameter::{Parameter, Status, Takes, Value};
pub use reference::keyword_reference;
pub use tables::{find_keyword, keywords};
