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
    // mass per area, and stiffness
    let of_sections = properties.sections.iter().map(|section| {
        let material = properties.materials.get(section.material)?;
        let stiffness = material.law.small_strain().young * section.thickness;
        Some((material.density * section.thickness, stiffness))
    });
    let of_sections: Vec<Option<(f64, f64)>> = of_sections.collect();
    for (index, element) in mesh_index.mesh.elements.iter().enumerate() {
        let section = properties
            .section_of(index)
            .and_then(|s| of_sections.get(s));
        let Some(&Some((density, stiffness))) = section else {
            continue;
        };
        let area = area(element, &mesh_index.mesh);
        let mass = density * area;
        total += mass;
        if [area, stiffness, mass, total]
            .iter()
            .all(|value| value.is_normal())
        {
            continue;
        }
        let magnitudes = [
            ("area of", area),
            ("stiffness E t of", stiffness),
            ("mass of", mass),
            ("mass of all elements up to", total),
        ];
        if let Some((what, value)) = magnitudes.iter().find(|(_, value)| !value.is_normal()) {
            let what = format!("the {what} element {}", mesh_index.element_name(index));
            return unusable(&what, *value, mesh_index.places.get(index), cx);
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
    let at = |node: usize| mesh.coordinates[node];
    match *element.nodes.as_slice() {
        [a, b, c, d] => polygon_area([a, b, c, d].map(at)),
        ref nodes => polygon_area(nodes.iter().map(|&node| at(node))),
    }
}
