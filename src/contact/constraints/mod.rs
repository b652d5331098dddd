//! Contact constraints: gap, slip and their rows, stiffness, compliance and Delassus operator, and the
//! constraints that are closed.

mod closed_pairs;
mod compliance;
mod configurations;
mod constraint;
mod delassus;
mod kinds;
mod node_to_corner;
mod node_to_segment;
mod responses;
mod stiffness;

pub use closed_pairs::{ClosedPair, ClosedPairs};
pub use compliance::{Compliance, Scope};
pub use configurations::{Configurations, RowForm};
pub use constraint::{Constraint, ConstraintKey, PerDof, Rows};
pub use delassus::{DelassusSpace, frictional_lcp};

#[cfg(test)]
mod seam_tests;
