//! Changes of the model by the command line.

use crate::cli::args::RunArgs;
use crate::model::{Frames, SolverChoice, Step};
use crate::output::{frames, solver};

/// Applies the command line to the steps; returns a note for each value of the deck that it
/// replaces.
pub(super) fn apply(args: &RunArgs, steps: &mut [Step]) -> Vec<String> {
    let mut notes = vec![];
    for (i, step) in steps.iter_mut().enumerate() {
        let number = i + 1;
        if let Some(wanted) = args.frames() {
            notes.extend(frames_note(number, &step.frames, &wanted));
            step.frames = wanted;
        }
        if let Some(wanted) = args.solver.map(SolverChoice::from) {
            notes.extend(solver_note(number, step.settings.solver, wanted));
            step.settings.solver = wanted;
        }
    }
    notes
}

fn frames_note(step: usize, deck: &Frames, wanted: &Frames) -> Option<String> {
    (deck != wanted && *deck != Frames::Default).then(|| {
        format!(
            "override step {step}: {} as the command line says, not {} as the deck does",
            frames(wanted),
            frames(deck)
        )
    })
}

fn solver_note(step: usize, deck: SolverChoice, wanted: SolverChoice) -> Option<String> {
    (deck != wanted).then(|| {
        format!(
            "override step {step}: solver {} as the command line says, not {} as the deck does",
            solver(wanted),
            solver(deck)
        )
    })
}
