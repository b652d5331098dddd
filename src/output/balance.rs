use crate::dynamics::{Energy, IncrementReport, Momentum};
use crate::model::Model;

/// Follows the energy balance and, of a free model, the momentum.
#[derive(Debug, Clone, Default)]
pub(super) struct Balance {
    /// Largest energy or external work so far.
    largest: f64,
    /// Largest absolute balance so far.
    worst: f64,
    /// Momentum at the start, when nothing outside may change it.
    start: Option<Momentum>,
    /// Largest linear momentum so far.
    momentum: f64,
    /// Largest change of the linear momentum so far.
    drift: f64,
    free: bool,
}

impl Balance {
    /// The balance of a model's run.
    pub fn new(model: &Model) -> Self {
        let free = model.steps.iter().all(|step| {
            step.supports.is_empty()
                && step.point_loads.is_empty()
                && step.body_forces.is_empty()
                && step.pressures.is_empty()
                && step.tractions.is_empty()
        });
        Balance {
            free,
            ..Balance::default()
        }
    }

    /// Takes an increment in.
    pub fn add(&mut self, report: &IncrementReport) {
        let Energy {
            kinetic,
            strain,
            external_work,
            balance,
            ..
        } = report.energy;
        for energy in [kinetic, strain, external_work] {
            self.largest = self.largest.max(energy.abs());
        }
        self.worst = self.worst.max(balance.abs());
        if self.free {
            self.add_momentum(report.momentum);
        }
    }

    fn add_momentum(&mut self, momentum: Momentum) {
        let [x, y] = momentum.linear;
        let [x0, y0] = self.start.get_or_insert(momentum).linear;
        self.momentum = self.momentum.max(x.hypot(y));
        self.drift = self.drift.max((x - x0).hypot(y - y0));
    }

    /// `balance` as a part of the largest energy so far.
    pub fn relative(&self, balance: f64) -> f64 {
        part(balance, self.largest)
    }

    /// The worst balance so far as a part of the largest energy.
    pub fn worst(&self) -> f64 {
        part(self.worst, self.largest)
    }

    /// The change of a free model's linear momentum as a part of its largest value.
    pub fn momentum_drift(&self) -> Option<f64> {
        self.free.then(|| part(self.drift, self.momentum))
    }
}

/// `value / whole`, 0 of nothing.
fn part(value: f64, whole: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / whole }
}
