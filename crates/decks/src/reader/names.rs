//! Symbol tables of the reader: user-defined names, and node and element numbers, resolved to
//! indices. Names left undefined by a reported error are not reported again.

use super::context::Context;
use super::label::{LabelMap, instance_of, label};
use crate::deck::{Card, Name, Text};
use crate::diagnostics::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// The names of one kind of object, numbered in the order of definition.
pub(super) struct Names {
    what: &'static str,
    /// Whether parts may define names of this table, once for each of their instances.
    of_parts: bool,
    index: HashMap<String, Option<usize>>,
    typed: Vec<Name>,
    nameless: bool,
}

impl Names {
    /// An empty table of names for objects called `what`.
    pub fn new(what: &'static str) -> Names {
        Names {
            what,
            of_parts: false,
            index: HashMap::new(),
            typed: Vec::new(),
            nameless: false,
        }
    }

    /// An empty table of names for objects called `what` that parts may define: the name `Set` of a part is
    /// `Instance.Set` outside.
    pub fn of_parts(what: &'static str) -> Names {
        Names {
            of_parts: true,
            ..Names::new(what)
        }
    }

    /// The name that a card defines; an invalid name is reported.
    pub fn defined(&self, text: Text, cx: &mut Context) -> Option<Name> {
        let name = text.name(cx.d)?;
        Some(match self.of_parts {
            true => cx.of_instance(name, text.span),
            false => name,
        })
    }

    /// The names as they were first typed.
    pub fn typed(&self) -> impl Iterator<Item = &str> + Clone {
        self.typed.iter().map(|name| name.typed.as_str())
    }

    /// Number of a name; a new name gets the next number.
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

    /// Whether the name is defined without an error.
    pub fn is_defined(&self, name: &Name) -> bool {
        matches!(self.index.get(&name.key), Some(Some(_)))
    }

    /// The name of a card that defines something, from its parameter `NAME`; a missing, invalid or repeated name is
    /// reported.
    pub fn new_name(&mut self, card: &Card, cx: &mut Context) -> Option<Name> {
        let text = card.required("NAME", cx.d);
        let name = text.and_then(|text| self.defined(text, cx));
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

    /// Marks that the name of some definition is missing, after an error has been reported.
    pub fn spoil_unknown(&mut self) {
        self.nameless = true;
    }

    /// Number of a name; an undefined name is reported.
    pub fn find(&self, text: Text, cx: &mut Context) -> Option<usize> {
        let name = text.name(cx.d)?;
        let local = self.defined(text, cx)?;
        let found = self.known(text, cx);
        if found.is_none() && !self.nameless {
            let prefix = local.typed.strip_suffix(&name.typed).unwrap_or_default();
            let known = self.typed();
            let known = known.map(|known| known.strip_prefix(prefix).unwrap_or(known));
            cx.undefined(self.what, text, known);
        }
        found?
    }

    /// Number of the object that a name means at its place; `Some(None)` if the definition of the name has an error,
    /// `None` if the name is undefined.
    fn known(&self, text: Text, cx: &Context) -> Option<Option<usize>> {
        let keys = match self.of_parts {
            true => cx.keys_of(text),
            false => [text.name_key(), String::new(), String::new()],
        };
        keys.iter().find_map(|key| self.index.get(key)).copied()
    }

    /// Full name of the object that a name means at its place, valid in the whole deck.
    pub fn full_name(&self, text: Text, cx: &Context) -> String {
        let found = self.known(text, cx).flatten();
        let found = found.and_then(|index| self.typed.get(index));
        found.map_or_else(|| text.text.to_owned(), |name| name.typed.clone())
    }
}

/// Objects of one kind with their names.
pub(super) struct Named<T> {
    /// Names of the objects.
    pub names: Names,
    /// The objects in the order of their names.
    pub all: Vec<T>,
}

impl<T> Named<T> {
    /// An empty list of objects called `what`.
    pub fn new(what: &'static str) -> Named<T> {
        Named {
            names: Names::new(what),
            all: Vec::new(),
        }
    }

    /// Adds the object that `read` makes of a card, under the name in the parameter `NAME`; if `read` returns `None`,
    /// the name is marked as faulty.
    pub fn add(
        &mut self,
        card: &Card,
        cx: &mut Context,
        read: impl FnOnce(&Name, &mut Context) -> Option<T>,
    ) {
        let Some(name) = self.names.new_name(card, cx) else {
            return;
        };
        match read(&name, cx) {
            Some(thing) => {
                self.all.push(thing);
                self.names.define(name);
            }
            None => self.names.spoil(&name),
        }
    }

