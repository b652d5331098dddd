//! The loop over steps and increments, with cutbacks.

mod nominal_increment;
mod runner;

pub use runner::{RunError, run};
