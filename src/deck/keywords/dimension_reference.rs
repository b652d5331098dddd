//! The table of dimensions as JSON, for programs that change the units of a deck, and in words, for
//! the keyword reference.

use super::dimensions::{Dimensions, Quantity, RowForm};
use super::keyword::{Data, Keyword, Parameter, Status, Value};
use super::table::keywords;
use super::table_dimensions::DIMENSIONS;
use std::fmt::Write;

/// What the numbers of a keyword measure.
pub(crate) fn of(keyword: &Keyword) -> Option<&'static Dimensions> {
    DIMENSIONS.iter().find(|d| d.keyword == keyword.name)
}

/// Faults of the table of dimensions: accepted keywords and parameters that it lacks, and entries
/// without such a keyword or parameter.
pub fn dimension_faults() -> Vec<String> {
    let mut faults = Vec::new();
    for keyword in keywords().filter(|k| k.status == Status::Read) {
        let Some(dimensions) = of(keyword) else {
            faults.push(format!("*{} has no dimensions", keyword.name));
            continue;
        };
        let has_rows = matches!(keyword.data, Data::Rows | Data::Required);
        if has_rows == dimensions.rows.is_empty() {
            faults.push(format!("the data lines of *{}", keyword.name));
        }
        for parameter in taken(keyword).filter(|p| dimensions.of(p).is_none()) {
            faults.push(format!("{} of *{}", parameter.name, keyword.name));
        }
    }
    for dimensions in DIMENSIONS {
        let known = keywords().find(|k| k.name == dimensions.keyword);
        let unknown = |name: &str| known.and_then(|k| k.parameter(name)).is_none();
        let measured = dimensions.measured.iter().map(|(name, _)| name);
        let strays = dimensions.plain.iter().chain(measured);
        let strays = strays.filter(|name| unknown(name));
        faults.extend(strays.map(|name| format!("unknown {name} of *{}", dimensions.keyword)));
        if known.is_none() {
            faults.push(format!("unknown *{}", dimensions.keyword));
        }
    }
    faults
}

/// Parameters that are accepted: read, ignored or left out with a warning.
fn taken(keyword: &Keyword) -> impl Iterator<Item = &'static Parameter> {
    let parameters = keyword.parameters.iter();
    parameters.filter(|parameter| parameter.status != Status::Refused)
}

/// The table of dimensions as JSON: an object with an entry for every keyword.
pub fn dimensions_json() -> String {
    let entries = keywords().filter_map(|keyword| {
        let dimensions = of(keyword)?;
        Some(entry(keyword, dimensions))
    });
    let entries: Vec<String> = entries.collect();
    format!("{{\n{}\n}}\n", entries.join(",\n"))
}

fn entry(keyword: &Keyword, dimensions: &Dimensions) -> String {
    let parameters = taken(keyword).filter_map(|parameter| {
        let value = match parameter.values() {
            [] => quantity(dimensions.of(parameter)?),
            values => words(values),
        };
        Some(format!("    \"{}\": {value}", parameter.name))
    });
    let rows = dimensions.rows.iter().map(row);
    let content = match keyword.data {
        _ if dimensions.anything => "  \"anything\": true".to_string(),
        Data::Text => object("parameters", parameters) + ",\n  \"text\": true",
        _ => object("parameters", parameters) + ",\n" + &list("rows", rows),
    };
    format!(" \"{}\": {{\n{content}\n }}", keyword.name)
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
    let fields: Vec<String> = form.fields.iter().map(|&q| quantity(q)).collect();
    let _ = write!(text, "\"fields\": [{}]", fields.join(", "));
    if form.repeats {
        text.push_str(", \"repeats\": true");
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

/// The dimensions of a keyword's fields and parameters in words; `None` if there are none.
pub(crate) fn in_words(keyword: &Keyword) -> Option<String> {
    let dimensions = of(keyword)?;
    let mut words: Vec<String> = dimensions.rows.iter().filter_map(row_in_words).collect();
    words.extend(dimensions.measured.iter().filter_map(|&(name, quantity)| {
        let taken = taken(keyword).any(|p| p.name == name && p.status == Status::Read);
        let dimension = dimension(quantity).filter(|_| taken)?;
        Some(format!("`{name}=` {dimension}"))
    }));
    (!words.is_empty()).then(|| words.join("; "))
}

fn row_in_words(form: &RowForm) -> Option<String> {
    let measured = form.fields.iter().enumerate();
    let measured = measured.filter_map(|(i, &q)| Some((i + 1, dimension(q)?)));
    let fields: Vec<String> = measured
        .map(|(i, dimension)| match form.fields.len() {
            1 if form.repeats => format!("all fields {dimension}"),
            _ => format!("field {i} {dimension}"),
        })
        .collect();
    if fields.is_empty() {
        return None;
    }
    let of_parameter = form
        .parameter
        .map(|(name, value)| format!("`{name}={value}`"));
    let of_word = form.word.map(|(_, words)| words.join(", "));
    let which: Vec<String> = of_parameter.into_iter().chain(of_word).collect();
    let which = if which.is_empty() {
        String::new()
    } else {
        which.join(" ") + ": "
    };
    let over = if form.repeats && form.fields.len() > 1 {
        ", and so on"
    } else {
        ""
    };
    Some(format!("{which}{}{over}", fields.join(", ")))
}

fn dimension(quantity: Quantity) -> Option<&'static str> {
    match quantity {
        Quantity::Plain | Quantity::Unknown => None,
        Quantity::Of(dimension) | Quantity::OfOr(dimension, _) | Quantity::OrName(dimension) => {
            Some(dimension)
        }
    }
}
