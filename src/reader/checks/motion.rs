//! Whether anything moves at all.

use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Load, Model, Step, SupportMotion};
use crate::reader::context::Context;
use crate::reader::mesh::StepCards;

/// Warns at the first step about a model in which nothing ever moves.
pub(crate) fn motion(model: &Model, cards: &[StepCards], cx: &mut Context) {
    let Some(first) = cards.first().filter(|_| !cx.d.has_errors()) else {
        return;
    };
    let moves = || model.initial_velocity.iter().any(|v| *v != 0.0);
    if model.steps.iter().any(has_cause) || moves() {
        return;
    }
    let message = "nothing moves: there is no load, no velocity and no prescribed motion";
    let warning = Diagnostic::warning(Code::NothingToDo, first.head.span, message);
    cx.d.push(warning.help(
        "add *DLOAD, *DSLOAD or *CLOAD, a *BOUNDARY that moves, or *INITIAL CONDITIONS, \
         TYPE=VELOCITY",
    ));
}

/// Whether something in a step sets bodies in motion.
fn has_cause(step: &Step) -> bool {
    let moves = |motion: SupportMotion| match motion {
        SupportMotion::Ramp { to } => to != 0.0,
        SupportMotion::Amplitude { value, .. } | SupportMotion::Rate { value, .. } => value != 0.0,
    };
    step.supports.iter().any(|support| moves(support.motion))
        || acts(&step.point_loads)
        || acts(&step.body_forces)
        || acts(&step.pressures)
        || acts(&step.tractions)
}

fn acts<T>(loads: &[Load<T>]) -> bool {
    loads.iter().any(|load| load.magnitude != 0.0)
}
