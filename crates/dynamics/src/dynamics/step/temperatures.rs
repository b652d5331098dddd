//! Temperatures of the nodes in a step. See docs/theory/materials.md, Temperature.

use super::loads::{Interval, TimePoint};
use crate::dynamics::results::State;
use crate::model::{Load, Model, NodeTemperature, Step};

/// Temperatures of one step.
pub(crate) struct Temperatures<'m> {
    model: &'m Model,
    loads: &'m [Load<NodeTemperature>],
    are_none: bool,
}

impl<'m> Temperatures<'m> {
    /// Temperatures of a step.
    pub fn new(model: &'m Model, step: &'m Step) -> Self {
        Temperatures {
            model,
            loads: &step.temperatures,
            are_none: !model.has_temperatures(),
        }
    }

    /// Temperature of every node at a time; empty if the deck gives no temperatures.
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

    /// Writes the temperatures (1 - theta1) T0 + theta1 T1 at which an increment is balanced; T0 and T1 are the
    /// temperatures at the start and at the end of the increment.
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

/// Temperature of every node at the start of the analysis; empty if the deck gives no temperatures.
pub(crate) fn initial_temperatures(model: &Model) -> Vec<f64> {
    let nodes = 0..model.mesh.node_count();
    match model.has_temperatures() {
        true => nodes
            .map(|node| model.initial_temperature_of(node))
            .collect(),
        false => Vec::new(),
    }
}
