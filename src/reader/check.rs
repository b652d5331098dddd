//! Checks across keywords: the quality of the mesh, magnitudes, thicknesses.

use super::context::Context;
use super::materials::Properties;
use super::mesh::{MeshIndex, Surfaces};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Bodies, Contact, Element, Equation, Mesh, Model, Plane, SurfaceKind};
use crate::vectors::polygon_area;
use std::collections::{BTreeSet, HashMap};

/// Smallest cross product of two sides, relative to the square of the longest side.
const FLAT: f64 = 1e-10;

/// Reports elements that are clockwise, degenerate, not convex or defined twice.
pub(super) fn mesh(mesh_index: &MeshIndex, cx: &mut Context) {
    let mut known: HashMap<Vec<usize>, u64> = HashMap::new();
    for (element, &span) in mesh_index
        .mesh
        .elements
        .iter()
        .zip(&mesh_index.element_spans)
    {
        shape(element, &mesh_index.mesh, span, cx);
        let mut nodes = element.nodes.clone();
        nodes.sort_unstable();
        if let Some(first) = known.insert(nodes, element.label) {
            let message = format!("element {} has the nodes of element {first}", element.label);
            cx.error(Code::RepeatedElement, span, message);
        }
    }
}

fn shape(element: &Element, mesh: &Mesh, span: Span, cx: &mut Context) {
    let at: Vec<[f64; 2]> = element.nodes.iter().map(|&n| mesh.coordinates[n]).collect();
    let count = at.len();
    let side = |i: usize| {
        let (a, b) = (at[i % count], at[(i + 1) % count]);
        [b[0] - a[0], b[1] - a[1]]
    };
    let longest = (0..count)
        .map(|i| side(i)[0].hypot(side(i)[1]))
        .fold(0.0, f64::max);
    if !longest.is_finite() {
        let what = format!("the longest side of element {}", element.label);
        return unusable(&what, longest, span, cx);
    }
    let turn = |i: usize| {
        let (s, t) = (side(i), side(i + 1));
        s[0] / longest * (t[1] / longest) - s[1] / longest * (t[0] / longest)
    };
    let left = (0..count).filter(|&i| turn(i) > FLAT).count();
    let right = (0..count).filter(|&i| turn(i) < -FLAT).count();
    let label = element.label;
    let (fault, help) = if left == count {
        return;
    } else if right == count {
        (
            format!("element {label} is numbered clockwise"),
            "reverse its node order",
        )
    } else if left + right < count {
        (
            format!("element {label} is degenerate: three of its nodes lie on one line"),
            "mend the mesh",
        )
    } else if left == right {
        (
            format!("the sides of element {label} cross"),
            "list its nodes in order around it",
        )
    } else {
        (format!("element {label} is not convex"), "mend the mesh")
    };
    cx.d.push(Diagnostic::error(Code::BadShape, span, fault).help(help));
}

/// Reports materials and elements whose wave speed, area, stiffness or mass overflows or vanishes:
/// nothing can be computed with them.
pub(super) fn magnitudes(mesh_index: &MeshIndex, properties: &Properties, cx: &mut Context) {
    if cx.d.has_errors() {
        return;
    }
    for (material, &span) in properties.materials.iter().zip(&properties.material_spans) {
        let speed = material.wave_speed(Plane::Strain);
        if material.density > 0.0 && !speed.is_normal() {
            let what = format!("the wave speed of material {}", material.name);
            unusable(&what, speed, span, cx);
        }
    }
    let mut total = 0.0;
    let places = mesh_index.element_spans.iter().zip(&properties.section_of);
    for (element, (&span, section)) in mesh_index.mesh.elements.iter().zip(places) {
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
            let what = format!("the {what} element {}", element.label);
            return unusable(&what, *value, span, cx);
        }
    }
}

fn unusable(what: &str, value: f64, span: Span, cx: &mut Context) {
    let message = format!("{what} is {value:e}: it cannot be computed with");
    let error = Diagnostic::error(Code::Magnitude, span, message);
    cx.d.push(error.help("choose units in which the numbers of the deck are not so extreme"));
}

/// Area of an element.
fn area(element: &Element, mesh: &Mesh) -> f64 {
    polygon_area(element.nodes.iter().map(|&node| mesh.coordinates[node]))
}

