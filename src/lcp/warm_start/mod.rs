//! Solvers that start from the states of the last problem.

mod active_set;
mod gauss_seidel;
mod hybrid;
mod kept_factors;
mod reduced;
mod similar;
mod solution;

pub use hybrid::{LcpMethod, solve_frictional, solve_similar};
pub use kept_factors::{ContactName, KeptFactors};
pub use solution::{FrictionalSolution, Method};
