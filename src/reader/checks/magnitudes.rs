//! Quantities that overflow or vanish.

use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Element, Mesh, Plane};
use crate::reader::context::Context;
use crate::reader::materials::Properties;
use crate::reader::mesh::MeshIndex;
use crate::vectors::polygon_area;

/// Reports materials in use and elements whose wave speed, area, stiffness or mass overflows or vanishes:
/// nothing can be computed with them.
pub(crate) fn magnitudes(mesh_index: &MeshIndex, properties: &Properties, cx: &mut Context) {
    if cx.d.has_errors() {
        return;
    }
    let materials = properties.materials.iter().zip(&properties.material_spans);
    for (index, (material, &span)) in materials.enumerate() {
        let is_used = properties.sections.iter().any(|s| s.material == index);
        let speed = material.wave_speed(Plane::Strain);
        if is_used && !speed.is_normal() {
            let what = format!("the wave speed of material {}", material.name);
            unusable(&what, speed, span, cx);
        }
    }
    let mut total = 0.0;
    let places = mesh_index.element_spans.iter().zip(&properties.section_of);
    let elements = mesh_index.mesh.elements.iter().enumerate();
    for ((index, element), (&span, section)) in elements.zip(places) {
        let section = section.and_then(|s| properties.sections.get(s));
        let material = section.and_then(|s| properties.materials.get(s.material));
        let (Some(section), Some(material)) = (section, material) else {
            continue;
        };
        let area = area(element, &mesh_index.mesh);
        let mass = material.density * section.thickness * area;
        let stiffness = material.law.small_strain().young * section.thickness;
        total += mass;
        let magnitudes = [
            ("area of", area),
            ("stiffness E t of", stiffness),
            ("mass of", mass),
            ("mass of all elements up to", total),
        ];
        if let Some((what, value)) = magnitudes.iter().find(|(_, value)| !value.is_normal()) {
            let what = format!("the {what} element {}", mesh_index.element_name(index));
            return unusable(&what, *value, span, cx);
        }
    }
}

/// Reports a quantity that is not a normal number.
pub(super) fn unusable(what: &str, value: f64, span: Span, cx: &mut Context) {
    let message = format!("{what} is {value:e}: it cannot be computed with");
    let error = Diagnostic::error(Code::Magnitude, span, message);
    cx.d.push(error.help("choose units in which the numbers of the deck are not so extreme"));
}

/// Area of an element.
fn area(element: &Element, mesh: &Mesh) -> f64 {
    polygon_area(element.nodes.iter().map(|&node| mesh.coordinates[node]))
}
