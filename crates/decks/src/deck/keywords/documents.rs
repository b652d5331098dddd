//! Documents made from the keyword table: the reference of all keywords, the text of `stickslip explain`, and the
//! dimensions as JSON for programs that change the units of a deck.

use super::keywords;
use super::types::{
    Data, DataLineForm, Field, Keyword, Level, Levels, Parameter, Quantity, Scope, Status, Takes,
};
use crate::diagnostics::wrapped;
use serde_json::{Map, Value as Json, json};
use std::fmt::Write;

/// Markdown text of the keyword reference: tables by task of the keywords that are read, an index by name, a section
/// for each keyword that is read, and tables of the keywords that are not read.
pub fn keyword_reference() -> String {
    let read: Vec<&Keyword> = keywords().filter(|k| k.status == Status::Read).collect();
    let mut text = String::from(HEAD);
    text.push_str("## Keywords that are read\n");
    for family in read.chunk_by(|one, next| one.task == next.task) {
        let title = family[0].task;
        let _ = write!(
            text,
            "\n### {title}\n\n| keyword | level | what it does |\n|---|---|---|\n"
        );
        for keyword in family {
            push_entry(&mut text, keyword);
        }
    }
    push_names(&mut text);
    text.push_str("\n## Each keyword\n");
    for keyword in &read {
        push_keyword(&mut text, keyword);
    }
    for (status, title) in OTHERS {
        push_list(&mut text, status, title);
    }
    text
}

/// Titles of the tables of keywords that are not read.
const OTHERS: [(Status, &str); 3] = [
    (Status::Refused, "Keywords that stop with an error"),
    (Status::Warned, "Keywords that are left out with a warning"),
    (
        Status::Ignored,
        "Keywords that are left out without a warning",
    ),
];

/// The anchor of a heading.
fn anchor(heading: &str) -> String {
    heading.to_lowercase().replace(' ', "-")
}

/// All keywords in alphabetical order, each with a link to its section or table.
fn push_names(text: &mut String) {
    let mut all: Vec<&Keyword> = keywords().collect();
    all.sort_unstable_by_key(|keyword| keyword.name);
    let link = |keyword: &Keyword| {
        let (name, status) = (keyword.name, keyword.status);
        let other = OTHERS.iter().find(|(of, _)| *of == status);
        format!(
            "[{name}](#{})",
            anchor(other.map_or(name, |(_, title)| title))
        )
    };
    text.push_str("\n### All keywords by name\n");
    for letter in
        all.chunk_by(|one, next| one.name.as_bytes().first() == next.name.as_bytes().first())
    {
        let links: Vec<String> = letter.iter().map(|keyword| link(keyword)).collect();
        let _ = write!(text, "\n{}\n", links.join(" \u{b7} "));
    }
}

const HEAD: &str = "\
# Keywords

