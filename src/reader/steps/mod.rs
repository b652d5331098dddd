//! Steps with their loads, boundary conditions, amplitudes and output requests.

pub(crate) mod amplitude;
pub(crate) mod boundary;
pub(crate) mod equation;
pub(crate) mod initial_velocity;
mod load_history;
mod loads;
pub(crate) mod output;
mod settings;
mod signal;
pub(crate) mod step;
