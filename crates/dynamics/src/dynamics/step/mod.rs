//! The problem of a step: unknowns, loads, supports, mass, scheme, effective stiffness, and the
//! workspace of its increments.

mod bodies;
mod committed;
mod fits;
mod free_motions;
mod friction;
mod held_motions;
mod hinges;
mod integration;
mod loads;
mod mass;
mod matrices;
mod meter;
mod normals;
mod parts;
mod pins;
mod rank_update;
mod seen;
mod slave_faces;
mod step_problem;
mod temperatures;
mod turning;
mod unknowns;
mod wear;
mod workspace;

pub(crate) use bodies::{Hold, holds};
pub(crate) use committed::Committed;
pub(crate) use free_motions::{FreeMotions, Loose};
pub(crate) use friction::BeforeIterate;
pub(crate) use held_motions::HeldMotions;
pub(crate) use hinges::Hinges;
pub(crate) use loads::{ForceChange, Interval, StepPlace, TimePoint};
pub(crate) use mass::{Mass, dot};
pub(crate) use matrices::{
    ClosedConstraints, FactoredMatrix, ResponseVectors, StiffnessForm, System,
};
#[cfg(test)]
pub(crate) use meter::Meter;
pub(crate) use parts::{Parts, PerBody};
pub(crate) use seen::{ROUND_OFF, Seen};
pub(crate) use slave_faces::SlaveFaces;
pub(crate) use step_problem::{
    Discretization, Equilibrium, StartVelocity, StepProblem, check_finite, difference, sum,
    write_difference, write_sum,
};
pub(crate) use temperatures::initial_temperatures;
pub use turning::{TurningBody, rigid_inertia};
pub(crate) use wear::FactoredState;
pub(crate) use workspace::Workspace;
