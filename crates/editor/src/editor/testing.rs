//! Tests over all decks of the repository: names resolve as the reader resolves them, a deck with changed names has the
//! same meaning, and no text and no edit stops the server.

use super::completion::completion;
use super::hover::hover;
use super::navigation::{changeable, definitions, references, rename};
use super::outline::outline;
use super::symbols::{Occurrence, What};
use super::workspace::{Place, Workspace};
use crate::deck::Kind;
use crate::diagnostics::{Diagnostics, Interrupt, Sources, whole_path};
use lsp_types::{Position, Range, Url};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use stickslip_decks::reader;

/// The decks of the repository.
fn decks() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut all = Vec::new();
    let mut folders: Vec<PathBuf> = ["tests/decks", "input"]
        .map(|name| root.join(name))
        .to_vec();
    while let Some(folder) = folders.pop() {
        for entry in folder.read_dir().expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "inp") {
                all.push(whole_path(&path));
            }
        }
    }
    all.sort();
    assert!(all.len() > 40);
    all
}

/// The messages of the reader about a deck whose files have the given texts: whether the deck gives a model, and codes
/// and lines of the messages.
fn said(deck: &Path, texts: BTreeMap<PathBuf, String>) -> (bool, Vec<(&'static str, u32)>) {
    let mut sources = Sources::with_unsaved(texts, Interrupt::default());
    let mut d = Diagnostics::new();
    let model = reader::read_model(deck, &mut sources, &mut d);
    let places = d.sorted().into_iter();
    let places = places.map(|one| (one.code.id(), one.span.map_or(0, |span| span.line)));
    (model.is_some(), places.collect())
}

/// A workspace with one deck open.
fn opened(deck: &Path) -> Workspace {
    let text = std::fs::read(deck).expect("a deck");
    let mut workspace = Workspace::default();
    let uri = Url::from_file_path(deck).expect("a path");
    workspace.files.open(&uri, &String::from_utf8_lossy(&text));
    workspace
}

/// Names of surfaces that the reader makes, and words that replace names.
const MADE: [&str; 3] = ["ALL_EXTERIOR", "CURVED", "NONE"];

fn is_unknown(one: &&Occurrence) -> bool {
    !one.is_known && !MADE.contains(&&*one.symbol.key)
}

#[test]
fn names_of_decks_without_error_are_all_defined() {
    let mut names = 0;
    for deck in decks() {
        let mut workspace = opened(&deck);
        let view = workspace.view(&deck);
        let unknown = view.symbols.all.iter().filter(is_unknown);
        let unknown: Vec<_> = unknown.collect();
        names += view.symbols.all.len();
        if !unknown.is_empty() {
            let (is_sound, said) = said(&deck, BTreeMap::new());
            assert!(!is_sound, "{}: {unknown:?} {said:?}", deck.display());
        }
    }
    assert!(names > 1000, "{names}");
}

#[test]
fn a_changed_name_leaves_the_deck_as_it_was() {
    let mut changes = 0;
    for deck in decks() {
        let before = said(&deck, BTreeMap::new());
        let length = deck.metadata().expect("a deck").len();
        if !before.0 || length > 30_000 {
            continue;
        }
        let mut workspace = opened(&deck);
        let view = workspace.view(&deck);
        for one in view.symbols.defined() {
            let place = Place {
                view: workspace.view(&deck),
                file: one.file,
                line: one.spot.line,
                column: one.spot.start,
            };
            let edit = rename(&workspace, &place, "another_1").expect("a name");
            let mut texts = BTreeMap::new();
            for (uri, mut edits) in edit.changes.expect("changes") {
                let path = uri.to_file_path().expect("a file");
                let document = &workspace.files.get(&path).expect("known").document;
                let mut changed = super::document::Document::new(&document.rope().to_string());
                edits.sort_by_key(|edit| std::cmp::Reverse(edit.range.start));
                for edit in edits {
                    changed.change(Some(edit.range), &edit.new_text);
                }
                texts.insert(path, changed.rope().to_string());
            }
            let after = said(&deck, texts);
            // a coupling or tie without use has its name in results, not in messages
            assert_eq!(after, before, "{}: {one:?}", deck.display());
            changes += 1;
        }
    }
    assert!(changes > 200, "{changes}");
}

#[test]
fn a_name_that_is_not_defined_is_the_one_that_the_reader_reports() {
    let text = "*NSET, NSET=A\n1\n*BOUNDARY\nA, 1\nB, 1\n*STEP\n*CLOAD, AMPLITUDE=C\nA, 1, 1.\n";
    let mut workspace = Workspace::default();
    let uri = Url::parse("untitled:one").expect("an address");
    let path = workspace.open(&uri, text);
    let view = workspace.view(&path);
    let unknown = view.symbols.all.iter().filter(is_unknown);
    let unknown: Vec<_> = unknown
        .map(|one| (one.typed.as_str(), one.symbol.what))
        .collect();
    let expected = [
        ("B", What::Thing(Kind::NodeSet)),
        ("C", What::Thing(Kind::Amplitude)),
    ];
    assert_eq!(unknown, expected);
}

/// Cards and names of a deck, as text.
fn shown(workspace: &mut Workspace, path: &Path) -> String {
    let view = workspace.view(path);
    let cards = view.cards.all.iter();
    let cards: Vec<_> = cards
        .map(|card| (&card.head, &card.rows, card.end))
        .collect();
    format!("{cards:?} {:?}", view.symbols.all)
}

/// Asks for everything that the server can answer about a place.
fn ask(workspace: &mut Workspace, path: &Path, at: Position) {
    let Some(place) = workspace.place(path, at) else {
        return;
    };
    completion(workspace, &place);
    hover(workspace, &place);
    definitions(workspace, &place);
    references(workspace, &place, true);
    changeable(workspace, &place);
    let _ = rename(workspace, &place, "another");
    if let Some(document) = workspace.document(&place.view, place.file) {
        let whole = outline(&place.view.cards, place.file, document);
        let is_inside = |one: &lsp_types::DocumentSymbol| {
            one.range.start <= one.selection_range.start && one.selection_range.end <= one.range.end
        };
        assert!(whole.iter().all(is_inside), "{whole:?}");
    }
}

const SEEDS: [&str; 3] = [
    include_str!("../../../../tests/decks/assembly.inp"),
    include_str!("../../../../tests/decks/every_card.inp"),
    "*PARAMETER\na = 2*b # c\nb=sin(1)\n*NODE,\nNSET=\"x y\"\n<a>, 1\n*INCLUDE, INPUT=no.inc\nA, 1\n",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn no_change_ends_the_server(
        seed in 0..SEEDS.len(),
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), 0..60_u32, 0..3_u32, 0..60_u32,
             "([*,=.<>\"#'A-C1ä😀\n -]|\\*NSET, |\\*PART\n|\\*INSTANCE, NAME=A, PART=B\n|\\*END PART\n|\\*STEP\n){0,8}"),
            1..12),
        at in prop::collection::vec((any::<prop::sample::Index>(), 0..60_u32), 4),
    ) {
        let uri = Url::parse("untitled:one").expect("an address");
        let mut workspace = Workspace::default();
        let path = workspace.open(&uri, SEEDS[seed]);
        for (line, start, lines, end, text) in changes {
            let document = workspace.files.changing(&path).expect("an open file");
            let count = document.line_count();
            let line = line.index(count) as u32;
            let range = Range {
                start: Position::new(line, start),
                end: Position::new(line + lines, end),
            };
            document.change(Some(range), &text);
            let text = document.rope().to_string();
            for (line, column) in &at {
                let position = Position::new(line.index(count + 2) as u32, *column);
                ask(&mut workspace, &path, position);
            }
            let mut fresh = Workspace::default();
            fresh.open(&uri, &text);
            prop_assert_eq!(shown(&mut workspace, &path), shown(&mut fresh, &path));
        }
    }
}
