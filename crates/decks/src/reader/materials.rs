//! `*MATERIAL` with its law (`*ELASTIC` with or without `*PLASTIC`, or `*HYPERELASTIC`), `*DENSITY` and `*DAMPING`.

use super::context::Context;
use super::names::Names;
use super::outline::{CardBlock, Outline};
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span};
use crate::materials::{
    Expansion, Hencky, Law, NeoHooke, Ogden, Plane, Plastic, Polynomial, SmallStrainModuli,
    VolumeEnergy,
};
use crate::model::{Damping, Material, Section};

/// Places of a material for messages.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MaterialPlaces {
    /// Place of `*MATERIAL`.
    pub material: Span,
    /// Place of the constant that determines Poisson's ratio.
    pub poisson: Span,
    /// Place of the mass-proportional damping.
    pub damping: Span,
    /// Whether the deck gives no density.
    pub has_no_density: bool,
}

/// A material with the properties that the deck gives.
struct Draft {
    name: String,
    places: MaterialPlaces,
    law: Constant<Law>,
    density: Constant<f64>,
    damping: Damping,
    expansion: Constant<Expansion>,
}

/// Density of a material without `*DENSITY`, for static steps, which do not use it; masses in the results are then
/// volumes.
const NO_DENSITY: f64 = 1.0;

/// The materials of a deck before their sections are known.
pub(super) struct Drafts {
    /// Names of the materials in their order.
    pub names: Names,
    all: Vec<Draft>,
}

impl Drafts {
    /// Reads all materials.
    pub fn read(outline: &Outline, cx: &mut Context) -> Self {
        let mut names = Names::new("material");
        let mut all = Vec::new();
        // damping of the materials that have none of their own: a card outside materials
        let general = damping(&outline.model_cards("DAMPING"), cx);
        for block in outline.blocks("MATERIAL") {
            if let Some(name) = names.new_name(block.head, cx) {
                all.push(draft(name.typed.clone(), block, general, cx));
                names.define(name);
            }
        }
        Drafts { names, all }
    }

    /// Reports materials in use without elasticity.
    pub fn report_without_law(&self, sections: &[Section], cx: &mut Context) {
        if cx.may_lack_cards() {
            return;
        }
        for (index, draft) in self.all.iter().enumerate() {
            if sections.iter().any(|section| section.material == index) {
                draft.report_without_law(cx);
            }
        }
    }

    /// The materials and their places. A law that is not given has constants zero, which are never used in a model
    /// without errors; a density that is not given is [`NO_DENSITY`].
    pub fn complete(self, cx: &mut Context) -> (Vec<Material>, Vec<MaterialPlaces>) {
        let complete = self.all.into_iter().map(|draft| {
            let material = Material {
                name: draft.name,
                law: draft.law.given().unwrap_or(Law::elastic(0.0, 0.0)),
                density: draft.density.given().unwrap_or(NO_DENSITY),
                damping: draft.damping,
                expansion: draft.expansion.given(),
            };
            if !draft.places.has_no_density {
                hint_at_units(&material, draft.places.material, cx);
            }
            (material, draft.places)
        });
        complete.unzip()
    }
}

/// Reads a material; `general` is the damping of materials without their own.
fn draft(
    name: String,
    block: &CardBlock,
    general: Option<(Damping, Span)>,
    cx: &mut Context,
) -> Draft {
    let material = block.head.span;
    let densities = block.parts_of("DENSITY");
    cx.only_once(&densities);
    let density = constant(&densities, density_row, cx);
    let own = damping(&block.parts_of("DAMPING"), cx);
    let (damping, damping_place) = own.or(general).unwrap_or((Damping::default(), material));
    Draft {
        name,
        places: MaterialPlaces {
            material,
            poisson: poisson_span(block).unwrap_or(material),
            damping: damping_place,
            has_no_density: density == Constant::Missing,
        },
        law: law(block, cx),
        density,
        damping,
        expansion: expansion(&block.parts_of("EXPANSION"), cx),
    }
}

