//! One increment: passes, contact forces, impulses, convergence.

mod acceleration;
mod attempt;
mod contact_forces;
mod contact_states;
mod contact_system;
mod convergence;
mod equal_forces;
mod impulses;
mod linear_pass;
mod pass;
mod pin_iteration;
mod refactorization;
mod returned;
mod rigid_predictor;
mod rigid_velocity;
mod trace;

pub(crate) use attempt::{Attempt, Path, Solved};
pub(crate) use contact_forces::ContactForces;
pub(crate) use convergence::PartNoise;
pub(crate) use returned::{PairReturn, Release, Returned};
pub(crate) use trace::Failed;
