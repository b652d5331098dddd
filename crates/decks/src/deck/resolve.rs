//! Looks up keywords, parameters and their values in the keyword table; reports unknown, ignored and refused words.

use super::card::{Card, Param};
use super::keywords::{Keyword, Parameter, Status, Takes, find_keyword, keywords};
use super::text::{Match, Text, find, find_known};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Span};
use std::cell::Cell;

/// A piece of a keyword line between commas.
pub(crate) struct Piece<'a> {
    /// Text of the piece and its place.
    pub text: Text<'a>,
    /// Whether the piece stands on a continuation line.
    pub continued: bool,
}

/// The keyword that a text with a star names, or the keyword that is probably meant; reports unknown, ignored and
/// refused keywords.
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
    let is_output = asks_for_output(typed);
    let unknown = || unknown_keyword(starred, span, known);
    let keyword = known_word(known, unknown, "*", (span, is_output), d).and_then(find_keyword)?;
    if let Match::Unknown(_) = known {
        return Some(keyword).filter(|keyword| keyword.status == Status::Read);
    }
    report_keyword(keyword, span, d);
    Some(keyword)
}

/// The keyword that a typed word means: the word is its name or an abbreviation of it.
pub fn keyword_read_as(typed: &str) -> Option<&'static Keyword> {
    find_keyword(typed).or_else(|| {
        match find_known(typed, keywords().map(|keyword| keyword.name)) {
            Match::Exact(name) | Match::Abbreviation(name) => find_keyword(name),
            Match::Unknown(_) => None,
        }
    })
}

/// Whether the last word of an unknown keyword asks for output (`OUTPUT`, `PRINT`, `FILE`).
fn asks_for_output(typed: &str) -> bool {
    let last = typed.split_whitespace().next_back().unwrap_or_default();
    let words = ["OUTPUT", "PRINT", "FILE"];
    typed != last && words.iter().any(|word| last.eq_ignore_ascii_case(word))
}

/// The known word that was found, or else the word that is probably meant; reports abbreviations and unknown words.
/// Unknown words that ask for output are left out with a warning.
fn known_word(
    found: Match,
    unknown: impl FnOnce() -> Diagnostic,
    prefix: &str,
    (span, is_output): (Span, bool),
    d: &mut Diagnostics,
) -> Option<&'static str> {
    match found {
        Match::Exact(name) => Some(name),
        Match::Abbreviation(name) => {
            let message = format!("this abbreviation is read as {prefix}{name}");
            d.warning_once(Code::Abbreviation, span, message)
                .help("write the whole word");
            Some(name)
        }
        Match::Unknown(_) if is_output => {
            d.push(left_out(unknown()));
            None
        }
        Match::Unknown(meant) => {
            d.push(unknown());
            meant.filter(|_| !d.is_lenient())
        }
    }
}

/// Makes the error of a request for output a warning.
fn left_out(fault: Diagnostic) -> Diagnostic {
    Diagnostic {
        severity: Severity::Warning,
        help: Some(
            "it is left out: what a deck asks for as output does not change the answer".into(),
        ),
        ..fault
    }
}

/// Error of an unknown keyword. If the keyword has several words or begins with a blank, the message suggests that a
/// comment was meant.
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
    let (what, help) = (format!("*{}", keyword.name), advice(keyword.text));
    match keyword.status {
        Status::Read | Status::Ignored => {}
        Status::Warned => {
            let message = format!("{what} is left out");
            d.warning_once(Code::IgnoredKeyword, span, message)
                .help(help);
        }
        Status::Refused => {
            let message = format!("{what} cannot be used");
            d.error(Code::UnsupportedKeyword, span, message).help(help);
        }
    }
}

/// A sentence of the table as the help of a diagnostic: without its capital letter and full stop.
fn advice(sentence: &str) -> String {
    let mut characters = sentence.trim_end_matches('.').chars();
    let first = characters.next().into_iter().flat_map(char::to_lowercase);
    first.chain(characters).collect()
}

/// A parameter of `card`, checked against the table; `None` if the parameter is left out.
pub(crate) fn parameter(card: &Card, piece: &Piece, d: &mut Diagnostics) -> Option<Param> {
    let span = piece.text.span;
    let (typed, value) = piece.text.assignment();
    let found = find(typed, card.keyword.parameter_names());
    let unknown = || unknown_parameter(card, typed, piece, found);
    let is_output = card.keyword.is_output;
    let name = known_word(found, unknown, "", (span, is_output), d)?;
    let known = card.keyword.parameter(name)?;
    let name = known.name;
    if card.params.iter().any(|param| param.name == name) {
        d.error(
            Code::RepeatedParameter,
            span,
            format!("{name} is given twice"),
        );
        return None;
    }
    let what = format!("{name} of {}", card.title());
    report(known.status, [&what, "is left out", known.text], span, d)?;
    if known.status != Status::Read {
        return None;
    }
    let mut param = Param {
        name: known.name,
        span,
        value: value.map(|value| (value.text.to_string(), value.span)),
        choice: None,
        faulty: false,
        used: Cell::new(false),
    };
    check_value(known, is_output, &mut param, d);
    Some(param)
}

/// Reports a parameter or a value that is left out or refused; returns `None` if the parameter or value is refused. The
/// three texts say what the object is, what the program does with it, and why.
fn report(
    status: Status,
    [what, treated, why]: [&str; 3],
    span: Span,
    d: &mut Diagnostics,
) -> Option<()> {
    match status {
        Status::Read | Status::Ignored => {}
        Status::Warned => {
            let message = format!("{what} {treated}");
            d.warning_once(Code::IgnoredParameter, span, message)
                .help(why);
        }
        Status::Refused => {
            let message = format!("{what} cannot be used");
            d.error(Code::UnsupportedParameter, span, message).help(why);
            return None;
        }
    }
    Some(())
}

fn unknown_parameter(card: &Card, typed: &str, piece: &Piece, found: Match) -> Diagnostic {
    let title = card.title();
    let meant = match found {
        Match::Unknown(meant) => meant,
        _ => None,
    };
    let names: Vec<&str> = card.keyword.parameter_names().collect();
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

/// Checks that a value is given where the parameter needs a value, and that the value is an allowed word.
fn check_value(known: &Parameter, is_output: bool, param: &mut Param, d: &mut Diagnostics) {
    let name = known.name;
    let typed = param.value.as_ref().filter(|(value, _)| !value.is_empty());
    let complaint = match (known.takes, typed) {
        (Takes::Nothing, _) if param.value.is_some() => format!("{name} takes no value"),
        (Takes::Value | Takes::Choice(_), None) => format!("{name} needs a value"),
        _ => String::new(),
    };
    if !complaint.is_empty() {
        let fault = Diagnostic::error(Code::BadValue, param.span, complaint);
        d.push(if is_output { left_out(fault) } else { fault });
        param.faulty = true;
    } else if let (Some((typed, span)), false) = (typed, known.values().is_empty()) {
        param.choice = choose(known, typed, (*span, is_output), d);
        param.faulty = param.choice.is_none();
    }
}

/// The full word of a typed value; `None` if the value is unknown or refused.
fn choose(
    known: &Parameter,
    typed: &str,
    (span, is_output): (Span, bool),
    d: &mut Diagnostics,
) -> Option<&'static str> {
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
    let name = known_word(found, unknown, "", (span, is_output), d)?;
    let value = known.values().iter().find(|value| value.name == name)?;
    let what = format!("{}={name}", known.name);
    report(
        value.status,
        [&what, "is not taken as written", value.text],
        span,
        d,
    )?;
    Some(value.name)
}