/// Reads rows `alpha[, T]` of increasing temperatures; alpha is the mean expansion from `ZERO` to T.
fn expansion(cards: &[&Card], cx: &mut Context) -> Constant<Expansion> {
    cx.only_once(cards);
    let Some(card) = cards.first() else {
        return Constant::Missing;
    };
    if card.faulty {
        return Constant::Wrong;
    }
    let errors = cx.errors();
    let zero = card
        .value("ZERO")
        .map_or(Some(0.0), |value| value.real(cx.d));
    let mut table: Vec<[f64; 2]> = Vec::new();
    for row in card.rows.iter() {
        row.at_most(2, cx.d);
        let alpha = row.real(0, "the coefficient of expansion", cx.d);
        let temperature = row.real_or(1, 0.0, cx.d);
        let (Some(alpha), Some(temperature)) = (alpha, temperature) else {
            continue;
        };
        if table
            .last()
            .is_some_and(|[before, _]| temperature <= *before)
        {
            let message = "temperatures must grow from row to row";
            cx.error(Code::MaterialRange, row.span_at(1), message);
        }
        table.push([temperature, alpha]);
    }
    match zero {
        Some(zero) if cx.errors() == errors => Constant::Given(Expansion { zero, table }),
        _ => Constant::Wrong,
    }
}

/// `rho[, T]`
fn density_row(row: Line, cx: &mut Context) -> Option<f64> {
    row.at_most(2, cx.d);
    let density = row.required(0, "the density", cx.d);
    temperature(row, 1, cx)?;
    let rule = "the density must be positive";
    density?.real_that(|rho| rho > 0.0, rule, Code::MaterialRange, cx.d)
}

impl Draft {
    fn report_without_law(&self, cx: &mut Context) {
        if self.law == Constant::Missing {
            let message = format!("material {} lacks *ELASTIC or *HYPERELASTIC", self.name);
            cx.error(Code::IncompleteMaterial, self.places.material, message);
        }
    }
}

/// Notes a wave speed whose value hints at mixed units.
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

/// The law of a material; a material without a law, or with two laws, is reported.
fn law(block: &CardBlock, cx: &mut Context) -> Constant<Law> {
    let is_law = |card: &&&Card| KEYWORDS.contains(&card.keyword.name);
    let mut cards = block.parts.iter().filter(is_law);
    let Some(first) = cards.next() else {
        return Constant::Missing;
    };
    let plastic = block.parts_of("PLASTIC");
    cx.only_once(&plastic);
    let law = match first.keyword.name {
        _ if !plastic.is_empty() => metal(first, plastic[0], cx),
        "ELASTIC" => {
            let read = match first.choice("TYPE") {
                Some("NEO HOOKE") => elastic_neo_hooke_row,
                Some("HENCKY") => hencky_row,
                _ => elastic_row,
            };
            constant(&[first], read, cx)
        }
        _ => hyperelastic(first, cx),
    };
    cards.fold(law, |_, card| {
        report_second(first, card, cx);
        Constant::Wrong
    })
}

/// The metal of `*ELASTIC` and `*PLASTIC`. The elastic strains of the metal are logarithmic (Hencky), with or without
/// TYPE=HENCKY in the deck.
fn metal(elasticity: &Card, plasticity: &Card, cx: &mut Context) -> Constant<Law> {
    let is_of_metals =
        elasticity.keyword.name == "ELASTIC" && elasticity.choice("TYPE") != Some("NEO HOOKE");
    if !is_of_metals {
        let message = "*PLASTIC stands beside *ELASTIC with E and nu, or with TYPE=HENCKY";
        cx.error(Code::IncompleteMaterial, elasticity.span, message)
            .help("the elastic strains of metals are logarithmic (Hencky) and small: other laws agree with these constants");
        return Constant::Wrong;
    }
    let elastic = constant(&[elasticity], elastic_row, cx).given();
    let hardening = hardening(plasticity, cx);
    match (elastic, hardening) {
        (Some(elastic), Some((hardening, kinematic))) => Constant::Given(Law::Plastic(Plastic {
            moduli: elastic.small_strain(),
            hardening: hardening.into(),
            kinematic,
        })),
        _ => Constant::Wrong,
    }
}

