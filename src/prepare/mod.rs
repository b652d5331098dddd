//! What is done to a model before it runs: gaps of the slave nodes in the reference configuration,
//! nodes moved on to their masters, and the check for initial penetration.

mod adjustment;
mod initial_gaps;
mod initial_penetration;
mod prepared_model;

pub use adjustment::Adjusted;
pub use initial_gaps::InitialGap;
pub use prepared_model::{PreparedModel, prepare};
