//! Equations of the chapters in docs/theory and what refers to them: numbers, citations in the source,
//! the table of docs/architecture.md, and the items, subjects and pages that texts name.
//!
//! `BLESS=1 cargo test --test house` brings the items of the table up to date.

use crate::names::{Tree, missing};
use crate::numbers::{Number, citations, equations, misnumbered, references};
use crate::pages;
use crate::subjects::unknown;
use crate::table::{HEADING, updated};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Equations that a new reader looks for: beginnings of the second column of the table.
const MAIN_EQUATIONS: [&str; 12] = [
    "strain",
    "tangent",
    "gap rows",
    "equilibrium",
    "velocity update",
    "K*",
    "Delassus matrix",
    "equal-force rule",
    "impulses",
    "discrete gradient",
    "corner gap",
    "ledger",
];

const THEORY: &str = "docs/theory/";
const NUMERICS: &str = "docs/numerics.md";
const ARCHITECTURE: &str = "docs/architecture.md";

fn read(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn tree() -> Tree {
    Tree::read(Path::new(env!("CARGO_MANIFEST_DIR")))
}

/// Paths and texts of the chapters.
fn chapters(tree: &Tree) -> Vec<(String, String)> {
    let paths = tree.paths(THEORY).filter(|path| path.ends_with(".md"));
    paths.map(|path| (path.to_string(), read(path))).collect()
}

/// Numbers of all equations, with the chapter and the line that define them.
fn defined(chapters: &[(String, String)]) -> Vec<(String, Number)> {
    let own = |(path, text): &(String, String)| {
        let place = |(line, number)| (format!("{path}:{line}"), number);
        equations(text).into_iter().map(place).collect::<Vec<_>>()
    };
    chapters.iter().flat_map(own).collect()
}

fn assert_none(offences: &[String]) {
    assert!(offences.is_empty(), "\n{}", offences.join("\n"));
}

#[test]
fn numbers_are_unique_and_none_is_missing() {
    let chapters = chapters(&tree());
    assert!(defined(&chapters).len() > 12 && chapters.len() > 5);
    let texts: Vec<(&str, &str)> = (chapters.iter())
        .map(|(path, text)| (path.as_str(), text.as_str()))
        .collect();
    assert_none(&misnumbered(&texts));
}

#[test]
fn citations_name_equations_that_exist() {
    let tree = tree();
    let chapters = chapters(&tree);
    let known: BTreeSet<Number> = defined(&chapters).into_iter().map(|(_, n)| n).collect();
    let mut offences = Vec::new();
    let mut check = |path: &str, found: Vec<(usize, Result<Number, String>)>| {
        offences.extend(found.into_iter().filter_map(|(line, number)| match number {
            Ok(number) if known.contains(&number) => None,
            Ok(number) => Some(format!("{path}:{line}: {THEORY} has no equation {number}")),
            Err(form) => Some(format!("{path}:{line}: `{form}` should read `eq. (1.2)`")),
        }));
    };
    for (path, text) in tree.sources() {
        check(path, citations(text));
    }
    for (path, text) in &chapters {
        check(path, references(text));
    }
    for path in [NUMERICS, ARCHITECTURE] {
        check(path, references(&read(path)));
    }
    assert_none(&offences);
}

#[test]
fn every_number_is_cited() {
    let tree = tree();
    let chapters = chapters(&tree);
    let cited: BTreeSet<Number> = (tree.sources())
        .flat_map(|(_, text)| citations(text))
        .chain(chapters.iter().flat_map(|(_, text)| references(text)))
        .filter_map(|(_, number)| number.ok())
        .collect();
    let idle = defined(&chapters).into_iter();
    let idle = idle.filter(|(_, number)| !cited.contains(number));
    let offence = |(place, number)| format!("{place}: nothing cites eq. {number}");
    assert_none(&idle.map(offence).collect::<Vec<_>>());
}

#[test]
fn pages_that_texts_name_exist() {
    let tree = tree();
    let mut offences = Vec::new();
    let tests = tree.rust_files("tests/");
    let tests = tests.filter(|(path, _)| !path.starts_with("tests/house/"));
    for (path, text) in tree.sources().chain(tests) {
        let absent = pages::named(text).into_iter();
        let absent = absent.filter(|(_, page)| !tree.has_path(page));
        offences.extend(absent.map(|(line, page)| format!("{path}:{line}: there is no {page}")));
    }
    assert_none(&offences);
}

#[test]
fn named_subjects_exist() {
    let (tree, mut offences) = (tree(), Vec::new());
    let mut pages = chapters(&tree);
    pages.push((NUMERICS.to_string(), read(NUMERICS)));
    let documents: Vec<(String, String)> = [ARCHITECTURE, "docs/performance.md"]
        .map(|path| (path.to_string(), read(path)))
        .into_iter()
        .chain(pages.clone())
        .collect();
    for (name, page) in &pages {
        let name = name.trim_start_matches("docs/");
        let mut check = |path: &str, text: &str, is_source| {
            let subjects = unknown(text, is_source, (name, page)).into_iter();
            offences.extend(subjects.map(|s| format!("{path}: {name} has no subject `{s}`")));
        };
        for (path, text) in tree.sources().chain(tree.rust_files("tests/")) {
            check(path, text, true);
        }
        for (path, text) in &documents {
            check(path, text, false);
        }
    }
    assert_none(&offences);
}

#[test]
fn named_items_exist() {
    let (tree, mut offences) = (tree(), Vec::new());
    let mut documents = chapters(&tree);
    documents.extend([NUMERICS, ARCHITECTURE].map(|path| (path.to_string(), read(path))));
    for (path, text) in documents {
        let names = missing(&text, &tree).into_iter();
        offences.extend(names.map(|(line, name)| format!("{path}:{line}: there is no `{name}`")));
    }
    assert_none(&offences);
}

#[test]
fn the_table_has_the_items_of_the_main_equations() {
    let text = read(ARCHITECTURE);
    let table = updated(&text, &tree());
    let table = table.unwrap_or_else(|offences| panic!("\n{}", offences.join("\n")));
    let has = |what: &&str| table.subjects.iter().any(|s| s.starts_with(*what));
    let absent: Vec<&str> = MAIN_EQUATIONS.into_iter().filter(|s| !has(s)).collect();
    assert!(absent.is_empty(), "no row of \"{HEADING}\" for {absent:?}");
    if std::env::var_os("BLESS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(ARCHITECTURE);
        fs::write(path, table.text).expect("the document is written");
        return;
    }
    let hint = "BLESS=1 cargo test --test house writes these rows:";
    let pairs = text.lines().zip(table.text.lines());
    let changed = pairs.filter(|(old, new)| old != new);
    let changed: Vec<String> = changed.map(|(_, new)| new.to_string()).collect();
    assert!(changed.is_empty(), "{hint}\n{}", changed.join("\n"));
}
