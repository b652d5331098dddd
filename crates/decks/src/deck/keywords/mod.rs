//! The table of all keywords, joined from its families, with the dimensions of their fields; look-up
//! by name, and the documents made from it. Words that are no keywords, with what to use.

mod documents;
mod table;
mod types;
mod words;

pub use documents::{dimensions_json, keyword_reference};
pub use types::{
    Data, DataLineForm, Field, Keyword, Kind, Level, Levels, Parameter, Quantity, Scope, Status,
    Takes, Value,
};
pub use words::{Word, find_word, words};

use super::text::fold;
use std::collections::HashMap;
use std::sync::LazyLock;

static ALL: LazyLock<Vec<Keyword>> = LazyLock::new(|| {
    let texts = [
        include_str!("mesh.txt"),
        include_str!("materials.txt"),
        include_str!("contact.txt"),
        include_str!("conditions.txt"),
        include_str!("steps.txt"),
    ];
    let output = table::read(include_str!("output.txt"));
    let output = output.into_iter().map(|keyword| Keyword {
        is_output: true,
        ..keyword
    });
    let all = texts.into_iter().flat_map(table::read).chain(output);
    table::with_levels(all.collect())
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
