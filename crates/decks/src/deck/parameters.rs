//! Parameters of a deck: the rows of `*PARAMETER`, and the lines in which `<name>` stands for a value. Messages about a
//! line with `<name>` show the line as it was typed.

use std::collections::BTreeMap;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use super::content::LONGEST_LINE;
use super::expression::{ParameterValue, evaluate};
use super::lines::{Line, LineKind, Lines};
use crate::diagnostics::{Code, Diagnostics, Replaced, Sources, Span, closest};

/// The parameters of a deck that is being read.
#[derive(Default)]
pub(super) struct Parameters {
    values: BTreeMap<String, ParameterValue>,
    /// Places where the parameters are defined.
    places: BTreeMap<String, Span>,
    /// Parameters that a line or an expression uses.
    used: BTreeSet<String>,
    /// Parameters whose values were given outside the deck.
    given: BTreeSet<String>,
    /// Parameters without a value, after a reported error.
    faulty: BTreeSet<String>,
    /// Whether a line had a name without value since the last [`Self::take_failure`].
    has_failed: bool,
}

impl Parameters {
    /// The parameters of a deck; `settings` gives values, `name=expression`, in place of the values of the deck.
    pub fn new(settings: &[String], d: &mut Diagnostics) -> Self {
        let mut parameters = Parameters::default();
        parameters.set(settings, d);
        parameters
    }

    fn set(&mut self, settings: &[String], d: &mut Diagnostics) {
        for setting in settings {
            let (name, text) = setting.split_once('=').unwrap_or((setting, ""));
            let name = name.trim();
            let value = match is_name(name) {
                true => evaluate(text, &self.values).map_err(|fault| fault.message),
                false => Err("expected name=value".to_owned()),
            };
            match value {
                Ok((value, used)) => {
                    self.used.extend(used);
                    self.values.insert(name.to_owned(), value);
                    self.given.insert(name.to_owned());
                }
                Err(why) => {
                    let message = format!("the parameter `{setting}` of the command line: {why}");
                    d.error_without_place(Code::BadExpression, message);
                }
            }
        }
    }

    /// Reads a row `name = expression  # note`.
    pub fn define(&mut self, line: Line, d: &mut Diagnostics) {
        let text = before_note(line.text);
        let Some((left, right)) = text.split_once('=') else {
            let message = "a row of *PARAMETER is `name = expression`";
            d.error(Code::BadExpression, line.span(), message);
            return;
        };
        let name = left.trim();
        let at = left.len() - left.trim_start().len();
        let place = line.span_of(at..at + name.len().max(1));
        if !is_name(name) {
            let message = format!("`{name}` cannot be the name of a parameter");
            d.error(Code::BadExpression, place, message)
                .help("a name begins with a letter and has letters, digits and underscores");
            return;
        }
        if self.places.contains_key(name) {
            let message = format!("the parameter {name} is defined already");
            d.error(Code::BadExpression, place, message);
            return;
        }
        self.places.insert(name.to_owned(), place);
        if self.given.contains(name) {
            return;
        }
        match evaluate(right, &self.values) {
            Ok((value, used)) => {
                self.used.extend(used);
                self.values.insert(name.to_owned(), value);
            }
            Err(fault) => {
                self.faulty.insert(name.to_owned());
                self.used.extend(fault.unknown.clone());
                if fault
                    .unknown
                    .as_ref()
                    .is_some_and(|name| self.faulty.contains(name))
                {
                    return;
                }
                let start = left.len() + 1;
                let span = line.span_of(start + fault.at.start..start + fault.at.end);
                match fault.unknown {
                    Some(unknown) => self.report_unknown(&unknown, span, d),
                    None => drop(d.error(Code::BadExpression, span, fault.message)),
                }
            }
        }
    }

    /// Whether a line had a name without value (a reported error) since the last call of this function.
    pub fn take_failure(&mut self) -> bool {
        std::mem::take(&mut self.has_failed)
    }

    /// Lines with the values of their parameters.
    pub fn replaced(
        &mut self,
        lines: Lines,
        sources: &mut Sources,
        d: &mut Diagnostics,
    ) -> Arc<String> {
        let mut text = String::with_capacity(lines.rest().len());
        for line in lines {
            let value = match line.kind() {
                LineKind::Data => self.replace(line, sources, d),
                _ => None,
            };
            text.push_str(value.as_deref().unwrap_or(line.text));
            text.push('\n');
        }
        Arc::new(text)
    }

