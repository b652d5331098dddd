//! `*ELASTIC` and `*HYPERELASTIC`.

use super::constant::{Constant, constant, out_of_range, temperature};
use crate::deck::{Card, Row};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::materials::{Law, NeoHooke};
use crate::reader::context::Context;
use crate::reader::mesh::Block;

/// Keywords of the laws.
const KEYWORDS: [&str; 2] = ["ELASTIC", "HYPERELASTIC"];

/// The one law of a material.
pub(super) fn read(block: &Block, cx: &mut Context) -> Constant<Law> {
    let is_law = |card: &&&Card| KEYWORDS.contains(&card.keyword.name);
    let mut cards = block.parts.iter().filter(is_law);
    let Some(first) = cards.next() else {
        return Constant::Missing;
    };
    let law = match first.keyword.name {
        "ELASTIC" => constant(&[first], elastic_row, cx),
        _ => hyperelastic(first, cx),
    };
    cards.fold(law, |_, card| {
        report_second(first, card, cx);
        Constant::Wrong
    })
}

/// Place of what Poisson's ratio follows from: the second constant of the law.
pub(super) fn poisson_span(block: &Block) -> Option<Span> {
    let mut cards = block.parts.iter();
    let card = cards.find(|card| KEYWORDS.contains(&card.keyword.name))?;
    Some(card.rows.first()?.get(1)?.span)
}

/// Reports a law that stands beside the first one.
fn report_second(first: &Card, card: &Card, cx: &mut Context) {
    if first.keyword.name == card.keyword.name {
        return cx.only_once(&[first, card]);
    }
    let message = format!("a material has one law: {} is given already", first.title());
    let error = Diagnostic::error(Code::RepeatedCard, card.span, message);
    cx.d.push(error.help("take one of the two out, or give each a material of its own"));
}

/// `E, nu[, T]`
fn elastic_row(row: Row, cx: &mut Context) -> Option<Law> {
    row.at_most(3, cx.d);
    let young = row.real(0, "Young's modulus", cx.d);
    let poisson = row.real_or(1, 0.0, cx.d);
    temperature(row, 2, cx)?;
    let (young, poisson) = (young?, poisson?);
    if young <= 0.0 {
        out_of_range("Young's modulus must be positive", row, 0, cx);
        return None;
    }
    if poisson <= -1.0 || poisson >= 0.5 {
        out_of_range("Poisson's ratio must lie between -1 and 0.5", row, 1, cx);
        return None;
    }
    Some(Law::elastic(young, poisson))
}

/// The law of `*HYPERELASTIC`, which must say NEO HOOKE. What a faulty keyword line gives is not
/// looked at.
fn hyperelastic(card: &Card, cx: &mut Context) -> Constant<Law> {
    if card.faulty {
        return Constant::Wrong;
    }
    if !card.has("NEO HOOKE") {
        let message = "*HYPERELASTIC needs the parameter NEO HOOKE";
        let error = Diagnostic::error(Code::MissingParameter, card.span, message);
        cx.d.push(
            error.help("its data line is C10, D1 with C10 = mu/2, D1 = 2/K of small strains"),
        );
        return Constant::Wrong;
    }
    constant(&[card], neo_hooke_row, cx)
}

/// `C10, D1[, T]`
fn neo_hooke_row(row: Row, cx: &mut Context) -> Option<Law> {
    row.at_most(3, cx.d);
    let c10 = row.real(0, "C10", cx.d);
    let d1 = row.real_or(1, 0.0, cx.d);
    temperature(row, 2, cx)?;
    let (c10, d1) = (c10?, d1?);
    if c10 <= 0.0 {
        out_of_range("C10 must be positive", row, 0, cx);
        return None;
    }
    if d1 <= 0.0 {
        report_d1(d1, row, cx);
        return None;
    }
    Some(Law::NeoHooke(NeoHooke { c10, d1 }))
}

/// Reports a D1 that is missing, zero or negative.
fn report_d1(d1: f64, row: Row, cx: &mut Context) {
    let given = row.get(1).filter(|field| !field.text.is_empty());
    let (code, span, message) = match given {
        None => (
            Code::MissingField,
            row.span(),
            "D1 is missing: the material would be incompressible".to_owned(),
        ),
        Some(field) if d1 == 0.0 => (
            Code::MaterialRange,
            field.span,
            "D1 = 0 makes the material incompressible".to_owned(),
        ),
        Some(field) => (
            Code::MaterialRange,
            field.span,
            format!("D1 must be positive, found {}", field.text),
        ),
    };
    let error = Diagnostic::error(code, span, message);
    cx.d.push(error.help(
        "D1 = 2/K with the bulk modulus K, which must be finite; where it is not known, K = 20 mu \
         (D1 = 0.05/C10) is usual for rubber",
    ));
}
