//! Time integration with contact and impact.

mod accounts;
mod bodies;
mod contact_forces;
mod contact_ledger;
mod convergence;
mod dofs;
mod effective;
mod entry;
mod events;
mod failure;
mod gain;
mod grid;
mod hold;
mod impact;
mod increment;
mod ledger;
mod loads;
mod mass;
mod meter;
mod parts;
mod pressure;
mod report;
mod results;
mod rigid;
mod root;
mod run;
mod scheme;
mod step_problem;
mod supports;
mod touching;

pub use failure::{Cause, FailedLcp, Failure, Worst};
pub use report::{
    BodyResult, ContactImpulse, ContactOnBody, ContactResultant, Cutback, Energy, IncrementReport,
    Landing, Momentum, NodalResults, NodeStatus, Observer, Outcome, PassReport, RigidReaction,
    RunSummary, SolverCounts, State, Timings,
};
pub use run::{RunError, run};
