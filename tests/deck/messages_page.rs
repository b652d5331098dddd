//! The page docs/messages.md: every code with its meaning, cause and cure, an example and what the
//! program says about it. With the environment variable `BLESS` it is written anew.

use super::{BLOCKS, SHARED, SQUARE};
use stickslip::diagnostics::Code;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/messages.md");

/// Longest line of an example.
const WIDTH: usize = 240;

/// Most lines of an example, and those that are kept of a longer one at its ends.
const MOST: usize = 90;
const ENDS: [usize; 2] = [8, 32];

const HEAD: &str = "\
# Messages

`stickslip explain CODE` prints what a code means, its cause and its cure. This page is generated from the table of codes
(`crates/mechanics/src/diagnostics/code.rs`) and the decks of `tests/deck/errors.rs`.

A message says what is wrong, shows the line with a caret, and says what to do. In an included file it also names the
lines that include this file.

* Errors reject the deck (exit code 2). `--strict` turns warnings into errors.
* `--lenient` turns errors about unknown keywords and parameters into warnings.
* One run reports all errors that do not follow from others: at most 20 of each severity, and then their number.

| codes | subject |
|---|---|
| D1 | files, lines and fields |
| D2 | keywords and where they stand |
| D3 | mesh, sets and surfaces |
| D4 | materials, sections and contact |
| D5 | supports, loads, steps and output |

Each example changes one of [three decks](#the-deck-of-one-square) at the end of this page: lines with `+` replace
lines with `-`.

";

/// The page holds these entries; with `BLESS` it is made to.
pub fn check(entries: &str) {
    let wanted = format!(
        "{HEAD}## Codes\n{entries}\n## The deck of one square\n\n```\n{SQUARE}```\n\n\
         ## The deck of a block on its base\n\n```\n{SHARED}```\n\n\
         ## The assembly of two blocks\n\n```\n{BLOCKS}```\n"
    );
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(PAGE, &wanted).expect("the page can be written");
    }
    let found = std::fs::read_to_string(PAGE).unwrap_or_default();
    assert!(
        found == wanted,
        "docs/messages.md is out of date: run this test with BLESS=1"
    );
}

/// The part of the page about a code.
pub fn entry(code: Code, deck: &str, message: &str) -> String {
    let (id, meaning, cause, cure) = (code.id(), code.meaning(), code.cause(), code.cure());
    let [meaning, cause, cure] = [meaning, cause, cure].map(|text| text.replace('*', "\\*"));
    let said: Vec<&str> = message
        .split("\n\n")
        .filter(|one| one.contains(id))
        .collect();
    format!(
        "\n### {id}\n\n{meaning} {cause}\n\nCure: {cure}\n\n{}\n```text\n{}\n```\n",
        example(deck),
        shortened(said.first().unwrap_or(&""))
    )
}

/// How a deck differs from the nearest one of the three, or the deck itself.
fn example(deck: &str) -> String {
    let bases = [
        ("the deck of one square", SQUARE),
        ("the deck of a block on its base", SHARED),
        ("the assembly of two blocks", BLOCKS),
    ];
    let changes = bases.map(|(name, base)| (name, change(base, deck)));
    let nearest = changes
        .into_iter()
        .min_by_key(|(_, change)| change.lines().count());
    match nearest {
        Some((name, change)) if change.lines().count() < deck.lines().count() => {
            format!("In {name}:\n\n```diff\n{change}```\n")
        }
        _ => format!(
            "The deck:\n\n```text\n{}\n```\n",
            shortened(deck.trim_end())
        ),
    }
}

/// The lines that differ between two decks, from the first to the last one.
fn change(base: &str, deck: &str) -> String {
    let (old, new): (Vec<&str>, Vec<&str>) = (base.lines().collect(), deck.lines().collect());
    let same =
        |pairs: &mut dyn Iterator<Item = (&&str, &&str)>| pairs.take_while(|(a, b)| a == b).count();
    let before = same(&mut old.iter().zip(&new));
    let (old, new) = (&old[before..], &new[before..]);
    let after = same(&mut old.iter().rev().zip(new.iter().rev()));
    let (old, new) = (&old[..old.len() - after], &new[..new.len() - after]);
    let context = base.lines().take(before).last().filter(|_| old.is_empty());
    let mut lines: Vec<String> = context.map(|line| format!(" {line}")).into_iter().collect();
    lines.extend(old.iter().map(|line| format!("-{line}")));
    lines.extend(new.iter().map(|line| format!("+{line}")));
    shortened(&lines.join("\n")) + "\n"
}

/// A text without NUL bytes, with its long lines cut and without the middle of many lines.
fn shortened(text: &str) -> String {
    let cut = |line: &str| match line.char_indices().nth(WIDTH) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line.to_owned(),
    };
    let mut lines: Vec<String> = text.trim_end().lines().map(cut).collect();
    if lines.len() > MOST {
        let middle = ENDS[0]..lines.len() - ENDS[1];
        lines.splice(middle.clone(), [format!("** ... {} lines", middle.len())]);
    }
    lines.join("\n").replace('\0', "\\0")
}
