//! Cards from lines: keywords and parameters are looked up in the table here.

use super::lexer::{Line, assignment};
use super::word::{self, Match};
use super::{Card, Data, Keyword, Param, Parameter, Row, Scope, Status, Takes, Text, Value};
use super::{keyword, keywords};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Span};
use std::cell::Cell;
use std::collections::HashSet;

/// All cards of a deck.
#[derive(Debug, Clone, Default)]
pub struct Deck {
    /// Cards whose keyword is known, in order, included files in their place.
    pub cards: Vec<Card>,
    /// Whether something that is not read, and reported, could define anything: a missing file.
    pub incomplete: bool,
    /// Names, as compared, that left out cards may have defined.
    pub suspects: HashSet<String>,
}

impl Deck {
    /// Whether it is an assembly deck, which is reported.
    pub fn has_assembly(&self) -> bool {
        let mut scopes = self.cards.iter().map(|card| card.keyword.scope);
        scopes.any(|scope| scope == Scope::Assembly)
    }
}

/// A file that a keyword line asks for.
pub(super) struct Inclusion {
    /// Path as typed.
    pub path: String,
    /// Place of the path.
    pub span: Span,
    /// Whether it may hold data lines only.
    pub rows_only: bool,
}

/// A piece of a keyword line between commas.
pub(super) struct Piece<'a> {
    /// Its text and place.
    pub text: Text<'a>,
    /// Whether it stands on a continuation line.
    pub continued: bool,
}

/// What happens to data lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rows {
    /// No keyword yet.
    Stray,
    /// They belong to the last card.
    Keep,
    /// They are left out.
    Skip,
    /// The last card takes none.
    Refuse,
}

/// Collects the lines of a deck into cards.
pub(super) struct Collector {
    /// The cards so far.
    pub deck: Deck,
    rows: Rows,
}

impl Collector {
    /// No cards yet.
    pub fn new() -> Collector {
        Collector {
            deck: Deck::default(),
            rows: Rows::Stray,
        }
    }

    /// Adds a data line to the last card.
    pub fn data(&mut self, line: &Line, d: &mut Diagnostics) {
        let text_only = self
            .deck
            .cards
            .last()
            .is_some_and(|c| c.keyword.data == Data::Text);
        match self.rows {
            Rows::Skip => {}
            Rows::Keep if text_only => self.keep(Row::new(line, Vec::new())),
            Rows::Keep => self.keep(Row::new(line, line.fields(d))),
            Rows::Stray => self.refuse(line, "a data line before the first keyword".into(), d),
            Rows::Refuse => {
                let title = self.deck.cards.last().map(Card::title).unwrap_or_default();
                self.refuse(line, format!("{title} takes no data lines"), d);
            }
        }
    }

    /// Whether the next data line is free text or left out.
    pub fn in_free_text(&self) -> bool {
        let text = self
            .deck
            .cards
            .last()
            .is_some_and(|c| c.keyword.data == Data::Text);
        self.rows == Rows::Skip || (self.rows == Rows::Keep && text)
    }

    fn keep(&mut self, row: Row) {
        if let Some(card) = self.deck.cards.last_mut() {
            card.rows.push(row);
        }
    }

    fn refuse(&mut self, line: &Line, message: String, d: &mut Diagnostics) {
        d.push(Diagnostic::error(
            Code::StrayData,
            line.visible_span(),
            message,
        ));
        self.rows = Rows::Skip;
    }

    /// Adds a keyword line; returns the file it asks for.
    pub fn keyword(&mut self, pieces: &[Piece], d: &mut Diagnostics) -> Option<Inclusion> {
        let (first, rest) = pieces.split_first()?;
        let typed = first.text.text.trim_start_matches('*').trim();
        let Some(keyword) = resolve_keyword(typed, first.text.span, d) else {
            self.suspect(rest);
            self.rows = Rows::Skip;
            return None;
        };
        if keyword.status != Status::Read {
            self.suspect(rest);
            self.start(keyword, first.text.span, Rows::Skip);
            return None;
        }
        if keyword.name == "INCLUDE" {
            return self.inclusion(keyword, first, rest, d);
        }
        let rows = match keyword.data {
            Data::None => Rows::Refuse,
            Data::Rows | Data::Required | Data::Text => Rows::Keep,
        };
        self.start(keyword, first.text.span, rows);
        self.parameters(rest, d);
        self.input()
    }

    fn start(&mut self, keyword: &'static Keyword, span: Span, rows: Rows) {
        self.rows = rows;
        self.deck.cards.push(Card {
            keyword,
            span,
            faulty: false,
            rows: Vec::new(),
            params: Vec::new(),
        });
    }