This page is generated from the table that the reader uses (`crates/decks/src/deck/keywords/`).
`stickslip explain KEYWORD` prints the part about one keyword. The keywords are listed
[by task](#bodies-nodes-elements-sets-surfaces-parts) and [by name](#all-keywords-by-name).

A deck is a text file, ASCII or UTF-8.

* A keyword line begins with `*`, a comment line with `**`. Data lines follow their keyword; commas
  separate their fields. Empty lines are skipped. An empty field has its default.
* A keyword line that ends with a comma continues on the next line.
* Case and blanks in keywords, parameters and names do not matter. A name in quotation marks keeps both.
* A keyword or parameter may be abbreviated to a unique beginning of at least four letters (warning).
* Keywords of the model stand before the first step. A keyword that belongs to another one stands
  directly below it.
* A deck may have parts, instances of them in an assembly, and cards behind the assembly. The tables below give
  the levels at which a keyword may stand: `part` (in a part, or between `*INSTANCE` and `*END INSTANCE`),
  `assembly`, `model` (outside both) and `step`. In a deck without parts, keywords of parts and the assembly stand before
  the first step.
* A name is looked up at the level where it is used, then at the levels outside it (part, assembly, model). From outside,
  a set, surface, node or element of an instance has the instance's name before it: `Block-1.Top`, `Block-1.12`.
* Points, normals, and the directions of springs, dashpots and equations of a part move and turn with its instances.
  The directions of `*BOUNDARY`, loads and initial conditions are those of the whole deck.
* Node and element numbers run from 1 to 999 999 999, as in Abaqus. Numbers have a decimal point.
* Any consistent set of units gives the same results. `scripts/rescale.py` writes a deck in another set.

An error stops the run before it begins. These are errors:

* a keyword, parameter or value that this page does not list. In output requests, and in keywords that end in `OUTPUT`,
  `PRINT` or `FILE`, such words are left out with a warning;
* a data line with more fields than its keyword reads;
* a NUL byte, or a line of more than 65536 bytes (Abaqus reads 256);
* a wave speed, or the area, stiffness or mass of an element, that overflows or vanishes in
  floating-point numbers.

";

/// The row of a keyword in the tables at the beginning of the reference: the levels of the keyword and the first
/// sentence about it.
fn push_entry(text: &mut String, keyword: &Keyword) {
    let sentence = keyword
        .text
        .trim_end_matches('.')
        .replace("St. ", "St.\u{a0}");
    let ends = [": ", "; ", ". "]
        .iter()
        .filter_map(|end| sentence.find(end));
    let first = &sentence[..ends.min().unwrap_or(sentence.len())].replace('\u{a0}', " ");
    let (name, first, levels) = (keyword.name, plain(first), levels(keyword).join(", "));
    let _ = writeln!(
        text,
        "| [`*{name}`](#{}) | {levels} | {first} |",
        anchor(name)
    );
}

fn push_keyword(text: &mut String, keyword: &Keyword) {
    let (name, sentence) = (keyword.name, plain(keyword.text));
    let _ = write!(text, "\n### `*{name}`\n\n{sentence}\n");
    let (place, lines) = (place(keyword), data_lines(keyword.data));
    let _ = write!(text, "\n*Place:* {place}. *Data lines:* {lines}.\n");
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

/// The rows of a parameter and its values: rows of values that the program reads go to `read`, all other rows to
/// `other`.
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

impl Keyword {
    /// Text of a keyword for the screen: treatment, meaning, data lines, parameters and an example.
    pub fn explanation(&self) -> String {
        let head = format!("*{}: {}", self.name, treatment(self));
        let mut text = format!("{}\n{}", wrapped(&head, 0), wrapped(self.text, 0));
        let forms = self.data.forms().iter();
        let forms: String = forms
            .map(|one| wrapped(&format!("  {}", one.explanation()), 2))
            .collect();
        push(&mut text, "data lines", &forms);
        let parameters = self.parameters.iter().map(Parameter::explanation);
        let parameters: String = parameters.collect();
        push(&mut text, "parameters", &parameters);
        let lines = self.example.lines();
        let example: String = lines.map(|line| format!("  {line}\n")).collect();
        let title = match self.status {
            Status::Read => "example",
            _ => "in its place",
        };
        push(&mut text, title, &example);
        text
    }
}

impl Parameter {
    /// Text of a parameter for the screen: treatment, meaning and values.
    pub fn explanation(&self) -> String {
        parameter(self)
    }
}

impl DataLineForm {
    /// The fields of a kind of data line as the reference writes them, with the condition under which a line is of this
    /// kind.
    pub fn explanation(&self) -> String {
        form(self).replace('`', "")
    }
}

/// Words for the treatment of a keyword by the program.
fn treatment(keyword: &Keyword) -> String {
    match keyword.status {
        Status::Read => {
            let (place, data) = (place(keyword).replace('`', ""), data(keyword.data));
            format!("read; it stands {place}, with {data}")
        }
        Status::Ignored => "left out silently".to_string(),
        Status::Warned => "left out with a warning".to_string(),
        Status::Refused => "stops with an error".to_string(),
    }
}

/// Adds a part with its title; an empty part is left out.
pub(super) fn push(text: &mut String, title: &str, part: &str) {
    if !part.is_empty() {
        let _ = write!(text, "\n{title}\n{part}");
    }
}

/// The lines of a parameter and of its values.
fn parameter(parameter: &Parameter) -> String {
    let treated = status(parameter.status);
    let head = format!("  {} ({treated}) ", written(parameter));
    let values = parameter.values().iter().map(|value| {
        let head = format!("    {} ({}) ", value.name, status(value.status));
        wrapped(&(head + value.text), 6)
    });
    wrapped(&(head + &meaning(parameter)), 4) + &values.collect::<String>()
}

/// Words for the place of a keyword in a deck.
pub(super) fn place(keyword: &Keyword) -> String {
    match keyword.scope {
        Scope::At(_) if keyword.name == "STEP" => "after the keywords of the model".to_string(),
        Scope::At(levels) => place_by_levels(levels),
        Scope::Block(name) => format!("under `*{name}`"),
        Scope::BlockOrAfter(name, other) => format!("under `*{name}` or `*{other}`"),
        Scope::BlockOrModel(name) => format!("under `*{name}` or before the first step"),
        Scope::Structure => "in assembly decks".to_string(),
    }
}

/// Words for the place of a keyword in a deck without parts, and in a deck with parts.
fn place_by_levels(levels: Levels) -> String {
    let in_steps = [Level::FirstStep, Level::LaterStep].map(|level| levels.has(level));
    let flat = match (levels.are_of_model(), in_steps) {
        (false, _) => "in a step",
        (true, [true, true]) => "before the first step or in a step",
        (true, [true, false]) => "before the first step or in it",
        (true, _) => "before the first step",
    };
    let with_parts = match [Level::Assembly, Level::Model].map(|level| levels.has(level)) {
        _ if !levels.are_of_mesh() => "",
        [false, _] => "; in a deck with parts in a part or an instance",
        [true, false] => "; in a deck with parts in a part, an instance or the assembly",
        [true, true] => "; in a deck with parts in a part, an instance, the assembly or behind it",
    };
    format!("{flat}{with_parts}")
}

/// Words for the levels of a keyword.
fn levels(keyword: &Keyword) -> Vec<&'static str> {
    if keyword.scope == Scope::Structure {
        return Vec::new();
    }
    let levels = keyword.levels;
    let words = [
        (Level::Part, "part"),
        (Level::Assembly, "assembly"),
        (Level::Model, "model"),
    ];
    let words = words.into_iter().filter(|(level, _)| levels.has(*level));
    let steps = match [Level::LaterStep, Level::FirstStep].map(|level| levels.has(level)) {
        [true, _] => Some("step"),
        [false, true] => Some("first step"),
        [false, false] => None,
    };
    words.map(|(_, word)| word).chain(steps).collect()
}

/// Words for the data lines that a keyword has.
pub(super) fn data(data: Data) -> &'static str {
    match data {
        Data::None => "no data lines",
        Data::Rows(_) => "data lines",
        Data::Required(_) => "at least one data line",
        Data::Text => "free text",
        Data::Words | Data::Skipped => "data lines that are not looked at",
    }
}

