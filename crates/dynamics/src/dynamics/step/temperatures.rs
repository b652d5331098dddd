//! Temperatures of the nodes in a step, and what they bring into the elements that expand. See
//! docs/theory/materials.md, Temperature.

use super::loads::{Interval, TimePoint};
use super::step_problem::StepProblem;
use crate::dynamics::results::State;
use crate::elements::{Motion, Updated};
use crate::linear::larger;
use crate::model::{Load, Model, NodeTemperature, Step};

/// Temperatures of one step.
pub(crate) struct Temperatures<'m> {
    model: &'m Model,
    loads: &'m [Load<NodeTemperature>],
    are_none: bool,
}

impl<'m> Temperatures<'m> {
    /// Those of a step.
    pub fn new(model: &'m Model, step: &'m Step) -> Self {
        Temperatures {
            model,
            loads: &step.temperatures,
            are_none: !model.has_temperatures(),
        }
    }

    /// Temperature of every node at a time; none where the deck gives none.
    pub fn at(&self, time: TimePoint) -> Vec<f64> {
        if self.are_none {
            return Vec::new();
        }
        let mut all = initial_temperatures(self.model);
        for load in self.loads {
            all[load.at.node] = time.magnitude(self.model, load);
        }
        all
    }

    /// Writes (1 - theta1) T0 + theta1 T1, at which an increment is balanced, T0 being those of its start.
    pub fn write_weighted(
        &self,
        theta1: f64,
        start: &State,
        interval: Interval,
        temperature: &mut Vec<f64>,
    ) {
        if self.are_none {
            return;
        }
        *temperature = self.at(interval.end);
        for (t, t0) in temperature.iter_mut().zip(&start.temperature) {
            *t = (1.0 - theta1) * t0 + theta1 * *t;
        }
    }
}

/// Temperature of every node at the start of the analysis; none where the deck gives no temperatures.
pub(crate) fn initial_temperatures(model: &Model) -> Vec<f64> {
    let nodes = 0..model.mesh.node_count();
    match model.has_temperatures() {
        true => nodes
            .map(|node| model.initial_temperature_of(node))
            .collect(),
        false => Vec::new(),
    }
}

/// What the materials are at the end of an increment.
#[derive(Debug, Default)]
pub(crate) struct Committed {
    /// Internal variables, and what is dissipated on the way to them.
    pub updated: Updated,
    /// Work of the temperature, and the larger of its parts, which cancel where a body may expand (force length).
    pub thermal_work: [f64; 2],
}

impl StepProblem<'_> {
    /// Internal variables at the end of an increment to displacements `u1` and temperatures T1, what is dissipated, and the work
    /// of the temperature. Where the temperature changes, the materials follow it at once: their variables are those of the
    /// end, and the work is what the potential of the elements changes by at displacements that stay,
    ///
    /// ```text
    /// Phi(U1; T1) - Phi(U1; Tm) + Phi(U0; Tm) - W0                   energy-momentum form, Tm halfway
    /// (Phi(U0; T1) - W0 + Phi(U1; T1) - Phi(U1; T0))/2               else                    eq. (9.18)
    /// ```
    ///
    /// The first adds up to W1 + D - W0 with the work of the internal force at Tm.
    pub fn commit(&self, start: &State, u1: &[f64], [halfway, t1]: [&[f64]; 2]) -> Committed {
        let committed = Motion::at(u1, &start.internal).heated(t1);
        if start.temperature == t1 || !self.elements.expand() {
            let between = Motion {
                start: Some(&start.u),
                ..committed
            };
            return Committed {
                updated: self.elements.update(between),
                thermal_work: [0.0; 2],
            };
        }
        let potential = |u, temperature| {
            let motion = Motion::at(u, &start.internal).heated(temperature);
            self.elements.potential(motion)
        };
        let first = |temperature| {
            potential(&start.u, temperature) - self.elements.stored_by_expanding(start.motion())
        };
        let last = |temperature| potential(u1, t1) - potential(u1, temperature);
        let [first, last] = match self.integration.energy_momentum {
            true => [first(halfway), last(halfway)],
            false => [first(t1) / 2.0, last(&start.temperature) / 2.0],
        };
        Committed {
            updated: self.elements.update(committed),
            thermal_work: [first + last, larger(first.abs(), last.abs())],
        }
    }
}
