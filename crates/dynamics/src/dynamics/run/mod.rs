//! The loop over steps and increments: time control, acceptance and cutbacks.

mod acceptance;
mod automatic;
mod bisection;
mod impact_control;
#[cfg(test)]
mod internal_variables_tests;
mod nominal_increments;
mod runner;
mod time_control;
mod truncation_error;

pub use runner::{RunError, resume, run};
