//! `*MATERIAL` with its law (`*ELASTIC` or `*HYPERELASTIC`), `*DENSITY` and `*DAMPING`.

use super::context::Context;
use super::names::Names;
use super::outline::{CardBlock, Outline};
use crate::deck::{Card, Line};
use crate::diagnostics::{Code, Span};
use crate::materials::{Law, NeoHooke, Plane};
use crate::model::{Damping, Material, Section};

/// A material as far as the deck gives it.
struct Draft {
    name: String,
    span: Span,
    /// Place of what Poisson's ratio follows from.
    poisson_span: Span,
    law: Constant<Law>,
    density: Constant<f64>,
    damping: Damping,
    /// Place of mass-proportional damping.
    damping_span: Span,
}

/// The materials of a deck before their sections are known.
pub(super) struct Drafts {
    /// Names, in the order of the materials.
    pub names: Names,
    all: Vec<Draft>,
}

impl Drafts {
    /// Reads all materials.
    pub fn read(outline: &Outline, cx: &mut Context) -> Self {
        let mut names = Names::new("material");
        let mut all = Vec::new();
        let general = general_damping(outline, cx);
        for block in outline.blocks("MATERIAL") {
            if let Some(name) = names.new_name(block.head, cx) {
                all.push(draft(name.typed.clone(), block, general, cx));
                names.define(name);
            }
        }
        Drafts { names, all }
    }

    /// Places of the materials.
    pub fn spans(&self) -> Vec<Span> {
        self.all.iter().map(|draft| draft.span).collect()
    }

    /// Places of what their Poisson's ratios follow from.
    pub fn poisson_spans(&self) -> Vec<Span> {
        self.all.iter().map(|draft| draft.poisson_span).collect()
    }

    /// Places of their mass-proportional damping.
    pub fn damping_spans(&self) -> Vec<Span> {
        self.all.iter().map(|draft| draft.damping_span).collect()
    }

    /// Reports constants that a material in use lacks.
    pub fn report_incomplete(&self, sections: &[Section], cx: &mut Context) {
        if cx.may_lack_cards() {
            return;
        }
        for (index, draft) in self.all.iter().enumerate() {
            if sections.iter().any(|section| section.material == index) {
                draft.report_incomplete(cx);
            }
        }
    }

    /// The materials, with unknown constants as zero, which a model without errors never has in use.
    pub fn complete(self, cx: &mut Context) -> Vec<Material> {
        let drafts = self.all.into_iter();
        drafts.map(|draft| draft.complete(cx)).collect()
    }
}

/// A material; `general` is the damping of one that has none of its own.
fn draft(name: String, block: &CardBlock, general: Option<Placed>, cx: &mut Context) -> Draft {
    let density = block.parts_of("DENSITY");
    cx.only_once(&density);
    let damping = own_damping(block, cx).or(general);
    let (damping, damping_span) = damping.unwrap_or((Damping::default(), block.head.span));
    Draft {
        name,
        span: block.head.span,
        poisson_span: poisson_span(block).unwrap_or(block.head.span),
        law: law(block, cx),
        density: constant(&density, density_row, cx),
        damping,
        damping_span,
    }
}

/// `rho[, T]`
fn density_row(row: Line, cx: &mut Context) -> Option<f64> {
    row.at_most(2, cx.d);
    let density = row.real(0, "the density", cx.d);
    temperature(row, 1, cx)?;
    let density = density?;
    if density <= 0.0 {
        out_of_range("the density must be positive", row, 0, cx);
        return None;
    }
    Some(density)
}

impl Draft {
    fn report_incomplete(&self, cx: &mut Context) {
        let mut missing = Vec::new();
        if self.law == Constant::Missing {
            missing.push("*ELASTIC");
        }
        if self.density == Constant::Missing {
            missing.push("*DENSITY");
        }
        if !missing.is_empty() {
            let message = format!("material {} lacks {}", self.name, missing.join(" and "));
            cx.error(Code::IncompleteMaterial, self.span, message);
        }
    }

    fn complete(self, cx: &mut Context) -> Material {
        let material = Material {
            name: self.name,
            law: self.law.given().unwrap_or(Law::elastic(0.0, 0.0)),
            density: self.density.given().unwrap_or(0.0),
            damping: self.damping,
        };
        hint_at_units(&material, self.span, cx);
        material
    }
}

