//! The dimensions of the keyword table as JSON, for programs that change the units of a deck.

use super::fields::{Quantity, RowForm};
use super::keyword::{Data, Keyword};
use super::parameter::{Parameter, Status, Value};
use super::tables::keywords;
use std::fmt::Write;

/// What the numbers of accepted keywords measure, as JSON: an object with an entry for every
/// keyword.
pub fn dimensions_json() -> String {
    let entries: Vec<String> = keywords().filter_map(entry).collect();
    format!("{{\n{}\n}}\n", entries.join(",\n"))
}

/// The entry of a keyword; `None` if what it holds is not known.
fn entry(keyword: &Keyword) -> Option<String> {
    let parameters = keyword.parameters.iter();
    let taken = parameters.filter(|parameter| parameter.status != Status::Refused);
    let parameters = taken.map(|parameter| {
        let value = measure(parameter);
        format!("    \"{}\": {value}", parameter.name)
    });
    let content = match keyword.data {
        Data::Skipped => return None,
        Data::Words => "  \"anything\": true".to_string(),
        Data::Text => object("parameters", parameters) + ",\n  \"text\": true",
        data => {
            let rows = data.forms().iter().map(row);
            object("parameters", parameters) + ",\n" + &list("rows", rows)
        }
    };
    Some(format!(" \"{}\": {{\n{content}\n }}", keyword.name))
}

fn measure(parameter: &Parameter) -> String {
    match parameter.values() {
        [] => quantity(parameter.holds),
        values => words(values),
    }
}

/// The accepted words of a parameter's values.
fn words(values: &[Value]) -> String {
    let taken = values
        .iter()
        .filter(|value| value.status != Status::Refused);
    let words: Vec<String> = taken.map(|value| format!("\"{}\"", value.name)).collect();
    format!("[{}]", words.join(", "))
}

fn object(name: &str, lines: impl Iterator<Item = String>) -> String {
    wrapped(name, lines, ["{", "}"])
}

fn list(name: &str, lines: impl Iterator<Item = String>) -> String {
    wrapped(name, lines, ["[", "]"])
}

fn wrapped(name: &str, lines: impl Iterator<Item = String>, [open, close]: [&str; 2]) -> String {
    let lines: Vec<String> = lines.collect();
    match lines.is_empty() {
        true => format!("  \"{name}\": {open}{close}"),
        false => format!("  \"{name}\": {open}\n{}\n  {close}", lines.join(",\n")),
    }
}

fn row(form: &RowForm) -> String {
    let mut text = String::from("    {");
    if let Some((name, value)) = form.parameter {
        let _ = write!(text, "\"parameter\": [\"{name}\", \"{value}\"], ");
    }
    if let Some((index, words)) = form.word {
        let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
        let _ = write!(text, "\"word\": [{index}, [{}]], ", words.join(", "));
    }
    if form.first {
        text.push_str("\"first\": true, ");
    }
    let fields: Vec<String> = form.fields.iter().map(|f| quantity(f.holds)).collect();
    let _ = write!(text, "\"fields\": [{}]", fields.join(", "));
    if form.repeating > 0 {
        let _ = write!(text, ", \"repeating\": {}", form.repeating);
    }
    text + "}"
}

fn quantity(quantity: Quantity) -> String {
    match quantity {
        Quantity::Plain => "null".to_string(),
        Quantity::Of(dimension) => format!("\"{dimension}\""),
        Quantity::OfOr(dimension, default) => {
            format!("{{\"dimension\": \"{dimension}\", \"default\": \"{default}\"}}")
        }
        Quantity::OrName(dimension) => {
            format!("{{\"dimension\": \"{dimension}\", \"or_name\": true}}")
        }
        Quantity::Unknown => "\"unknown\"".to_string(),
    }
}
