//! Large problems by blocks of contacts that are coupled strongly, the others weakly.

mod acceleration;
mod block_iteration;

pub use block_iteration::{BlockIteration, BlockSolution, BlockStart, LcpBlock, Progress};
