//! Factorisations of symmetric matrices, a multifrontal one with faer's analysis and sprs-ldl's, behind one trait,
//! substitutions with their factors, and parts of the inverses.

mod choice;
mod faer_ldl;
mod multifrontal;
mod ordering;
mod solver;
mod sprs_ldl;

pub use choice::{linear_solver, two_linear_solvers};
pub use faer_ldl::{FaerLdl, factor_entries};
pub use solver::{LinearError, LinearSolver};
pub use sprs_ldl::SprsLdl;
