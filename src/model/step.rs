//! Steps: time increments, prescribed displacements, loads, solver settings and times of field
//! output.

use super::{BodyForce, Load, PointLoad, Pressure, Settings, Support, Traction};

/// One step with everything that acts in it, whether given in it or in an earlier step.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Name of the step, if it has one.
    pub name: Option<String>,
    /// Its procedure.
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

/// Procedure of a step.
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
    /// Smallest increment a cutback may reach (time); 0 by default.
    pub dt_min: f64,
    /// Whether the deck requests fixed increments (DIRECT).
    pub direct: bool,
}

/// When field frames are written. The start and the end of a step are always written.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Frames {
    /// The program's default number of frames.
    #[default]
    Default,
    /// This many, evenly spaced over the step.
    Count(usize),
    /// At multiples of this time since the start of the step.
    Every(f64),
    /// Each time this number of increments is done.
    Increments(usize),
    /// At these step times, increasing.
    Times(Vec<f64>),
}
