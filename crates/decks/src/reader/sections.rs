//! `*SOLID SECTION`: material, thickness and formulation of elements, and checks of elements against their materials.

use super::context::Context;
use super::materials::{Drafts, MaterialPlaces};
use super::mesh_index::MeshIndex;
use super::names::Names;
use super::outline::Outline;
use super::sets::Sets;
use crate::deck::Card;
use crate::diagnostics::Code;
use crate::materials::{Law, Plane};
use crate::model::{Element, ElementType, Formulation, Material, NO_SECTION, Section};

/// Materials and sections.
#[derive(Default)]
pub(crate) struct Properties {
    /// Materials in the order of their names.
    pub materials: Vec<Material>,
    /// Places of the materials.
    pub places: Vec<MaterialPlaces>,
    /// Sections.
    pub sections: Vec<Section>,
}

/// Reads materials and sections, and gives the sections to the elements.
pub(super) fn read(
    outline: &Outline,
    mesh_index: &mut MeshIndex,
    sets: &Sets,
    cx: &mut Context,
) -> Properties {
    let drafts = Drafts::read(outline, cx);
    let mut properties = Properties::default();
    let mut complete = true;
    for card in outline.model_cards("SOLID SECTION") {
        let section = section(card, &drafts.names, cx);
        complete &= properties.assign(section, card, mesh_index, sets, cx);
    }
    report_without_section(complete, mesh_index, cx);
    drafts.report_without_law(&properties.sections, cx);
    (properties.materials, properties.places) = drafts.complete(cx);
    properties.report_locking(mesh_index, cx);
    properties
}

/// Reads `*SOLID SECTION`, with `thickness` on its data line.
fn section(card: &Card, materials: &Names, cx: &mut Context) -> Option<Section> {
    let material = card.required("MATERIAL", cx.d);
    let material = material.and_then(|name| materials.find(name, cx));
    let row = card.rows.first();
    if let Some(row) = row {
        row.at_most(1, cx.d);
    }
    let rule = "the thickness must be positive";
    let thickness = row.and_then(|row| row.get(0)).map_or(Some(1.0), |field| {
        field.real_that(|t| t > 0.0, rule, Code::MaterialRange, cx.d)
    });
    Some(Section {
        material: material?,
        thickness: thickness?,
    })
}

