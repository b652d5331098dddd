//! State that all functions of the reader share: the deck and the diagnostics. An undefined name is reported with a
//! suggestion from the names of all kinds of objects of the deck.

use super::label::{instance_of, label, number_of};
use crate::deck::{Card, Deck, Line, Name, Placement, Text};
use crate::diagnostics::{Added, Code, Diagnostic, Diagnostics, Span, closest, list_of};
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// Context of every reader function: the deck as a whole, and the list of messages.
pub(super) struct Context<'a> {
    /// All cards.
    pub deck: &'a Deck,
    /// Messages so far.
    pub d: &'a mut Diagnostics,
    /// Names of the deck with their kinds, collected when the first name is not found.
    catalogue: OnceCell<Catalogue>,
}

impl<'a> Context<'a> {
    /// A deck and its messages.
    pub fn new(deck: &'a Deck, d: &'a mut Diagnostics) -> Context<'a> {
        Context {
            deck,
            d,
            catalogue: OnceCell::new(),
        }
    }

    /// Adds an error.
    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) -> Added<'_> {
        self.d.error(code, span, message)
    }

    /// Adds a warning.
    pub fn warning(&mut self, code: Code, span: Span, message: impl Into<String>) -> Added<'_> {
        self.d.warning(code, span, message)
    }

    /// Whether cards may be missing because of a reported error.
    pub fn may_lack_cards(&self) -> bool {
        self.deck.incomplete || self.deck.dropped
    }

    /// The result of reading a card; `None` if an error of the card or of its reading has been reported.
    pub fn sound<T>(
        &mut self,
        card: &Card,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        let errors = self.errors();
        let read = read(self);
        read.filter(|_| !card.faulty && self.errors() == errors)
    }

    /// Stops the reading if the reading has been cancelled.
    pub fn go_on(&self) {
        self.deck.interrupt.end_if_asked();
    }

    /// Number of errors so far.
    pub fn errors(&self) -> usize {
        self.d.errors_found()
    }

    /// Place of a point of a part in the instance of a row (length).
    pub fn placed(&self, at: [f64; 2], row: Line) -> [f64; 2] {
        let placement = self.placement_of(row);
        placement.map_or(at, |placement| placement.of(at))
    }

    /// Direction of a part, turned into the instance of a row; its length stays the same.
    pub fn turned(&self, direction: [f64; 2], row: Line) -> [f64; 2] {
        let placement = self.placement_of(row);
        placement.map_or(direction, |placement| placement.turn(direction))
    }

    fn placement_of(&self, row: Line) -> Option<&Placement> {
        let index = (row.instance as usize).checked_sub(1)?;
        Some(&self.deck.instances.get(index)?.placement)
    }

    /// Name of an object of a part in the form in which other cards call the object: `Instance.name`.
    pub fn of_instance(&self, name: Name, span: Span) -> Name {
        match self.deck.instance_of(span) {
            Some(instance) => instance.name.joined(&name),
            None => name,
        }
    }

    /// Key of a name that a card defines; a name of a part gets the name of its instance in front.
    pub fn key_of(&self, text: Text) -> String {
        match self.deck.instance_of(text.span) {
            Some(instance) => format!("{}.{}", instance.name.key, text.name_key()),
            None => text.name_key(),
        }
    }

    /// Keys of the objects that a name may mean at its place: first objects of the instance there, then objects of the
    /// assembly and of the model. In `"instance.name"`, with one pair of quotation marks, each of the two names may be
    /// defined without such marks.
    pub fn keys_of(&self, text: Text) -> [String; 3] {
        let key = text.name_key();
        let of_instance = self.deck.instances.iter().find_map(|instance| {
            let (name, own) = key.split_at_checked(instance.name.key.len())?;
            let own = own.strip_prefix('.')?;
            let is_meant = Text { text: name, ..text }.name_key() == instance.name.key
                || name == instance.name.typed;
            is_meant.then(|| format!("{}.{}", instance.name.key, Name::plain(own).key))
        });
        let last = of_instance.unwrap_or_else(|| key.clone());
        [self.key_of(text), key, last]
    }

    /// A number such as `Block-1.12`, with the name of an instance before it, as the number alone, marked as a number
    /// of that instance.
    pub fn in_instance<'t>(&self, text: Text<'t>) -> Text<'t> {
        if self.deck.instances.is_empty() {
            return text;
        }
        let parts = text.text.rsplit_once('.');
        let numbered = parts.filter(|(_, n)| n.bytes().all(|byte| byte.is_ascii_digit()));
        let found = numbered.and_then(|(name, number)| {
            let name = Text { text: name, ..text };
            Some((self.deck.instance(&name.name_key())?, number))
        });
        match found {
            Some((instance, text_of_number)) => Text {
                text: text_of_number,
                span: Span {
                    instance,
                    ..text.span
                },
            },
            None => text,
        }
    }

    /// Whether a text is a number, with or without the name of an instance before it.
    pub fn is_number(&self, text: Text) -> bool {
        self.in_instance(text).as_integer().is_some()
    }

    /// The label of a number, or `None` without a report if the text is not a number.
    pub fn as_label(&self, text: Text) -> Option<u64> {
        let text = self.in_instance(text);
        let number = u64::try_from(text.as_integer()?).ok()?;
        Some(label(text.span.instance, number))
    }

    /// Whether a row of a keyword, such as `*NODE`, begins with a given label.
    pub fn defines(&self, keyword: &str, label: u64) -> bool {
        let cards = self.deck.cards_of(keyword);
        let rows = cards.flat_map(|card| card.rows.iter());
        let mut labels = rows.filter_map(|row| self.as_label(row.get(0)?));
        labels.any(|known| known == label)
    }

    /// Name of the node or element with a given label in the words of the deck.
    pub fn named(&self, label: u64) -> String {
        let index = (instance_of(label) as usize).checked_sub(1);
        let instance = index.and_then(|index| self.deck.instances.get(index));
        match instance {
            Some(instance) => format!("{}.{}", instance.name, number_of(label)),
            None => label.to_string(),
        }
    }

    /// Reports an undefined name of an object of kind `what`, unless a reported error may be the cause.
    pub fn undefined<'n>(
        &mut self,
        what: &str,
        name: Text,
        known: impl Iterator<Item = &'n str> + Clone,
    ) {
        let suspects = &self.deck.suspects;
        if self.deck.incomplete || suspects.contains(&name.name_key()) {
            return;
        }
        let message = format!("{what} {} is not defined", name.text);
        let error = Diagnostic::error(Code::UndefinedName, name.span, message);
        // The search for a suggestion takes time: for shown errors only.
        let error = match self.d.may_show(&error) {
            true => self.with_what_is_meant(error, what, name, known),
            false => error,
        };
        self.d.push(error);
    }

    /// Adds a suggestion to the error of an undefined name: an object of another kind with this name, a missing comma,
    /// a similar name of this kind or of another kind, or else the list of defined names.
    fn with_what_is_meant<'n>(
        &self,
        error: Diagnostic,
        what: &str,
        name: Text,
        known: impl Iterator<Item = &'n str> + Clone,
    ) -> Diagnostic {
        let catalogue = self.catalogue.get_or_init(|| Catalogue::new(self.deck));
        let way = |kind, name: &str| {
            let way = help_for(what, kind, name).map(|way| way + "; ");
            way.unwrap_or_default() + &list_of(what, known.clone())
        };
        let key = name.name_key();
        if let Some(kind) = catalogue.other_kind(&key, what) {
            let label = format!("{} is {}", name.text, with_article(kind));
            return error.label(label).help(way(kind, name.text));
        }
        if let Some(cut) = name_before_blank(name, known.clone()) {
            return error.label(format!("is a comma missing after {cut}?"));
        }
        if let Some(meant) = closest(name.text, known.clone()) {
            return error.suggest(Some(meant));
        }
        match catalogue.meant(&key, what) {
            Some((meant, kind)) => error
                .suggest(Some(format!("the {kind} {meant}")))
                .help(way(kind, meant)),
            None => error.help(list_of(what, known)),
        }
    }

    /// Reports a second card of a keyword that may appear only once.
    pub fn only_once(&mut self, cards: &[&Card]) {
        for card in cards.iter().skip(1) {
            let message = format!("{} appears a second time here", card.title());
            self.error(Code::RepeatedCard, card.span, message);
        }
    }
}