/// Reads rows `yield stress, plastic strain[, T]`; returns the table of plastic strains and yield stresses, and the
/// modulus of kinematic hardening.
fn hardening(card: &Card, cx: &mut Context) -> Option<(Vec<[f64; 2]>, f64)> {
    if card.faulty {
        return None;
    }
    let (errors, code) = (cx.errors(), Code::MaterialRange);
    let mut table: Vec<[f64; 2]> = Vec::new();
    let mut at = None;
    for row in card.rows.iter() {
        row.at_most(3, cx.d);
        let stress = row.required(0, "the yield stress", cx.d).and_then(|field| {
            field.real_that(|s| s > 0.0, "the yield stress must be positive", code, cx.d)
        });
        let strain = row.real_or(1, 0.0, cx.d);
        let temperature = row.real_or(2, 0.0, cx.d);
        let (Some(stress), Some(strain), Some(temperature)) = (stress, strain, temperature) else {
            continue;
        };
        if *at.get_or_insert(temperature) != temperature {
            let message = "constants that depend on temperature cannot be used";
            cx.error(Code::UnsupportedParameter, row.span(), message);
            return None;
        }
        match table.last() {
            None if strain != 0.0 => {
                let message = "the first plastic strain is zero";
                cx.error(code, row.span_at(1), message);
            }
            Some([before, _]) if strain <= *before => {
                let message = "plastic strains must grow from row to row";
                cx.error(code, row.span_at(1), message);
            }
            Some([_, before]) if stress < *before => {
                let message = "the yield stress must not fall with the plastic strain";
                cx.error(code, row.span_at(0), message)
                    .help("a metal that softens has no solution that does not depend on the mesh");
            }
            _ => {}
        }
        table.push([strain, stress]);
    }
    if table.is_empty() || cx.errors() != errors {
        return None;
    }
    if card.choice("HARDENING") != Some("KINEMATIC") {
        return Some((table, 0.0));
    }
    let [[_, first], [strain, second]] = table[..] else {
        let message = "linear kinematic hardening has two rows";
        cx.error(code, card.span, message)
            .help("give the yield stress at plastic strain 0 and at another one");
        return None;
    };
    if second == first {
        return Some((vec![[0.0, first]], 0.0));
    }
    Some((vec![[0.0, first]], (second - first) / strain))
}

/// Place of the constant that determines Poisson's ratio: the second constant of the law.
fn poisson_span(block: &CardBlock) -> Option<Span> {
    let mut cards = block.parts.iter();
    let card = cards.find(|card| KEYWORDS.contains(&card.keyword.name))?;
    Some(card.rows.first()?.get(1)?.span)
}

/// Reports a second law of a material.
fn report_second(first: &Card, card: &Card, cx: &mut Context) {
    if first.keyword.name == card.keyword.name {
        return cx.only_once(&[first, card]);
    }
    let message = format!("a material has one law: {} is given already", first.title());
    cx.error(Code::RepeatedCard, card.span, message)
        .help("take one of the two out, or give each a material of its own");
}

/// Reads a row `E, nu[, T]`.
fn elastic_row(row: Line, cx: &mut Context) -> Option<Law> {
    row.at_most(3, cx.d);
    let code = Code::MaterialRange;
    let young = row.required(0, "Young's modulus", cx.d).and_then(|field| {
        let rule = "Young's modulus must be positive";
        field.real_that(|young| young > 0.0, rule, code, cx.d)
    });
    let poisson = row.get(1).map_or(Some(0.0), |field| {
        let rule = "Poisson's ratio must lie between -1 and 0.5";
        field.real_that(|nu| -1.0 < nu && nu < 0.5, rule, code, cx.d)
    });
    temperature(row, 2, cx)?;
    Some(Law::elastic(young?, poisson?))
}

