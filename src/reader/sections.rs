//! `*SOLID SECTION`: material, thickness and formulation of elements, and whether elements suit their
//! materials.

use super::context::Context;
use super::materials::{Drafts, out_of_range};
use super::mesh_index::MeshIndex;
use super::names::Names;
use super::outline::Outline;
use super::sets::Sets;
use crate::deck::Card;
use crate::diagnostics::{Code, Span};
use crate::materials::Plane;
use crate::model::{Element, ElementType, Formulation, Material, Section};
use std::num::NonZeroU32;

/// Materials and sections.
pub(crate) struct Properties {
    /// Materials in the order of their names.
    pub materials: Vec<Material>,
    /// Sections.
    pub sections: Vec<Section>,
    /// Section of each element, counted from 1.
    section_of: Vec<Option<NonZeroU32>>,
    /// Type of each element, in the formulation of its section.
    pub element_types: Vec<ElementType>,
    /// Places of the materials.
    pub material_spans: Vec<Span>,
    /// Places of their mass-proportional damping.
    pub damping_spans: Vec<Span>,
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
    /// No materials and sections yet.
    pub(super) fn new(elements: &[Element], material_spans: Vec<Span>) -> Self {
        Properties {
            materials: Vec::new(),
            sections: Vec::new(),
            section_of: vec![None; elements.len()],
            element_types: elements.iter().map(|e| e.element_type).collect(),
            material_spans,
            damping_spans: Vec::new(),
        }
    }

    /// Section of an element.
    pub fn section_of(&self, element: usize) -> Option<usize> {
        let section = self.section_of.get(element).copied().flatten();
        section.map(|number| number.get() as usize - 1)
    }

    /// Reads the sections and gives them to their elements.
    pub(super) fn read_sections(
        &mut self,
        outline: &Outline,
        materials: &Names,
        (mesh_index, sets): (&MeshIndex, &Sets),
        cx: &mut Context,
    ) {
        let mut complete = true;
        for card in outline.model_cards("SOLID SECTION") {
            let section = section(card, materials, cx);
            complete &= self.assign(section, card, mesh_index, sets, cx);
        }
        self.report_without_section(complete, mesh_index, cx);
    }

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
        let known = name.filter(|&name| sets.element_names.find(name, cx).is_some());
        let Some(set) = known else {
            return false;
        };
        let elements = sets.elements_of(set, mesh_index, cx);
        let complete = section.is_some() && cx.errors() == errors;
        if card.choice("FORMULATION") == Some("MEAN DILATATION") {
            self.set_mean_dilatation(&elements, card, mesh_index, cx);
        }
        let index = self.sections.len();
        self.sections.extend(section);
        let mut taken = Vec::new();
        for &element in elements.iter() {
            match self.section_of.get_mut(element) {
                Some(Some(_)) => taken.push(element),
                Some(free) => *free = NonZeroU32::new(index as u32 + 1),
                None => {}
            }
        }
        if let Some(&first) = taken.first() {
            let name = mesh_index.element_name(first);
            let message = match taken.len() {
                1 => format!("element {name} has a section already"),
                n => format!("{n} elements have a section already, the first is {name}"),
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
                let label = mesh_index.element_name(index);
                let name = element_type.name();
                let message = format!("MEAN DILATATION is for CPE4: element {label} is {name}");
                cx.error(Code::ElementType, card.span_of("FORMULATION"), message)
                    .help(
                        "give other elements a section of their own with FORMULATION=DISPLACEMENT",
                    );
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
        let name = mesh_index.element_name(first);
        if !cx.may_lack_cards() {
            let message = match bare().count() {
                1 => format!("element {name} has no section"),
                n => format!("{n} elements have no section, the first is {name}"),
            };
            let span = mesh_index.places[first];
            cx.error(Code::NoSection, span, message)
                .help("give them a material and a thickness with *SOLID SECTION");
        }
    }
}

/// Poisson's ratio at small strains from which on fully integrated elements lock in plane strain:
/// lambda / mu = 2 nu / (1 - 2 nu) is 9 there.
const LOCKING: f64 = 0.45;

impl Properties {
    /// Reports materials in plane stress elements that are for plane strain only.
    pub(super) fn report_plane_stress(&self, mesh_index: &MeshIndex, cx: &mut Context) {
        let types = self.element_types.iter().enumerate();
        for (index, _) in types.filter(|(_, of)| of.plane == Plane::Stress) {
            let section = self.section_of(index).and_then(|s| self.sections.get(s));
            let material = section.and_then(|s| self.materials.get(s.material));
            if let Some(material) = material
                && !material.law.has_plane_stress()
            {
                let message = format!(
                    "element {} is in plane stress, material {} is for plane strain only",
                    mesh_index.element_name(index),
                    material.name
                );
                let span = mesh_index.places[index];
                cx.error(Code::PlaneStrainOnly, span, message)
                    .help("take CPE elements, or *ELASTIC");
                return;
            }
        }
    }

    /// Warns about nearly incompressible materials in plane strain, at their Poisson's ratios; in
    /// plane stress the thickness gives way and nothing locks.
    pub(super) fn report_locking(&self, poisson_spans: &[Span], cx: &mut Context) {
        let mut locks = vec![false; self.materials.len()];
        for (index, element_type) in self.element_types.iter().enumerate() {
            let section = self.section_of(index).and_then(|s| self.sections.get(s));
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
                cx.warning(Code::Locking, span, message).help(
                    "CPE3 and CPE4 are integrated fully: from nu = 0.45 on they are too stiff, the \
                     more so the closer nu is to 0.5; CPE4 is not with FORMULATION=MEAN DILATATION \
                     on its *SOLID SECTION",
                );
            }
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
    let drafts = Drafts::read(outline, cx);
    let mut properties = Properties::new(&mesh_index.mesh.elements, drafts.spans());
    properties.read_sections(outline, &drafts.names, (mesh_index, sets), cx);
    drafts.report_incomplete(&properties.sections, cx);
    let poisson_spans = drafts.poisson_spans();
    properties.damping_spans = drafts.damping_spans();
    properties.materials = drafts.complete(cx);
    properties.report_plane_stress(mesh_index, cx);
    properties.report_locking(&poisson_spans, cx);
    properties
}
