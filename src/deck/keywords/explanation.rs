//! What is known of one keyword, as text for the screen.

use super::keyword::Keyword;
use super::parameter::{Parameter, Status};
use super::words::{data, form, meaning, place, status, written};
use crate::diagnostics::wrapped;
use std::fmt::Write;

impl Keyword {
    /// Text for the screen: treatment, meaning, data lines, parameters and an example.
    pub fn explanation(&self) -> String {
        let head = format!("*{}: {}", self.name, treatment(self));
        let mut text = format!("{}\n{}", wrapped(&head, 0), wrapped(self.text, 0));
        let forms = self.data.forms().iter();
        let forms: String = forms
            .map(|one| wrapped(&format!("  {}", form(one).replace('`', "")), 2))
            .collect();
        push(&mut text, "data lines", &forms);
        let parameters: String = self.parameters.iter().map(parameter).collect();
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

/// What becomes of the keyword.
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

/// Adds a titled part, if there is one.
fn push(text: &mut String, title: &str, part: &str) {
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
