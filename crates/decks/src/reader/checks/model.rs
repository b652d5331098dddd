//! Checks whether the model makes sense as a whole: increments and duration against the time that waves take, something
//! that moves, densities, damping of bodies in free flight, slaves that contact cannot move, and the thickness of both
//! sides of a contact.

use crate::diagnostics::Code;
use crate::model::{
    ALL_EXTERIOR, Bodies, Contact, Equation, Face, Load, Mesh, Model, Procedure, Section, Step,
    Surface, SurfaceKind,
};
use crate::reader::context::Context;
use crate::reader::materials::MaterialPlaces;
use crate::reader::outline::StepCards;
use crate::reader::sections::Properties;
use std::collections::BTreeSet;

/// Number of element sides that waves cross in one increment above which the increment must be a mistake: implicit
/// increments of slow motions reach some thousands.
const MOST_SIDES: f64 = 1e6;

/// Warns about steps that end before a wave has crossed the shortest side of an element, and about increments in which
/// a wave crosses more than a million sides. `guide` is the shortest time in which a wave crosses a side.
pub(crate) fn proportion(
    steps: &[Step],
    cards: &[StepCards],
    guide: Option<f64>,
    cx: &mut Context,
) {
    let Some(guide) = guide else {
        return;
    };
    let timed = |(step, _): &(&Step, _)| step.procedure != Procedure::Static;
    for (step, cards) in steps.iter().zip(cards).filter(timed) {
        let mut procedures = cards.cards.iter();
        let card = procedures.find(|card| card.keyword.name == "DYNAMIC");
        let row = card.and_then(|card| card.rows.first());
        let span = |index: usize| {
            let field = row.and_then(|row| row.get(index));
            field.map_or(cards.head.span, |field| field.span)
        };
        let (dt, period) = (step.increments.dt, step.increments.period);
        let (span, message) = if period < guide {
            let sides = period / guide;
            (
                span(1),
                format!("in this step a wave crosses {sides:.1e} of the shortest element side"),
            )
        } else if dt > MOST_SIDES * guide {
            let sides = dt / guide;
            (
                span(0),
                format!(
                    "in one increment a wave crosses {sides:.1e} times the shortest element side"
                ),
            )
        } else {
            continue;
        };
        cx.warning(Code::OutOfProportion, span, message).help(format!(
            "it takes {guide:.2e} for one side: are times, lengths and material in one system of \
             units?"
        ));
    }
}

/// Warns at the first step about a model in which no step moves anything.
pub(crate) fn motion(model: &Model, cards: &[StepCards], cx: &mut Context) {
    let Some(first) = cards.first() else {
        return;
    };
    let moves = || model.initial_velocity.iter().any(|v| *v != 0.0);
    if model.steps.iter().any(has_cause) || moves() {
        return;
    }
    let message = "nothing moves: there is no load, no velocity and no prescribed motion";
    cx.warning(Code::NothingToDo, first.head.span, message)
        .help(
            "add *DLOAD, *DSLOAD or *CLOAD, a *BOUNDARY that moves, or *INITIAL CONDITIONS, \
         TYPE=VELOCITY",
        );
}

/// Whether something in a step sets bodies in motion.
fn has_cause(step: &Step) -> bool {
    step.supports
        .iter()
        .any(|support| !support.motion.is_still())
        || acts(&step.point_loads)
        || acts(&step.body_forces)
        || acts(&step.centrifugal_forces)
        || acts(&step.pressures)
        || acts(&step.tractions)
        || !step.interferences.is_empty()
        || !step.temperatures.is_empty()
}

fn acts<T>(loads: &[Load<T>]) -> bool {
    loads.iter().any(|load| load.magnitude != 0.0)
}

/// Reports materials in use without density. A missing density is an error if a step moves or weighs masses, and a note
/// in static steps.
pub(crate) fn density(properties: &Properties, mesh: &Mesh, steps: &[Step], cx: &mut Context) {
    if cx.may_lack_cards() {
        return;
    }
    let weighed = |material: usize, step: &Step| {
        let forces = step.body_forces.iter().map(|load| &load.at);
        let weighed = forces.filter(|force| force.per_mass);
        let turned = step.centrifugal_forces.iter();
        let elements = weighed.map(|force| force.element);
        let mut elements = elements.chain(turned.map(|load| load.at.element));
        elements.any(|element| {
            let section = properties.sections.get(mesh.elements[element].section);
            section.is_some_and(|section| section.material == material)
        })
    };
    let materials = properties.materials.iter().zip(&properties.places);
    for (index, (material, places)) in materials.enumerate() {
        let is_used = properties
            .sections
            .iter()
            .any(|section| section.material == index);
        if !is_used || !places.has_no_density {
            continue;
        }
        let is_moved = |step: &Step| step.procedure != Procedure::Static;
        let name = &material.name;
        if steps.is_empty()
            || steps
                .iter()
                .any(|step| is_moved(step) || weighed(index, step))
        {
            let message = format!("material {name} lacks *DENSITY");
            cx.error(Code::IncompleteMaterial, places.material, message)
                .help("static steps without gravity need none");
        } else {
            let message =
                format!("material {name} has no density: masses in the results are volumes");
            cx.d.note(Code::NoDensity, places.material, message)
                .help("static steps do not use them");
        }
    }
}

