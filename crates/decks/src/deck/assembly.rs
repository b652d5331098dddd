//! Makes decks with parts and an assembly flat: every instance gets the cards of its part, and their spans name the
//! instance. The reader decides what a name or a number means in an instance.

use super::card::{Card, Instance, Placement};
use super::collect::Deck;
use super::keywords::{Level, Levels, Scope, Status};
use super::lines::Line;
use super::text::{Name, Text};
use crate::diagnostics::{Code, Diagnostics, Severity, Sources, Span, closest, list_of};

/// The deck with the cards of the parts in place of their instances.
pub(in crate::deck) fn flatten(deck: Deck, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let is_structure = |card: &Card| card.keyword.scope == Scope::Structure;
    if !deck.cards.iter().any(is_structure) {
        return without_assembly(deck, d);
    }
    let errors = d.count(Severity::Error);
    let Structure { parts, items, .. } = Structure::new(deck.cards, d);
    let faulty = d.count(Severity::Error) > errors;
    let mut flat = Deck {
        cards: Vec::new(),
        incomplete: deck.incomplete || faulty,
        ..deck
    };
    let copies = instances(&items, &parts, &mut flat, sources, d);
    for (item, copy) in items.into_iter().zip(&copies) {
        match item {
            Item::Card(card) => {
                let card = scoped(card, &flat, d);
                flat.cards.push(card);
            }
            Item::Instance(_, own) => {
                let of_part = copy.part.and_then(|part| parts.get(part));
                let of_part = of_part.map_or(&[][..], |part| &part.cards).iter().cloned();
                let all = of_part
                    .chain(own)
                    .map(|card| card.in_instance(copy.instance));
                flat.cards.extend(all);
            }
        }
    }
    flat.incomplete |= d.count(Severity::Error) > errors;
    for (index, part) in parts.iter().enumerate() {
        let is_used = copies.iter().any(|copy| copy.part == Some(index));
        if let (Some(name), false, false) = (&part.name, is_used, flat.incomplete)
            && !part.cards.is_empty()
        {
            let message = format!("part {name} has no instance");
            d.warning(Code::AssemblyStructure, part.head.span_of("NAME"), message)
                .help("left out");
        }
    }
    flat
}

/// Number of an instance and index of its part; for cards outside instances zero and `None`.
#[derive(Default)]
struct Copy {
    instance: u32,
    part: Option<usize>,
}

/// Registers the instances with the deck and the sources.
fn instances(
    items: &[Item],
    parts: &[Part],
    flat: &mut Deck,
    sources: &mut Sources,
    d: &mut Diagnostics,
) -> Vec<Copy> {
    let mut all = Vec::new();
    for item in items {
        let mut copy = Copy::default();
        if let Item::Instance(head, _) = item {
            let part = part_of(head, parts, flat, d);
            // the cards of an instance without name would be those of the whole deck
            if let Some(name) = instance_name(head, flat, d) {
                let instance = sources.add_instance(&name.typed, head.span);
                copy = Copy { instance, part };
                let placement = placement(head, d);
                flat.instances.push(Instance { name, placement });
            }
        }
        all.push(copy);
    }
    all
}

/// Name of an instance; a name that is missing, or that another instance has, is reported.
fn instance_name(head: &Card, flat: &Deck, d: &mut Diagnostics) -> Option<Name> {
    let text = head.required("NAME", d)?;
    let name = text.name(d)?;
    if flat.instance(&name.key).is_some() {
        let message = format!("instance {name} is defined a second time");
        d.error(Code::RepeatedName, text.span, message);
        return None;
    }
    Some(name)
}

/// Part of an instance; a part that is not defined is reported.
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
    let names = names.map(|name| name.typed.as_str());
    let error = d.error(Code::UndefinedName, text.span, message);
    match closest(text.text, names.clone()) {
        Some(meant) => error.suggest(Some(meant)),
        None => error.help(list_of(what, names)),
    };
}

