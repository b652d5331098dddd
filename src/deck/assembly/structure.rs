//! The parts of a deck, and its other cards in their order.

use super::places::{Place, report_open};
use crate::deck::cards::Card;
use crate::deck::lines::Name;
use crate::diagnostics::{Code, Diagnostic, Diagnostics};

/// A part with its cards.
pub(super) struct Part {
    /// Its name, unless that cannot be read.
    pub name: Option<Name>,
    /// `*PART`.
    pub head: Card,
    /// The cards up to `*END PART`.
    pub cards: Vec<Card>,
    /// Number of its instances that have no cards yet.
    pub wanted: usize,
}

/// A card outside parts, or an instance.
pub(super) enum Item {
    /// A card.
    Card(Card, Place),
    /// `*INSTANCE` with the cards up to `*END INSTANCE`.
    Instance(Card, Vec<Card>),
}

/// The cards of a deck by where they stand.
pub(super) struct Structure {
    pub parts: Vec<Part>,
    pub items: Vec<Item>,
    place: Place,
    has_assembly: bool,
    /// Whether the last card is reported to be out of place: one of several in a row is.
    misplaced: bool,
}

impl Structure {
    /// Sorts cards; reports those out of place and what is not closed.
    pub fn new(cards: Vec<Card>, d: &mut Diagnostics) -> Structure {
        let mut structure = Structure {
            parts: Vec::new(),
            items: Vec::new(),
            place: Place::Model,
            has_assembly: false,
            misplaced: false,
        };
        let end = cards.last().map(|card| card.span);
        for card in cards {
            structure.add(card, d);
        }
        if let Some(end) = end {
            report_open(structure.place, end, d);
        }
        structure
    }

    fn add(&mut self, card: Card, d: &mut Diagnostics) {
        match card.keyword.name {
            "PART" => self.part(card, d),
            "ASSEMBLY" => self.assembly(&card, d),
            "INSTANCE" => self.instance(card, d),
            "END PART" => self.end(Place::Part, Place::Model, &card, d),
            "END ASSEMBLY" => self.end(Place::Assembly, Place::Model, &card, d),
            "END INSTANCE" => self.end(Place::Instance, Place::Assembly, &card, d),
            _ => self.other(card, d),
        }
    }

    fn part(&mut self, head: Card, d: &mut Diagnostics) {
        report_open(self.place, head.span, d);
        self.place = Place::Part;
        let text = head.required("NAME", d);
        let name = text.and_then(|text| text.name(d));
        let known = |name: &Name| {
            let mut names = self.parts.iter().filter_map(|part| part.name.as_ref());
            names.any(|known| known.key == name.key)
        };
        if let Some(name) = name.as_ref().filter(|name| known(name)) {
            let message = format!("part {name} is defined a second time");
            d.push(Diagnostic::error(
                Code::RepeatedName,
                head.span_of("NAME"),
                message,
            ));
        }
        self.parts.push(Part {
            name,
            head,
            cards: Vec::new(),
            wanted: 0,
        });
    }

    fn assembly(&mut self, head: &Card, d: &mut Diagnostics) {
        report_open(self.place, head.span, d);
        self.place = Place::Assembly;
        head.has("NAME");
        if std::mem::replace(&mut self.has_assembly, true) {
            let message = "*ASSEMBLY appears a second time here";
            d.push(Diagnostic::error(Code::RepeatedCard, head.span, message));
        }
    }

    fn instance(&mut self, head: Card, d: &mut Diagnostics) {
        if self.place != Place::Assembly {
            report_open(self.place, head.span, d);
        }
        if self.place == Place::Model {
            let error = Diagnostic::error(
                Code::WrongPlace,
                head.span,
                "*INSTANCE must stand in the assembly",
            );
            d.push(error.help("move it between *ASSEMBLY and *END ASSEMBLY"));
        }
        self.place = Place::Instance;
        self.items.push(Item::Instance(head, Vec::new()));
    }

    /// The end of `place`, behind which cards belong to `outer`.
    fn end(&mut self, place: Place, outer: Place, card: &Card, d: &mut Diagnostics) {
        if self.place == Place::Instance && place == Place::Assembly {
            report_open(self.place, card.span, d);
        } else if self.place != place {
            let head = place.head().unwrap_or_default();
            let message = format!("{} without *{head}", card.title());
            d.push(Diagnostic::error(
                Code::AssemblyStructure,
                card.span,
                message,
            ));
        }
        self.place = outer;
    }

    fn other(&mut self, card: Card, d: &mut Diagnostics) {
        if card.keyword.name == "STEP" {
            report_open(self.place, card.span, d);
            self.place = Place::Model;
        }
        let misplaced = !self.place.takes(&card);
        if misplaced && !self.misplaced {
            self.place.report(&card, d);
        }
        self.misplaced = misplaced;
        let (part, item) = (self.parts.last_mut(), self.items.last_mut());
        match (self.place, part, item) {
            (Place::Part, Some(part), _) => part.cards.push(card),
            (Place::Instance, _, Some(Item::Instance(_, cards))) => cards.push(card),
            (place, _, _) => self.items.push(Item::Card(card, place)),
        }
    }
}
