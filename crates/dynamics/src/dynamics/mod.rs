//! Time integration with contact and impact.

mod events;
mod free_nodes;
mod impact_search;
mod increment;
mod landing;
mod ledger;
mod patterns;
mod release;
mod release_return;
mod results;
mod run;
mod shares;
mod step;

pub use results::{
    Alternation, BodyResult, Cause, ContactImpulse, ContactOnBody, ContactResultant,
    ContactViolation, Course, Cutback, Energy, FailedLcp, Failure, FrictionResults,
    IncrementReport, Landing, Momentum, NodalResults, NodeMass, NodeStatus, Observer, Outcome,
    PassReport, ReturnedImpulse, RigidReaction, RunSummary, SolverCounts, State, Timings, Touch,
    Unbalanced, Worst,
};
pub use run::{RunError, resume, run};
pub use step::rigid_inertia;
