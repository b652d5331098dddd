use super::increment::Solved;
use super::mass::dot;
use super::step_problem::{Equilibrium, StepProblem};
use super::{Cause, Energy, Momentum, State};
use crate::linear::{larger, largest};

/// Energy ledger: every term is computed on its own, so that the balance shows what is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
            largest: larger(kinetic, strain),
            start: kinetic + strain,
        }
    }

    /// The ledger with a converged increment that started from `start`.
    ///
    /// # Errors
    /// An energy that is not finite.
    pub fn with(
        mut self,
        problem: &StepProblem,
        start: &State,
        solved: &Solved,
        dt: f64,
    ) -> Result<Self, Cause> {
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
        e.strain = problem.body.strain_energy(&end.u);
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
        let largest = largest(&[self.largest, e.kinetic, e.strain, e.external_work]);
        self.largest = largest;
        self.check(end)?;
        Ok(self)
    }

    /// All energies must be finite.
    ///
    /// # Errors
    /// [`Cause::NotFinite`] with the node that moves most in `state`, or is the fastest.
    pub fn check(&self, state: &State) -> Result<(), Cause> {
        let e = &self.energy;
        let energies = [
            ("the strain energy", e.strain, &state.u),
            ("the kinetic energy", e.kinetic, &state.v),
            ("the external work", e.external_work, &state.v),
            (
                "the work of the contact forces",
                e.normal_contact_work,
                &state.v,
            ),
            ("the friction dissipation", e.friction_dissipation, &state.v),
            ("the impact loss", e.impact_loss, &state.v),
            (
                "the numerical dissipation",
                e.numerical_dissipation,
                &state.u,
            ),
            ("the energy balance", e.balance, &state.v),
        ];
        let wrong = energies.iter().find(|(_, energy, _)| !energy.is_finite());
        wrong.map_or(Ok(()), |&(what, _, motion)| {
            let larger = |i: &usize, j: &usize| motion[*i].abs().total_cmp(&motion[*j].abs());
            let dof = (0..motion.len()).max_by(larger).unwrap_or(0);
            Err(Cause::NotFinite {
                what,
                node: dof / 2,
            })
        })
    }
}

/// Linear momentum sum m v and angular momentum sum x cross m v about the origin.
pub(super) fn momentum(problem: &StepProblem, state: &State) -> Momentum {
    let p = problem.mass.times(&state.v);
    let mut momentum = Momentum::default();
    for node in 0..problem.model.mesh.node_count() {
        let position = problem.position(&state.u, node);
        let [px, py] = [p[2 * node], p[2 * node + 1]];
        momentum.linear[0] += px;
        momentum.linear[1] += py;
        momentum.angular += position[0] * py - position[1] * px;
    }
    momentum
}
