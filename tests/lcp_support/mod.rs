//! Problems with known answers for the tests and benches of the LCP solver.

#![allow(dead_code)] // Each test uses its part.

pub mod block;
pub mod problems;
pub mod random;
pub mod tableau;
