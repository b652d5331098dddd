//! Damping of bodies in free flight.

use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Bodies, Equation, Model};
use crate::reader::context::Context;
use std::collections::BTreeSet;

/// Warns where mass-proportional damping takes momentum from bodies that have no support in a step.
pub(crate) fn braked_flight(model: &Model, damping_spans: &[Span], cx: &mut Context) {
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
