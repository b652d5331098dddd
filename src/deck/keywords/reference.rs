//! The keyword reference, generated from the table the reader uses.

use super::keyword::Keyword;
use super::parameter::{Parameter, Status};
use super::tables::keywords;
use super::words::{data, form, meaning, place, status, written};
use std::fmt::Write;

/// Markdown text of the keyword reference: a table of what is read, each keyword by itself, and
/// tables of what is not read.
pub fn keyword_reference() -> String {
    let read: Vec<&Keyword> = keywords().filter(|k| k.status == Status::Read).collect();
    let mut text = String::from(HEAD);
    text.push_str("## What is read\n\n| keyword | |\n|---|---|\n");
    for keyword in &read {
        push_entry(&mut text, keyword);
    }
    text.push_str("\n## Each keyword\n");
    for keyword in &read {
        push_keyword(&mut text, keyword);
    }
    let others = [
        (Status::Refused, "What stops with an error"),
        (Status::Warned, "What is left out with a warning"),
        (Status::Ignored, "What is left out silently"),
    ];
    for (status, title) in others {
        push_list(&mut text, status, title);
    }
    text
}

const HEAD: &str = "\
# Keywords

This page is generated from the table that the reader uses (`src/deck/keywords/tables/`).
`stickslip explain KEYWORD` prints what it says about one keyword.

A deck is a text file, ASCII or UTF-8.

* A keyword line begins with `*`, a comment line with `**`. Data lines follow their keyword; commas
  separate their fields. Empty lines are skipped. An empty field has its default.
* A keyword line that ends with a comma continues on the next line.
* Case and blanks in keywords, parameters and names do not matter. A name in quotation marks keeps both.
* A keyword or parameter may be cut to a unique beginning of at least four letters; a warning says so.
* Keywords of the model stand before the first step. A keyword that belongs to another one stands
  directly below it.
* Node and element numbers run from 1 to 999 999 999, as in Abaqus. Numbers have a decimal point.
* Units are up to the user: any consistent set gives the same results. `scripts/rescale.py` writes a
  deck in another set.

An error stops the run before it begins. These are errors:

* a keyword, parameter or value that this page does not list;
* a field beyond those that a data line has;
* a NUL byte, or a line of more than 65536 bytes (Abaqus reads 256);
* a wave speed, or the area, stiffness or mass of an element, that overflows or vanishes in
  floating-point numbers.

";

/// A keyword that is read, in the table at the beginning: its first sentence, and where it stands.
fn push_entry(text: &mut String, keyword: &Keyword) {
    let sentence = keyword
        .text
        .trim_end_matches('.')
        .replace("St. ", "St.\u{a0}");
    let ends = [": ", "; ", ". "]
        .iter()
        .filter_map(|end| sentence.find(end));
    let first = &sentence[..ends.min().unwrap_or(sentence.len())].replace('\u{a0}', " ");
    let anchor = keyword.name.to_lowercase().replace(' ', "-");
    let (name, first) = (keyword.name, plain(first));
    let _ = writeln!(text, "| [`*{name}`](#{anchor}) | {first} |");
}

fn push_keyword(text: &mut String, keyword: &Keyword) {
    let (name, sentence) = (keyword.name, plain(keyword.text));
    let _ = write!(text, "\n### `*{name}`\n\n{sentence}\n");
    let (place, data) = (place(keyword), data(keyword.data));
    let _ = write!(text, "\nIt stands {place}, with {data}.\n");
    let forms = keyword.data.forms().iter();
    let forms: String = forms.map(|one| format!("\n* {}", form(one))).collect();
    if !forms.is_empty() {
        let _ = writeln!(text, "{forms}");
    }
    let (mut read, mut other) = (String::new(), String::new());
    for parameter in keyword.parameters {
        push_parameter(&mut read, &mut other, parameter);
    }
    if !read.is_empty() {
        let _ = write!(text, "\n| parameter | meaning |\n|---|---|\n{read}");
    }
    if !other.is_empty() {
        let _ = write!(
            text,
            "\n| not read | what happens | why |\n|---|---|---|\n{other}"
        );
    }
    let _ = write!(text, "\n```\n{}\n```\n", keyword.example);
}

/// A parameter with its values: what is read, and what is not.
fn push_parameter(read: &mut String, other: &mut String, parameter: &Parameter) {
    let (form, text) = (written(parameter), plain(&meaning(parameter)));
    if parameter.status != Status::Read {
        let _ = writeln!(
            other,
            "| `{form}` | {} | {text} |",
            status(parameter.status)
        );
        return;
    }
    let _ = writeln!(read, "| `{form}` | {text} |");
    for value in parameter.values() {
        let (name, text) = (value.name, plain(value.text));
        let _ = match value.status {
            Status::Read => writeln!(read, "| &nbsp;&nbsp;`{name}` | {text} |"),
            other_status => {
                let treated = status(other_status);
                writeln!(
                    other,
                    "| `{}={name}` | {treated} | {text} |",
                    parameter.name
                )
            }
        };
    }
}

fn push_list(text: &mut String, status: Status, title: &str) {
    let _ = write!(text, "\n## {title}\n\n| keyword | |\n|---|---|\n");
    for keyword in keywords().filter(|k| k.status == status) {
        let _ = writeln!(text, "| `*{}` | {} |", keyword.name, plain(keyword.text));
    }
}

/// A sentence with its stars escaped for Markdown.
fn plain(sentence: &str) -> String {
    sentence.replace('*', "\\*")
}
