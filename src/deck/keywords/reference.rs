//! The keyword reference, generated from the table the reader uses.

use super::keyword::Keyword;
use super::parameter::{Parameter, Status};
use super::tables::keywords;
use super::words::{data, form, meaning, place, status, written};
use std::fmt::Write;

/// Markdown text of the keyword reference.
pub fn keyword_reference() -> String {
    let mut text = String::from(HEAD);
    text.push_str("## Keywords that are read\n");
    for keyword in keywords().filter(|k| k.status == Status::Read) {
        push_keyword(&mut text, keyword);
    }
    let others = [
        (Status::Ignored, "Keywords that are accepted silently"),
        (Status::Warned, "Keywords that are left out with a warning"),
        (Status::Refused, "Keywords that stop with an error"),
    ];
    for (status, title) in others {
        push_list(&mut text, status, title);
    }
    text
}

const HEAD: &str = "\
# Keywords

Generated from the table that the reader uses (`src/deck/keywords/tables/`); do not edit by hand.
`stickslip explain KEYWORD` prints the same about one keyword.

A deck is a text file. A keyword line begins with `*`, a comment line with `**`; data lines follow
their keyword, with fields between commas. Case and blanks in keywords, parameters and names do not
matter; a name in quotation marks keeps both. A keyword line that ends with a comma continues on the
next line. Empty lines are skipped, an empty field has its default. Units are up to the user: any
consistent set gives the same results, and `scripts/rescale.py` writes a deck in another one. A file
holds text, ASCII or UTF-8, without NUL bytes, and no line of more than 65536 bytes (Abaqus reads
256): anything else is an error at once.

Keywords, parameters and values not listed here are errors. A unique beginning of at least four
letters is understood, with a warning. Fields beyond those described are errors. Keywords of the model
stand before the first step, those under another one directly below it. Node and element numbers run
from 1 to 999 999 999, the largest that Abaqus reads. Numbers have a decimal point.

A wave speed, or an element's area, stiffness or mass, that overflows or vanishes in floating-point
numbers is an error.

";

fn push_keyword(text: &mut String, keyword: &Keyword) {
    let (name, sentence) = (keyword.name, plain(keyword.text));
    let _ = write!(text, "\n### `*{name}`\n\n{sentence}\n");
    let (place, data) = (place(keyword), data(keyword.data));
    let _ = write!(text, "\nStands {place}; {data}.\n");
    let forms = keyword.data.forms().iter();
    let forms: String = forms.map(|one| format!("\n* {}", form(one))).collect();
    if !forms.is_empty() {
        let _ = writeln!(text, "{forms}");
    }
    if !keyword.parameters.is_empty() {
        text.push_str("\n| parameter | | meaning |\n|---|---|---|\n");
    }
    for parameter in keyword.parameters {
        push_parameter(text, parameter);
    }
    let _ = write!(text, "\n```\n{}\n```\n", keyword.example);
}

fn push_parameter(text: &mut String, parameter: &Parameter) {
    let (form, treated) = (written(parameter), status(parameter.status));
    let meaning = plain(&meaning(parameter));
    let _ = writeln!(text, "| `{form}` | {treated} | {meaning} |");
    for value in parameter.values() {
        let (treated, name, meaning) = (status(value.status), value.name, plain(value.text));
        let _ = writeln!(text, "| &nbsp;&nbsp;`{name}` | {treated} | {meaning} |");
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
