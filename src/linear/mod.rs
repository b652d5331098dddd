//! Sparse symmetric matrices over the unknowns of u = T q + g with the pattern of the elements and, if
//! need be, further blocks, their factorisations, and parts of their inverses.

mod added_blocks;
mod assembled;
mod checked;
mod largest;
mod nodal_matrix;
mod rotation;
mod solvers;
mod transformation;

pub use added_blocks::AddedBlocks;
pub use assembled::Assembled;
pub use checked::CheckedSolver;
pub use largest::{SMALLEST, larger, largest};
pub use nodal_matrix::NodalMatrix;
pub use rotation::Rotation;
pub use solvers::{
    FaerLdl, LinearError, LinearSolver, SprsLdl, factor_entries, linear_solver, two_linear_solvers,
};
pub use transformation::Transformation;
