//! The table of all keywords, joined from its families, with the dimensions of their fields; look-up by name, and the
//! documents made from it. Words that are no keywords, with the cards to use in their place.

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

/// The families of keywords: the title of each, and the text of its part of the table.
const FAMILIES: [(&str, &str); 6] = [
    (
        "Bodies: nodes, elements, sets, surfaces, parts",
        include_str!("mesh.txt"),
    ),
    (
        "Materials, sections, springs",
        include_str!("materials.txt"),
    ),
    ("Contact, friction, ties", include_str!("contact.txt")),
    ("Supports, loads, couplings", include_str!("conditions.txt")),
    ("Steps and restart", include_str!("steps.txt")),
    (RESULTS, include_str!("output.txt")),
];

/// The family of output requests.
const RESULTS: &str = "Results";

static ALL: LazyLock<Vec<Keyword>> = LazyLock::new(|| {
    let families = FAMILIES.into_iter().flat_map(|(task, text)| {
        table::read(text).into_iter().map(move |keyword| Keyword {
            task,
            is_output: task == RESULTS,
            ..keyword
        })
    });
    table::with_levels(families.collect())
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
