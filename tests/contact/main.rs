//! Search, targets and crossings.

mod crossing;
#[path = "../lcp/random.rs"]
#[allow(dead_code)] // shared with the complementarity problems
mod random;
mod scenes;
mod search;
mod targets;