/// Warns where mass-proportional damping takes momentum from bodies that have no support in a step.
pub(crate) fn braked_flight(model: &Model, places: &[MaterialPlaces], cx: &mut Context) {
    if model.materials.iter().all(|m| m.damping.alpha == 0.0) {
        return;
    }
    let bodies = Bodies::new(&model.mesh);
    let is_held = held_in_all_steps(model, &bodies);
    let rigid: BTreeSet<usize> = (model.rigid_bodies.iter())
        .flat_map(|body| body.elements.iter().copied())
        .collect();
    let mut braked = vec![BTreeSet::new(); model.materials.len()];
    let mut has_rigid = vec![false; model.materials.len()];
    for (index, element) in model.mesh.elements.iter().enumerate() {
        let (body, material) = (
            bodies.of_element[index],
            model.sections[element.section].material,
        );
        if rigid.contains(&index) {
            has_rigid[material] = true;
        } else if !is_held[body] {
            braked[material].insert(body);
        }
    }
    for (index, material) in model.materials.iter().enumerate() {
        if material.damping.alpha > 0.0 && has_rigid[index] {
            let name = &material.name;
            let message =
                format!("ALPHA of material {name} has no effect on elements of rigid bodies");
            cx.warning(Code::IgnoredParameter, places[index].damping, message)
                .help("*DASHPOT brakes a rigid body at its nodes");
        }
    }
    for ((material, braked), places) in model.materials.iter().zip(&braked).zip(places) {
        let count = braked.len();
        if material.damping.alpha > 0.0 && count > 0 {
            let bodies = if count == 1 { "a body" } else { "bodies" };
            let message = format!(
                "ALPHA of material {} takes momentum from {bodies} without support",
                material.name
            );
            cx.warning(Code::BrakedFlight, places.damping, message).help(
                "it acts against the velocity, that of free flight too; BETA damps vibration alone \
                 and keeps momentum",
            );
        }
    }
}

/// For every body, whether the body has a node with a support or an equation in all steps.
fn held_in_all_steps(model: &Model, bodies: &Bodies) -> Vec<bool> {
    let mut is_held = vec![true; bodies.count];
    let tied: Vec<usize> = model.equations.iter().flat_map(Equation::dofs).collect();
    for step in &model.steps {
        let dofs = step.supports.iter().map(|support| support.dof);
        let mut held = vec![false; bodies.count];
        for body in dofs
            .chain(tied.iter().copied())
            .filter_map(|dof| *bodies.of_node.get(dof / 2)?)
        {
            held[body] = true;
        }
        for (is_held, held) in is_held.iter_mut().zip(held) {
            *is_held &= held;
        }
    }
    is_held
}

/// Warns about contact pairs of which more than half of the slave nodes are prescribed in both directions throughout. A
/// clamped end of a surface is common and harmless.
pub(crate) fn fixed_slaves(model: &Model, cx: &mut Context) {
    let prescribed = prescribed_throughout(&model.steps);
    let is_fixed = |node: &usize| [0, 1].iter().all(|i| prescribed.contains(&(2 * node + i)));
    for contact in &model.contacts {
        let slave = &model.surfaces[contact.slave];
        if contact.is_self_contact() || slave.name == ALL_EXTERIOR {
            continue;
        }
        let nodes = model.slave_nodes(contact);
        let fixed = nodes.iter().filter(|node| is_fixed(node)).count();
        if 2 * fixed <= nodes.len() {
            continue;
        }
        let message = format!(
            "{fixed} of the {} slave nodes of {} are prescribed in both directions",
            nodes.len(),
            slave.name,
        );
        cx.warning(Code::FixedSlave, contact.span, message)
            .help("contact cannot move them: make the free surface the slave");
    }
}

/// Dofs that are prescribed in all steps.
pub(crate) fn prescribed_throughout(steps: &[Step]) -> BTreeSet<usize> {
    let of = |step: &Step| step.supports.iter().map(|support| support.dof).collect();
    let sets = steps.iter().map(of);
    let common = sets.reduce(|common: BTreeSet<usize>, of| &common & &of);
    common.unwrap_or_default()
}

/// Warns where the two sides of a contact differ in thickness.
pub(crate) fn thickness(
    contacts: &[Contact],
    surfaces: &[Surface],
    sections: &[Section],
    mesh: &Mesh,
    cx: &mut Context,
) {
    for contact in contacts {
        let range = |surface: usize| range_of_thickness(surface, surfaces, sections, mesh);
        let [slave, master] = [contact.slave, contact.master].map(range);
        if let (Some(slave), Some(master)) = (slave, master)
            && (slave != master || slave.0 < slave.1 && contact.is_self_contact())
        {
            let message = "the two sides of this contact differ in thickness";
            cx.warning(Code::ThicknessMismatch, contact.span, message)
                .help("the bodies touch over the whole thickness of each");
        }
    }
}

fn range_of_thickness(
    surface: usize,
    surfaces: &[Surface],
    sections: &[Section],
    mesh: &Mesh,
) -> Option<(f64, f64)> {
    let SurfaceKind::Faces(faces) = &surfaces[surface].kind else {
        return None;
    };
    let section = |face: &Face| sections.get(mesh.elements[face.element].section);
    let all = faces.iter().filter_map(section);
    let all: Vec<f64> = all.map(|section| section.thickness).collect();
    let low = all.iter().copied().reduce(f64::min)?;
    Some((low, all.iter().copied().fold(low, f64::max)))
}
