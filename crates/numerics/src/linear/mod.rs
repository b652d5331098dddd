//! Sparse symmetric matrices over the unknowns q of u = T q + g, their factorisations, and parts of their inverses. A
//! matrix has the pattern of the elements and, if needed, further blocks.

mod assembled;
mod checked;
mod largest;
mod multifrontal;
mod nodal_matrix;
mod solver;
mod sprs_ldl;
mod symmetric;
mod transformation;

pub use assembled::{AddedBlocks, Assembled};
pub use checked::CheckedSolver;
pub use largest::{SMALLEST, larger, largest};
pub use multifrontal::{MultifrontalLdl, factor_entries};
pub use nodal_matrix::NodalMatrix;
pub use solver::{LinearError, LinearSolver};
pub use sprs_ldl::SprsLdl;
pub use symmetric::{Pattern, SymmetricMatrix};
pub use transformation::{Rotation, Transformation};

/// Sparse factorisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolverChoice {
    /// Multifrontal factorisation LDL^T with the order that faer finds.
    Faer,
    /// Factorisation LDL^T of the library sprs-ldl with an AMD permutation.
    Sprs,
}

/// A solver of the kind that the deck chooses.
pub fn linear_solver(choice: SolverChoice) -> Box<dyn LinearSolver> {
    match choice {
        SolverChoice::Faer => Box::new(MultifrontalLdl::default()),
        SolverChoice::Sprs => Box::new(SprsLdl::default()),
    }
}

/// Two solvers for matrices whose patterns may be the same: then both solvers share one analysis.
pub fn two_linear_solvers(choice: SolverChoice) -> [Box<dyn LinearSolver>; 2] {
    match choice {
        SolverChoice::Faer => MultifrontalLdl::two().map(|solver| Box::new(solver) as _),
        SolverChoice::Sprs => [(); 2].map(|()| linear_solver(choice)),
    }
}
