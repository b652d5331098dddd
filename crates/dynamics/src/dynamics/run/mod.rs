//! The loop over steps and increments: time control, acceptance and cutbacks.

mod acceptance;
#[cfg(test)]
mod internal_variables_tests;
mod runner;
mod time_control;
mod truncation_error;

pub use runner::{RunError, resume, run};