/// The card with its rows read in the instance that its parameter INSTANCE names.
fn scoped(card: Card, flat: &Deck, d: &mut Diagnostics) -> Card {
    let Some(text) = card.value("INSTANCE") else {
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

/// Reports sets of instances in a deck that has no instances.
fn without_assembly(mut deck: Deck, d: &mut Diagnostics) -> Deck {
    let sets = (deck.cards.iter()).filter(|card| ["NSET", "ELSET"].contains(&card.keyword.name));
    let mut incomplete = deck.incomplete;
    for text in sets.filter_map(|card| card.value("INSTANCE")) {
        if !deck.incomplete {
            undefined("instance", text, std::iter::empty(), d);
        }
        incomplete = true;
    }
    deck.incomplete = incomplete;
    deck
}

/// A part with its cards.
pub(super) struct Part {
    /// Name of the part; `None` if the name cannot be read.
    pub name: Option<Name>,
    /// `*PART`.
    pub head: Card,
    /// The cards up to `*END PART`.
    pub cards: Vec<Card>,
}

/// A card outside parts, or an instance.
pub(super) enum Item {
    /// A card.
    Card(Card),
    /// `*INSTANCE` with the cards up to `*END INSTANCE`.
    Instance(Card, Vec<Card>),
}

/// The cards of a deck, sorted by the part, the instance or the assembly in which they stand.
pub(super) struct Structure {
    pub parts: Vec<Part>,
    pub items: Vec<Item>,
    /// The level of the next card.
    level: Level,
    has_assembly: bool,
    /// Whether the last card has been reported to be out of place: of several such cards in a row, only the first is
    /// reported.
    misplaced: bool,
}

impl Structure {
    /// Sorts cards; reports cards that are out of place, and parts, instances and assemblies without an end.
    pub fn new(cards: Vec<Card>, d: &mut Diagnostics) -> Structure {
        let mut structure = Structure {
            parts: Vec::new(),
            items: Vec::new(),
            level: Level::Model,
            has_assembly: false,
            misplaced: false,
        };
        let end = cards.last().map(|card| card.span);
        for card in cards {
            structure.add(card, d);
        }
        if let Some(end) = end {
            report_open(structure.level, end, d);
        }
        structure
    }

    fn add(&mut self, card: Card, d: &mut Diagnostics) {
        self.misplaced &= card.keyword.scope != Scope::Structure;
        match card.keyword.name {
            "PART" => self.part(card, d),
            "ASSEMBLY" => self.assembly(&card, d),
            "INSTANCE" => self.instance(card, d),
            "END PART" => self.end(Level::Part, Level::Model, &card, d),
            "END ASSEMBLY" => self.end(Level::Assembly, Level::Model, &card, d),
            "END INSTANCE" => self.end(Level::Instance, Level::Assembly, &card, d),
            _ => self.other(card, d),
        }
    }

    fn part(&mut self, head: Card, d: &mut Diagnostics) {
        report_open(self.level, head.span, d);
        self.level = Level::Part;
        let text = head.required("NAME", d);
        let name = text.and_then(|text| text.name(d));
        let known = |name: &Name| {
            let mut names = self.parts.iter().filter_map(|part| part.name.as_ref());
            names.any(|known| known.key == name.key)
        };
        if let Some(name) = name.as_ref().filter(|name| known(name)) {
            let message = format!("part {name} is defined a second time");
            d.error(Code::RepeatedName, head.span_of("NAME"), message);
        }
        self.parts.push(Part {
            name,
            head,
            cards: Vec::new(),
        });
    }

    fn assembly(&mut self, head: &Card, d: &mut Diagnostics) {
        report_open(self.level, head.span, d);
        self.level = Level::Assembly;
        head.has("NAME");
        if std::mem::replace(&mut self.has_assembly, true) {
            let message = "*ASSEMBLY appears a second time here";
            d.error(Code::RepeatedCard, head.span, message);
        }
    }

    fn instance(&mut self, head: Card, d: &mut Diagnostics) {
        if self.level != Level::Assembly {
            report_open(self.level, head.span, d);
        }
        if self.level == Level::Model {
            d.error(
                Code::WrongPlace,
                head.span,
                "*INSTANCE must stand in the assembly",
            )
            .help("move it between *ASSEMBLY and *END ASSEMBLY");
        }
        self.level = Level::Instance;
        self.items.push(Item::Instance(head, Vec::new()));
    }

    /// Ends `level`; the cards that follow belong to `outer`.
    fn end(&mut self, level: Level, outer: Level, card: &Card, d: &mut Diagnostics) {
        if self.level == Level::Instance && level == Level::Assembly {
            report_open(self.level, card.span, d);
        } else if self.level != level {
            let head = head(level).unwrap_or_default();
            let message = format!("{} without *{head}", card.title());
            d.error(Code::AssemblyStructure, card.span, message);
        }
        self.level = outer;
    }

    fn other(&mut self, card: Card, d: &mut Diagnostics) {
        match card.keyword.name {
            "STEP" => {
                report_open(self.level, card.span, d);
                self.level = Level::LaterStep;
            }
            "END STEP" => self.level = Level::Model,
            _ => {}
        }
        let misplaced = !takes(self.level, &card);
        if misplaced && !self.misplaced {
            report(self.level, &card, d);
        }
        // sets and surfaces of a mesh out of place may stand there
        self.misplaced = misplaced || (self.misplaced && card.keyword.levels.are_of_mesh());
        let (part, item) = (self.parts.last_mut(), self.items.last_mut());
        match (self.level, part, item) {
            (Level::Part, Some(part), _) => part.cards.push(card),
            (Level::Instance, _, Some(Item::Instance(_, cards))) => cards.push(card),
            _ => self.items.push(Item::Card(card)),
        }
    }
}

/// The keyword that begins a part, an instance or the assembly.
fn head(level: Level) -> Option<&'static str> {
    match level {
        Level::Part => Some("PART"),
        Level::Assembly => Some("ASSEMBLY"),
        Level::Instance => Some("INSTANCE"),
        Level::Model | Level::FirstStep | Level::LaterStep => None,
    }
}

/// Whether parts and the assembly allow a card at its place; the order of model and steps is not checked.
fn takes(level: Level, card: &Card) -> bool {
    if card.keyword.status != Status::Read {
        return true;
    }
    let levels = card.keyword.levels;
    match level {
        Level::Part | Level::Instance | Level::Assembly => levels.has(level),
        Level::Model => levels.has(level) || !levels.are_of_mesh(),
        Level::FirstStep | Level::LaterStep => true,
    }
}

/// Place in the deck where a card of the given levels belongs, in words.
fn advice(levels: Levels) -> &'static str {
    if levels.has(Level::Part) && !levels.has(Level::Assembly) {
        "put it between *PART and *END PART"
    } else if levels.are_of_mesh() {
        "in a deck with an assembly it belongs to *PART or *ASSEMBLY"
    } else if !levels.has(Level::Model) {
        "move it between *STEP and *END STEP"
    } else {
        "move it behind *END ASSEMBLY"
    }
}

