//! `*DAMPING` of a material, and of all that have none.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::Damping;
use crate::reader::context::Context;
use crate::reader::mesh::{Block, Outline};

/// Damping with the place of the part in proportion to the mass.
pub(super) type Placed = (Damping, Span);

/// Damping of a material of its own.
pub(super) fn own(block: &Block, cx: &mut Context) -> Option<Placed> {
    only(&block.parts_of("DAMPING"), cx)
}

/// Damping of the materials that have none of their own: a card outside materials.
pub(super) fn general(outline: &Outline, cx: &mut Context) -> Option<Placed> {
    only(&outline.model_cards("DAMPING"), cx)
}

/// What a card gives that may appear once.
fn only(cards: &[&Card], cx: &mut Context) -> Option<Placed> {
    cx.only_once(cards);
    let card = cards.first()?;
    report_empty(card, cx);
    let damping = Damping {
        alpha: factor(card, "ALPHA", cx),
        beta: factor(card, "BETA", cx),
    };
    Some((damping, card.span_of("ALPHA")))
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
