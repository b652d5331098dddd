//! Loads and prescribed displacements of a step, with their variation in time (docs/theory.md,
//! section 4).

use super::{Amplitude, Face, TimeBase};

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

impl<T> Load<T> {
    /// Magnitudes at start and end of the step; none where an amplitude gives them.
    pub fn ends(&self) -> Option<[f64; 2]> {
        match self.variation {
            Variation::Constant => Some([self.magnitude; 2]),
            Variation::Ramp { from } => Some([from, self.magnitude]),
            Variation::Amplitude(_) => None,
        }
    }

    /// The load with these magnitudes at start and end of the step, linear in between.
    pub fn between(self, [from, magnitude]: [f64; 2]) -> Self {
        let variation = match from == magnitude {
            true => Variation::Constant,
            false => Variation::Ramp { from },
        };
        Load {
            magnitude,
            variation,
            ..self
        }
    }
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

/// Motion of a support within a step.
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
    /// A velocity or an acceleration, which displacement and velocity of the start of the step go on
    /// with.
    Rate {
        /// What is prescribed.
        rate: Rate,
        /// Its value, or the factor of the amplitude (length/time, length/time^2).
        value: f64,
        /// Index into `Model::amplitudes`; without, the rate is constant.
        amplitude: Option<usize>,
    },
}

impl SupportMotion {
    /// How a support that no card changes goes on after a step of this duration: what follows an
    /// amplitude in step time keeps its last value.
    pub fn after_step(self, period: f64, amplitudes: &[Amplitude]) -> SupportMotion {
        let last = |index: usize| {
            let curve = amplitudes.get(index);
            let curve = curve.filter(|curve| curve.time == TimeBase::Step);
            curve.map(|curve| curve.at(period))
        };
        match self {
            SupportMotion::Amplitude { value, amplitude } => match last(amplitude) {
                Some(last) => SupportMotion::Ramp { to: value * last },
                None => self,
            },
            SupportMotion::Rate {
                rate,
                value,
                amplitude,
            } => match amplitude.and_then(last) {
                Some(last) => SupportMotion::Rate {
                    rate,
                    value: value * last,
                    amplitude: None,
                },
                None => self,
            },
            SupportMotion::Ramp { .. } => self,
        }
    }
}

/// The derivative of the displacement that is prescribed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rate {
    /// The first.
    Velocity,
    /// The second.
    Acceleration,
}
