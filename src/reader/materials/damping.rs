//! `*DAMPING`.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::Damping;
use crate::reader::context::Context;
use crate::reader::mesh::Block;

/// Damping of a material; none without a card, or where it has an error.
pub(super) fn read(block: &Block, cx: &mut Context) -> Damping {
    let cards = block.parts_of("DAMPING");
    cx.only_once(&cards);
    cards.first().map_or(Damping::default(), |card| {
        report_empty(card, cx);
        Damping {
            alpha: factor(card, "ALPHA", cx),
            beta: factor(card, "BETA", cx),
        }
    })
}

/// Place of mass-proportional damping.
pub(super) fn span(block: &Block) -> Option<Span> {
    let cards = block.parts_of("DAMPING");
    cards.first().map(|card| card.span_of("ALPHA"))
}

/// Reports a card that gives nothing.
fn report_empty(card: &Card, cx: &mut Context) {
    if !card.faulty && !card.has("ALPHA") && !card.has("BETA") {
        let message = "*DAMPING has neither ALPHA nor BETA";
        let error = Diagnostic::error(Code::MissingParameter, card.span, message);
        cx.d.push(error.help("ALPHA damps in proportion to the mass, BETA to the elasticity"));
    }
}

/// A factor that may not be negative; 0 where it is not given.
fn factor(card: &Card, name: &str, cx: &mut Context) -> f64 {
    let value = card.real(name, cx.d).unwrap_or(0.0);
    if let (true, Some(typed)) = (value < 0.0, card.value(name)) {
        let message = format!("{name} must not be negative, found {}", typed.text);
        cx.error(Code::MaterialRange, card.span_of(name), message);
    }
    value.max(0.0)
}