/// Reports a card that cannot stand at its level.
fn report(level: Level, card: &Card, d: &mut Diagnostics) {
    let place = match level {
        Level::Part => "in a part",
        Level::Assembly => "in the assembly",
        Level::Instance => "in an instance",
        Level::Model | Level::FirstStep | Level::LaterStep => "outside parts and the assembly",
    };
    let message = format!("{} cannot stand {place}", card.title());
    d.error(Code::WrongPlace, card.span, message)
        .help(advice(card.keyword.levels));
}

/// Reports a part, an assembly or an instance whose end is missing before `span`.
pub(super) fn report_open(level: Level, span: Span, d: &mut Diagnostics) {
    if let Some(head) = head(level) {
        let message = format!("the *{head} before is not closed");
        d.error(Code::AssemblyStructure, span, message)
            .help(format!("close it with *END {head}"));
    }
}

/// Largest deviation of the axis of a rotation from the normal of the plane, relative to the length of the axis:
/// the deviation allows for numbers of six digits.
const TILT: f64 = 1e-6;

/// Reads the position of an instance; reports a position out of the plane.
pub(super) fn placement(card: &Card, d: &mut Diagnostics) -> Placement {
    let mut rows = card.rows.iter();
    let translation = rows.next().map(|row| translation(row, d));
    let rotation = rows.next().and_then(|row| rotation(row, d));
    if let Some(extra) = rows.next() {
        let message = "an instance has a translation and a rotation only";
        d.error(Code::StrayData, extra.span(), message);
    }
    Placement {
        translation: translation.unwrap_or_default(),
        rotation,
    }
}

/// Translation of an instance, `tx, ty, tz`.
fn translation(row: Line, d: &mut Diagnostics) -> [f64; 2] {
    row.at_most(3, d);
    let [x, y, z] = [0, 1, 2].map(|i| row.real_or(i, 0.0, d).unwrap_or(0.0));
    if z != 0.0 {
        let span = row.span_at(2);
        out_of_plane(span, "this translation leads out of the plane", d);
    }
    [x, y]
}

/// Rotation of an instance, `x1, y1, z1, x2, y2, z2, angle`: its centre, and cosine and sine of its angle.
fn rotation(row: Line, d: &mut Diagnostics) -> Option<([f64; 2], [f64; 2])> {
    row.at_most(7, d);
    let point = |first: usize, d: &mut Diagnostics| {
        [0, 1, 2].map(|i| row.real_or(first + i, 0.0, d).unwrap_or(0.0))
    };
    let (a, b) = (point(0, d), point(3, d));
    let angle = row.real(6, "the angle in degrees", d)?;
    let [x, y, z] = [0, 1, 2].map(|i| b[i] - a[i]);
    if angle == 0.0 {
        return None;
    }
    if x.abs().max(y.abs()) > TILT * z.abs() || z == 0.0 {
        let message = "the axis of this rotation is not normal to the plane";
        out_of_plane(row.span(), message, d);
    }
    Some(([a[0], a[1]], cosine_and_sine(angle * z.signum())))
}

/// Cosine and sine of an angle in degrees, exact for quarter turns.
fn cosine_and_sine(degrees: f64) -> [f64; 2] {
    match degrees.rem_euclid(360.0) {
        0.0 => [1.0, 0.0],
        90.0 => [0.0, 1.0],
        180.0 => [-1.0, 0.0],
        270.0 => [0.0, -1.0],
        other => [other.to_radians().cos(), other.to_radians().sin()],
    }
}

fn out_of_plane(span: Span, message: &str, d: &mut Diagnostics) {
    d.error(Code::Placement, span, message)
        .help("the program is plane: instances move in x and y and turn about z");
}
