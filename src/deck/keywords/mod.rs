//! The table of all keywords, joined from its families, with the dimensions of their fields; look-up
//! by name, and the documents made from it.

mod common;
mod conditions;
mod contact;
mod documents;
mod materials;
mod mesh;
mod output;
mod steps;
mod types;

pub use documents::{dimensions_json, keyword_reference};
pub use types::{Data, Field, Keyword, Parameter, Quantity, RowForm, Scope, Status, Takes, Value};

use super::text::fold;
use std::collections::HashMap;
use std::sync::LazyLock;

const FAMILIES: [&[Keyword]; 7] = [
    mesh::MESH,
    mesh::ASSEMBLY,
    materials::MATERIALS,
    contact::CONTACT,
    conditions::CONDITIONS,
    steps::STEPS,
    output::OUTPUT,
];

/// All known keywords.
pub fn keywords() -> impl Iterator<Item = &'static Keyword> + Clone {
    FAMILIES.into_iter().flatten()
}

/// The keyword with this name, blanks and case aside.
pub fn find_keyword(name: &str) -> Option<&'static Keyword> {
    static INDEX: LazyLock<HashMap<String, &'static Keyword>> =
        LazyLock::new(|| keywords().map(|k| (fold(k.name), k)).collect());
    INDEX.get(&fold(name)).copied()
}
