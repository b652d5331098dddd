//! Results that a run reports, as plain data: increments, passes, contacts, energies, failures, totals.

mod contact_results;
mod course;
mod failure;
mod increment_report;
mod pass_report;
mod run_summary;

pub use contact_results::{
    ContactImpulse, ContactOnBody, ContactResultant, ContactViolation, Landing, ReturnedImpulse,
    Touch,
};
pub use course::{Alternation, Course};
pub use failure::{Cause, FailedLcp, Failure, Worst};
pub use increment_report::{
    BodyResult, Cutback, Energy, IncrementReport, Momentum, NodalResults, NodeMass, NodeStatus,
    Observer, RigidReaction, SolverCounts, State,
};
pub use pass_report::PassReport;
pub use run_summary::{Outcome, RunSummary, Timings};