/// The data lines of a keyword in one or two words.
fn data_lines(data: Data) -> &'static str {
    match data {
        Data::None => "none",
        Data::Rows(_) => "any number",
        Data::Required(_) => "one or more",
        Data::Text => "free text",
        Data::Words | Data::Skipped => "not looked at",
    }
}

/// The word for the treatment of a parameter or value by the program.
pub(super) fn status(status: Status) -> &'static str {
    match status {
        Status::Read => "read",
        Status::Ignored => "silent",
        Status::Warned => "warning",
        Status::Refused => "error",
    }
}

/// A parameter in the spelling of decks.
pub(super) fn written(parameter: &Parameter) -> String {
    let name = match parameter.other {
        "" => parameter.name.to_string(),
        other => format!("{} or {other}", parameter.name),
    };
    match parameter.takes {
        Takes::Nothing => name,
        Takes::Value | Takes::Choice(_) => format!("{name}="),
        Takes::Optional | Takes::OptionalChoice(_) => format!("{name}[=]"),
    }
}

/// Meaning of a parameter, with the dimension of its value.
pub(super) fn meaning(parameter: &Parameter) -> String {
    match parameter.holds.dimension() {
        Some(dimension) => format!("{} ({dimension})", parameter.text),
        None => parameter.text.to_string(),
    }
}

