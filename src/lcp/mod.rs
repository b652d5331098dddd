//! Linear complementarity problems, general and frictional. Knows no mechanics.
//!
//! The general problem ([`Lcp`]): find z >= 0 with w = M z + q >= 0 and z.w = 0; solved by
//! [`lemke()`], Lemke's method with a lexicographic ratio test on a revised basis.
//!
//! The frictional problem ([`FrictionalLcp`]): unilateral contacts with Coulomb friction, coupled
//! by a symmetric matrix Q; solved by [`solve_frictional`] on the states open, stick, slip+ and
//! slip-: a warm active set first, Gauss-Seidel sweeps when it cycles, Lemke when nothing else
//! succeeds. Every answer is checked by a residual that shares nothing with the method.
//!
//! All methods work on a problem scaled by powers of two, so that the answer of a problem whose
//! lengths or forces are multiplied by powers of two is the same to the last bit.

mod active_set;
mod basis;
mod dense;
mod exchange;
mod factors;
mod frictional;
mod frictional_lemke;
mod gauss_seidel;
mod hybrid;
mod lemke;
mod pivoting;
mod problem;
mod ratio;
mod reduced;
mod residual;
mod scaled;
mod scaling;
mod state;

pub use exchange::{JsonAnswer, solve_json};
pub use frictional::FrictionalLcp;
pub use hybrid::{FrictionalSolution, LcpMethod, Method, solve_frictional};
pub use lemke::{LemkeSettings, covering_vector, lemke};
pub use problem::{Lcp, LcpError, LcpSolution};
pub use residual::residual;
pub use state::{ContactState, Counters};
