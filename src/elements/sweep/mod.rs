//! Sweeps over blocks of elements: as many elements of one shape and material side by side as an
//! instruction acts on. For elements in the displacement formulation whose material has no internal
//! variables.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

mod block;
mod chunk;
mod results;
mod shape;
mod tangent;

pub use chunk::{BlockTangents, Chunk, MAX_CHUNK, TangentSweep};
pub use shape::Shape;