/// Text of a kind of data line: its condition, its fields, and the dimensions of fields that have one.
pub(super) fn form(form: &DataLineForm) -> String {
    let names: Vec<&str> = form.fields().map(|field| field.name).collect();
    let over = if form.repeating > 0 { ", ..." } else { "" };
    let dimensions: Vec<String> = form.fields().filter_map(dimension).collect();
    let dimensions = match dimensions.is_empty() {
        true => String::new(),
        false => format!(" ({})", dimensions.join(", ")),
    };
    let (condition, names) = (condition(form), names.join(", "));
    format!("{condition}`{names}{over}`{dimensions}")
}

fn dimension(field: Field) -> Option<String> {
    let dimension = field.holds.dimension()?;
    Some(format!("{}: {dimension}", field.name))
}

/// Words for the condition under which a line is of a kind.
fn condition(form: &DataLineForm) -> String {
    let under = form.parameter.map(|parameter| match parameter {
        (name, "") => format!("with `{name}`"),
        (name, value) => format!("with `{name}={value}`"),
    });
    let first = form.first.then(|| "first line".to_string());
    let conditions: Vec<String> = under.into_iter().chain(first).collect();
    match conditions.is_empty() {
        true => String::new(),
        false => conditions.join(", ") + ": ",
    }
}

/// Dimensions of the numbers of accepted keywords, as JSON: an object with an entry for every keyword, one entry on a
/// line.
pub fn dimensions_json() -> String {
    let entries: Vec<String> = keywords().filter_map(entry).collect();
    format!("{{\n{}\n}}\n", entries.join(",\n"))
}

/// The entry of a keyword; `None` if the contents of its fields are not known.
fn entry(keyword: &Keyword) -> Option<String> {
    let taken = |status: Status| status != Status::Refused;
    let parameters = keyword.parameters.iter().filter(|p| taken(p.status));
    let measure = |parameter: &Parameter| match parameter.values() {
        [] => quantity(parameter.holds),
        values => {
            let taken = values.iter().filter(|value| taken(value.status));
            taken.map(|value| value.name).collect()
        }
    };
    let names = parameters.flat_map(|parameter| {
        let both = [parameter.name, parameter.other].into_iter();
        let both = both.filter(|name| !name.is_empty());
        both.map(move |name| (name.to_string(), measure(parameter)))
    });
    let parameters: Map<String, Json> = names.collect();
    let content = match keyword.data {
        Data::Skipped => return None,
        Data::Words => json!({"anything": true}),
        Data::Text => json!({"parameters": parameters, "text": true}),
        data => {
            let rows: Vec<Json> = data.forms().iter().map(row).collect();
            json!({"parameters": parameters, "rows": rows})
        }
    };
    Some(format!("\"{}\": {content}", keyword.name))
}

fn row(form: &DataLineForm) -> Json {
    let fields: Vec<Json> = form.fields().map(|field| quantity(field.holds)).collect();
    let mut row = json!({"fields": fields});
    if let Some(parameter) = form.parameter {
        row["parameter"] = json!(parameter);
    }
    if let Some(word) = form.word {
        row["word"] = json!(word);
    }
    if form.first {
        row["first"] = json!(true);
    }
    if form.repeating > 0 {
        row["repeating"] = json!(form.repeating);
    }
    row
}

fn quantity(quantity: Quantity) -> Json {
    match quantity {
        Quantity::Plain | Quantity::Name(_) | Quantity::New(_) | Quantity::File => Json::Null,
        Quantity::Of(dimension) => json!(dimension),
        Quantity::OfOr(dimension, default) => json!({"dimension": dimension, "default": default}),
        Quantity::OrName(dimension, _) => json!({"dimension": dimension, "or_name": true}),
        Quantity::Unknown => json!("unknown"),
    }
}
