//! The cards of all instances, in the place of the instance.

use super::placement;
use super::places::Place;
use super::structure::{Item, Part, Structure};
use crate::deck::cards::{Card, Deck, Instance};
use crate::deck::keywords::Scope;
use crate::deck::lines::{Name, Text};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Sources, Span, closest};

/// The deck with the cards of the parts in place of their instances.
pub(in crate::deck) fn flatten(deck: Deck, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let is_structure = |card: &Card| card.keyword.scope == Scope::Assembly;
    if !deck.cards.iter().any(is_structure) {
        return without_assembly(deck, d);
    }
    let errors = d.count(Severity::Error);
    let Structure {
        mut parts, items, ..
    } = Structure::new(deck.cards, d);
    let faulty = d.count(Severity::Error) > errors;
    let mut flat = Deck {
        cards: Vec::new(),
        incomplete: deck.incomplete || faulty,
        ..deck
    };
    let of_items = instances(&items, &mut parts, &mut flat, sources, d);
    for (item, of_item) in items.into_iter().zip(of_items) {
        match item {
            Item::Card(card, place) => {
                let card = scoped(card, place, &flat, d);
                flat.cards.push(card);
            }
            Item::Instance(_, own) => flat.cards.extend(of_item.cards(&mut parts, own)),
        }
    }
    flat.incomplete |= d.count(Severity::Error) > errors;
    report_unused(&parts, &flat, d);
    flat
}

/// Instance and part of an item; zero and none of other cards.
struct Copied {
    instance: u32,
    part: Option<usize>,
}

impl Copied {
    /// The cards of the part, followed by those of the instance itself.
    fn cards(&self, parts: &mut [Part], own: Vec<Card>) -> Vec<Card> {
        let part = self.part.and_then(|part| parts.get_mut(part));
        let of_part = part.map(|part| {
            part.wanted -= 1;
            match part.wanted {
                0 => std::mem::take(&mut part.cards),
                _ => part.cards.clone(),
            }
        });
        let all = of_part.unwrap_or_default().into_iter().chain(own);
        all.map(|card| card.in_instance(self.instance)).collect()
    }
}

/// Registers the instances with the deck and the sources.
fn instances(
    items: &[Item],
    parts: &mut [Part],
    flat: &mut Deck,
    sources: &mut Sources,
    d: &mut Diagnostics,
) -> Vec<Copied> {
    let mut all = Vec::new();
    for item in items {
        let (mut instance, mut part) = (0, None);
        if let Item::Instance(head, _) = item {
            part = part_of(head, parts, flat, d);
            if let Some(name) = instance_name(head, flat, d) {
                instance = sources.add_instance(&name.typed, head.span);
                let placement = placement::read(head, d);
                flat.instances.push(Instance { name, placement });
            }
        }
        // the cards of an instance without name would be those of the whole deck
        part = part.filter(|_| instance > 0);
        if let Some(part) = part.and_then(|part| parts.get_mut(part)) {
            part.wanted += 1;
        }
        all.push(Copied { instance, part });
    }
    all
}

/// The name of an instance; reports one that is missing or taken.
fn instance_name(head: &Card, flat: &Deck, d: &mut Diagnostics) -> Option<Name> {
    let text = head.required("NAME", d)?;
    let name = text.name(d)?;
    if flat.instance(&name.key).is_some() {
        let message = format!("instance {name} is defined a second time");
        d.push(Diagnostic::error(Code::RepeatedName, text.span, message));
        return None;
    }
    Some(name)
}

/// The part of an instance; reports one that is not defined.
fn part_of(head: &Card, parts: &[Part], flat: &Deck, d: &mut Diagnostics) -> Option<usize> {
    let text = head.required("PART", d)?;
    let key = text.name_key();
    let names = || parts.iter().filter_map(|part| part.name.as_ref());
    let found = parts
        .iter()
        .position(|part| part.name.as_ref().is_some_and(|name| name.key == key));
    if found.is_none() && !flat.incomplete && names().count() == parts.len() {
        undefined("part", text, names(), d);
    }
    found
}

fn undefined<'n>(
    what: &str,
    text: Text,
    names: impl Iterator<Item = &'n Name> + Clone,
    d: &mut Diagnostics,
) {
    let message = format!("{what} {} is not defined", text.text);
    let error = Diagnostic::error(Code::UndefinedName, text.span, message);
    let meant = closest(text.text, names.clone().map(|name| name.typed.as_str()));
    d.push(match (meant, names.clone().next()) {
        (Some(meant), _) => error.suggest(Some(meant)),
        (None, None) => error.help(format!("the deck has no {what}s")),
        (None, Some(_)) => {
            let all: Vec<&str> = names.map(|name| name.typed.as_str()).collect();
            let (the, are) = match all.len() {
                1 => ("the only ", " is"),
                _ => ("the ", "s are"),
            };
            error.help(format!("{the}{what}{are} {}", all.join(", ")))
        }
    });
}

/// The card with its rows in the instance that its parameter names.
fn scoped(card: Card, place: Place, flat: &Deck, d: &mut Diagnostics) -> Card {
    let Some(text) = card.value("INSTANCE").filter(|_| place == Place::Assembly) else {
        return card;
    };
    match flat.instance(&text.name_key()) {
        Some(instance) => card.with_rows_in(instance),
        None => {
            undefined("instance", text, flat.instances.iter().map(|i| &i.name), d);
            card
        }
    }
}

/// Reports sets of instances in a deck that has none.
fn without_assembly(mut deck: Deck, d: &mut Diagnostics) -> Deck {
    let fields: Vec<(String, Span)> = deck
        .cards
        .iter()
        .filter(|card| ["NSET", "ELSET"].contains(&card.keyword.name))
        .filter_map(|card| card.value("INSTANCE"))
        .map(|text| (text.text.to_string(), text.span))
        .collect();
    for (text, span) in fields.iter().filter(|_| !deck.incomplete) {
        undefined(
            "instance",
            Text { text, span: *span },
            std::iter::empty(),
            d,
        );
    }
    deck.incomplete |= !fields.is_empty();
    deck
}

/// Warns about parts without instance.
fn report_unused(parts: &[Part], flat: &Deck, d: &mut Diagnostics) {
    for part in parts.iter().filter(|part| !part.cards.is_empty()) {
        if let (Some(name), false) = (&part.name, flat.incomplete) {
            let message = format!("part {name} has no instance");
            let span = part.head.span_of("NAME");
            let warning = Diagnostic::warning(Code::AssemblyStructure, span, message);
            d.push(warning.help("left out"));
        }
    }
}
