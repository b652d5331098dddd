//! The table of all keywords, of the dimensions of their fields, and the reference made from it.

mod dimension_reference;
mod dimensions;
mod keyword;
mod reference;
mod table;
mod table_assembly;
mod table_dimensions;
mod table_model;
mod table_others;
mod table_steps;

pub use dimension_reference::{dimension_faults, dimensions_json};
pub use keyword::{Data, Keyword, Parameter, Scope, Status, Takes, Value};
pub use reference::keyword_reference;
pub(crate) use table::find;
pub use table::keywords;