/// Reads a row `E, nu[, T]` for the neo-Hookean material that has these moduli at small strains.
fn elastic_neo_hooke_row(row: Line, cx: &mut Context) -> Option<Law> {
    let SmallStrainModuli { young, poisson } = elastic_row(row, cx)?.small_strain();
    let law = NeoHooke::of_small_strain(SmallStrainModuli { young, poisson });
    Some(Law::NeoHooke(law))
}

/// Reads a row `E, nu[, T]` for Hencky's material.
fn hencky_row(row: Line, cx: &mut Context) -> Option<Law> {
    let moduli = elastic_row(row, cx)?.small_strain();
    Some(Law::Hencky(Hencky { moduli }))
}

/// The law of `*HYPERELASTIC`, by its form. A card with a faulty keyword line is not read further.
fn hyperelastic(card: &Card, cx: &mut Context) -> Constant<Law> {
    if card.faulty {
        return Constant::Wrong;
    }
    let forms = ["NEO HOOKE", "MOONEY-RIVLIN", "YEOH", "POLYNOMIAL", "OGDEN"];
    let given: Vec<&str> = forms.into_iter().filter(|form| card.has(form)).collect();
    let order = card.choice("N").unwrap_or("1");
    if given != ["OGDEN"] && order != "1" {
        let message = format!("N={order} is an order of OGDEN alone");
        cx.error(Code::UnsupportedParameter, card.span_of("N"), message)
            .help("give MOONEY-RIVLIN or YEOH");
        return Constant::Wrong;
    }
    let read = match given[..] {
        ["OGDEN"] => return ogden(card, order, cx),
        ["NEO HOOKE"] => neo_hooke_row,
        ["YEOH"] => yeoh_row,
        [] | ["POLYNOMIAL" | "MOONEY-RIVLIN"] => mooney_rivlin_row,
        _ => {
            let message =
                "*HYPERELASTIC has one form: NEO HOOKE, MOONEY-RIVLIN, YEOH, OGDEN or POLYNOMIAL";
            cx.error(Code::MissingParameter, card.span, message).help(
                "the data line of NEO HOOKE is C10, D1 with C10 = mu/2, D1 = 2/K of small strains",
            );
            return Constant::Wrong;
        }
    };
    constant(&[card], read, cx)
}

/// Reads a row `C10, D1[, T]`.
fn neo_hooke_row(row: Line, cx: &mut Context) -> Option<Law> {
    row.at_most(3, cx.d);
    let c10 = row.required(0, "C10", cx.d);
    temperature(row, 2, cx)?;
    let c10 = positive_c10(c10?, cx)?;
    let d1 = d1(row, 1, c10, cx)?;
    Some(Law::NeoHooke(NeoHooke { c10, d1 }))
}

/// Reads a row `C10, C01, D1[, T]`.
fn mooney_rivlin_row(row: Line, cx: &mut Context) -> Option<Law> {
    row.at_most(4, cx.d);
    let c10 = row.required(0, "C10", cx.d)?;
    let c01 = row.required(1, "C01", cx.d)?;
    temperature(row, 3, cx)?;
    let (first, second) = (c10.real(cx.d)?, c01.real(cx.d)?);
    if first + second <= 0.0 {
        let message = "C10 + C01, half the shear modulus, must be positive";
        cx.error(Code::MaterialRange, c10.span, message);
        return None;
    }
    let d1 = d1(row, 2, first + second, cx)?;
    Some(Law::Polynomial(Polynomial {
        shape: [first, 0.0, 0.0],
        c01: second,
        d: [d1, 0.0, 0.0],
    }))
}

