//! One increment: passes, contact forces, impulses, convergence.

mod active_constraints;
mod attempt;
mod closed_pairs;
mod contact_forces;
mod convergence;
mod impulses;

pub(crate) use active_constraints::ActiveConstraints;
pub(crate) use attempt::{Attempt, Failed, Solved};
pub(crate) use closed_pairs::ClosedPairs;
pub(crate) use contact_forces::ContactForces;
