//! The loop over steps and increments: time control, acceptance and cutbacks.

mod acceptance;
mod bisection;
mod impact_control;
#[cfg(test)]
mod internal_variables_tests;
mod nominal_increment;
mod runner;
mod time_control;

pub use runner::{RunError, run};
