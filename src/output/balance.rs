//! The energy balance of a run, the energy that contact puts in, and the momentum of a model without external forces,
//! increment by increment. See docs/theory/contact.md and docs/theory/impacts.md.

use super::warnings::{BALANCE, Losses, hourglass_part, part};
use crate::dynamics::{Energy, IncrementReport, Momentum};
use crate::linear::larger;
use crate::model::{Connector, Equation, Model};

/// Follows the energy balance, the energy that contact puts in and, in a free model, the momentum.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Balance {
    /// Largest energy or work so far.
    pub largest: f64,
    /// Largest absolute balance so far.
    worst: f64,
    /// Largest energy of hourglass modes so far; `internal` is the largest sum so far of strain energy and energy
    /// dissipated by materials.
    hourglass: f64,
    internal: f64,
    /// The last energies.
    last: Energy,
    /// Work of normal contact forces so far at nodes that replaced other closed nodes.
    handover_work: f64,
    contact_energy: ContactEnergy,
    /// Momentum at the start of a model without external forces.
    start: Option<Momentum>,
    /// Mass of all bodies.
    mass: f64,
    /// Largest sqrt(2 M T) so far, which the linear momenta of all bodies do not exceed.
    momentum: f64,
    /// Largest change of the linear momentum so far, with the momentum that mass-proportional damping has removed put
    /// back.
    drift: f64,
    free: bool,
}

/// Increments in which the normal contact forces did positive work. With energy-momentum contact, contact does positive
/// work in increments that a pair enters with a negative gap.
#[derive(Debug, Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct ContactEnergy {
    /// Number of these increments.
    pub count: usize,
    /// The energy that contact put in.
    pub energy: f64,
}

impl Balance {
    /// The balance of a run of a model.
    pub fn new(model: &Model) -> Self {
        let free = model.equations.iter().all(keeps_momentum)
            && model.connectors.iter().all(Connector::has_no_resultant)
            && model.steps.iter().all(|step| {
                step.supports.is_empty()
                    && step.point_loads.is_empty()
                    && step.body_forces.is_empty()
                    && step.centrifugal_forces.is_empty()
                    && step.pressures.is_empty()
                    && step.tractions.is_empty()
            });
        let elements = model.mesh.elements.iter();
        let bodies = model.rigid_bodies.iter().flat_map(|body| &body.masses);
        let points = bodies.chain(&model.point_masses);
        let of_points: f64 = points.map(|(_, mass)| mass).sum();
        Balance {
            free,
            mass: of_points + elements.map(|e| model.element_mass(e)).sum::<f64>(),
            ..Balance::default()
        }
    }

    /// Enters an increment; returns the energy that contact put in, if any.
    pub fn add(&mut self, report: &IncrementReport) -> Option<f64> {
        let Energy {
            kinetic,
            strain,
            external_work,
            thermal_work,
            balance,
            scale,
            ..
        } = report.energy;
        for energy in [kinetic, strain, external_work, thermal_work, scale] {
            self.largest = larger(self.largest, energy.abs());
        }
        self.worst = larger(self.worst, balance.abs());
        self.hourglass = larger(self.hourglass, report.energy.hourglass);
        let internal = strain + report.energy.material_dissipation;
        self.internal = larger(self.internal, internal);
        if self.free {
            let most = (2.0 * self.mass * kinetic).sqrt();
            self.momentum = larger(self.momentum, most);
            self.add_momentum(report.momentum);
        }
        self.last = report.energy;
        self.handover_work = report.contacts.iter().map(|c| c.handover_work).sum();
        if let Some(added) = report.contact_energy {
            self.contact_energy.count += 1;
            self.contact_energy.energy += added;
        }
        report.contact_energy
    }

    /// The increments in which contact put energy in.
    pub fn contact_energy(&self) -> ContactEnergy {
        self.contact_energy
    }

    fn add_momentum(&mut self, momentum: Momentum) {
        let [dx, dy] = momentum.damped_linear;
        let [x, y] = [momentum.linear[0] + dx, momentum.linear[1] + dy];
        let [x0, y0] = self.start.get_or_insert(momentum).linear;
        self.drift = larger(self.drift, (x - x0).hypot(y - y0));
    }

    /// `balance` as a part of the largest energy so far, or of a larger scale, for which round-off stays within the
    /// bound of the balance.
    pub fn relative(&self, balance: f64) -> f64 {
        part(balance, self.whole())
    }

    /// The largest energy so far, but at least so large that the work of round-off relative to it stays within the
    /// bound of the balance.
    fn whole(&self) -> f64 {
        larger(self.largest, self.last.round_off / BALANCE)
    }

    /// Largest energy of hourglass modes as a part of the largest strain energy.
    pub fn hourglass(&self) -> f64 {
        hourglass_part([self.hourglass, self.internal], self.whole())
    }

    /// The worst balance so far as a part of the largest energy.
    pub fn worst(&self) -> f64 {
        self.relative(self.worst)
    }

    /// Losses of energy so far.
    pub fn losses(&self) -> Losses {
        Losses::new(&self.last, self.handover_work, self.largest)
    }

    /// Whether there are no external forces.
    pub fn is_free(&self) -> bool {
        self.free
    }

    /// The change of the linear momentum of a free model as a part of the largest momenta of its bodies.
    pub fn momentum_drift(&self) -> Option<f64> {
        self.free.then(|| part(self.drift, self.momentum))
    }
}

/// Whether the forces of an equation have no resultant: the sum of its coefficients is zero for
/// each direction.
fn keeps_momentum(equation: &Equation) -> bool {
    let own = [(equation.dof, -1.0)];
    let terms = own.iter().chain(&equation.terms);
    let mut sums = [[0.0; 2]; 2];
    for &(dof, c) in terms {
        let [sum, size] = &mut sums[dof % 2];
        (*sum, *size) = (*sum + c, *size + f64::abs(c));
    }
    sums.iter()
        .all(|[sum, size]| sum.abs() <= Equation::ROUND_OFF * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_that_are_round_off_are_no_scale() {
        let report = IncrementReport {
            energy: Energy {
                strain: 1e-33,
                external_work: -1e-33,
                numerical_dissipation: -1e-33,
                balance: 1e-33,
                scale: 1e-33,
                round_off: 1e-20,
                ..Energy::default()
            },
            ..IncrementReport::default()
        };
        let mut balance = Balance::default();
        balance.add(&report);
        assert!(balance.worst() < BALANCE, "{:e}", balance.worst());
        assert!(balance.losses().lines().is_empty());
    }

    #[test]
    fn a_balance_that_is_no_number_is_the_worst() {
        let report = |balance| IncrementReport {
            energy: Energy {
                kinetic: 1.0,
                balance,
                ..Energy::default()
            },
            ..IncrementReport::default()
        };
        let mut balance = Balance::default();
        for value in [1e-3, f64::NAN, 1e-9] {
            balance.add(&report(value));
        }
        assert!(balance.worst().is_nan());
    }
}