/// The known name, or the number, that stands before the first blank of a text.
fn name_before_blank<'t, 'n>(
    name: Text<'t>,
    mut known: impl Iterator<Item = &'n str>,
) -> Option<&'t str> {
    let (before, _) = name.text.split_once(char::is_whitespace)?;
    let is_number = before.bytes().all(|byte| byte.is_ascii_digit());
    let is_known = known.any(|known| known.eq_ignore_ascii_case(before));
    (is_number || is_known).then_some(before)
}

/// Keys of the names of a deck, with the kinds of objects that have them.
pub(super) struct Catalogue {
    kinds: BTreeMap<String, Vec<&'static str>>,
}

impl Catalogue {
    /// Collects the names that the cards of a deck define.
    pub fn new(deck: &Deck) -> Catalogue {
        let mut kinds: BTreeMap<String, Vec<&'static str>> = BTreeMap::new();
        for (name, kind) in deck.cards.iter().flat_map(|card| definitions(card, deck)) {
            let of_name = kinds.entry(name).or_default();
            if !of_name.contains(&kind) {
                of_name.push(kind);
            }
        }
        Catalogue { kinds }
    }

    /// A kind other than `kind` among the objects with a given key.
    pub fn other_kind(&self, name: &str, kind: &str) -> Option<&'static str> {
        let kinds = self.kinds.get(name)?;
        kinds.iter().copied().find(|other| *other != kind)
    }

    /// An object of a kind other than `kind` that a misspelt key probably means, and its kind.
    pub fn meant(&self, name: &str, kind: &str) -> Option<(&str, &'static str)> {
        let others = self
            .kinds
            .iter()
            .filter(|(_, kinds)| !kinds.contains(&kind));
        let meant = closest(name, others.map(|(key, _)| key.as_str()))?;
        Some((meant, self.other_kind(meant, kind)?))
    }
}

/// Key and kind of the object that a card defines.
fn definitions(card: &Card, deck: &Deck) -> Option<(String, &'static str)> {
    let (parameter, kind) = card.keyword.definition()?;
    let key = card.value(parameter.name)?.name_key();
    let key = match deck.instance_of(card.span) {
        Some(instance) => format!("{}.{key}", instance.name.key),
        None => key,
    };
    Some((key, kind.name()))
}

/// A kind of object with its article.
pub(super) fn with_article(kind: &str) -> String {
    let article = if kind.starts_with(['a', 'e']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {kind}")
}

/// Help where an object of kind `wanted` is needed, and `name` is an object of kind `found`.
pub(super) fn help_for(wanted: &str, found: &str, name: &str) -> Option<String> {
    match (wanted, found) {
        ("node set", "element set") => Some(format!(
            "*NSET, NSET=..., ELSET={name} makes a node set of its nodes"
        )),
        ("surface", "element set") => Some(format!(
            "*SURFACE, NAME=... with the row `{name}` makes a surface of its free faces"
        )),
        ("surface", "node set") => Some(format!(
            "*SURFACE, NAME=..., TYPE=NODE with the row `{name}` makes a surface of its nodes"
        )),
        _ => None,
    }
}
