//! Factorisations of symmetric matrices, faer's and sprs-ldl's behind one trait, substitutions with their
//! factors, and parts of the inverses.

mod choice;
mod faer_ldl;
mod ordering;
mod partial_inverse;
mod solver;
mod sprs_ldl;
mod substitution;
mod supernode;

pub use choice::linear_solver;
pub use faer_ldl::{FaerLdl, factor_entries};
pub use solver::{LinearError, LinearSolver};
pub use sprs_ldl::SprsLdl;
