//! Names of a deck: where each name is defined and used. Names are resolved as in the reader: in a part, a name means an
//! object of the part, or else of the whole deck; outside a part, the name of the instance stands before the name.

use super::cards::{Card, Cards, Instance, Scope, fields_of, is_first_row, key, spot};
use super::document::{Document, Spot};
use super::files::Files;
use crate::deck::{Kind, Name, Quantity, Status, Text};
use crate::diagnostics::Span;
use std::collections::HashSet;
use std::sync::Arc;

/// The constant `pi` of expressions, which is not a parameter.
const PI: &str = "pi";

/// Kind of the object that a name means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum What {
    /// An object of the given kind.
    Thing(Kind),
    /// A parameter of `*PARAMETER`.
    Parameter,
}

impl What {
    /// Words for the kind of object.
    pub fn name(self) -> &'static str {
        match self {
            What::Thing(kind) => kind.name(),
            What::Parameter => "parameter",
        }
    }
}

/// An object that has a name.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Symbol {
    /// Kind of the object.
    pub what: What,
    /// Scope to which the object belongs.
    pub scope: Scope,
    /// Key by which the name is compared.
    pub key: Arc<str>,
}

/// A place where a name stands.
#[derive(Debug, Clone)]
pub(super) struct Occurrence {
    /// Number of the file in the deck.
    pub file: usize,
    /// Place of the name, without quotation marks and without the name of its instance.
    pub spot: Spot,
    /// The name as typed at the place.
    pub typed: String,
    /// The object that the name means.
    pub symbol: Symbol,
    /// Whether the place defines the name.
    pub defines: bool,
    /// Whether the name is defined anywhere.
    pub is_known: bool,
    /// Whether the name stands between quotation marks at the place.
    pub is_quoted: bool,
}

/// A name that is to be looked up.
struct Use {
    file: usize,
    spot: Spot,
    typed: String,
    what: What,
    scope: Scope,
}

/// All names of a deck.
#[derive(Debug, Clone, Default)]
pub(super) struct Symbols {
    /// Occurrences of names, sorted by file and place.
    pub all: Vec<Occurrence>,
}

impl Symbols {
    /// Finds the names in the cards of a deck.
    pub fn new(cards: &Cards, files: &Files) -> Symbols {
        let mut collector = Collector {
            instances: &cards.instances,
            defined: HashSet::new(),
            all: Vec::new(),
            uses: Vec::new(),
        };
        for card in &cards.all {
            collector.head(card);
            for &(file, line) in &card.rows {
                let path = cards.files.get(file).map(|file| &file.path);
                if let Some(file_of) = path.and_then(|path| files.get(path)) {
                    collector.row(card, file, line, &file_of.document);
                }
            }
        }
        for one in std::mem::take(&mut collector.uses) {
            collector.resolve(one);
        }
        let mut all = collector.all;
        all.sort_by_key(|one| (one.file, one.spot));
        Symbols { all }
    }

    /// The name at a character of a file.
    pub fn at(&self, file: usize, line: usize, column: usize) -> Option<&Occurrence> {
        let here = self.of_line(file, line).iter();
        let mut here = here.filter(|one| (one.spot.start..=one.spot.end).contains(&column));
        here.next()
    }

    /// The names in a line.
    fn of_line(&self, file: usize, line: usize) -> &[Occurrence] {
        let place = |one: &Occurrence| (one.file, one.spot.line);
        let start = self.all.partition_point(|one| place(one) < (file, line));
        let end = self.all.partition_point(|one| place(one) <= (file, line));
        self.all.get(start..end).unwrap_or_default()
    }

    /// All places of a symbol.
    pub fn of(&self, symbol: &Symbol) -> impl Iterator<Item = &Occurrence> {
        self.all.iter().filter(move |one| one.symbol == *symbol)
    }

