use super::increment::Solved;
use super::mass::dot;
use super::step_problem::{Equilibrium, StepProblem};
use super::{Energy, State};

/// Energy ledger: every term is computed on its own, so that the balance shows what is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ledger {
    pub energy: Energy,
    /// Largest energy or external work so far.
    pub largest: f64,
    /// T + W at the start of the analysis.
    start: f64,
}

impl Ledger {
    /// Opens the ledger at the start of the analysis.
    pub fn new(kinetic: f64, strain: f64) -> Self {
        Ledger {
            energy: Energy {
                kinetic,
                strain,
                ..Energy::default()
            },
            largest: kinetic.max(strain),
            start: kinetic + strain,
        }
    }

    /// Enters a converged increment that started from `start` and ends with the strain energy
    /// `strain`.
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        start: &State,
        solved: &Solved,
        strain: f64,
        dt: f64,
    ) {
        let Solved {
            d,
            v0p,
            end,
            forces,
            ..
        } = solved;
        let Equilibrium {
            load,
            internal,
            inertia,
            ..
        } = &solved.equilibrium;
        let e = &mut self.energy;
        let strain0 = e.strain;
        e.strain = strain;
        e.kinetic = problem.mass.kinetic_energy(&end.v);

        // d.R_theta, and the supports: dt V_mid.(M A)_p + d_p.(F - R - B^T P)_p
        e.external_work += dot(d, load);
        let contact = forces.resultant(d.len());
        for p in problem.supports.dofs() {
            let v_mid = (v0p[p] + end.v[p]) / 2.0;
            e.external_work +=
                dt * v_mid * inertia[p] + d[p] * (internal[p] - load[p] - contact[p]);
        }
        // Pn.(Bn d) and -Pt.(Bt d)
        for (k, pair) in forces.pairs.iter().enumerate() {
            e.normal_contact_work += forces.normal[k] * pair.normal_of(d);
            e.friction_dissipation -= forces.tangential[k] * pair.tangent_of(d);
        }
        // T(V0) - T(V0+)
        if v0p != &start.v {
            let kinetic = |v| problem.mass.kinetic_energy(v);
            e.impact_loss += kinetic(&start.v) - kinetic(v0p);
        }
        // d.F_theta - (W1 - W0)
        e.numerical_dissipation += dot(d, internal) - (e.strain - strain0);

        e.balance = e.kinetic + e.strain - self.start - e.external_work - e.normal_contact_work
            + e.friction_dissipation
            + e.impact_loss
            + e.numerical_dissipation;
        for energy in [e.kinetic, e.strain, e.external_work.abs()] {
            self.largest = self.largest.max(energy);
        }
    }
}
