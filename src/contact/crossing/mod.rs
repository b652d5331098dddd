//! When a moving node crosses a moving segment, and whether a node has gone through one.

mod penetration_check;
#[cfg(test)]
mod penetration_check_tests;
mod quartic;
mod segment_crossing;

pub use penetration_check::{NodeContact, Penetration, find_penetration};
pub use segment_crossing::{Crossing, Direction, Motion, crossings, line_crossings};
