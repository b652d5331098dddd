//! What is done to a model before it runs: gaps of the slave nodes in the reference configuration,
//! nodes moved on to their masters, and the check for initial penetration.

mod adjustment;
mod initial_gaps;
mod initial_penetration;

pub use adjustment::{Adjusted, adjust, report_adjusted};
pub use initial_gaps::{InitialGap, initial_gaps};
pub use initial_penetration::report_penetrations;
