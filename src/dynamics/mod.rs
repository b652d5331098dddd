//! Time integration with contact and impact.

mod failure;
mod report;

pub use failure::{Cause, Failure, Worst};
pub use report::{
    ContactResultant, Cutback, Energy, IncrementReport, Landing, Momentum, NodalResults,
    NodeStatus, Observer, Outcome, PassReport, RunSummary, SolverCounts, State, Timings,
};
