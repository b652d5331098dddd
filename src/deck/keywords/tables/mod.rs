//! The table of all keywords, joined from its families, and look-up by name.

mod assembly;
mod common;
mod conditions;
mod contact;
mod materials;
mod mesh;
mod output;
mod steps;

use super::keyword::Keyword;
use crate::deck::lines::word;
use std::collections::HashMap;
use std::sync::LazyLock;

const FAMILIES: [&[Keyword]; 7] = [
    mesh::MESH,
    assembly::ASSEMBLY,
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
        LazyLock::new(|| keywords().map(|k| (word::fold(k.name), k)).collect());
    INDEX.get(&word::fold(name)).copied()
}
