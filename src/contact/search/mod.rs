//! Candidate segments of every slave node, by hierarchies of bounding circles.

mod candidate_search;

pub use candidate_search::{Candidate, ListedSlave, Search, Territory, all_segments};
