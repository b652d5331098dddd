//! The choice between the direct solvers.

use super::{FaerLdl, LinearSolver, SprsLdl};
use crate::model::SolverChoice;

/// The solver that the deck chooses.
pub fn linear_solver(choice: SolverChoice) -> Box<dyn LinearSolver> {
    match choice {
        SolverChoice::Faer => Box::new(FaerLdl::default()),
        SolverChoice::Sprs => Box::new(SprsLdl::default()),
    }
}
