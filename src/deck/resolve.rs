//! Looks keywords, parameters and their values up in the keyword table; reports those that are
//! unknown, ignored or refused.

use super::card::{Card, Param};
use super::keywords::{Keyword, Parameter, Status, Takes, Value, find_keyword, keywords};
use super::lines::assignment;
use super::text::{Match, Text, find, find_known};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Span};
use std::cell::Cell;

/// A piece of a keyword line between commas.
pub(crate) struct Piece<'a> {
    /// Its text and place.
    pub text: Text<'a>,
    /// Whether it stands on a continuation line.
    pub continued: bool,
}

/// The keyword of a text that begins with its star, or the one probably meant; reports unknown,
/// ignored and refused keywords.
pub(crate) fn keyword(text: Text, d: &mut Diagnostics) -> Option<&'static Keyword> {
    let (starred, span) = (text.text.trim_start_matches('*'), text.span);
    let typed = starred.trim();
    if let Some(keyword) = find_keyword(typed) {
        report_keyword(keyword, span, d);
        return Some(keyword);
    }
    let names = keywords().map(|keyword| keyword.name);
    let known = match d.may_show(&Diagnostic::error(Code::UnknownKeyword, span, "")) {
        true => find(typed, names),
        false => find_known(typed, names),
    };
    let unknown = || unknown_keyword(starred, span, known);
    let keyword = known_word(known, unknown, "*", span, d).and_then(find_keyword)?;
    if let Match::Unknown(_) = known {
        return Some(keyword).filter(|keyword| keyword.status == Status::Read);
    }
    report_keyword(keyword, span, d);
    Some(keyword)
}

/// The known word of a match, or the one probably meant unless reading is lenient; reports
/// abbreviations and unknown words.
fn known_word(
    found: Match,
    unknown: impl FnOnce() -> Diagnostic,
    prefix: &str,
    span: Span,
    d: &mut Diagnostics,
) -> Option<&'static str> {
    match found {
        Match::Exact(name) => Some(name),
        Match::Abbreviation(name) => {
            let message = format!("this abbreviation is read as {prefix}{name}");
            d.push_once(
                Diagnostic::warning(Code::Abbreviation, span, message).help("write the whole word"),
            );
            Some(name)
        }
        Match::Unknown(meant) => {
            d.push(unknown());
            meant.filter(|_| !d.is_lenient())
        }
    }
}

/// Error of an unknown keyword, as typed after its star; several words or a leading blank suggest
/// a comment.
fn unknown_keyword(starred: &str, span: Span, found: Match) -> Diagnostic {
    let meant = match found {
        Match::Unknown(Some(name)) => Some(format!("*{name}")),
        _ => None,
    };
    let message = format!("unknown keyword *{}", starred.trim_end());
    let is_sentence = meant.is_none() && starred.trim_end().contains(char::is_whitespace);
    let comment = match is_sentence {
        true => "a comment begins with two stars, `**`; ",
        false => "",
    };
    let help = format!(
        "{comment}unknown keywords stop the run because ignoring one can change the answer; \
         --lenient turns this into a warning"
    );
    Diagnostic::error(Code::UnknownKeyword, span, message)
        .suggest(meant)
        .help(help)
}

fn report_keyword(keyword: &Keyword, span: Span, d: &mut Diagnostics) {
    let name = keyword.name;
    match keyword.status {
        Status::Read | Status::Ignored => {}
        Status::Warned => {
            let message = format!("*{name} is left out");
            d.push_once(
                Diagnostic::warning(Code::IgnoredKeyword, span, message).help(advice(keyword.text)),
            );
        }
        Status::Refused => {
            let message = format!("*{name} cannot be used");
            d.push(
                Diagnostic::error(Code::UnsupportedKeyword, span, message)
                    .help(advice(keyword.text)),
            );
        }
    }
}

/// A sentence of the table as the help of a diagnostic: without capital and full stop.
fn advice(sentence: &str) -> String {
    let mut characters = sentence.trim_end_matches('.').chars();
    let first = characters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(characters).collect()
}

/// A parameter of `card`, checked against the table; `None` if it is left out.
pub(crate) fn parameter(card: &Card, piece: &Piece, d: &mut Diagnostics) -> Option<Param> {
    let span = piece.text.span;
    let typed = assignment(piece.text.text);
    let names = card.keyword.parameters.iter().map(|p| p.name);
    let found = find(typed.name.0, names);
    let unknown = || unknown_parameter(card, typed.name.0, piece, found);
    let name = known_word(found, unknown, "", span, d)?;
    let known = card.keyword.parameter(name)?;
    if card.params.iter().any(|param| param.name == name) {
        let message = format!("{name} is given twice");
        d.push(Diagnostic::error(Code::RepeatedParameter, span, message));
        return None;
    }
    let offset = typed.value.map_or(0, |(_, at)| at);
    let value = typed
        .value
        .map(|(value, _)| (value.to_string(), value_span(piece, value, offset)));
    let mut param = Param {
        name: known.name,
        span,
        value,
        choice: None,
        faulty: false,
        used: Cell::new(false),
    };
    check_status(card, known, span, d)?;
    check_value(known, &mut param, d);
    Some(param)
}

