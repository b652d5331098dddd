//! Linear complementarity problems, general and frictional. This module knows no mechanics.
//!
//! The general problem ([`Lcp`]) is to find z >= 0 with w = M z + q >= 0 and z.w = 0. [`lemke()`] solves the general
//! problem by Lemke's method, with a lexicographic ratio test on a revised basis.
//!
//! The frictional problem ([`FrictionalLcp`]) has unilateral contacts with Coulomb friction, coupled by a symmetric
//! matrix Q. [`solve_frictional`] finds the states open, stick, slip+ and slip- of the contacts: with a warm active set
//! first, with Gauss-Seidel sweeps and proximal steps if the active set cycles, and with Lemke's method if nothing else
//! succeeds. Problems of many contacts are solved by blocks ([`BlockIteration`]); the last steps of this iteration
//! accelerate it ([`Acceleration`]). Every answer is checked by a residual whose computation shares nothing with the
//! method.
//!
//! All methods work on a problem scaled by powers of two, so that the answer of a problem whose
//! lengths or forces are multiplied by powers of two is the same to the last bit.

mod active_set;
mod anderson;
mod basis;
mod block_iteration;
mod dense;
mod exchange;
mod free;
mod free_solution;
mod gauss_seidel;
mod hybrid;
mod joints;
mod kept;
mod known;
mod lemke;
mod problems;
mod proximal;
mod reduced;
mod residual;
mod scaled;

pub use anderson::{Acceleration, IterationStep};
pub use block_iteration::{BlockIteration, BlockSolution, BlockStart, LcpBlock, Progress};
pub use exchange::{JsonAnswer, solve_json};
pub use hybrid::{LcpMethod, solve_frictional, solve_similar};
pub use kept::KeptFactors;
pub use known::Known;
pub use lemke::{LemkeSettings, covering_vector, lemke};
pub use problems::{
    ContactState, Counters, FreeUnknowns, FrictionalLcp, FrictionalSolution, Lcp, LcpError,
    LcpSolution, Method, Stability,
};
pub use residual::residual;
