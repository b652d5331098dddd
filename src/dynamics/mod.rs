//! Time integration with contact and impact.

mod contact_forces;
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
mod report;
mod results;
mod root;
mod run;
mod scheme;
mod step_problem;
mod supports;
mod touching;

pub use failure::{Cause, FailedLcp, Failure, Worst};
pub use report::{
    ContactResultant, Cutback, Energy, IncrementReport, Landing, Momentum, NodalResults,
    NodeStatus, Observer, Outcome, PassReport, RunSummary, SolverCounts, State, Timings,
};
pub use run::{RunError, run};
