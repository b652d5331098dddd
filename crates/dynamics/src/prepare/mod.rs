//! Preparation of a model before its run: adjustment of slave nodes onto their masters, contact surfaces, initial gaps,
//! the check for initial penetration, the redistribution of mass, and the memory that a run needs.

mod adjustment;
mod initial_gaps;
mod initial_penetration;
mod memory_need;
mod prepared_model;
mod redistribution;

pub use adjustment::Adjusted;
pub use initial_gaps::InitialGap;
pub(crate) use initial_penetration::deepest_fault;
pub use memory_need::MemoryNeed;
pub use prepared_model::{PreparedModel, prepare};
pub use redistribution::Redistribution;
#[cfg(test)]
pub(crate) use redistribution::tests as redistribution_tests;
