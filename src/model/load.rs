//! Loads and prescribed displacements of a step, with their variation in time (docs/theory.md,
//! section 4).

use super::Face;

/// How a load's magnitude follows time within its step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variation {
    /// The full magnitude from the start of the step.
    Constant,
    /// Linear over the step up to the full magnitude.
    Ramp {
        /// Magnitude at the start of the step.
        from: f64,
    },
    /// Magnitude times the amplitude with this index.
    Amplitude(usize),
}

/// A load: its kind and place (`at`), its full magnitude and its variation in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load<T> {
    /// Loaded dof, element or face, and direction.
    pub at: T,
    /// Full magnitude.
    pub magnitude: f64,
    /// How the magnitude follows time.
    pub variation: Variation,
}

/// Concentrated force (magnitude: force) on one dof, `2 node + direction`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLoad {
    /// Loaded dof.
    pub dof: usize,
}

/// Force per reference volume along a fixed direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyForce {
    /// Loaded element.
    pub element: usize,
    /// Direction; a unit vector.
    pub direction: [f64; 2],
    /// Whether the magnitude is an acceleration (GRAV: multiplied by the density) or a force per
    /// volume (BX, BY).
    pub per_mass: bool,
}

/// Follower pressure (magnitude: force/length^2, positive into the body) on the current face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressure {
    /// Loaded face.
    pub face: Face,
}

/// Dead traction (magnitude: force per reference area) along a fixed direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Traction {
    /// Loaded face.
    pub face: Face,
    /// Direction; a unit vector.
    pub direction: [f64; 2],
}

/// A dof whose displacement is prescribed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Prescribed dof, `2 node + direction`.
    pub dof: usize,
    /// Its displacement in time.
    pub motion: SupportMotion,
}

/// Displacement of a support within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SupportMotion {
    /// Linear over the step from the displacement at its start to `to` (length) at its end.
    Ramp {
        /// Displacement at the end of the step.
        to: f64,
    },
    /// `value` (length) times the amplitude with index `amplitude`.
    Amplitude {
        /// Factor of the amplitude.
        value: f64,
        /// Index into `Model::amplitudes`.
        amplitude: usize,
    },
}
