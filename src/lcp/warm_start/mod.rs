//! Solvers that start from the states of the last problem.

mod active_set;
mod gauss_seidel;
mod hybrid;
mod kept_factors;
mod reduced;
mod similar;

pub use hybrid::{FrictionalSolution, LcpMethod, Method, solve_frictional, solve_similar};
pub use kept_factors::KeptFactors;