/// Notes a wave speed that hints at mixed units.
fn hint_at_units(material: &Material, span: Span, cx: &mut Context) {
    let speed = material.wave_speed(Plane::Strain);
    if speed.is_finite() && speed > 0.0 && !(10.0..=1e8).contains(&speed) {
        let name = &material.name;
        let message = format!("the waves in material {name} run at {speed:.3e}");
        cx.d.note(Code::UnitsHint, span, message)
            .help("most materials lie between 10 and 1e8 in common units");
    }
}

/// Keywords of the laws.
const KEYWORDS: [&str; 2] = ["ELASTIC", "HYPERELASTIC"];

/// The one law of a material.
pub(super) fn law(block: &CardBlock, cx: &mut Context) -> Constant<Law> {
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
pub(super) fn poisson_span(block: &CardBlock) -> Option<Span> {
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
    cx.error(Code::RepeatedCard, card.span, message)
        .help("take one of the two out, or give each a material of its own");
}

/// `E, nu[, T]`
fn elastic_row(row: Line, cx: &mut Context) -> Option<Law> {
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
        cx.error(Code::MissingParameter, card.span, message)
            .help("its data line is C10, D1 with C10 = mu/2, D1 = 2/K of small strains");
        return Constant::Wrong;
    }
    constant(&[card], neo_hooke_row, cx)
}

/// `C10, D1[, T]`
fn neo_hooke_row(row: Line, cx: &mut Context) -> Option<Law> {
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
fn report_d1(d1: f64, row: Line, cx: &mut Context) {
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
    cx.error(code, span, message).help(
        "D1 = 2/K with the bulk modulus K, which must be finite; where it is not known, K = 20 mu \
         (D1 = 0.05/C10) is usual for rubber",
    );
}

/// Damping with the place of the part in proportion to the mass.
pub(super) type Placed = (Damping, Span);

/// Damping of a material of its own.
pub(super) fn own_damping(block: &CardBlock, cx: &mut Context) -> Option<Placed> {
    only(&block.parts_of("DAMPING"), cx)
}

/// Damping of the materials that have none of their own: a card outside materials.
pub(super) fn general_damping(outline: &Outline, cx: &mut Context) -> Option<Placed> {
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
        cx.error(Code::MissingParameter, card.span, message)
            .help("ALPHA damps in proportion to the mass, BETA to the elasticity");
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

/// A constant of a material.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Constant<T> {
    Missing,
    Wrong,
    Given(T),
}

impl<T> Constant<T> {
    /// The constant, if there is one without an error.
    pub fn given(self) -> Option<T> {
        match self {
            Constant::Given(value) => Some(value),
            Constant::Missing | Constant::Wrong => None,
        }
    }
}

/// The constant that all rows of a card agree on.
pub(super) fn constant<T: PartialEq + Copy>(
    cards: &[&Card],
    read: fn(Line, &mut Context) -> Option<T>,
    cx: &mut Context,
) -> Constant<T> {
    let Some(card) = cards.first() else {
        return Constant::Missing;
    };
    let mut found = Constant::Wrong;
    for row in card.rows.iter() {
        match (read(row, cx), found) {
            (None, _) => return Constant::Wrong,
            (Some(value), Constant::Given(first)) if value != first => {
                let message = "constants that depend on temperature cannot be used";
                cx.error(Code::UnsupportedParameter, row.span(), message);
            }
            (Some(value), _) => found = Constant::Given(value),
        }
    }
    found
}

/// A temperature in field `index`, which may be any: the rows of all temperatures are alike.
pub(super) fn temperature(row: Line, index: usize, cx: &mut Context) -> Option<()> {
    row.real_or(index, 0.0, cx.d).map(|_| ())
}

/// Reports the number in a field, if it is there.
pub(super) fn out_of_range(rule: &str, row: Line, index: usize, cx: &mut Context) {
    if let Some(field) = row.get(index) {
        let message = format!("{rule}, found {}", field.text);
        cx.error(Code::MaterialRange, field.span, message);
    }
}
