//! Preparation of a model before its run: adjustment of slave nodes onto their masters, contact
//! surfaces, initial gaps, the check for initial penetration, and the redistribution of mass.

mod adjustment;
mod initial_gaps;
mod initial_penetration;
mod prepared_model;
mod redistribution;

pub use adjustment::Adjusted;
pub use initial_gaps::InitialGap;
pub use prepared_model::{PreparedModel, prepare};
pub use redistribution::Redistribution;
#[cfg(test)]
pub(crate) use redistribution::tests as redistribution_tests;
