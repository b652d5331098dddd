//! The loop over steps and increments, with cutbacks.

mod nominal_increment;
mod runner;

pub(crate) use nominal_increment::StepPlace;
pub use runner::{RunError, run};
