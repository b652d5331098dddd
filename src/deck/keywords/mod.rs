//! The table of all keywords, of the dimensions of their fields, and the reference made from it.

mod dimensions;
mod keyword;
mod reference;
mod table_dimensions;
mod table_model;
mod table_others;
mod table_steps;

pub use dimensions::{dimension_faults, dimensions_json};
pub(crate) use keyword::find;
pub use keyword::{Data, Keyword, Parameter, Scope, Status, Takes, Value, keywords};
pub use reference::keyword_reference;
