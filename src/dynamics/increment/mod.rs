//! One increment: passes, contact forces, impulses, convergence.

mod active_constraints;
mod alternation;
mod attempt;
mod contact_forces;
mod contact_system;
mod convergence;
mod impulses;
mod refactorization;
mod returned;
mod rigid_predictor;
mod trace;

pub(crate) use active_constraints::{ActiveConstraints, ConstraintSet};
pub(crate) use attempt::{Attempt, Solved};
pub(crate) use contact_forces::ContactForces;
pub(crate) use returned::{PairReturn, Returned};
pub(crate) use trace::Failed;