    /// `*INCLUDE` is no card of its own: the lines of its file belong to the card before it.
    fn inclusion(
        &mut self,
        keyword: &'static Keyword,
        first: &Piece,
        rest: &[Piece],
        d: &mut Diagnostics,
    ) -> Option<Inclusion> {
        let rows = self.rows;
        self.start(keyword, first.text.span, rows);
        self.parameters(rest, d);
        let card = self.deck.cards.pop()?;
        let path = card.required("INPUT", d);
        self.deck.incomplete |= path.is_none();
        path.map(|path| inclusion(path, false))
    }

    /// The file that the last card takes its data lines from.
    fn input(&self) -> Option<Inclusion> {
        let path = self.deck.cards.last()?.value("INPUT")?;
        Some(inclusion(path, true))
    }

    /// Names on the line of a card that is left out.
    fn suspect(&mut self, pieces: &[Piece]) {
        for piece in pieces {
            if let Some((value, _)) = assignment(piece.text.text).value {
                let text = Text {
                    text: value,
                    span: piece.text.span,
                };
                self.deck.suspects.insert(text.name_key());
            }
        }
    }

    fn parameters(&mut self, pieces: &[Piece], d: &mut Diagnostics) {
        for piece in pieces.iter().filter(|piece| !piece.text.is_empty()) {
            let Some(card) = self.deck.cards.last_mut() else {
                return;
            };
            let errors = d.count(Severity::Error);
            let param = parameter(card, piece, d);
            card.faulty |= d.count(Severity::Error) > errors;
            match param {
                Some(param) => card.params.push(param),
                None => self.suspect(std::slice::from_ref(piece)),
            }
        }
    }
}

fn inclusion(path: Text, rows_only: bool) -> Inclusion {
    Inclusion {
        path: path.text.trim_matches('"').to_string(),
        span: path.span,
        rows_only,
    }
}

/// The keyword that is typed, or the one that is meant; reports what is not read.
fn resolve_keyword(typed: &str, span: Span, d: &mut Diagnostics) -> Option<&'static Keyword> {
    let found = match keyword::find(typed) {
        Some(keyword) => Some(keyword),
        None => {
            let known = word::find(typed, keywords().map(|keyword| keyword.name));
            known_word(known, || unknown_keyword(typed, span, known), "*", span, d)
                .and_then(keyword::find)
        }
    }?;
    report_keyword(found, span, d);
    Some(found)
}

/// Reports a word that is not typed in full; the word to go on with.
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

fn unknown_keyword(typed: &str, span: Span, found: Match) -> Diagnostic {
    let meant = match found {
        Match::Unknown(Some(name)) => Some(format!("*{name}")),
        _ => None,
    };
    let message = format!("unknown keyword *{typed}");
    Diagnostic::error(Code::UnknownKeyword, span, message)
        .suggest(meant)
        .help(
            "unknown keywords stop the run because ignoring one can change the answer; \
             --lenient turns this into a warning",
        )
}

fn report_keyword(keyword: &Keyword, span: Span, d: &mut Diagnostics) {
    let name = keyword.name;
    match keyword.status {
        Status::Read | Status::Ignored => {}
        Status::Warned => {
            let message = format!("*{name} is left out");
            d.push_once(
                Diagnostic::warning(Code::IgnoredKeyword, span, message).help(keyword.text),
            );
        }
        Status::Refused if keyword.scope == Scope::Assembly => {
            d.push_once(Diagnostic::error(
                Code::UnsupportedKeyword,
                span,
                keyword.text,
            ));
        }
        Status::Refused => {
            let message = format!("*{name} cannot be used");
            d.push(Diagnostic::error(Code::UnsupportedKeyword, span, message).help(keyword.text));
        }
    }
}

/// A parameter of `card`, checked against the table; `None` if it is left out.
fn parameter(card: &Card, piece: &Piece, d: &mut Diagnostics) -> Option<Param> {
    let span = piece.text.span;
    let typed = assignment(piece.text.text);
    let names = card.keyword.parameters.iter().map(|p| p.name);
    let found = word::find(typed.name.0, names);
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

/// `None` if the parameter is left out.
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

/// Checks that a value is there, or not, and one of those allowed.
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

/// The word among the values of a parameter; `None` if it cannot be used.
fn choose(known: &Parameter, typed: &str, span: Span, d: &mut Diagnostics) -> Option<&'static str> {
    let names = known.values().iter().map(|value| value.name);
    let found = word::find(typed, names.clone());
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
