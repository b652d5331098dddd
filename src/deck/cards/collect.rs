//! Collects the lines of a deck into cards; cards with a reported error are left out.

use super::card::Card;
use super::instance::Instance;
use super::resolve::{self, Piece};
use super::rows::Rows;
use crate::deck::keywords::{Data, Keyword, Status};
use crate::deck::lines::{Lines, Text, assignment};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Span};
use std::collections::HashSet;
use std::sync::Arc;

/// All cards of a deck.
#[derive(Debug, Clone, Default)]
pub struct Deck {
    /// Cards whose keyword is known, in order, included files in their place.
    pub cards: Vec<Card>,
    /// Whether a file is missing, which is reported: it might define any name.
    pub incomplete: bool,
    /// Whether a card is left out because of a reported error.
    pub dropped: bool,
    /// Keys of the names that the cards left out may define.
    pub suspects: HashSet<String>,
    /// Instances of parts; spans number them from 1.
    pub instances: Vec<Instance>,
}

impl Deck {
    /// The instance that a span belongs to.
    pub fn instance_of(&self, span: Span) -> Option<&Instance> {
        let index = (span.instance as usize).checked_sub(1)?;
        self.instances.get(index)
    }

    /// Number of the instance with this name.
    pub fn instance(&self, key: &str) -> Option<u32> {
        let mut all = self.instances.iter().zip(1..);
        let found = all.find(|(instance, _)| instance.name.key == key);
        found.map(|(_, number)| number)
    }
}

/// A file named on a keyword line.
pub(crate) struct Inclusion {
    /// Path as typed.
    pub path: String,
    /// Place of the path.
    pub span: Span,
    /// Whether it may hold data lines only.
    pub rows_only: bool,
}

/// The text of a file.
#[derive(Clone, Copy)]
pub(crate) struct FileText<'a> {
    /// The whole text.
    pub source: &'a Arc<String>,
    /// Whether it is [plain](crate::deck::lines::Content::is_plain).
    pub is_plain: bool,
}

/// What happens to data lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RowRule {
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
pub(crate) struct Collector {
    /// The cards so far.
    pub deck: Deck,
    rows: RowRule,
}

impl Collector {
    /// No cards yet.
    pub fn new() -> Collector {
        Collector {
            deck: Deck::default(),
            rows: RowRule::Stray,
        }
    }

    /// Adds data lines of a file to the last card.
    pub fn data(&mut self, lines: Lines, file: FileText, d: &mut Diagnostics) {
        match (self.rows, self.deck.cards.last_mut()) {
            (RowRule::Skip, _) => {}
            (RowRule::Keep, Some(card)) => {
                let may_hold_quotes = !file.is_plain && card.keyword.data != Data::Text;
                if may_hold_quotes && lines.text().contains('"') {
                    lines.data().for_each(|line| line.check_quotes(d));
                }
                let is_ascii = file.is_plain || lines.text().is_ascii();
                card.rows.add(lines, file.source, is_ascii);
            }
            (RowRule::Refuse, Some(card)) => {
                let message = format!("{} takes no data lines", card.title());
                self.refuse(lines, message, d);
            }
            (_, _) => self.refuse(lines, "a data line before the first keyword".into(), d),
        }
    }

    /// Whether the next data line is free text or left out.
    pub fn in_free_text(&self) -> bool {
        let text = self
            .deck
            .cards
            .last()
            .is_some_and(|c| c.keyword.data == Data::Text);
        self.rows == RowRule::Skip || (self.rows == RowRule::Keep && text)
    }

    /// Reports the first of the lines.
    fn refuse(&mut self, lines: Lines, message: String, d: &mut Diagnostics) {
        if let Some(line) = lines.data().next() {
            let span = line.visible_span();
            d.push(Diagnostic::error(Code::StrayData, span, message));
        }
        self.rows = RowRule::Skip;
    }

    /// Adds a keyword line; returns the file that it names.
    pub fn keyword(&mut self, pieces: &[Piece], d: &mut Diagnostics) -> Option<Inclusion> {
        let (first, rest) = pieces.split_first()?;
        let Some(keyword) = resolve::keyword(first.text, d) else {
            if !d.is_lenient() {
                self.drop_card(rest);
            }
            self.rows = RowRule::Skip;
            return None;
        };
        if keyword.status != Status::Read {
            if keyword.status == Status::Refused {
                self.drop_card(rest);
            }
            self.start(keyword, first.text.span, RowRule::Skip);
            return None;
        }
        if keyword.name == "INCLUDE" {
            return self.inclusion(keyword, first, rest, d);
        }
        let rows = match keyword.data {
            Data::None => RowRule::Refuse,
            Data::Rows(_) | Data::Required(_) | Data::Text => RowRule::Keep,
            Data::Words | Data::Skipped => RowRule::Skip,
        };
        self.start(keyword, first.text.span, rows);
        self.parameters(rest, d);
        self.input()
    }

    fn start(&mut self, keyword: &'static Keyword, span: Span, rows: RowRule) {
        self.rows = rows;
        self.deck.cards.push(Card {
            keyword,
            span,
            faulty: false,
            rows: Rows::default(),
            params: Vec::new(),
        });
    }

    /// The file of `*INCLUDE`, whose lines continue the card before it.
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

    /// Leaves out a card with a reported error, and the names that it defines.
    fn drop_card(&mut self, pieces: &[Piece]) {
        self.deck.dropped = true;
        self.suspect(pieces);
    }

    /// Records the names that a card with a reported error may define.
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
            let param = resolve::parameter(card, piece, d);
            let faulty = d.count(Severity::Error) > errors;
            card.faulty |= faulty;
            match param {
                Some(param) => card.params.push(param),
                None if faulty => self.suspect(std::slice::from_ref(piece)),
                None => {}
            }
            // numbers of a data line that a comma has drawn in: one message is enough
            if faulty && piece.continued && begins_as_a_number(piece.text) {
                return;
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

fn begins_as_a_number(text: Text) -> bool {
    let first = text.text.trim_start().chars().next();
    first.is_some_and(|c| c.is_ascii_digit() || "+-.".contains(c))
}
