//! Kinds of the names that a deck defines: sets, surfaces, materials, amplitudes, interactions.

use crate::deck::{Card, Deck};
use crate::diagnostics::closest;
use std::collections::BTreeMap;

/// Keyword and parameter that define a name, and the kind of thing it is.
const DEFINITIONS: [(&str, &str, &str); 9] = [
    ("NODE", "NSET", "node set"),
    ("NSET", "NSET", "node set"),
    ("ELEMENT", "ELSET", "element set"),
    ("ELSET", "ELSET", "element set"),
    ("SURFACE", "NAME", "surface"),
    ("MATERIAL", "NAME", "material"),
    ("SURFACE INTERACTION", "NAME", "surface interaction"),
    ("AMPLITUDE", "NAME", "amplitude"),
    ("TIME POINTS", "NAME", "list of time points"),
];

/// Most names that a message lists.
const LISTED: usize = 8;

/// Keys of the names of a deck, with the kinds of objects that have them.
pub(super) struct Catalogue {
    kinds: BTreeMap<String, Vec<&'static str>>,
}

impl Catalogue {
    /// Collects the names that the cards of a deck define.
    pub fn new(deck: &Deck) -> Catalogue {
        let mut kinds: BTreeMap<String, Vec<&'static str>> = BTreeMap::new();
        for (name, kind) in deck.cards.iter().flat_map(|card| definitions(card, deck)) {
            let of_name = kinds.entry(name).or_default();
            if !of_name.contains(&kind) {
                of_name.push(kind);
            }
        }
        Catalogue { kinds }
    }

    /// Another kind than `kind` of the objects with this key.
    pub fn other_kind(&self, name: &str, kind: &str) -> Option<&'static str> {
        let kinds = self.kinds.get(name)?;
        kinds.iter().copied().find(|other| *other != kind)
    }

    /// An object of another kind than `kind` that a misspelt key probably means, and its kind.
    pub fn meant(&self, name: &str, kind: &str) -> Option<(&str, &'static str)> {
        let others = self
            .kinds
            .iter()
            .filter(|(_, kinds)| !kinds.contains(&kind));
        let meant = closest(name, others.map(|(key, _)| key.as_str()))?;
        Some((meant, self.other_kind(meant, kind)?))
    }
}

/// Key and kind of the object that a card defines.
fn definitions(card: &Card, deck: &Deck) -> Option<(String, &'static str)> {
    let defines = |&&(keyword, _, _): &&(&str, &str, &str)| keyword == card.keyword.name;
    let (_, parameter, kind) = DEFINITIONS.iter().find(defines)?;
    let key = card.value(parameter)?.name_key();
    let key = match deck.instance_of(card.span) {
        Some(instance) => format!("{}.{key}", instance.name.key),
        None => key,
    };
    Some((key, kind))
}

/// A kind of object with its article.
pub(super) fn with_article(kind: &str) -> String {
    let article = if kind.starts_with(['a', 'e']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {kind}")
}

/// Help where an object of kind `wanted` is needed and `name` is a `found`.
pub(super) fn help_for(wanted: &str, found: &str, name: &str) -> Option<String> {
    match (wanted, found) {
        ("node set", "element set") => Some(format!(
            "*NSET, NSET=..., ELSET={name} makes a node set of its nodes"
        )),
        ("surface", "element set") => Some(format!(
            "*SURFACE, NAME=... with the row `{name}` makes a surface of its free faces"
        )),
        ("surface", "node set") => Some(format!(
            "*SURFACE, NAME=..., TYPE=NODE with the row `{name}` makes a surface of its nodes"
        )),
        _ => None,
    }
}

/// A list of the defined names, of the first few where there are many.
pub(super) fn list_of<'n>(kind: &str, names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<&str> = names.collect();
    let plural = match kind {
        "list of time points" => "lists of time points".to_string(),
        _ => format!("{kind}s"),
    };
    let shown = names.iter().take(LISTED).copied().collect::<Vec<_>>();
    let more = names.len() - shown.len();
    match (names.len(), more) {
        (0, _) => format!("the deck has no {plural}"),
        (1, _) => format!("the only {kind} is {}", shown[0]),
        (_, 0) => format!("the {plural} are {}", shown.join(", ")),
        _ => format!("the {plural} are {} and {more} more", shown.join(", ")),
    }
}
