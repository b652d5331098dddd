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
use types::Unread;

const FAMILIES: [(&[Keyword], &[Unread]); 7] = [
    (mesh::MESH, mesh::UNREAD_MESH),
    (mesh::ASSEMBLY, &[]),
    (materials::MATERIALS, materials::UNREAD_MATERIALS),
    (contact::CONTACT, contact::UNREAD_CONTACT),
    (conditions::CONDITIONS, conditions::UNREAD_CONDITIONS),
    (steps::STEPS, steps::UNREAD_STEPS),
    (output::OUTPUT, output::UNREAD_OUTPUT),
];

static ALL: LazyLock<Vec<Keyword>> = LazyLock::new(|| {
    let mut all = Vec::new();
    for (read, unread) in FAMILIES {
        all.extend(read);
        all.extend(unread.iter().flat_map(Unread::keywords));
    }
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
