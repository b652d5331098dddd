//! Steps: time increments, prescribed displacements, loads, solver settings and times of field
//! output.

use super::{BodyForce, Load, PointLoad, Pressure, Settings, Support, Traction};

/// One step: everything that acts in it, whether named in it or carried on from before.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Name of the step, if it has one.
    pub name: Option<String>,
    /// What is solved in it.
    pub procedure: Procedure,
    /// Its increments.
    pub increments: Increments,
    /// Settings of the solver.
    pub settings: Settings,
    /// Prescribed dofs, sorted by dof, each at most once.
    pub supports: Vec<Support>,
    /// Concentrated forces.
    pub point_loads: Vec<Load<PointLoad>>,
    /// Body forces.
    pub body_forces: Vec<Load<BodyForce>>,
    /// Follower pressures.
    pub pressures: Vec<Load<Pressure>>,
    /// Dead tractions.
    pub tractions: Vec<Load<Traction>>,
    /// When field frames are written.
    pub frames: Frames,
}

/// What is solved in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Procedure {
    /// The equation of motion, integrated implicitly in time (`*DYNAMIC`).
    Dynamic,
}

/// Time increments of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increments {
    /// Increment dt (time).
    pub dt: f64,
    /// Duration T of the step (time).
    pub period: f64,
    /// Smallest increment a cutback may reach (time); 0 when the deck says nothing.
    pub dt_min: f64,
    /// Whether the deck asked for fixed increments (DIRECT).
    pub direct: bool,
}

/// When field frames are written. The start and the end of a step always are.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Frames {
    /// The program's default number of frames.
    #[default]
    Default,
    /// This many, evenly spaced over the step.
    Count(usize),
    /// At multiples of this time since the start of the step.
    Every(f64),
    /// Every so many increments.
    Increments(usize),
    /// At these step times, increasing.
    Times(Vec<f64>),
}
