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

/// Two of them, for matrices whose patterns may be the same: one takes over the analysis of the other.
pub fn two_linear_solvers(choice: SolverChoice) -> [Box<dyn LinearSolver>; 2] {
    match choice {
        SolverChoice::Faer => FaerLdl::two().map(|solver| Box::new(solver) as _),
        SolverChoice::Sprs => [(); 2].map(|()| linear_solver(choice)),
    }
}