    /// The first definition of each symbol.
    pub fn defined(&self) -> impl Iterator<Item = &Occurrence> {
        let mut known = HashSet::new();
        let definitions = self.all.iter().filter(|one| one.defines);
        definitions.filter(move |one| known.insert(&one.symbol))
    }
}

struct Collector<'c> {
    instances: &'c [Instance],
    defined: HashSet<Symbol>,
    all: Vec<Occurrence>,
    uses: Vec<Use>,
}

impl Collector<'_> {
    fn head(&mut self, card: &Card) {
        for piece in &card.head.pieces {
            let Some((text, place)) = &piece.value else {
                continue;
            };
            self.parameters_in(card.file, *place, text);
            let Some(parameter) = piece.parameter else {
                continue;
            };
            if text.contains('<') || parameter.status == Status::Refused {
                continue;
            }
            match parameter.holds {
                Quantity::New(kind) => self.define(What::Thing(kind), card, *place, text),
                Quantity::Name(kind) | Quantity::OrName(_, kind) => self.uses.push(Use {
                    file: card.file,
                    spot: *place,
                    typed: text.clone(),
                    what: What::Thing(kind),
                    scope: card.scope.clone(),
                }),
                _ => {}
            }
        }
    }

    fn row(&mut self, card: &Card, file: usize, line: usize, document: &Document) {
        let text = document.line(line);
        if card.head.name() == "PARAMETER" {
            self.expression(card, file, line, &text);
            return;
        }
        if card.head.data().forms().is_empty() {
            return;
        }
        let scope = match card.head.piece("INSTANCE").and_then(|p| p.value.as_ref()) {
            Some((name, _)) => Scope::Instance(key(name)),
            None => card.scope.clone(),
        };
        let is_first = is_first_row(document, card, line);
        for (field, known) in fields_of(card, &text, is_first) {
            let place = spot(line, field);
            if field.text.contains('<') {
                self.parameters_in(file, place, field.text);
                continue;
            }
            let kind = known.and_then(|known| known.holds.kind());
            let one = Use {
                file,
                spot: place,
                typed: field.text.to_owned(),
                what: What::Thing(kind.unwrap_or(Kind::Instance)),
                scope: scope.clone(),
            };
            // a number may have the name of its instance before it
            let is_use = match kind {
                Some(_) => !field.is_empty(),
                None => is_numbered(field.text) && !self.split(&one).is_empty(),
            };
            if is_use {
                self.uses.push(one);
            }
        }
    }

    /// Reads a row `name = expression # note` of a parameter.
    fn expression(&mut self, card: &Card, file: usize, line: usize, text: &str) {
        let said = text.split('#').next().unwrap_or_default();
        let Some((left, right)) = said.split_once('=') else {
            return;
        };
        let name = left.trim();
        let start = left.chars().take_while(|c| c.is_whitespace()).count();
        let place = Spot {
            line,
            start,
            end: start + name.chars().count(),
        };
        let of_file = Card {
            file,
            rows: Vec::new(),
            ..card.clone()
        };
        self.define(What::Parameter, &of_file, place, name);
        let before = left.chars().count() + 1;
        for (at, word) in words(right) {
            let spot = Spot {
                line,
                start: before + at,
                end: before + at + word.chars().count(),
            };
            self.use_parameter(file, spot, &word);
        }
    }

    /// The parameters `<name>` of a text.
    fn parameters_in(&mut self, file: usize, place: Spot, text: &str) {
        let mut rest = text;
        let mut column = place.start;
        while let Some((before, behind)) = rest.split_once('<') {
            let Some((name, after)) = behind.split_once('>') else {
                return;
            };
            let start = column + before.chars().count() + 1;
            let end = start + name.chars().count();
            let spot = Spot {
                line: place.line,
                start,
                end,
            };
            self.use_parameter(file, spot, name);
            (rest, column) = (after, end + 1);
        }
    }

    fn use_parameter(&mut self, file: usize, spot: Spot, name: &str) {
        self.uses.push(Use {
            file,
            spot,
            typed: name.to_owned(),
            what: What::Parameter,
            scope: Scope::Deck,
        });
    }

    fn define(&mut self, what: What, card: &Card, place: Spot, text: &str) {
        let (spot, typed, is_quoted) = unquoted(place, text);
        if typed.is_empty() {
            return;
        }
        let symbol = Symbol {
            what,
            scope: card.scope.clone(),
            key: key_of(what, text),
        };
        self.defined.insert(symbol.clone());
        self.all.push(Occurrence {
            file: card.file,
            spot,
            typed,
            symbol,
            defines: true,
            is_known: true,
            is_quoted,
        });
    }

    fn resolve(&mut self, one: Use) {
        let kind = match one.what {
            What::Parameter => None,
            What::Thing(kind) => Some(kind),
        };
        let whole = key_of(one.what, &one.typed);
        let scopes = match kind {
            Some(Kind::Instance | Kind::Part | Kind::Step) | None => vec![Scope::Deck],
            Some(_) => self.scopes(&one.scope),
        };
        let symbol = |scope: Scope, key: Arc<str>| Symbol {
            what: one.what,
            scope,
            key,
        };
        let own = scopes
            .into_iter()
            .map(|scope| symbol(scope, Arc::clone(&whole)));
        let found = own.into_iter().find(|symbol| self.defined.contains(symbol));
        if let Some(symbol) = found {
            self.push(&one, one.spot, &one.typed, symbol, true);
            return;
        }
        let splits = kind.map(|_| self.split(&one)).unwrap_or_default();
        let mut outer = None;
        for split in &splits {
            let instance = Symbol {
                what: What::Thing(Kind::Instance),
                scope: Scope::Deck,
                key: Arc::clone(&split.instance),
            };
            let inside = self.scopes(&Scope::Instance(Arc::clone(&split.instance)));
            let inside = inside.into_iter().filter(|scope| *scope != Scope::Deck);
            let found = inside
                .map(|scope| symbol(scope, Arc::clone(&split.own)))
                .find(|symbol| self.defined.contains(symbol));
            outer.get_or_insert((instance, split, found.clone()));
            if found.is_some() {
                outer = outer.map(|(instance, ..)| (instance, split, found));
                break;
            }
        }
        if let Some((instance, split, found)) = outer {
            self.push(&one, split.before, &split.typed_before, instance, true);
            let is_known = found.is_some();
            let in_instance = Scope::Instance(Arc::clone(&split.instance));
            let meant = found.unwrap_or_else(|| symbol(in_instance, Arc::clone(&split.own)));
            if !is_number(&split.typed_own) {
                self.push(&one, split.behind, &split.typed_own, meant, is_known);
            }
        } else if !is_number(&one.typed) && !one.typed.is_empty() {
            let (unknown, spot) = (symbol(Scope::Deck, whole), one.spot);
            self.push(&one, spot, &one.typed, unknown, false);
        }
    }

    fn push(&mut self, one: &Use, spot: Spot, typed: &str, symbol: Symbol, is_known: bool) {
        let (spot, typed, is_quoted) = unquoted(spot, typed);
        self.all.push(Occurrence {
            file: one.file,
            spot,
            typed,
            symbol,
            defines: false,
            is_known,
            is_quoted,
        });
    }

    /// The scopes in which a name in `scope` is looked up, the nearest scope first.
    fn scopes(&self, scope: &Scope) -> Vec<Scope> {
        let mut all = match scope {
            Scope::Deck => Vec::new(),
            own => vec![own.clone()],
        };
        if let Scope::Instance(instance) = scope {
            let is_meant = |known: &&Instance| *known.name.key == **instance;
            let known = self.instances.iter().find(is_meant);
            all.extend(known.map(|known| Scope::Part(Arc::clone(&known.part))));
        }
        all.push(Scope::Deck);
        all
    }

    /// All ways to split a name into the name of an instance and the name behind its dot.
    fn split(&self, one: &Use) -> Vec<Split> {
        let is_whole = one.typed.len() > 1
            && one.typed.starts_with('"')
            && one.typed.ends_with('"')
            && one.typed.matches('"').count() == 2;
        let (place, text, _) = match is_whole {
            true => unquoted(one.spot, &one.typed),
            false => (one.spot, one.typed.clone(), false),
        };
        let mut is_inside = false;
        let mut found = Vec::new();
        for (column, (at, c)) in text.char_indices().enumerate() {
            is_inside ^= c == '"';
            if c != '.' || is_inside {
                continue;
            }
            let (before, behind) = (&text[..at], &text[at + 1..]);
            let before_key = key(before);
            let is_meant = |known: &&Instance| {
                *known.name.key == *before_key || (is_whole && known.name.typed == before)
            };
            let Some(instance) = self.instances.iter().find(is_meant) else {
                continue;
            };
            let dot = place.start + column;
            found.push(Split {
                instance: instance.name.key.as_str().into(),
                before: Spot { end: dot, ..place },
                typed_before: before.to_owned(),
                own: match is_whole {
                    true => Name::plain(behind).key.into(),
                    false => key(behind),
                },
                behind: Spot {
                    start: dot + 1,
                    ..place
                },
                typed_own: behind.to_owned(),
            });
        }
        found
    }
}

