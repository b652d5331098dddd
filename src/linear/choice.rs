//! The choice between the direct solvers.

use super::{FaerLdl, LinearSolver, SprsLdl};
use crate::model::SolverChoice;

/// The solver of the deck's choice.
pub fn linear_solver(choice: SolverChoice) -> Box<dyn LinearSolver> {
    match choice {
        SolverChoice::Faer => Box::new(FaerLdl::default()),
        SolverChoice::Sprs => Box::new(SprsLdl::default()),
    }
}
