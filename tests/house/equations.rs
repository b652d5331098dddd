//! Equations of docs/theory.md and what refers to them: numbers, citations in the source, the table
//! of docs/architecture.md, and the items and subjects that these documents and docs/numerics.md name.
//!
//! `BLESS=1 cargo test --test house` brings the items of the table up to date.

use crate::names::{Tree, missing};
use crate::numbers::{Number, citations, equations, misnumbered, references};
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

const THEORY: &str = "docs/theory.md";
const NUMERICS: &str = "docs/numerics.md";
const ARCHITECTURE: &str = "docs/architecture.md";

fn read(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn tree() -> Tree {
    Tree::read(Path::new(env!("CARGO_MANIFEST_DIR")))
}

fn assert_none(offences: &[String]) {
    assert!(offences.is_empty(), "\n{}", offences.join("\n"));
}

#[test]
fn numbers_count_the_equations_of_their_sections() {
    let theory = read(THEORY);
    assert!(equations(&theory).len() > 12);
    assert_none(&misnumbered(&theory));
}

#[test]
fn citations_name_equations_that_exist() {
    let theory = read(THEORY);
    let known: BTreeSet<Number> = equations(&theory).into_iter().map(|(_, n)| n).collect();
    let mut offences = Vec::new();
    let mut check = |path: &str, found: Vec<(usize, Result<Number, String>)>| {
        offences.extend(found.into_iter().filter_map(|(line, number)| match number {
            Ok(number) if known.contains(&number) => None,
            Ok(number) => Some(format!("{path}:{line}: {THEORY} has no equation {number}")),
            Err(form) => Some(format!("{path}:{line}: `{form}` should read `eq. (1.2)`")),
        }));
    };
    for (path, text) in tree().sources() {
        check(path, citations(text));
    }
    for path in [THEORY, NUMERICS, ARCHITECTURE] {
        check(path, references(&read(path)));
    }
    assert_none(&offences);
}

#[test]
fn every_number_is_cited() {
    let theory = read(THEORY);
    let tree = tree();
    let cited: BTreeSet<Number> = (tree.sources())
        .flat_map(|(_, text)| citations(text))
        .chain(references(&theory))
        .filter_map(|(_, number)| number.ok())
        .collect();
    let idle = equations(&theory).into_iter();
    let idle = idle.filter(|(_, number)| !cited.contains(number));
    let offence = |(line, number)| format!("{THEORY}:{line}: nothing cites eq. {number}");
    assert_none(&idle.map(offence).collect::<Vec<_>>());
}

#[test]
fn named_subjects_exist() {
    let (tree, mut offences) = (tree(), Vec::new());
    for page in [THEORY, NUMERICS] {
        let name = page.trim_start_matches("docs/");
        let page = read(page);
        let mut check = |path: &str, text: &str, is_source| {
            let subjects = unknown(text, is_source, (name, &page)).into_iter();
            offences.extend(subjects.map(|s| format!("{path}: {name} has no subject `{s}`")));
        };
        for (path, text) in tree.sources().chain(tree.rust_files("tests/")) {
            check(path, text, true);
        }
        for path in [THEORY, NUMERICS, ARCHITECTURE, "docs/performance.md"] {
            check(path, &read(path), false);
        }
    }
    assert_none(&offences);
}

#[test]
fn named_items_exist() {
    let (tree, mut offences) = (tree(), Vec::new());
    for path in [THEORY, NUMERICS, ARCHITECTURE] {
        let names = missing(&read(path), &tree).into_iter();
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
