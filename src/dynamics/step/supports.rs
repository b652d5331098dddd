//! Prescribed displacements and velocities of a step, by ramps and amplitudes. Section 4 of
//! docs/theory.md.

use super::loads::TimePoint;
use crate::model::{Model, Step, SupportMotion};

/// Prescribed motion of the supports of one step.
pub(super) struct Supports<'m> {
    model: &'m Model,
    step: &'m Step,
    /// Displacement of every support at the start of the step.
    from: Vec<f64>,
}

impl<'m> Supports<'m> {
    /// Supports of a step that starts at the displacements `u`.
    pub fn new(model: &'m Model, step: &'m Step, u: &[f64]) -> Self {
        let from = step.supports.iter().map(|support| u[support.dof]).collect();
        Supports { model, step, from }
    }

    /// Prescribed dofs.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.step.supports.iter().map(|support| support.dof)
    }

    /// Dof, displacement and velocity of every support: from the amplitude and its derivative.
    pub fn motion(&self, at: TimePoint) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        self.step
            .supports
            .iter()
            .zip(&self.from)
            .map(move |(support, &from)| match support.motion {
                SupportMotion::Ramp { to } => {
                    let u = from + (to - from) * (at.step / at.period);
                    (support.dof, u, (to - from) / at.period)
                }
                SupportMotion::Amplitude { value, amplitude } => (
                    support.dof,
                    value * at.amplitude(self.model, amplitude),
                    value * at.amplitude_rate(self.model, amplitude),
                ),
            })
    }
}
