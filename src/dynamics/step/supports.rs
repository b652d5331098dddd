//! Prescribed motion of a step: displacements by ramps and amplitudes, velocities and accelerations
//! integrated. Section 4 of docs/theory.md.

use super::loads::TimePoint;
use crate::model::{Model, Rate, Step, SupportMotion};

/// Prescribed motion of the supports of one step.
pub(super) struct Supports<'m> {
    model: &'m Model,
    step: &'m Step,
    /// Displacement and velocity of every support at the start of the step.
    from: Vec<[f64; 2]>,
}

impl<'m> Supports<'m> {
    /// Supports of a step that starts with the displacements `u` and velocities `v`.
    pub fn new(model: &'m Model, step: &'m Step, [u, v]: [&[f64]; 2]) -> Self {
        let dofs = step.supports.iter().map(|support| support.dof);
        let from = dofs.map(|dof| [u[dof], v[dof]]).collect();
        Supports { model, step, from }
    }

    /// Prescribed dofs.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.step.supports.iter().map(|support| support.dof)
    }

    /// Dof, displacement and velocity of every support: from the amplitude and its derivative or its
    /// integrals.
    pub fn motion(&self, at: TimePoint) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let supports = self.step.supports.iter().zip(&self.from);
        supports.map(move |(support, &from)| {
            let [u, v] = self.displacement_and_velocity(support.motion, from, at);
            (support.dof, u, v)
        })
    }

    /// Of one support that starts with the displacement `from` and the velocity `v0`.
    fn displacement_and_velocity(
        &self,
        motion: SupportMotion,
        [from, v0]: [f64; 2],
        at: TimePoint,
    ) -> [f64; 2] {
        match motion {
            SupportMotion::Ramp { to } => {
                let u = from + (to - from) * (at.step / at.period);
                [u, (to - from) / at.period]
            }
            SupportMotion::Amplitude { value, amplitude } => [
                value * at.amplitude(self.model, amplitude),
                value * at.amplitude_rate(self.model, amplitude),
            ],
            SupportMotion::Rate {
                rate,
                value,
                amplitude,
            } => {
                // a, and its first and second integral since the start of the step, eq. (4.26)
                let [a, first, second] = at.integrals(self.model, amplitude);
                match rate {
                    Rate::Velocity => [from + value * first, value * a],
                    Rate::Acceleration => {
                        [from + v0 * at.step + value * second, v0 + value * first]
                    }
                }
            }
        }
    }
}
