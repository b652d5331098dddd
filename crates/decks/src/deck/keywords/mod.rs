//! The table of all keywords, joined from its families, with the dimensions of their fields; look-up by name, and the
//! documents made from it. Also words that are no keywords, with the cards to use in place of these words.

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

/// The families of keywords: the title of each family, and the text of its part of the table.
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
    let mut all = Vec::new();
    for (task, text) in FAMILIES {
        let before = all.len();
        table::read(text, &mut all);
        for keyword in &mut all[before..] {
            keyword.task = task;
            keyword.is_output = task == RESULTS;
        }
    }
    table::with_levels(all)
});

/// All known keywords.
pub fn keywords() -> impl Iterator<Item = &'static Keyword> + Clone {
    ALL.iter()
}

/// The keyword with a given name; blanks and case do not matter.
pub fn find_keyword(name: &str) -> Option<&'static Keyword> {
    static INDEX: LazyLock<HashMap<String, &'static Keyword>> =
        LazyLock::new(|| keywords().map(|k| (fold(k.name), k)).collect());
    INDEX.get(&fold(name)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_parameter_that_is_as_that_of_another_keyword_has_one() {
        let mut count = 0;
        for (_, text) in FAMILIES {
            let mut names = "";
            for line in table::lines(text) {
                if let Some(entry) = line.strip_prefix('*') {
                    names = entry.split(" @ ").next().unwrap_or(entry);
                } else if let Some((name, of)) = line
                    .strip_prefix("- ")
                    .and_then(|line| line.split_once(" as *"))
                {
                    for keyword in names.split(", ") {
                        let keyword = find_keyword(keyword.trim_start_matches('*'));
                        let found = keyword.and_then(|keyword| keyword.parameter(name));
                        assert!(found.is_some(), "{name} of *{names}, as of *{of}");
                        count += 1;
                    }
                }
            }
        }
        assert!(count > 50, "{count}");
    }
}