fn value_span(piece: &Piece, value: &str, offset: usize) -> Span {
    let before = piece.text.text.get(..offset).unwrap_or("");
    Span {
        column: piece.text.span.column + before.chars().count() as u32,
        length: (value.chars().count() as u32).max(1),
        ..piece.text.span
    }
}

fn unknown_parameter(card: &Card, typed: &str, piece: &Piece, found: Match) -> Diagnostic {
    let title = card.title();
    let meant = match found {
        Match::Unknown(meant) => meant,
        _ => None,
    };
    let names: Vec<&str> = card.keyword.parameters.iter().map(|p| p.name).collect();
    let mut help = match names.is_empty() {
        true => format!("{title} has no parameters"),
        false => format!("the parameters of {title} are {}", names.join(", ")),
    };
    if piece.continued {
        help += "; the line above ends with a comma, so this line continues it";
    }
    let message = format!("unknown parameter {typed} of {title}");
    Diagnostic::error(Code::UnknownParameter, piece.text.span, message)
        .suggest(meant)
        .help(help)
}

/// Reports a parameter that is ignored or refused; `None` if it is left out.
fn check_status(card: &Card, known: &Parameter, span: Span, d: &mut Diagnostics) -> Option<()> {
    let (name, title) = (known.name, card.title());
    match known.status {
        Status::Read => Some(()),
        Status::Ignored => None,
        Status::Warned => {
            let message = format!("{name} of {title} is left out");
            d.push_once(
                Diagnostic::warning(Code::IgnoredParameter, span, message).help(known.text),
            );
            None
        }
        Status::Refused => {
            let message = format!("{name} of {title} cannot be used");
            d.push(Diagnostic::error(Code::UnsupportedParameter, span, message).help(known.text));
            None
        }
    }
}

/// Checks that a value is given where the parameter takes one, and that it is an allowed word.
fn check_value(known: &Parameter, param: &mut Param, d: &mut Diagnostics) {
    let name = known.name;
    let typed = param.value.as_ref().filter(|(value, _)| !value.is_empty());
    let complaint = match (known.takes, typed) {
        (Takes::Nothing, _) if param.value.is_some() => format!("{name} takes no value"),
        (Takes::Value | Takes::Choice(_), None) => format!("{name} needs a value"),
        _ => String::new(),
    };
    if !complaint.is_empty() {
        d.push(Diagnostic::error(Code::BadValue, param.span, complaint));
        param.faulty = true;
    } else if let (Some((typed, span)), false) = (typed, known.values().is_empty()) {
        param.choice = choose(known, typed, *span, d);
        param.faulty = param.choice.is_none();
    }
}

/// The full word of a typed value; `None` if it is unknown or refused.
fn choose(known: &Parameter, typed: &str, span: Span, d: &mut Diagnostics) -> Option<&'static str> {
    let names = known.values().iter().map(|value| value.name);
    let found = find(typed, names.clone());
    let unknown = || {
        let message = format!("{} cannot be {typed}", known.name);
        let meant = match found {
            Match::Unknown(meant) => meant,
            _ => None,
        };
        let all: Vec<&str> = names.clone().collect();
        Diagnostic::error(Code::BadValue, span, message)
            .suggest(meant)
            .help(format!("it can be {}", all.join(", ")))
    };
    let name = known_word(found, unknown, "", span, d)?;
    let value = known.values().iter().find(|value| value.name == name)?;
    report_choice(known, value, span, d)
}

fn report_choice(
    known: &Parameter,
    value: &Value,
    span: Span,
    d: &mut Diagnostics,
) -> Option<&'static str> {
    let words = format!("{}={}", known.name, value.name);
    match value.status {
        Status::Read | Status::Ignored => Some(value.name),
        Status::Warned => {
            let message = format!("{words} is not taken as written");
            d.push_once(
                Diagnostic::warning(Code::IgnoredParameter, span, message).help(value.text),
            );
            Some(value.name)
        }
        Status::Refused => {
            let message = format!("{words} cannot be used");
            d.push(Diagnostic::error(Code::UnsupportedParameter, span, message).help(value.text));
            None
        }
    }
}
