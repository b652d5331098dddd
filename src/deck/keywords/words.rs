//! The rows of the keyword table in words, for the reference and for the screen.

use super::fields::{Field, RowForm};
use super::keyword::{Data, Keyword, Scope};
use super::parameter::{Parameter, Status, Takes};

/// Where a keyword stands.
pub(super) fn place(keyword: &Keyword) -> String {
    match keyword.scope {
        Scope::Model if keyword.name == "STEP" => "after the keywords of the model".to_string(),
        Scope::Model => "before the first step".to_string(),
        Scope::Step => "in a step".to_string(),
        Scope::Anywhere => "before the first step or in a step".to_string(),
        Scope::Block(name) => format!("under `*{name}`"),
        Scope::BlockOrModel(name) => format!("under `*{name}` or before the first step"),
        Scope::Assembly => "in assembly decks".to_string(),
    }
}

/// The data lines of a keyword.
pub(super) fn data(data: Data) -> &'static str {
    match data {
        Data::None => "no data lines",
        Data::Rows(_) => "data lines",
        Data::Required(_) => "at least one data line",
        Data::Text => "free text",
        Data::Words | Data::Skipped => "data lines that are not looked at",
    }
}

/// What the program does with a parameter or value.
pub(super) fn status(status: Status) -> &'static str {
    match status {
        Status::Read => "read",
        Status::Ignored => "silent",
        Status::Warned => "warning",
        Status::Refused => "error",
    }
}

/// A parameter as it is written.
pub(super) fn written(parameter: &Parameter) -> String {
    let name = parameter.name;
    match parameter.takes {
        Takes::Nothing => name.to_string(),
        Takes::Value | Takes::Choice(_) => format!("{name}="),
        Takes::Optional | Takes::OptionalChoice(_) => format!("{name}[=]"),
    }
}

/// What a parameter means, with its dimension.
pub(super) fn meaning(parameter: &Parameter) -> String {
    match parameter.holds.dimension() {
        Some(dimension) => format!("{} ({dimension})", parameter.text),
        None => parameter.text.to_string(),
    }
}

/// A kind of data lines: which ones, their fields, and the dimensions of those that have one.
pub(super) fn form(form: &RowForm) -> String {
    let names: Vec<&str> = form.fields.iter().map(|field| field.name).collect();
    let over = if form.repeating > 0 { ", ..." } else { "" };
    let dimensions: Vec<String> = form.fields.iter().filter_map(dimension).collect();
    let dimensions = match dimensions.is_empty() {
        true => String::new(),
        false => format!(" ({})", dimensions.join(", ")),
    };
    let (condition, names) = (condition(form), names.join(", "));
    format!("{condition}`{names}{over}`{dimensions}")
}

fn dimension(field: &Field) -> Option<String> {
    let dimension = field.holds.dimension()?;
    Some(format!("{}: {dimension}", field.name))
}

/// Which lines are of a kind.
fn condition(form: &RowForm) -> String {
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
