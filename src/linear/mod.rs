//! Sparse symmetric matrices over the unknowns of u = T q + g with the pattern of the elements and, if
//! need be, further blocks, their factorisations, and parts of their inverses.

mod added_blocks;
mod assembled;
mod checked;
mod choice;
mod faer_ldl;
mod largest;
mod ordering;
mod partial_inverse;
mod rotation;
mod solver;
mod sprs_ldl;
mod transformation;

pub use added_blocks::AddedBlocks;
pub use assembled::Assembled;
pub use checked::CheckedSolver;
pub use choice::linear_solver;
pub use faer_ldl::{FaerLdl, factor_entries};
pub use largest::{larger, largest};
pub use rotation::Rotation;
pub use solver::{LinearError, LinearSolver};
pub use sprs_ldl::SprsLdl;
pub use transformation::Transformation;
