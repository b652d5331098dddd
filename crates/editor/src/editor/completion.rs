//! Completion of what is typed at a place: keywords, parameters, their values, names, files, and words of data lines.

use super::cards::{Card, Scope, given, is_first_row, key};
use super::document::{Document, as_line};
use super::symbols::What;
use super::workspace::{Place, View, Workspace};
use crate::deck::{
    self, Data, Keyword, Kind, LineKind, Parameter, Quantity, Status, Takes, find_keyword, keywords,
};
use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionTextEdit, Documentation, Range, TextEdit,
};
use std::path::Path;

/// Largest number of entries of a folder that are shown.
const MOST_FILES: usize = 500;

/// A text that may be typed.
struct Choice {
    label: String,
    kind: CompletionItemKind,
    detail: String,
    /// The inserted text, if it differs from the label.
    insert: Option<String>,
}

impl Choice {
    fn new(label: &str, kind: CompletionItemKind, detail: &str) -> Choice {
        Choice {
            label: label.to_owned(),
            kind,
            detail: detail.to_owned(),
            insert: None,
        }
    }
}

/// The completions at a place.
pub(super) fn completion(workspace: &Workspace, place: &Place) -> Vec<CompletionItem> {
    let Some(document) = workspace.document(&place.view, place.file) else {
        return Vec::new();
    };
    let text = document.line(place.line);
    let before: String = text.chars().take(place.column).collect();
    if as_line(&text).kind() == LineKind::Comment {
        return Vec::new();
    }
    let (typed, choices) = match before.rsplit_once('<') {
        Some((_, name)) if !name.contains(['>', ',']) => (name, parameters_of_deck(&place.view)),
        _ => choices(workspace, place, document, &before),
    };
    let start = place.column - typed.chars().count().min(place.column);
    let range = Range {
        start: document.position(place.line, start),
        end: document.position(place.line, place.column),
    };
    let items = choices.into_iter().map(|choice| item(choice, range));
    items.collect()
}

fn item(choice: Choice, range: Range) -> CompletionItem {
    let insert = choice.insert.unwrap_or_else(|| choice.label.clone());
    CompletionItem {
        filter_text: Some(choice.label.clone()),
        label: choice.label,
        kind: Some(choice.kind),
        detail: Some(choice.detail).filter(|detail| !detail.is_empty()),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(range, insert))),
        ..CompletionItem::default()
    }
}

/// Adds documentation to an item that the user has selected in the list: the explanation of its keyword.
pub(super) fn with_documentation(mut item: CompletionItem) -> CompletionItem {
    let name = item.label.strip_prefix('*');
    let keyword = name.and_then(find_keyword);
    let text = keyword.map(|keyword| Documentation::String(keyword.explanation()));
    item.documentation = item.documentation.or(text);
    item
}

/// The completions of the text before the cursor, and the part of this text that they replace.
fn choices<'t>(
    workspace: &Workspace,
    place: &Place,
    document: &Document,
    before: &'t str,
) -> (&'t str, Vec<Choice>) {
    let typed = last_field(before);
    let card = place.view.cards.at(place.file, place.line);
    if before.trim_start().starts_with('*') && !before.contains(',') {
        return (before.trim_start(), all_keywords(card));
    }
    let Some(card) = card else {
        return (typed, Vec::new());
    };
    if place.line > card.head.last && !continues(document, card, place.line) {
        return (typed, of_row(place, document, card, before));
    }
    match typed.split_once('=') {
        None => (typed, parameters(card)),
        Some((name, value)) => {
            let keyword = card.head.keyword;
            let parameter = keyword.and_then(|keyword| keyword.parameter_read_as(name));
            let value = value.trim_start();
            let values = parameter.map(|one| values(workspace, place, card, one, value));
            let typed = match parameter.map(|one| one.holds) {
                Some(Quantity::File) => value.rsplit('/').next().unwrap_or(value),
                _ => value,
            };
            (typed, values.unwrap_or_default())
        }
    }
}