/// Reads `mu1, alpha1, ..., D1, ...[, T]` of `order` terms: at most eight constants in a row; the ninth constant and
/// the temperature stand in the next row.
fn ogden(card: &Card, order: &str, cx: &mut Context) -> Constant<Law> {
    let terms = match order {
        "1" => 1,
        "2" => 2,
        _ => 3,
    };
    let rows: Vec<Line> = card.rows.iter().collect();
    let mut found = Constant::Wrong;
    for rows in rows.chunks(if terms == 3 { 2 } else { 1 }) {
        match (ogden_rows(rows, terms, cx), &found) {
            (None, _) => return Constant::Wrong,
            (Some(law), Constant::Given(first)) if law != *first => {
                let message = "constants that depend on temperature cannot be used";
                cx.error(Code::UnsupportedParameter, rows[0].span(), message);
            }
            (Some(law), _) => found = Constant::Given(law),
        }
    }
    found
}

fn ogden_rows(rows: &[Line], terms: usize, cx: &mut Context) -> Option<Law> {
    let (first, code) = (rows[0], Code::MaterialRange);
    let last = *rows.last()?;
    let in_last = 3 * terms % 8;
    first.at_most(if terms == 3 { 8 } else { in_last + 1 }, cx.d);
    if rows.len() > 1 {
        last.at_most(in_last + 1, cx.d);
    }
    if rows.len() > 1 || terms < 3 {
        temperature(last, in_last, cx)?;
    }
    let mut law = Ogden {
        terms: [[0.0; 2]; 3],
        volume: VolumeEnergy::default(),
    };
    for (k, term) in law.terms.iter_mut().take(terms).enumerate() {
        let mu = first.required(2 * k, "mu", cx.d)?.real(cx.d)?;
        let alpha = first.required(2 * k + 1, "alpha", cx.d)?;
        let rule = "alpha must not be zero";
        *term = [mu, alpha.real_that(|alpha| alpha != 0.0, rule, code, cx.d)?];
    }
    let shear: f64 = law.terms.iter().map(|[mu, _]| mu).sum();
    if shear <= 0.0 {
        let message = "the sum of the mu, the shear modulus at small strains, must be positive";
        cx.error(code, first.span(), message);
        return None;
    }
    let [d1_at, d2_at] = [2 * terms, 2 * terms + 1];
    law.volume.d[0] = d1(first, d1_at, shear / 2.0, cx)?;
    if terms > 1 {
        law.volume.d[1] = higher_d(first, d2_at, cx)?;
    }
    if rows.len() > 1 {
        law.volume.d[2] = higher_d(last, 0, cx)?;
    }
    Some(Law::Ogden(law))
}

/// Constant D2 or D3; zero if the field is empty.
fn higher_d(row: Line, index: usize, cx: &mut Context) -> Option<f64> {
    let rule = "D2 and D3 must not be negative; 0 is none";
    let field = row.get(index).filter(|field| !field.text.is_empty());
    field.map_or(Some(0.0), |field| {
        field.real_that(|d| d >= 0.0, rule, Code::MaterialRange, cx.d)
    })
}

/// Reads a row `C10, C20, C30, D1, D2, D3[, T]`; constants other than C10 and D1 may be zero, which leaves out their
/// terms.
fn yeoh_row(row: Line, cx: &mut Context) -> Option<Law> {
    row.at_most(7, cx.d);
    let c10 = row.required(0, "C10", cx.d);
    temperature(row, 6, cx)?;
    let c10 = positive_c10(c10?, cx)?;
    let [c20, c30] = [row.real_or(1, 0.0, cx.d)?, row.real_or(2, 0.0, cx.d)?];
    let d1 = d1(row, 3, c10, cx)?;
    Some(Law::Polynomial(Polynomial {
        shape: [c10, c20, c30],
        c01: 0.0,
        d: [d1, higher_d(row, 4, cx)?, higher_d(row, 5, cx)?],
    }))
}

fn positive_c10(c10: Text, cx: &mut Context) -> Option<f64> {
    let rule = "C10 must be positive";
    c10.real_that(|c10| c10 > 0.0, rule, Code::MaterialRange, cx.d)
}

/// Ratio K/mu of a material with D1 = 0. In plane stress, at stretches from 0.5 to 1.5, the force of a material with
/// K/mu = 1e4 differs from the force of an incompressible material by at most 5e-5 of the force.
const NEARLY_INCOMPRESSIBLE: f64 = 1e4;

