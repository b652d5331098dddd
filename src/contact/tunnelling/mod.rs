//! Whether a slave node has passed into or through a body within an increment, and how far edges cross at its end.

mod crossed_edges;
mod penetration_check;
#[cfg(test)]
mod penetration_check_tests;

pub use crossed_edges::crossed_edges;
pub use penetration_check::{Penetration, find_penetration};