/// Whether a blank line continues a keyword line that ends with a comma.
fn continues(document: &Document, card: &Card, line: usize) -> bool {
    let head = document.line(card.head.last);
    let between = card.head.last + 1..=line;
    let is_silent = |line| matches!(document.kind(line), LineKind::Blank | LineKind::Comment);
    as_line(&head).ends_with_comma()
        && line - card.head.last < 20
        && between.into_iter().all(is_silent)
}

/// The field with which a text ends.
fn last_field(text: &str) -> &str {
    let mut is_inside = false;
    let mut start = 0;
    for (at, c) in text.char_indices() {
        is_inside ^= c == '"';
        if c == ',' && !is_inside {
            start = at + 1;
        }
    }
    text.get(start..).unwrap_or_default().trim_start()
}

/// Keywords that the program reads; keywords that may stand behind `card` come first.
fn all_keywords(card: Option<&Card>) -> Vec<Choice> {
    let block = card.map_or("", |card| card.head.name());
    let read = keywords().filter(|keyword| keyword.status == Status::Read);
    let mut all: Vec<_> = read.collect();
    let belongs = |scope: deck::Scope| match scope {
        deck::Scope::Block(head) | deck::Scope::BlockOrModel(head) => head == block,
        deck::Scope::BlockOrAfter(head, other) => [head, other].contains(&block),
        _ => false,
    };
    all.sort_by_key(|keyword| (!belongs(keyword.scope), keyword.name));
    let choice = |keyword: &&Keyword| {
        let sentence = keyword.text.split(". ").next().unwrap_or_default();
        let label = format!("*{}", keyword.name);
        Choice::new(&label, CompletionItemKind::KEYWORD, sentence)
    };
    all.iter().map(choice).collect()
}

/// Parameters of a keyword that the program reads and the card does not have yet.
fn parameters(card: &Card) -> Vec<Choice> {
    let all = card
        .head
        .keyword
        .map_or(&[][..], |keyword| keyword.parameters);
    let is_new = |parameter: &&Parameter| {
        parameter.status == Status::Read && card.head.piece(parameter.name).is_none()
    };
    let choice = |parameter: &Parameter| {
        let choice = Choice::new(parameter.name, CompletionItemKind::FIELD, parameter.text);
        let insert = match parameter.takes {
            Takes::Value | Takes::Choice(_) => Some(format!("{}=", parameter.name)),
            Takes::Nothing | Takes::Optional | Takes::OptionalChoice(_) => None,
        };
        Choice { insert, ..choice }
    };
    all.iter().filter(is_new).map(choice).collect()
}

/// Completions of the value of a parameter.
fn values(
    workspace: &Workspace,
    place: &Place,
    card: &Card,
    parameter: &Parameter,
    typed: &str,
) -> Vec<Choice> {
    let read = parameter.values().iter();
    let read = read.filter(|value| value.status == Status::Read);
    let mut all: Vec<Choice> = read
        .map(|value| Choice::new(value.name, CompletionItemKind::ENUM_MEMBER, value.text))
        .collect();
    match parameter.holds {
        Quantity::Name(kind)
        | Quantity::OrName(_, kind)
        | Quantity::New(kind @ (Kind::NodeSet | Kind::ElementSet)) => {
            all.extend(names(&place.view, kind, &card.scope));
        }
        Quantity::File => all.extend(files(workspace, place, typed)),
        _ => {}
    }
    all
}

/// Names of objects of a kind, as they are written in a scope.
fn names(view: &View, kind: Kind, scope: &Scope) -> Vec<Choice> {
    let mut all = Vec::new();
    let instances = &view.cards.instances;
    let part_of = |key: &str| {
        let known = instances.iter().find(|instance| instance.name.key == key);
        known.map(|known| Scope::Part(known.part.clone()))
    };
    for one in view.symbols.defined() {
        if one.symbol.what != What::Thing(kind) {
            continue;
        }
        let own = &one.symbol.scope;
        let written = match one.is_quoted {
            true => format!("\"{}\"", one.typed),
            false => one.typed.clone(),
        };
        let is_near = match scope {
            Scope::Instance(key) => part_of(key).as_ref() == Some(own),
            Scope::Deck | Scope::Part(_) => false,
        };
        if *own == Scope::Deck || own == scope || is_near {
            all.push(written);
            continue;
        }
        let outside = instances.iter().filter(|instance| match own {
            Scope::Part(part) => instance.part == *part,
            Scope::Instance(key) => *instance.name.key == **key,
            Scope::Deck => false,
        });
        if *scope == Scope::Deck {
            all.extend(outside.map(|instance| format!("{}.{written}", instance.name.typed)));
        }
    }
    let choice = |name: &String| Choice::new(name, CompletionItemKind::VARIABLE, kind.name());
    all.iter().map(choice).collect()
}

