//! What a run reports: increments, energies, failures. Plain data.

mod failure;
mod increment_report;

pub use failure::{Cause, FailedLcp, Failure, Worst};
pub use increment_report::{
    BodyResult, ContactImpulse, ContactOnBody, ContactResultant, Cutback, Energy, IncrementReport,
    Landing, Momentum, NodalResults, NodeStatus, Observer, Outcome, PassReport, RigidReaction,
    RunSummary, SolverCounts, State, Timings,
};
