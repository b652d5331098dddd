//! Symbol tables of the reader: user-defined names, and node and element numbers, resolved to
//! indices. Names left undefined by a reported error are not reported again.

use super::context::Context;
use crate::deck::{Card, Name, Text};
use crate::diagnostics::{Code, Span};
use std::collections::{BTreeMap, HashMap};

/// The names of one kind of thing, numbered in the order of their definition.
pub(super) struct Names {
    what: &'static str,
    index: HashMap<String, Option<usize>>,
    typed: Vec<Name>,
    nameless: bool,
}

impl Names {
    /// No names yet of objects called `what`.
    pub fn new(what: &'static str) -> Names {
        Names {
            what,
            index: HashMap::new(),
            typed: Vec::new(),
            nameless: false,
        }
    }

    /// Names as first typed.
    pub fn typed(&self) -> impl Iterator<Item = &str> + Clone {
        self.typed.iter().map(|name| name.typed.as_str())
    }

    /// Number of a name, new or not.
    pub fn define(&mut self, name: Name) -> usize {
        let next = self.typed.len();
        match self.index.entry(name.key.clone()).or_insert(Some(next)) {
            Some(known) if *known != next => *known,
            entry => {
                *entry = Some(next);
                self.typed.push(name);
                next
            }
        }
    }

    /// Whether the name has a number.
    pub fn is_defined(&self, name: &Name) -> bool {
        matches!(self.index.get(&name.key), Some(Some(_)))
    }

    /// The name of a card that defines something, from its parameter `NAME`; reports a missing,
    /// bad or repeated one.
    pub fn new_name(&mut self, card: &Card, cx: &mut Context) -> Option<Name> {
        let text = card.required("NAME", cx.d);
        let name = text.and_then(|text| text.name(cx.d));
        let (Some(text), Some(name)) = (text, name) else {
            self.nameless = true;
            return None;
        };
        if self.is_defined(&name) {
            let message = format!("{} {name} is defined a second time", self.what);
            cx.error(Code::RepeatedName, text.span, message);
            return None;
        }
        Some(name)
    }

    /// Marks a name whose definition has a reported error.
    pub fn spoil(&mut self, name: &Name) {
        self.index.entry(name.key.clone()).or_insert(None);
    }

    /// Marks that some definition has no name, which is reported.
    pub fn spoil_unknown(&mut self) {
        self.nameless = true;
    }

    /// Number of a name; reports an undefined one.
    pub fn find(&self, text: Text, cx: &mut Context) -> Option<usize> {
        let name = text.name(cx.d)?;
        let found = self.index.get(&name.key);
        if found.is_none() && !self.nameless {
            cx.undefined(self.what, text, self.typed());
        }
        *found?
    }
}

/// Meaning of a node or element number of the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Labelled {
    /// The node or element of this index.
    Index(usize),
    /// One that is left out, which is reported.
    LeftOut,
}

impl Labelled {
    /// The index, unless it is left out.
    pub fn index(self) -> Option<usize> {
        match self {
            Labelled::Index(index) => Some(index),
            Labelled::LeftOut => None,
        }
    }
}

/// Largest node or element number: the largest that Abaqus reads. CalculiX keeps 32 bits, and the
/// numbers that are given to the points of rigid surfaces have to follow the largest one of the
/// deck.
const LARGEST_LABEL: i64 = 999_999_999;

/// Node or element numbers of the deck.
pub(super) struct Labels {
    what: &'static str,
    code: Code,
    index: BTreeMap<u64, Labelled>,
    /// Whether some could not be read, which is reported.
    pub incomplete: bool,
}

impl Labels {
    /// No numbers yet of objects called `what`.
    pub fn new(what: &'static str, code: Code) -> Labels {
        Labels {
            what,
            code,
            index: BTreeMap::new(),
            incomplete: false,
        }
    }

    /// Adds a number.
    pub fn insert(&mut self, label: u64, labelled: Labelled) {
        self.index.insert(label, labelled);
    }

    /// Meaning of a number.
    pub fn get(&self, label: u64) -> Option<Labelled> {
        self.index.get(&label).copied()
    }

    /// Index of the node or element with this number; reports one that does not exist.
    pub fn find(&self, text: Text, cx: &mut Context) -> Option<usize> {
        let label = self.number(text, cx)?;
        match self.get(label) {
            Some(Labelled::Index(index)) => Some(index),
            Some(Labelled::LeftOut) => None,
            None => {
                self.undefined(label, text.span, cx);
                None
            }
        }
    }

    /// The number in `text`, from 1 to the largest allowed.
    pub fn number(&self, text: Text, cx: &mut Context) -> Option<u64> {
        let value = text.integer(cx.d)?;
        let what = self.what;
        let fault = if value < 1 {
            format!("{what} numbers are positive, found {value}")
        } else if value > LARGEST_LABEL {
            format!("{what} numbers end at {LARGEST_LABEL}, found {value}")
        } else {
            return u64::try_from(value).ok();
        };
        cx.error(Code::BadNumber, text.span, fault);
        None
    }

    /// Reports a number that does not exist.
    pub fn undefined(&self, label: u64, span: Span, cx: &mut Context) {
        if !self.incomplete && !cx.deck.incomplete {
            let message = format!("{} {label} is not defined", self.what);
            cx.error(self.code, span, message);
        }
    }

    /// Numbers from `first` to `last` with their meaning, in order.
    pub fn between(&self, first: u64, last: u64) -> impl Iterator<Item = (u64, Labelled)> {
        let valid = first <= last;
        let range = if valid { first..=last } else { 0..=0 };
        self.index.range(range).map(|(&label, &l)| (label, l))
    }
}