/// Files and folders for a typed path, relative to the folder of a file.
fn files(workspace: &Workspace, place: &Place, typed: &str) -> Vec<Choice> {
    let file = place.view.cards.files.get(place.file);
    let folder = file.and_then(|file| file.path.parent());
    let (Some(folder), true) = (
        folder,
        workspace.document(&place.view, place.file).is_some(),
    ) else {
        return Vec::new();
    };
    let typed = typed.trim_start_matches('"');
    let below = typed.rsplit_once('/').map_or("", |(below, _)| below);
    let Ok(entries) = folder.join(Path::new(below)).read_dir() else {
        return Vec::new();
    };
    let entries = entries.filter_map(|entry| entry.ok());
    let mut all: Vec<Choice> = entries
        .take(MOST_FILES)
        .filter_map(|entry| {
            let is_folder = entry.file_type().ok()?.is_dir();
            let name = entry.file_name().into_string().ok()?;
            let end = if is_folder { "/" } else { "" };
            let kind = match is_folder {
                true => CompletionItemKind::FOLDER,
                false => CompletionItemKind::FILE,
            };
            let is_shown = !name.starts_with('.');
            is_shown.then(|| Choice::new(&format!("{name}{end}"), kind, ""))
        })
        .collect();
    all.sort_by(|one, other| one.label.cmp(&other.label));
    all
}

/// Names and words for a field of a data line.
fn of_row(place: &Place, document: &Document, card: &Card, before: &str) -> Vec<Choice> {
    if matches!(card.head.data(), Data::None | Data::Text) {
        return Vec::new();
    }
    let scope = match card.head.value("INSTANCE") {
        Some(name) if !name.is_empty() => Scope::Instance(key(name)),
        _ => card.scope.clone(),
    };
    let begun = as_line(before).fields().count();
    let is_between = before.trim_end().ends_with(',') || before.trim().is_empty();
    let index = if is_between {
        begun
    } else {
        begun.saturating_sub(1)
    };
    let is_first = is_first_row(document, card, place.line);
    let mut all: Vec<Choice> = Vec::new();
    let mut kinds = Vec::new();
    for form in card.head.data().forms() {
        let is_meant = match form.parameter {
            Some((name, "")) => given(&card.head, name).is_some(),
            Some((name, word)) => given(&card.head, name) == Some(word),
            None => true,
        };
        if !is_meant || (form.first && !is_first) {
            continue;
        }
        if let Some((field, words)) = form.word
            && field == index
        {
            let is_word = |word: &&&str| !word.bytes().all(|byte| byte.is_ascii_digit());
            let words = words.iter().filter(is_word);
            all.extend(words.map(|word| Choice::new(word, CompletionItemKind::ENUM_MEMBER, "")));
        }
        let kind = form.field(index).and_then(|field| field.holds.kind());
        if let Some(kind) = kind.filter(|kind| !kinds.contains(kind)) {
            kinds.push(kind);
            all.extend(names(&place.view, kind, &scope));
        }
    }
    all
}

/// Parameters of `*PARAMETER`.
fn parameters_of_deck(view: &View) -> Vec<Choice> {
    let all = view.symbols.defined();
    let all = all.filter(|one| one.symbol.what == What::Parameter);
    all.map(|one| Choice::new(&one.typed, CompletionItemKind::CONSTANT, "parameter"))
        .collect()
}
