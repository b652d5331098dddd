//! A converged increment, and its motion as the path from which another attempt begins. See docs/theory/time.md.

use super::contact_states::ContactStates;
use super::convergence::PartNoise;
use super::pass::Pass;
use super::returned::Returned;
use super::static_factors::StaticRates;
use crate::contact::ClosedPairs;
use crate::dynamics::results::{PassReport, State};
use crate::dynamics::step::{Equilibrium, HeldMotions, StepProblem, Workspace};

/// A converged increment.
#[derive(Default)]
pub(crate) struct Solved {
    /// Displacement increment d = U1 - U0.
    pub d: Vec<f64>,
    /// Velocity V0+ after the impulses.
    pub v0p: Vec<f64>,
    /// Forces in equilibrium.
    pub equilibrium: Equilibrium,
    /// Contact forces and impact impulses.
    pub contact: ContactStates,
    /// Motion at the end of the increment.
    pub end: State,
    /// Energy that the materials have dissipated.
    pub material_dissipation: f64,
    /// Work of the temperature, and the larger of the two parts of this work.
    pub thermal_work: [f64; 2],
    /// Displacement increment after the first pass, by the tangent at the start. If contact alone holds a body, this is
    /// the displacement increment after the first pass with closed pairs.
    pub tangent: Vec<f64>,
    /// Its passes.
    pub passes: Vec<PassReport>,
    /// Energy given back after the increment has converged.
    pub returned: Returned,
    /// Motions that are held in the increment.
    pub held: HeldMotions,
    /// Whether closed pairs stiffened K*.
    pub pairs_stiffen: bool,
    /// Rates of the corrections that a static increment has measured with its factors.
    pub rates: StaticRates,
    /// Whether the last factors of a static increment show if the equilibrium at its end is stable.
    pub tells_stability: bool,
    /// Whether a body has tipped over, so that the next increment must not extrapolate the motion.
    pub has_tipped: bool,
}

/// The motion of a converged increment between its ends, from which another attempt at the same start may begin.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Path {
    /// Velocity V0+.
    pub v: Vec<f64>,
    /// Acceleration A, also at the supports.
    pub a: Vec<f64>,
    /// The pairs closed at the end.
    pub closed: ClosedPairs,
    /// Motions that are held.
    pub held: HeldMotions,
    /// Whether closed pairs stiffened K*.
    pub pairs_stiffen: bool,
    /// Rates of the corrections that static increments have measured with their factors.
    pub rates: StaticRates,
}

impl Path {
    /// Displacement t V0+ + t²/2 A after a time t, eq. (6.3).
    pub fn displacement(&self, t: f64) -> Vec<f64> {
        let both = self.v.iter().zip(&self.a);
        both.map(|(v, a)| t * (v + t / 2.0 * a)).collect()
    }
}

impl Solved {
    /// The motion of a static increment of length `dt` at a constant rate, from which the next increment begins. The
    /// rate is zero if a body has tipped over to another contact, on which it stays.
    pub fn static_path(&self, dt: f64) -> Path {
        let rate = |d: &f64| if self.has_tipped { 0.0 } else { d / dt };
        Path {
            v: self.d.iter().map(rate).collect(),
            a: vec![0.0; self.d.len()],
            closed: self.end.contact.clone(),
            held: self.held.clone(),
            pairs_stiffen: self.pairs_stiffen,
            rates: self.rates,
        }
    }

    /// The motion of an increment of length `dt`, with A = (2/dt²) (d - dt V0+), eq. (4.1).
    pub fn path(&self, dt: f64) -> Path {
        let both = self.d.iter().zip(&self.v0p);
        let a = both.map(|(d, v0p)| 2.0 / (dt * dt) * (d - dt * v0p));
        Path {
            a: a.collect(),
            v: self.v0p.clone(),
            closed: self.end.contact.clone(),
            held: self.held.clone(),
            pairs_stiffen: false,
            rates: StaticRates::default(),
        }
    }
}

impl Solved {
    /// Round-off of the forces of every part in the increment.
    pub fn noise(&self, problem: &StepProblem, workspace: &Workspace) -> Vec<PartNoise> {
        let none = vec![0.0; self.d.len()];
        let pass = Pass {
            equilibrium: &self.equilibrium,
            support_force: &none,
            contact: &self.contact.forces,
            displacements: [&self.end.u, &self.d, &none],
        };
        let scales = pass.scales(
            problem,
            workspace,
            &self.contact.forces.resultant(none.len()),
        );
        let stiffness = &workspace.stiffness;
        let diagonals = stiffness.stiffness.iter().zip(&stiffness.inertia);
        scales.noise(diagonals.map(|(k, m)| k + m))
    }
}
