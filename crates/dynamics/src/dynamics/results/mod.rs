//! Results of a run that the output receives through [`Observer`]: of increments, of failed attempts and of the whole
//! run.

mod bodies;
mod contacts;
mod course;
mod energy;
mod failure;
mod increment_report;
mod nodal;
mod observer;
mod pass_report;
mod run_summary;
mod state;

pub use bodies::{BodyResult, Momentum, RigidReaction};
pub use contacts::{
    ContactImpulse, ContactOnBody, ContactResultant, ContactViolation, Landing, ReturnedImpulse,
    Touch,
};
pub use course::{Alternation, Course};
pub use energy::Energy;
pub use failure::{Cause, FailedLcp, Failure, Unbalanced, Worst};
pub use increment_report::{IncrementReport, SolverCounts};
pub use nodal::{FrictionResults, NodalResults, NodeMass, NodeStatus};
pub use observer::{Cutback, Observer};
pub use pass_report::PassReport;
pub use run_summary::{Outcome, RunSummary, Timings};
pub use state::State;
