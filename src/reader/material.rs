//! `*MATERIAL` with its law and density, and `*SOLID SECTION`.

use super::context::Context;
use super::mesh::{Block, MeshIndex, Outline, Sets};
use super::names::Names;
use crate::deck::{Card, Row};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::materials::{Law, NeoHooke, Plane};
use crate::model::{ElementType, Formulation, Material, Section};

/// Poisson's ratio at small strains from which on fully integrated elements lock in plane strain:
/// lambda / mu = 2 nu / (1 - 2 nu) is 9 there.
const LOCKING: f64 = 0.45;

/// Materials and sections.
pub(super) struct Properties {
    /// Materials in the order of their names.
    pub materials: Vec<Material>,
    /// Sections.
    pub sections: Vec<Section>,
    /// Section of each element.
    pub section_of: Vec<Option<usize>>,
    /// Type of each element, in the formulation of its section.
    pub element_types: Vec<ElementType>,
    /// Places of the materials.
    pub material_spans: Vec<Span>,
}

/// A material as far as the deck gives it; `None` for a constant with a reported error.
struct Draft {
    name: String,
    span: Span,
    /// Place of Poisson's ratio, or of the compressibility.
    poisson_span: Span,
    law: Constant<Law>,
    density: Constant<f64>,
}

/// A constant of a material.
#[derive(Clone, Copy, PartialEq)]
enum Constant<T> {
    Missing,
    Wrong,
    Given(T),
}

impl<T> Constant<T> {
    fn given(self) -> Option<T> {
        match self {
            Constant::Given(value) => Some(value),
            Constant::Missing | Constant::Wrong => None,
        }
    }
}

/// Reads materials and sections.
pub(super) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    cx: &mut Context,
) -> Properties {
    let mut names = Names::new("material");
    let mut drafts = Vec::new();
    for block in outline.blocks("MATERIAL") {
        if let Some(name) = names.new_name(block.head, cx) {
            drafts.push(draft(name.typed.clone(), block, cx));
            names.define(name);
        }
    }
    let mut properties = Properties {
        materials: Vec::new(),
        sections: Vec::new(),
        section_of: vec![None; mesh_index.mesh.elements.len()],
        element_types: (mesh_index.mesh.elements.iter())
            .map(|element| element.element_type)
            .collect(),
        material_spans: drafts.iter().map(|draft| draft.span).collect(),
    };
    let poisson_spans: Vec<Span> = drafts.iter().map(|draft| draft.poisson_span).collect();
    let mut complete = true;
    let mut used = vec![false; drafts.len()];
    for card in outline.model_cards("SOLID SECTION") {
        let section = section(card, &names, cx);
        if let Some(used) = section.as_ref().and_then(|s| used.get_mut(s.material)) {
            *used = true;
        }
        complete &= properties.assign(section, card, mesh_index, sets, cx);
    }
    properties.report_without_section(complete, mesh_index, cx);
    report_incomplete(&drafts, &used, cx);
    properties.materials = drafts
        .into_iter()
        .map(|draft| material(draft, cx))
        .collect();
    properties.report_plane_stress(mesh_index, cx);
    properties.report_locking(&poisson_spans, cx);
    properties
}

fn draft(name: String, block: &Block, cx: &mut Context) -> Draft {
    let [elastic, hyperelastic, density] =
        ["ELASTIC", "HYPERELASTIC", "DENSITY"].map(|keyword| block.parts_of(keyword));
    for cards in [&elastic, &hyperelastic, &density] {
        cx.only_once(cards);
    }
    if let (Some(_), Some(card)) = (elastic.first(), hyperelastic.first()) {
        let message = "a material has one law: *ELASTIC is given already";
        cx.error(Code::RepeatedCard, card.span, message);
    }
    let law = elastic.first().or(hyperelastic.first());
    let row = law.and_then(|card| card.rows.first());
    let poisson = row.and_then(|row| row.get(1)).map(|field| field.span);
    Draft {
        name,
        span: block.head.span,
        poisson_span: poisson.unwrap_or(block.head.span),
        law: match hyperelastic.is_empty() {
            true => constant(&elastic, elastic_row, cx),
            false => hyperelastic_law(&hyperelastic, cx),
        },
        density: constant(&density, density_row, cx),
    }
}