impl Properties {
    /// Gives a section to its elements; returns whether the whole card could be read.
    fn assign(
        &mut self,
        section: Option<Section>,
        card: &Card,
        mesh_index: &mut MeshIndex,
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
        match card.choice("FORMULATION") {
            Some("MEAN DILATATION") => set_mean_dilatation(&elements, card, mesh_index, cx),
            Some("DISPLACEMENT") => report_mean_dilatation(&elements, card, mesh_index, cx),
            _ => {}
        }
        let is_ring = |&element: &usize| mesh_index.mesh.elements[element].element_type.is_ring();
        let has_rings = elements.iter().any(is_ring);
        if let Some(row) = card.rows.first().filter(|_| has_rings) {
            let help = "bodies of revolution go once around the axis";
            row.without_effect(0, "this thickness has no effect", help, cx.d);
        }
        let index = self.sections.len();
        self.sections.extend(section.map(|section| match has_rings {
            true => Section {
                thickness: 1.0,
                ..section
            },
            false => section,
        }));
        let mut taken = Vec::new();
        for &element in elements.iter() {
            match &mut mesh_index.mesh.elements[element].section {
                free @ &mut NO_SECTION => *free = index,
                _ => taken.push(element),
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
}

/// Gives each of the elements one volume strain (mean dilatation); all elements must be CPE4 or CAX4.
fn set_mean_dilatation(
    elements: &[usize],
    card: &Card,
    mesh_index: &mut MeshIndex,
    cx: &mut Context,
) {
    for &index in elements {
        let element_type = &mut mesh_index.mesh.elements[index].element_type;
        if [ElementType::CPE4, ElementType::CAX4].contains(element_type) {
            element_type.formulation = Formulation::MeanDilatation;
        } else if element_type.formulation != Formulation::MeanDilatation {
            let (name, label) = (element_type.name(), mesh_index.element_name(index));
            let message =
                format!("MEAN DILATATION is for CPE4 and CAX4: element {label} is {name}");
            cx.error(Code::ElementType, card.span_of("FORMULATION"), message)
                .help("give other elements a section of their own with FORMULATION=DISPLACEMENT");
            return;
        }
    }
}

/// Reports elements whose type has mean dilatation in a section with FORMULATION=DISPLACEMENT.
fn report_mean_dilatation(
    elements: &[usize],
    card: &Card,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    let of = |index: usize| mesh_index.mesh.elements[index].element_type;
    let has = |&&index: &&usize| of(index).formulation == Formulation::MeanDilatation;
    if let Some(&index) = elements.iter().find(has) {
        let label = mesh_index.element_name(index);
        let message = format!(
            "element {label} is {}, which has mean dilatation",
            of(index)
        );
        cx.error(Code::ElementType, card.span_of("FORMULATION"), message)
            .help("write CPE4 or CAX4 for strains of the displacements, or leave FORMULATION out");
    }
}

/// Reports elements without section, unless the deck has a section that could not be read.
fn report_without_section(complete: bool, mesh_index: &MeshIndex, cx: &mut Context) {
    let elements = || mesh_index.mesh.elements.iter();
    let bare = elements().position(|element| element.section == NO_SECTION);
    let is_cause = complete || !cx.d.has_errors();
    if let Some(first) = bare.filter(|_| is_cause && !cx.may_lack_cards()) {
        let name = mesh_index.element_name(first);
        let is_bare = |element: &&Element| element.section == NO_SECTION;
        let message = match elements().filter(is_bare).count() {
            1 => format!("element {name} has no section"),
            n => format!("{n} elements have no section, the first is {name}"),
        };
        cx.error(Code::NoSection, mesh_index.places[first], message)
            .help("give them a material and a thickness with *SOLID SECTION");
    }
}

/// Poisson's ratio at small strains from which on fully integrated elements lock in plane strain; at this value lambda
/// / mu = 2 nu / (1 - 2 nu) is 9.
const LOCKING: f64 = 0.45;

impl Properties {
    /// Index of the material of an element.
    fn material_of(&self, element: &Element) -> Option<usize> {
        Some(self.sections.get(element.section)?.material)
    }

    /// Warns about nearly incompressible materials, at the places of their Poisson's ratios. Elements in plane stress
    /// do not lock, because their thickness changes.
    fn report_locking(&self, mesh_index: &MeshIndex, cx: &mut Context) {
        let mut locks = vec![false; self.materials.len()];
        for element in &mesh_index.mesh.elements {
            let element_type = element.element_type;
            let may_lock = element_type.formulation == Formulation::Displacement
                && element_type.plane != Plane::Stress
                && !element_type.is_quadratic();
            if let Some(material) = self.material_of(element).filter(|_| may_lock) {
                locks[material] = true;
            }
        }
        let materials = self.materials.iter().zip(&self.places).zip(locks);
        for ((material, places), _) in materials.filter(|(_, locks)| *locks) {
            let poisson = material.law.small_strain().poisson;
            if let Law::Plastic(_) = material.law {
                let message = format!(
                    "material {} flows at constant volume, which makes its elements lock",
                    material.name
                );
                cx.warning(Code::Locking, places.poisson, message)
                    .help("CPE3, CPE4, CAX3 and CAX4 are too stiff once they flow: write CPE4H, CPE4I, CPE8R, CAX4H or CAX8R");
            } else if poisson >= LOCKING {
                let message = format!(
                    "material {} with nu = {} makes its elements lock",
                    material.name,
                    (poisson * 1e6).round() / 1e6
                );
                cx.warning(Code::Locking, places.poisson, message).help(
                    "CPE3, CPE4, CAX3 and CAX4 are integrated fully: from nu = 0.45 on they are too stiff, the \
                     more so the closer nu is to 0.5; CPE4H and CAX4H (with mean dilatation), CPE4I, CAX4I, CPE4R, CAX4R, \
                     CPE8H, CAX8H, CPE8R and CAX8R are not",
                );
            }
        }
    }
}
