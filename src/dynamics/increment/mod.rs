//! One increment: passes, contact forces, impulses, convergence.

mod acceleration;
mod active_constraints;
mod alternation;
mod attempt;
mod convergence;
mod forces;
mod pass;
mod refactorization;
mod returned;
mod rigid_predictor;
mod trace;

pub(crate) use active_constraints::{ActiveConstraints, ConstraintSet, NodeAtSegment};
pub(crate) use attempt::{Attempt, Path, Solved};
pub(crate) use forces::{ContactForces, ContactSystem};
pub(crate) use returned::{PairReturn, Release, Returned};
pub(crate) use trace::Failed;
