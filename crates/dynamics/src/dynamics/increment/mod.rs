//! One increment: passes, contact forces, impulses, convergence.

mod acceleration;
mod attempt;
mod contact_forces;
mod contact_states;
mod contact_system;
mod convergence;
mod corrections;
mod equal_forces;
mod impulses;
mod linear_pass;
mod pass;
mod passes;
mod pin_iteration;
mod refactorization;
mod returned;
mod rigid_predictor;
mod rigid_velocity;
mod solved;
mod static_attempt;
mod static_factors;
mod trace;

pub(crate) use attempt::Attempt;
pub(crate) use contact_forces::ContactForces;
pub(crate) use convergence::PartNoise;
pub(crate) use returned::{PairReturn, Release, Returned};
pub(crate) use solved::{Path, Solved};
pub(crate) use static_factors::StaticRates;
pub(crate) use trace::Failed;
