//! The table of all keywords, joined from its families, with the dimensions of their fields; look-up
//! by name, and the documents made from it.

mod common;
mod documents;
mod steps;
mod table;
mod types;

pub use documents::{dimensions_json, keyword_reference};
pub use types::{Data, Field, Keyword, Parameter, Quantity, RowForm, Scope, Status, Takes, Value};

use super::text::fold;
use std::collections::HashMap;
use std::sync::LazyLock;
use types::Unread;

static ALL: LazyLock<Vec<Keyword>> = LazyLock::new(|| {
    let mut all = Vec::new();
    for text in [
        include_str!("mesh.txt"),
        include_str!("materials.txt"),
        include_str!("contact.txt"),
        include_str!("conditions.txt"),
    ] {
        all.extend(table::read(text));
    }
    all.extend(steps::STEPS);
    all.extend(steps::UNREAD_STEPS.iter().flat_map(Unread::keywords));
    all.extend(table::read(include_str!("output.txt")));
    all
});

/// All known keywords.
pub fn keywords() -> impl Iterator<Item = &'static Keyword> + Clone {
    ALL.iter()
}

/// The keyword with this name, blanks and case aside.
pub fn find_keyword(name: &str) -> Option<&'static Keyword> {
    static INDEX: LazyLock<HashMap<String, &'static Keyword>> =
        LazyLock::new(|| keywords().map(|k| (fold(k.name), k)).collect());
    INDEX.get(&fold(name)).copied()
}