    /// The line with the values of its parameters; `None` if the line has no parameter.
    pub fn replace(
        &mut self,
        line: Line,
        sources: &mut Sources,
        d: &mut Diagnostics,
    ) -> Option<String> {
        let mut text = String::new();
        let mut replaced = Vec::new();
        let mut rest = 0..line.text.len();
        let length = |text: &str| text.chars().count() as u32;
        let mut column = 1;
        while let Some((bytes, name)) = next_name(line.text, rest.clone()) {
            self.used.insert(name.to_owned());
            let before = &line.text[rest.start..bytes.start];
            text.push_str(before);
            column += length(before);
            let (at, typed) = (column, line.span_of(bytes.clone()));
            match self.values.get(name).map(ParameterValue::written) {
                Some(value) => {
                    text.push_str(&value);
                    let length = length(&value);
                    replaced.push(Replaced {
                        column,
                        length,
                        typed,
                    });
                    column += length;
                    if text.len() >= LONGEST_LINE {
                        self.has_failed = true;
                        let message = format!(
                            "with the values of its parameters this line has {LONGEST_LINE} bytes or more"
                        );
                        d.error(Code::EndlessLine, typed, message);
                        return None;
                    }
                }
                None => {
                    let unknown = &line.text[bytes.clone()];
                    text.push_str(unknown);
                    column += length(unknown);
                    self.has_failed = true;
                    if !self.faulty.contains(name) {
                        self.report_unknown(
                            name,
                            Span {
                                column: at,
                                ..typed
                            },
                            d,
                        );
                    }
                }
            }
            rest.start = bytes.end;
        }
        if replaced.is_empty() {
            return None;
        }
        text.push_str(&line.text[rest]);
        sources.replace(line.file, line.number, replaced);
        Some(text)
    }

    fn report_unknown(&mut self, name: &str, span: Span, d: &mut Diagnostics) {
        self.faulty.insert(name.to_owned());
        let message = format!("there is no parameter {name}");
        let error = d.error(Code::UnknownValue, span, message);
        let mut known = self.values.keys().map(String::as_str);
        match known.clone().find(|known| known.eq_ignore_ascii_case(name)) {
            Some(other) => error.help(format!("capitals count in names of parameters: did you mean {other}?")),
            None => match closest(name, &mut known) {
                Some(other) => error.help(format!("did you mean {other}?")),
                None => error.help(
                    "*PARAMETER defines it, in a line above with `name = expression`, or --set name=value",
                ),
            },
        };
    }

    /// Reports the parameters that no line and no expression uses.
    pub fn finish(&self, d: &mut Diagnostics) {
        for (name, place) in &self.places {
            if !self.used.contains(name) && !self.faulty.contains(name) {
                let message = format!("nothing uses the parameter {name}");
                d.error(Code::UnusedValue, *place, message)
                    .help("a name that is misspelt where it should stand keeps its number there");
            }
        }
        for name in &self.given {
            if !self.used.contains(name) && !self.places.contains_key(name) {
                let message = format!(
                    "the deck has no parameter {name}, which the command line gives a value"
                );
                d.error_without_place(Code::UnknownValue, message);
            }
        }
    }
}

fn is_name(text: &str) -> bool {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') && text.chars().all(is_word)
}

/// The text before a note, which begins with # outside of quotation marks.
fn before_note(text: &str) -> &str {
    let mut quote = None;
    for (at, c) in text.char_indices() {
        match (quote, c) {
            (None, '#') => return &text[..at],
            (None, '\'' | '"') => quote = Some(c),
            (Some(open), c) if open == c => quote = None,
            _ => {}
        }
    }
    text
}

/// The next `<name>` of a line: the range of its bytes, and the name.
fn next_name(text: &str, within: Range<usize>) -> Option<(Range<usize>, &str)> {
    let mut start = within.start;
    while let Some(open) = text.get(start..within.end)?.find('<') {
        let open = start + open;
        let inside = text.get(open + 1..within.end)?;
        if let Some(close) = inside.find('>')
            && let name = inside[..close].trim()
            && is_name(name)
        {
            return Some((open..open + close + 2, name));
        }
        start = open + 1;
    }
    None
}
