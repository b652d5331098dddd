//! Materials and sections.

use super::lines::{Lines, named, number, set};
use super::mesh::set_of;
use crate::materials::{Law, NeoHooke, SaintVenantKirchhoff};
use crate::model::{Damping, Formulation, Material, Model, Section};

/// Writes materials and sections.
pub(super) fn write(model: &Model, lines: &mut Lines) {
    for material in &model.materials {
        write_material(material, lines);
    }
    for (index, section) in model.sections.iter().enumerate() {
        write_section(index, section, model, lines);
    }
}

fn write_material(material: &Material, lines: &mut Lines) {
    let Material {
        name,
        law,
        density,
        damping,
    } = material;
    lines.card("MATERIAL", [named("NAME", name)]);
    write_law(law, lines);
    // a material that no section names may lack constants
    if *density > 0.0 {
        lines.card("DENSITY", []);
        lines.row([number(*density)]);
    }
    let Damping { alpha, beta } = *damping;
    if alpha != 0.0 || beta != 0.0 {
        lines.card(
            "DAMPING",
            [set("ALPHA", number(alpha)), set("BETA", number(beta))],
        );
    }
}

fn write_law(law: &Law, lines: &mut Lines) {
    match *law {
        Law::SaintVenantKirchhoff(SaintVenantKirchhoff { young, poisson }) => {
            if young > 0.0 {
                lines.card("ELASTIC", []);
                lines.row([young, poisson].map(number));
            }
        }
        Law::NeoHooke(NeoHooke { c10, d1 }) => {
            lines.card("HYPERELASTIC", ["NEO HOOKE".to_owned()]);
            lines.row([c10, d1].map(number));
        }
        #[cfg(test)]
        Law::Yielding(_) => {}
    }
}

fn write_section(index: usize, section: &Section, model: &Model, lines: &mut Lines) {
    let Section {
        material,
        thickness,
    } = *section;
    let elements = model.mesh.elements.iter().enumerate();
    let members: Vec<usize> = elements
        .filter(|(_, e)| e.section == index)
        .map(|(i, _)| i)
        .collect();
    let set_name = set_of(&members, model).map(str::to_owned);
    let set_name = set_name.unwrap_or_else(|| new_set(index, &members, model, lines));
    let is_mean = |&element: &usize| {
        model.mesh.elements[element].element_type.formulation == Formulation::MeanDilatation
    };
    let formulation = match members.iter().any(is_mean) {
        true => "MEAN DILATATION",
        false => "DISPLACEMENT",
    };
    lines.card(
        "SOLID SECTION",
        [
            named("ELSET", &set_name),
            named("MATERIAL", &model.materials[material].name),
            set("FORMULATION", formulation),
        ],
    );
    lines.row([number(thickness)]);
}

/// Writes a set of the elements of a section, which no set of the model holds.
fn new_set(index: usize, members: &[usize], model: &Model, lines: &mut Lines) -> String {
    let name = format!("SECTION-{}", index + 1);
    lines.card("ELSET", [named("ELSET", &name)]);
    let labels: Vec<u64> = members
        .iter()
        .map(|&e| model.mesh.elements[e].label)
        .collect();
    lines.list(&labels);
    name
}
