//! The table of all keywords, joined from its parts, and look-up by name.

use super::keyword::Keyword;
use super::{table_assembly, table_model, table_others, table_steps};
use crate::deck::lines::word;
use std::collections::HashMap;
use std::sync::LazyLock;

/// All known keywords: those read first, then the others.
pub fn keywords() -> impl Iterator<Item = &'static Keyword> + Clone {
    let model = table_assembly::ASSEMBLY.iter().chain(table_model::MODEL);
    let read = model.chain(table_steps::STEPS);
    read.chain(table_others::OTHERS)
}

/// The keyword with this name, blanks and case aside.
pub(crate) fn find(name: &str) -> Option<&'static Keyword> {
    static INDEX: LazyLock<HashMap<String, &'static Keyword>> =
        LazyLock::new(|| keywords().map(|k| (word::fold(k.name), k)).collect());
    INDEX.get(&word::fold(name)).copied()
}
