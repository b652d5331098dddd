//! When a moving node crosses a moving segment.

mod quartic;
mod segment_crossing;

pub use segment_crossing::{Crossing, Direction, Motion, crossings, line_crossings};