/// Warns where the two sides of a contact differ in thickness.
pub(super) fn thickness(
    contacts: &[Contact],
    surfaces: &Surfaces,
    properties: &Properties,
    cx: &mut Context,
) {
    for contact in contacts {
        let sides = [contact.slave, contact.master];
        let [slave, master] = sides.map(|s| range_of_thickness(s, surfaces, properties));
        if let (Some(slave), Some(master)) = (slave, master)
            && (slave != master || slave.0 < slave.1 && contact.is_self_contact())
        {
            let message = "the two sides of this contact differ in thickness";
            let warning = Diagnostic::warning(Code::ThicknessMismatch, contact.span, message);
            cx.d.push(warning.help("the bodies touch over the whole thickness of each"));
        }
    }
}

fn range_of_thickness(
    surface: usize,
    surfaces: &Surfaces,
    properties: &Properties,
) -> Option<(f64, f64)> {
    let SurfaceKind::Faces(faces) = &surfaces.all.get(surface)?.kind else {
        return None;
    };
    let section = |element: usize| properties.section_of.get(element).copied().flatten();
    let all = faces
        .iter()
        .filter_map(|face| properties.sections.get(section(face.element)?));
    let all: Vec<f64> = all.map(|section| section.thickness).collect();
    let low = all.iter().copied().reduce(f64::min)?;
    Some((low, all.iter().copied().fold(low, f64::max)))
}

/// Warns where mass-proportional damping takes momentum from bodies that have no support in a step.
pub(super) fn braked_flight(model: &Model, damping_spans: &[Span], cx: &mut Context) {
    if cx.d.has_errors() || model.materials.iter().all(|m| m.damping.alpha == 0.0) {
        return;
    }
    let bodies = Bodies::new(&model.mesh);
    let is_held = held_in_all_steps(model, &bodies);
    let elements = model.mesh.elements.iter().zip(&bodies.of_element);
    let mut braked = vec![BTreeSet::new(); model.materials.len()];
    for (element, &body) in elements.filter(|(_, body)| !is_held[**body]) {
        braked[model.sections[element.section].material].insert(body);
    }
    for ((material, braked), &span) in model.materials.iter().zip(&braked).zip(damping_spans) {
        let count = braked.len();
        if material.damping.alpha > 0.0 && count > 0 {
            let bodies = if count == 1 { "a body" } else { "bodies" };
            let message = format!(
                "ALPHA of material {} takes momentum from {bodies} without support",
                material.name
            );
            let warning = Diagnostic::warning(Code::BrakedFlight, span, message);
            cx.d.push(warning.help(
                "it acts against the velocity, that of free flight too; BETA damps vibration alone \
                 and keeps momentum",
            ));
        }
    }
}

/// Whether every body has a node with a support, or an equation, in all steps.
fn held_in_all_steps(model: &Model, bodies: &Bodies) -> Vec<bool> {
    let mut is_held = vec![true; bodies.count];
    let tied: Vec<usize> = model.equations.iter().flat_map(Equation::dofs).collect();
    for step in &model.steps {
        let dofs = step.supports.iter().map(|support| support.dof);
        let mut held = vec![false; bodies.count];
        for body in dofs
            .chain(tied.iter().copied())
            .filter_map(|dof| bodies.of_node[dof / 2])
        {
            held[body] = true;
        }
        for (is_held, held) in is_held.iter_mut().zip(held) {
            *is_held &= held;
        }
    }
    is_held
}

/// Shortest time in which a wave crosses a side of an element.
pub(super) fn crossing_time(mesh: &Mesh, properties: &Properties) -> Option<f64> {
    let length = |[a, b]: [usize; 2]| {
        let (a, b) = (mesh.coordinates[a], mesh.coordinates[b]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    let of_element = |(element, section): (&Element, &Option<usize>)| {
        let material = properties.sections.get((*section)?)?.material;
        let material = properties.materials.get(material)?;
        let shortest = element.sides().map(length).reduce(f64::min)?;
        Some(shortest / material.wave_speed(element.element_type.plane))
    };
    let times = mesh.elements.iter().zip(&properties.section_of);
    let shortest = times.filter_map(of_element).reduce(f64::min)?;
    Some(shortest).filter(|time| time.is_finite() && *time > 0.0)
}
