//! Preparation of a model before its run: adjustment of slave nodes onto their masters, contact
//! surfaces, initial gaps, and the check for initial penetration.

mod adjustment;
mod initial_gaps;
mod initial_penetration;
mod prepared_model;

pub use adjustment::Adjusted;
pub use initial_gaps::InitialGap;
pub use prepared_model::{PreparedModel, prepare};
