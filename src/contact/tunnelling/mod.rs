//! Whether a slave node has passed into or through a body within an increment.

mod penetration_check;
#[cfg(test)]
mod penetration_check_tests;

pub use penetration_check::{Penetration, find_penetration};