/// Reads D1 in field `index` of a material with the shear modulus mu = 2 c; zero means K = 1e4 mu:
///
/// ```text
/// D1 = 2/K = 1/(1e4 c)
/// ```
fn d1(row: Line, index: usize, c: f64, cx: &mut Context) -> Option<f64> {
    let Some(field) = row.get(index).filter(|field| !field.text.is_empty()) else {
        let message = "D1 is missing: the material would be incompressible";
        cx.error(Code::MissingField, row.span(), message).help(BULK);
        return None;
    };
    let d1 = field.real(cx.d)?;
    if d1 == 0.0 {
        let message = "D1 = 0: the bulk modulus is 10000 shear moduli";
        cx.d.note(Code::Incompressible, field.span, message).help(
            "in plane strain this needs CPE4H, CPE8H or CPE8R; K = 20 mu (D1 = 0.05/C10 of NEO HOOKE) is usual for rubber",
        );
        return Some(1.0 / (NEARLY_INCOMPRESSIBLE * c));
    }
    if d1 < 0.0 {
        let message = format!("D1 must not be negative, found {}", field.text);
        cx.error(Code::MaterialRange, field.span, message)
            .help(BULK);
        return None;
    }
    Some(d1)
}

/// Help on the meaning of D1.
const BULK: &str = "D1 = 2/K with the bulk modulus K; where it is not known, K = 20 mu (D1 = 0.05/C10 of NEO HOOKE) is \
                    usual for rubber; D1 = 0 stands for K = 10000 mu, which is all but incompressible and needs CPE4H, \
                    CPE8H or CPE8R in plane strain";

/// Reads the damping of a material, which may have one card, and the place of its mass-proportional part.
fn damping(cards: &[&Card], cx: &mut Context) -> Option<(Damping, Span)> {
    cx.only_once(cards);
    let card = cards.first()?;
    if !card.faulty && !card.has("ALPHA") && !card.has("BETA") {
        let message = "*DAMPING has neither ALPHA nor BETA";
        cx.error(Code::MissingParameter, card.span, message)
            .help("ALPHA damps in proportion to the mass, BETA to the elasticity");
    }
    let mut factor = |name: &str| {
        let rule = format!("{name} must not be negative");
        let given = card.value(name);
        let factor =
            given.and_then(|text| text.real_that(|x| x >= 0.0, &rule, Code::MaterialRange, cx.d));
        factor.unwrap_or(0.0)
    };
    let damping = Damping {
        alpha: factor("ALPHA"),
        beta: factor("BETA"),
    };
    Some((damping, card.span_of("ALPHA")))
}

/// A constant of a material.
#[derive(Clone, PartialEq)]
enum Constant<T> {
    Missing,
    Wrong,
    Given(T),
}

impl<T> Constant<T> {
    /// The constant, if the deck gives it without an error.
    pub fn given(self) -> Option<T> {
        match self {
            Constant::Given(value) => Some(value),
            Constant::Missing | Constant::Wrong => None,
        }
    }
}

/// The value of a constant, on which all rows of a card must agree.
fn constant<T: PartialEq>(
    cards: &[&Card],
    read: fn(Line, &mut Context) -> Option<T>,
    cx: &mut Context,
) -> Constant<T> {
    let Some(card) = cards.first() else {
        return Constant::Missing;
    };
    let mut found = Constant::Wrong;
    for row in card.rows.iter() {
        match (read(row, cx), &found) {
            (None, _) => return Constant::Wrong,
            (Some(value), Constant::Given(first)) if value != *first => {
                let message = "constants that depend on temperature cannot be used";
                cx.error(Code::UnsupportedParameter, row.span(), message);
            }
            (Some(value), _) => found = Constant::Given(value),
        }
    }
    found
}

/// Reads the temperature in field `index`, whose value has no effect: the constants must be the same at all
/// temperatures.
fn temperature(row: Line, index: usize, cx: &mut Context) -> Option<()> {
    row.real_or(index, 0.0, cx.d).map(|_| ())
}