    /// The object with a given name; an undefined name is reported.
    pub fn find(&self, name: Text, cx: &mut Context) -> Option<&T> {
        self.all.get(self.names.find(name, cx)?)
    }
}

/// Meaning of a node or element number of the deck: an index, or a node or element that is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Labelled(u32);

impl Labelled {
    /// A node or element that is left out, after a message about it.
    pub const LEFT_OUT: Labelled = Labelled(u32::MAX);

    /// The node or element has this index.
    pub fn new(index: usize) -> Labelled {
        Labelled(index as u32)
    }

    /// The index of the node or element; `None` if the node or element is left out.
    pub fn index(self) -> Option<usize> {
        (self != Labelled::LEFT_OUT).then_some(self.0 as usize)
    }
}

/// Largest node or element number, which is also the largest that Abaqus reads. CalculiX keeps 32 bits of a number, and
/// the points of rigid surfaces get numbers after the largest number of the deck.
const LARGEST_LABEL: i64 = 999_999_999;

/// Node or element numbers of the deck, as labels.
pub(super) struct Labels {
    what: &'static str,
    code: Code,
    index: LabelMap<Labelled>,
    /// Whether some numbers could not be read (after reported errors).
    pub incomplete: bool,
}

impl Labels {
    /// An empty table of numbers of objects called `what`.
    pub fn new(what: &'static str, code: Code) -> Labels {
        Labels {
            what,
            code,
            index: LabelMap::default(),
            incomplete: false,
        }
    }

    /// Adds a number.
    pub fn insert(&mut self, label: u64, labelled: Labelled) {
        self.index.insert(label, labelled);
    }

    /// Makes room for `count` more numbers.
    pub fn reserve(&mut self, count: usize) {
        self.index.reserve(count);
    }

    /// Gives new indices; objects without a new index are left out from this call on.
    pub fn renumber(&mut self, numbers: &[Option<usize>]) {
        for labelled in self.index.values_mut() {
            let number = labelled.index().and_then(|index| numbers[index]);
            *labelled = number.map_or(Labelled::LEFT_OUT, Labelled::new);
        }
    }

    /// Meaning of a number of the deck.
    pub fn get(&self, label: u64) -> Option<Labelled> {
        self.index.get(label).copied()
    }

    /// Index of the node or element with a given number; a number that does not exist is reported.
    pub fn find(&self, text: Text, cx: &mut Context) -> Option<usize> {
        let label = self.label(text, cx)?;
        match self.get(label) {
            Some(labelled) => labelled.index(),
            None => {
                self.undefined(label, text.span, cx);
                None
            }
        }
    }

    /// The label of the number in `text`, which includes the instance.
    pub fn label(&self, text: Text, cx: &mut Context) -> Option<u64> {
        let text = cx.in_instance(text);
        let number = self.number(text, cx)?;
        Some(label(text.span.instance, number))
    }

    /// The label of a number in an instance, if the number lies between 1 and the largest allowed one.
    pub fn plain_label(&self, number: u64, instance: u32) -> Option<u64> {
        let allowed = 1..=LARGEST_LABEL as u64;
        allowed.contains(&number).then(|| label(instance, number))
    }

    /// The number in `text`, which must lie between 1 and the largest allowed one.
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

    /// Reports that the number of a label does not exist.
    pub fn undefined(&self, label: u64, span: Span, cx: &mut Context) {
        if self.incomplete || cx.deck.incomplete {
            return;
        }
        let message = format!("{} {} is not defined", self.what, cx.named(label));
        let error = Diagnostic::error(self.code, span, message);
        // The search for advice takes time: for shown errors only.
        let error = match cx.d.may_show(&error) {
            true => self.with_what_is_meant(error, label, cx),
            false => error,
        };
        cx.d.push(error);
    }

    /// Adds help to the error: another kind of object has the number, or numbers in instances are written otherwise.
    fn with_what_is_meant(&self, error: Diagnostic, label: u64, cx: &Context) -> Diagnostic {
        let (other, keyword, help) = match self.what {
            "node" => (
                "an element",
                "ELEMENT",
                "*NSET, NSET=..., ELSET=... makes a node set of the nodes of elements",
            ),
            _ => (
                "a node",
                "NODE",
                "nodes stand in *NSET, in *SURFACE with TYPE=NODE, and under *CLOAD",
            ),
        };
        if cx.defines(keyword, label) {
            let text = format!("{} is {other}", cx.named(label));
            return error.label(text).help(help);
        }
        let outside = instance_of(label) == 0;
        match cx.deck.instances.first().filter(|_| outside) {
            Some(instance) => error.help(format!(
                "a number in an instance has its name before it, such as {}.{label}",
                instance.name
            )),
            None => error,
        }
    }

    /// Labels from `first` to `last` with their meaning, in order.
    pub fn between(&self, first: u64, last: u64) -> impl Iterator<Item = (u64, Labelled)> {
        let found = self.index.between(first, last).into_iter();
        found.map(|(label, &labelled)| (label, labelled))
    }
}
