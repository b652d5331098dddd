//! The complementarity problems, general and frictional, their scaling and residuals.

mod arena;
mod dense;
mod frictional;
mod general;
mod residual;
mod scaled;
mod scaling;
mod state;

pub(crate) use arena::{List, copy, filled, list};
pub(crate) use dense::{add_sizes, axpy, combine, dot, max_abs};
pub use frictional::FrictionalLcp;
pub use general::{Lcp, LcpError, LcpSolution};
pub(crate) use general::{expect_finite, expect_non_negative, expect_size};
pub use residual::residual;
pub(crate) use residual::{ROUNDING, TOLERANCE, frictional_residual, law_residual};
pub(crate) use scaled::Scaled;
pub(crate) use scaling::{Equilibration, power_of_two};
pub use state::{ContactState, Counters};