/// A name, split into the name of its instance and its own name.
struct Split {
    instance: Arc<str>,
    before: Spot,
    typed_before: String,
    own: Arc<str>,
    behind: Spot,
    typed_own: String,
}

/// A text without its quotation marks, the place of the text, and whether it had quotation marks.
fn unquoted(spot: Spot, text: &str) -> (Spot, String, bool) {
    let inner = text
        .strip_prefix('"')
        .and_then(|text| text.strip_suffix('"'));
    match inner.filter(|inner| !inner.contains('"')) {
        Some(inner) => {
            let spot = Spot {
                start: spot.start + 1,
                end: spot.end - 1,
                ..spot
            };
            (spot, inner.to_owned(), true)
        }
        None => (spot, text.to_owned(), false),
    }
}

/// Key of a name; the names of parameters are compared letter by letter.
fn key_of(what: What, text: &str) -> Arc<str> {
    match what {
        What::Thing(_) => key(text),
        What::Parameter => text.into(),
    }
}

/// Whether a text ends with a dot and a number.
fn is_numbered(text: &str) -> bool {
    let parts = text.rsplit_once('.');
    let is_digits = |number: &str| number.bytes().all(|byte| byte.is_ascii_digit());
    parts.is_some_and(|(_, number)| !number.is_empty() && is_digits(number))
}

fn is_number(text: &str) -> bool {
    let span = Span::default();
    let text = Text { text, span };
    text.as_integer().is_some() || text.as_real().is_some()
}

/// Names of parameters in an expression, each with the number of its first character.
fn words(expression: &str) -> Vec<(usize, String)> {
    let characters: Vec<char> = expression.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(&c) = characters.get(at) {
        if c == '\'' || c == '"' {
            let rest = characters.iter().skip(at + 1);
            at += 2 + rest.take_while(|other| **other != c).count();
        } else if c.is_alphabetic() || c == '_' {
            let rest = characters.iter().skip(at);
            let word: String = rest
                .take_while(|c| c.is_alphanumeric() || **c == '_')
                .collect();
            let end = at + word.chars().count();
            let mut behind = characters
                .iter()
                .skip(end)
                .skip_while(|c| c.is_whitespace());
            if word != PI && behind.next() != Some(&'(') {
                found.push((at, word));
            }
            at = end;
        } else if c.is_ascii_digit() || c == '.' {
            // the exponent belongs to its number
            let rest = characters.iter().skip(at);
            at += rest
                .take_while(|c| c.is_alphanumeric() || **c == '.')
                .count()
                .max(1);
        } else {
            at += 1;
        }
    }
    found
}
