//! Definitions and uses of names, and renaming.

use super::cards::included;
use super::symbols::{Occurrence, What};
use super::workspace::{Place, Workspace};
use crate::deck::Text;
use crate::diagnostics::{Diagnostics, Span};
use lsp_types::{Location, Range, TextEdit, Url, WorkspaceEdit};
use std::collections::HashMap;

/// For a place in a deck: the definition of the name there, the beginning of a block that ends there, or the file that
/// is named there.
pub(super) fn definitions(workspace: &Workspace, place: &Place) -> Vec<Location> {
    let view = &place.view;
    let location = |one: &Occurrence| workspace.location(view, one.file, one.spot);
    if let Some(found) = place.occurrence() {
        let all = view.symbols.of(&found.symbol).filter(|one| one.defines);
        return all.filter_map(location).collect();
    }
    let Some(card) = view.cards.at(place.file, place.line) else {
        return Vec::new();
    };
    if card.head.last < place.line {
        return Vec::new();
    }
    if let Some(begin) = card.head.name().strip_prefix("END ") {
        let before = view.cards.of_file(place.file);
        let before = before.take_while(|other| other.head.spot.line < card.head.spot.line);
        let head = before.filter(|other| other.head.name() == begin).last();
        let location = head.and_then(|head| workspace.location(view, head.file, head.head.spot));
        return location.into_iter().collect();
    }
    let file = included(&card.head).and_then(|path| {
        let files = view.cards.files.iter();
        let ends = |known: &&super::cards::DeckFile| known.path.ends_with(clean(path));
        files.rev().find(ends)
    });
    let uri = file.and_then(|file| workspace.files.uri(&file.path));
    let location = uri.map(|uri| Location {
        uri,
        range: Range::default(),
    });
    location.into_iter().collect()
}

/// A path without its leading `./` and `../`.
fn clean(path: &str) -> &str {
    let mut path = path;
    while let Some(rest) = path.strip_prefix("../").or_else(|| path.strip_prefix("./")) {
        path = rest;
    }
    path
}

/// All uses of the name at a place, with or without its definitions.
pub(super) fn references(
    workspace: &Workspace,
    place: &Place,
    with_definitions: bool,
) -> Vec<Location> {
    let Some(found) = place.occurrence() else {
        return Vec::new();
    };
    let all = place.view.symbols.of(&found.symbol);
    let all = all.filter(|one| with_definitions || !one.defines);
    all.filter_map(|one| workspace.location(&place.view, one.file, one.spot))
        .collect()
}

/// Range of the name at a place, if the object can be renamed.
pub(super) fn changeable(workspace: &Workspace, place: &Place) -> Option<Range> {
    let found = place.occurrence().filter(|one| one.is_known)?;
    let location = workspace.location(&place.view, found.file, found.spot)?;
    Some(location.range)
}

/// Renames the name at a place everywhere in the deck.
///
/// # Errors
/// There is no name at the place, the new name is not allowed, or another object of the same kind has the new name.
pub(super) fn rename(
    workspace: &Workspace,
    place: &Place,
    new: &str,
) -> Result<WorkspaceEdit, String> {
    let found = place.occurrence().filter(|one| one.is_known);
    let found = found.ok_or("there is no name that the deck defines")?;
    let symbols = &place.view.symbols;
    let all: Vec<&Occurrence> = symbols.of(&found.symbol).collect();
    let is_quoted = all.iter().any(|one| one.is_quoted);
    let key = new_key(found.symbol.what, new, is_quoted)?;
    let is_taken = |one: &Occurrence| {
        let (own, other) = (&found.symbol, &one.symbol);
        let is_alike = other.what == own.what && other.scope == own.scope;
        is_alike && *other.key == *key && other != own
    };
    if symbols.all.iter().any(|one| one.defines && is_taken(one)) {
        let what = found.symbol.what.name();
        return Err(format!("there is another {what} of the name {new}"));
    }
    let mut changes: HashMap<Url, Vec<TextEdit>> = HashMap::new();
    for one in all {
        if let Some(location) = workspace.location(&place.view, one.file, one.spot) {
            let edit = TextEdit::new(location.range, new.to_owned());
            changes.entry(location.uri).or_default().push(edit);
        }
    }
    Ok(WorkspaceEdit::new(changes))
}

/// The key of a new name, which is checked with the rules of the reader.
fn new_key(what: What, new: &str, is_quoted: bool) -> Result<String, String> {
    let refused = |why: &str| Err(format!("`{new}` cannot be a name: {why}"));
    if new.contains(['\n', '\r', ',']) {
        return refused("it holds a comma or the end of a line");
    }
    if what == What::Parameter {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let begins = |c: char| c.is_ascii_alphabetic() || c == '_';
        return match new.starts_with(begins) && new.chars().all(is_word) {
            true => Ok(new.to_owned()),
            false => refused("it begins with a letter and has letters, digits and underscores"),
        };
    }
    if new.contains(['"', '.']) || new.trim() != new {
        return refused("it holds a dot, a quotation mark or a blank at an end");
    }
    let written = match is_quoted {
        true => format!("\"{new}\""),
        false => new.to_owned(),
    };
    let span = Span::default();
    let text = Text {
        text: &written,
        span,
    };
    let mut d = Diagnostics::new();
    match (text.name(&mut d), d.iter().next()) {
        (Some(name), None) => Ok(name.key),
        (_, fault) => refused(fault.and_then(|f| f.label.as_deref()).unwrap_or("")),
    }
}