/// The constant that all rows of a card agree on.
fn constant<T: PartialEq + Copy>(
    cards: &[&Card],
    read: fn(&Row, &mut Context) -> Option<T>,
    cx: &mut Context,
) -> Constant<T> {
    let Some(card) = cards.first() else {
        return Constant::Missing;
    };
    let mut found = Constant::Wrong;
    for row in &card.rows {
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

/// `E, nu[, T]`
fn elastic_row(row: &Row, cx: &mut Context) -> Option<Law> {
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

/// The law of `*HYPERELASTIC`, which must say NEO HOOKE.
fn hyperelastic_law(cards: &[&Card], cx: &mut Context) -> Constant<Law> {
    if let Some(card) = cards.first().filter(|card| !card.has("NEO HOOKE")) {
        let message = "*HYPERELASTIC needs the parameter NEO HOOKE";
        let error = Diagnostic::error(Code::MissingParameter, card.span, message);
        cx.d.push(error.help("its data line is C10, D1"));
        return Constant::Wrong;
    }
    constant(cards, neo_hooke_row, cx)
}

/// `C10, D1[, T]`
fn neo_hooke_row(row: &Row, cx: &mut Context) -> Option<Law> {
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
        let span = row.get(1).map_or(row.span(), |field| field.span);
        let message = match d1 == 0.0 {
            true => "D1 = 0 makes the material incompressible, which elements here cannot be",
            false => "D1 must be positive",
        };
        let error = Diagnostic::error(Code::MaterialRange, span, message);
        cx.d.push(error.help(
            "D1 = 2/K with the bulk modulus K; where it is not known, K = 20 mu (D1 = 0.05/C10) is \
             usual for rubber",
        ));
        return None;
    }
    Some(Law::NeoHooke(NeoHooke { c10, d1 }))
}

/// A temperature in field `index`: one row serves all of them.
fn temperature(row: &Row, index: usize, cx: &mut Context) -> Option<()> {
    row.real_or(index, 0.0, cx.d)?;
    let message = "this temperature has no effect";
    row.without_effect(index, message, "there are no temperatures", cx.d);
    Some(())
}

/// Reports the number in a field.
fn out_of_range(rule: &str, row: &Row, index: usize, cx: &mut Context) {
    if let Some(field) = row.get(index) {
        let message = format!("{rule}, found {}", field.text);
        cx.error(Code::MaterialRange, field.span, message);
    }
}

/// `rho[, T]`
fn density_row(row: &Row, cx: &mut Context) -> Option<f64> {
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

/// Constants that a material in use lacks.
fn report_incomplete(drafts: &[Draft], used: &[bool], cx: &mut Context) {
    if cx.may_lack_cards() {
        return;
    }
    for (draft, _) in drafts.iter().zip(used).filter(|(_, used)| **used) {
        let mut missing = Vec::new();
        if draft.law == Constant::Missing {
            missing.push("*ELASTIC");
        }
        if draft.density == Constant::Missing {
            missing.push("*DENSITY");
        }
        if !missing.is_empty() {
            let message = format!("material {} lacks {}", draft.name, missing.join(" and "));
            cx.error(Code::IncompleteMaterial, draft.span, message);
        }
    }
}

/// A complete material; unknown constants are zero, which a model without errors never has in use.
fn material(draft: Draft, cx: &mut Context) -> Material {
    let material = Material {
        name: draft.name,
        law: draft.law.given().unwrap_or(Law::elastic(0.0, 0.0)),
        density: draft.density.given().unwrap_or(0.0),
    };
    hint_at_units(&material, draft.span, cx);
    material
}

/// Notes a wave speed that hints at mixed units.
fn hint_at_units(material: &Material, span: Span, cx: &mut Context) {
    let speed = material.wave_speed(Plane::Strain);
    if speed.is_finite() && speed > 0.0 && !(10.0..=1e8).contains(&speed) {
        let name = &material.name;
        let message = format!("the waves in material {name} run at {speed:.3e}");
        let note = Diagnostic::note(Code::UnitsHint, span, message);
        cx.d.push(note.help("most materials lie between 10 and 1e8 in common units"));
    }
}

/// `*SOLID SECTION`, with `thickness` on its data line.
fn section(card: &Card, materials: &Names, cx: &mut Context) -> Option<Section> {
    let material = card.required("MATERIAL", cx.d);
    let material = material.and_then(|name| materials.find(name, cx));
    let row = card.rows.first();
    let thickness = row.map_or(Some(1.0), |row| row.real_or(0, 1.0, cx.d));
    if let (Some(row), Some(value)) = (row, thickness) {
        row.at_most(1, cx.d);
        if value <= 0.0 {
            out_of_range("the thickness must be positive", row, 0, cx);
        }
    }
    if let Some(extra) = card.rows.get(1) {
        let message = "*SOLID SECTION has one data line, the thickness";
        cx.error(Code::StrayData, extra.span(), message);
    }
    Some(Section {
        material: material?,
        thickness: thickness?,
    })
}

impl Properties {
    /// Gives a section to its elements; says whether all of the card could be read.
    fn assign(
        &mut self,
        section: Option<Section>,
        card: &Card,
        mesh_index: &MeshIndex,
        sets: &Sets,
        cx: &mut Context,
    ) -> bool {
        let errors = cx.errors();
        let name = card.required("ELSET", cx.d);
        let found = name.and_then(|name| sets.element_names.find(name, cx));
        let Some(set) = found.and_then(|index| sets.elements.get(index)) else {
            return false;
        };
        let complete = section.is_some() && cx.errors() == errors;
        if card.choice("FORMULATION") == Some("MEAN DILATATION") {
            self.set_mean_dilatation(&set.members, card, mesh_index, cx);
        }
        let index = self.sections.len();
        self.sections.extend(section);
        let mut taken = Vec::new();
        for &element in &set.members {
            match self.section_of.get_mut(element) {
                Some(Some(_)) => taken.push(element),
                Some(free) => *free = Some(index),
                None => {}
            }
        }
        if let Some(element) = taken.first().and_then(|&e| mesh_index.mesh.elements.get(e)) {
            let message = match taken.len() {
                1 => format!("element {} has a section already", element.label),
                n => format!(
                    "{n} elements have a section already, the first is {}",
                    element.label
                ),
            };
            cx.error(Code::TwoSections, card.span_of("ELSET"), message);
        }
        complete
    }

    /// Gives elements one volume strain each; all must be CPE4.
    fn set_mean_dilatation(
        &mut self,
        elements: &[usize],
        card: &Card,
        mesh_index: &MeshIndex,
        cx: &mut Context,
    ) {
        for &index in elements {
            let Some(element_type) = self.element_types.get_mut(index) else {
                continue;
            };
            if *element_type == ElementType::CPE4 {
                element_type.formulation = Formulation::MeanDilatation;
            } else if element_type.formulation == Formulation::Displacement {
                let label = mesh_index.mesh.elements.get(index).map_or(0, |e| e.label);
                let name = element_type.name();
                let message = format!("MEAN DILATATION is for CPE4: element {label} is {name}");
                let error =
                    Diagnostic::error(Code::ElementType, card.span_of("FORMULATION"), message);
                cx.d.push(error.help(
                    "give other elements a section of their own with FORMULATION=DISPLACEMENT",
                ));
                return;
            }
        }
    }

    /// Reports elements without section, unless a section could not be read.
    fn report_without_section(&self, complete: bool, mesh_index: &MeshIndex, cx: &mut Context) {
        let bare = || {
            self.section_of
                .iter()
                .enumerate()
                .filter(|(_, s)| s.is_none())
        };
        let is_cause = complete || !cx.d.has_errors();
        let Some((first, _)) = bare().next().filter(|_| is_cause) else {
            return;
        };
        let element = mesh_index.mesh.elements.get(first);
        let span = mesh_index.element_spans.get(first);
        if let (Some(element), Some(&span), false) = (element, span, cx.may_lack_cards()) {
            let message = match bare().count() {
                1 => format!("element {} has no section", element.label),
                n => format!(
                    "{n} elements have no section, the first is {}",
                    element.label
                ),
            };
            let error = Diagnostic::error(Code::NoSection, span, message);
            cx.d.push(error.help("give them a material and a thickness with *SOLID SECTION"));
        }
    }

    /// Reports materials in plane stress elements that are for plane strain only.
    fn report_plane_stress(&self, mesh_index: &MeshIndex, cx: &mut Context) {
        let places = mesh_index.element_spans.iter().zip(&self.section_of);
        for (element, (&span, section)) in mesh_index.mesh.elements.iter().zip(places) {
            let section = section.and_then(|s| self.sections.get(s));
            let material = section.and_then(|s| self.materials.get(s.material));
            if let (Plane::Stress, Some(material)) = (element.element_type.plane, material)
                && !material.law.has_plane_stress()
            {
                let message = format!(
                    "element {} is in plane stress, material {} is for plane strain only",
                    element.label, material.name
                );
                let error = Diagnostic::error(Code::PlaneStrainOnly, span, message);
                cx.d.push(error.help("take CPE elements, or *ELASTIC"));
                return;
            }
        }
    }

    /// Warns about nearly incompressible materials in plane strain, at their Poisson's ratios; in
    /// plane stress the thickness gives way and nothing locks.
    fn report_locking(&self, poisson_spans: &[Span], cx: &mut Context) {
        let mut locks = vec![false; self.materials.len()];
        for (element_type, section) in self.element_types.iter().zip(&self.section_of) {
            let section = section.and_then(|s| self.sections.get(s));
            let locks = section.and_then(|s| locks.get_mut(s.material));
            if let (Plane::Strain, Formulation::Displacement, Some(locks)) =
                (element_type.plane, element_type.formulation, locks)
            {
                *locks = true;
            }
        }
        let materials = self.materials.iter().zip(poisson_spans).zip(locks);
        for ((material, &span), _) in materials.filter(|(_, locks)| *locks) {
            let poisson = material.law.small_strain().poisson;
            if poisson >= LOCKING {
                let message = format!(
                    "material {} with nu = {} makes plane strain elements lock",
                    material.name,
                    (poisson * 1e6).round() / 1e6
                );
                let warning = Diagnostic::warning(Code::Locking, span, message);
                cx.d.push(warning.help(
                    "CPE3 and CPE4 are integrated fully: from nu = 0.45 on they are too stiff, the \
                     more so the closer nu is to 0.5; CPE4 is not with FORMULATION=MEAN DILATATION \
                     on its *SOLID SECTION",
                ));
            }
        }
    }
}
