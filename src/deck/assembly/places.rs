//! Where the cards of a deck with an assembly may stand.

use crate::deck::cards::Card;
use crate::deck::keywords::{Scope, Status};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Span};

/// The part of a deck that a card stands in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Outside parts and the assembly.
    Model,
    /// A part.
    Part,
    /// The assembly, outside its instances.
    Assembly,
    /// An instance.
    Instance,
}

/// Cards of parts and instances.
const OF_PARTS: [&str; 6] = [
    "NODE",
    "ELEMENT",
    "NSET",
    "ELSET",
    "SURFACE",
    "SOLID SECTION",
];

/// Cards of the assembly.
const OF_ASSEMBLY: [&str; 7] = [
    "NODE",
    "ELEMENT",
    "NSET",
    "ELSET",
    "SURFACE",
    "RIGID BODY",
    "EQUATION",
];

impl Place {
    /// The keyword that begins it; none outside parts and the assembly.
    pub fn head(self) -> Option<&'static str> {
        match self {
            Place::Model => None,
            Place::Part => Some("PART"),
            Place::Assembly => Some("ASSEMBLY"),
            Place::Instance => Some("INSTANCE"),
        }
    }

    /// Whether the card may stand here.
    pub fn takes(self, card: &Card) -> bool {
        let name = card.keyword.name;
        if card.keyword.status != Status::Read {
            return true;
        }
        match self {
            Place::Model => !OF_PARTS.contains(&name),
            Place::Part | Place::Instance => OF_PARTS.contains(&name),
            Place::Assembly => OF_ASSEMBLY.contains(&name),
        }
    }

    /// Where the card belongs.
    fn advice(card: &Card) -> &'static str {
        match (card.keyword.name, card.keyword.scope) {
            ("SOLID SECTION", _) => "put it between *PART and *END PART",
            (name, _) if OF_PARTS.contains(&name) => {
                "in a deck with an assembly it belongs to *PART or *ASSEMBLY"
            }
            (_, Scope::Step) => "move it between *STEP and *END STEP",
            _ => "move it behind *END ASSEMBLY",
        }
    }

    /// Reports a card that cannot stand here.
    pub fn report(self, card: &Card, d: &mut Diagnostics) {
        let place = match self {
            Place::Model => "outside parts and the assembly",
            Place::Part => "in a part",
            Place::Assembly => "in the assembly",
            Place::Instance => "in an instance",
        };
        let message = format!("{} cannot stand {place}", card.title());
        let error = Diagnostic::error(Code::WrongPlace, card.span, message);
        d.push(error.help(Place::advice(card)));
    }
}

/// Reports a part, an assembly or an instance whose end is missing before `span`.
pub(super) fn report_open(place: Place, span: Span, d: &mut Diagnostics) {
    if let Some(head) = place.head() {
        let message = format!("the *{head} before is not closed");
        let error = Diagnostic::error(Code::AssemblyStructure, span, message);
        d.push(error.help(format!("close it with *END {head}")));
    }
}
