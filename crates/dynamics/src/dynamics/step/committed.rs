//! State of the materials at the end of an increment: internal variables, and the work of the temperature. See
//! docs/theory/impacts.md, Ledger.

use super::step_problem::StepProblem;
use crate::dynamics::results::State;
use crate::elements::{Motion, Updated};
use crate::linear::larger;

/// State of the materials at the end of an increment.
#[derive(Debug, Default)]
pub(crate) struct Committed {
    /// Internal variables, and the energy dissipated since the start of the increment.
    pub updated: Updated,
    /// Work of the temperature, and the larger of its two parts (force length); the parts cancel if a body may expand
    /// freely.
    pub thermal_work: [f64; 2],
}

impl StepProblem<'_> {
    /// Internal variables at the end of an increment to displacements `u1` and temperatures T1, the dissipated energy,
    /// and the work of the temperature. If the temperature changes, the materials follow the change at once: their
    /// internal variables belong to the temperature of the end. The work of the temperature is the change of the
    /// potential of the elements at constant displacements,
    ///
    /// ```text
    /// Phi(U1; T1) - Phi(U1; Tm) + Phi(U0; Tm) - W0                   energy-momentum form, Tm halfway
    /// (Phi(U0; T1) - W0 + Phi(U1; T1) - Phi(U1; T0))/2               else                    eq. (9.18)
    /// ```
    ///
    /// Together with the work of the internal force at Tm, the first form adds up to W1 + D - W0.
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
