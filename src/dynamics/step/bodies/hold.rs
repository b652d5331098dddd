//! How bodies are held by supports and equations.

use crate::dynamics::step::step_problem::StepProblem;

/// How a body is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hold {
    /// Neither by supports nor by equations.
    Free,
    /// Both dofs of this node are prescribed, and no others.
    Pinned(usize),
    /// More is prescribed, or equations tie it.
    Held,
}

/// How the bodies of a step are held.
pub(crate) fn holds(problem: &StepProblem) -> Vec<Hold> {
    let (parts, unknowns) = (problem.parts, &problem.unknowns);
    let mut holds = vec![Hold::Free; parts.bodies()];
    let mut constrained = unknowns.constrained().iter().peekable();
    while let Some(&dof) = constrained.next() {
        let body = parts.of_nodes()[dof / 2];
        let both = dof % 2 == 0 && constrained.next_if(|next| **next == dof + 1).is_some();
        holds[body] = match holds[body] {
            Hold::Free if both => Hold::Pinned(dof / 2),
            _ => Hold::Held,
        };
    }
    for dof in problem
        .model
        .equations
        .iter()
        .flat_map(|equation| equation.dofs())
    {
        holds[parts.of_nodes()[dof / 2]] = Hold::Held;
    }
    holds
}
