//! Candidate segments of every slave node, by hierarchies of bounding circles.

mod bounding_circles;
mod candidate_search;

pub(crate) use bounding_circles::{Circle, CircleTree};
pub use candidate_search::{Candidate, ListedSlave, Search, Territory, all_segments};
