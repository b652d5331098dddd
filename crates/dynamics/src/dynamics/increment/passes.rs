//! Common parts of the passes of dynamic and static increments: evaluation of the iterate, motion of the supports,
//! forces of hinges, errors of a pass, end of the increment. See docs/theory/time.md (paper eqs 27, 29 and 36 to 49).

use super::contact_states::ContactStates;
use super::impulses::EarlierPass;
use super::linear_pass::Vectors;
use super::pass::{Iterate, Pass, PassStage, Residual};
use super::returned::Returned;
use super::solved::Solved;
use super::static_factors::StaticRates;
use super::trace::Trace;
use crate::contact::ConstraintSet;
use crate::contact::tolerances::{KEPT_BEYOND_ENDS, KEPT_WHEN_SETTLED};
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{
    Committed, Equilibrium, HeldMotions, Interval, StartVelocity, StepProblem, Workspace, sum,
    write_difference, write_sum,
};
use crate::linear::larger;

/// Number of passes after which further passes are accelerated, and slave nodes that go to and fro between two targets
/// keep both targets.
pub(super) const SLOW_PASSES: usize = 10;

/// Largest error of the friction after the last pass, relative to the largest normal force. The largest error of the
/// friction is a tenth of the limit in the certificate.
const OWN_FRICTION: f64 = 1e-10;

/// Overrun beyond the ends of a segment (segment lengths) up to which slave nodes keep their targets in a pass, even if
/// the nodes are at other targets; `None` before the pass `keeping`.
fn kept_beyond_ends(pass: usize, keeping: usize) -> Option<f64> {
    if pass < keeping {
        None
    } else if pass < SLOW_PASSES {
        Some(KEPT_WHEN_SETTLED)
    } else {
        Some(KEPT_BEYOND_ENDS)
    }
}

/// The passes of an increment.
pub(super) struct Passes<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
    pub start: &'a State,
    pub interval: Interval,
    pub set: ConstraintSet<'a>,
}

impl Passes<'_, '_> {
    /// Prepares the search for passes whose nodes move with the velocities `v`.
    pub fn start_search(&mut self, v: &[f64]) {
        let (problem, search) = (self.problem, &mut self.workspace.search);
        search.start(v, self.interval.dt);
        if !problem.fits.are_none() {
            search.allow(problem.fits.allowed(self.interval));
        }
    }

    /// Evaluates the iterate U = U0 + d: constraints, impulses and forces. From the pass `keeping` on, slave nodes keep their
    /// targets.
    pub fn evaluate(
        &mut self,
        (pass, keeping): (usize, usize),
        d: &mut [f64],
        contact: &mut ContactStates,
        v: &mut Vectors,
    ) -> Result<(), Cause> {
        let (problem, start) = (self.problem, self.start);
        // positions and rows of bodies that turn, eq. (11.1) and eq. (11.3), g, Dt and their rows in the iterate U = U0 + d
        let turning = &problem.unknowns.turning;
        turning.follow(&start.u, d);
        write_sum(&start.u, d, &mut v.u);
        turning.turn([&start.u, d], &mut v.u);
        (self.workspace.stiffness).write_rows(problem, [&start.u, d]);
        problem.check_segments(&v.u)?;
        let of_set = (self.set, kept_beyond_ends(pass, keeping));
        let of_increment = (start, self.interval, pass == 0);
        contact.find(problem, self.workspace, of_increment, &v.u, of_set);

        // V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1)
        let last = EarlierPass::new(&v.equilibrium, self.interval.dt);
        let ContactStates {
            impulses, found, ..
        } = contact;
        let v0p = impulses.start_velocity(problem, self.workspace, found, start, &last)?;

        // r = R_theta - F(U_theta) - M A, eq. (4.5)
        self.equilibrium(&v0p, [&v.u, d], &mut v.equilibrium)
    }

    /// Writes load, internal force and inertia of the iterate U = U0 + d.
    fn equilibrium(
        &mut self,
        v0p: &StartVelocity,
        iterate: [&[f64]; 2],
        equilibrium: &mut Equilibrium,
    ) -> Result<(), Cause> {
        let (problem, start, interval) = (self.problem, self.start, self.interval);
        let evaluate = || problem.equilibrium(start, v0p, iterate, interval, equilibrium);
        (self.workspace.meter).time(|t| &mut t.assembly, evaluate)
    }

    /// Writes the part d_p of the prescribed motion that the predictor leaves, the force theta2 K d_p, and the load r -
    /// theta2 K d_p. The first pass performs the motion d_p; in later passes d_p is zero.
    pub fn supports(&mut self, pass: usize, vectors: &mut Vectors) {
        self.move_supports(pass, vectors);
        let Vectors {
            equilibrium,
            support_force,
            load,
            ..
        } = vectors;
        write_difference(&equilibrium.out_of_balance, support_force, load);
    }

    /// Writes the prescribed motion d_p and its force theta2 K d_p.
    fn move_supports(&mut self, pass: usize, vectors: &mut Vectors) {
        let (problem, integration) = (self.problem, &self.problem.integration);
        let Vectors {
            equilibrium,
            u,
            d_p,
            support_force: force,
            ..
        } = vectors;
        match pass {
            0 => {
                let from = [&self.start.u[..], u];
                *d_p = (problem.unknowns).prescribed_increment(from, self.interval.end);
            }
            1 => d_p.fill(0.0),
            _ => return,
        }
        force.clear();
        force.resize(u.len(), 0.0);
        if d_p.iter().any(|d| *d != 0.0) {
            let motion = integration.motion(self.start, u, equilibrium.place());
            let product = (self.workspace).tangent_product(problem, motion, d_p);
            (force.iter_mut().zip(&product)).for_each(|(f, k)| *f = integration.theta2 * k);
        }
    }

    /// Adds to the forces of the hinges, in a pass: the forces that close the gaps of the hinges, and the reactions of
    /// the hinges to all other forces.
    pub fn take_hinge_forces(&mut self, closing: Vec<f64>, v: &mut Vectors) {
        let hinges = &self.problem.hinges;
        if hinges.are_none() {
            return;
        }
        let change = sum(&closing, &self.workspace.k().hinge_forces());
        let Equilibrium {
            hinges: forces,
            load,
            out_of_balance,
            ..
        } = &mut v.equilibrium;
        forces.iter_mut().zip(&change).for_each(|(f, c)| *f += c);
        hinges.add_forces(&change, load);
        hinges.add_forces(&change, out_of_balance);
    }

    /// The relative residual if the available forces balance the iterate and its gaps and slips obey the contact law;
    /// else `None`.
    pub fn residual(
        &mut self,
        iterate: &Iterate,
        stage: PassStage,
        residual: &mut Residual,
    ) -> Result<Option<f64>, Cause> {
        let solved = iterate.residual(self.problem, self.workspace, stage, residual)?;
        if let Some(residual) = solved {
            self.workspace.meter.counts.residual = residual;
        }
        Ok(solved)
    }

    /// Adds the constraints of far slave nodes at the iterate U. Returns whether the constraints of far nodes stay open
    /// after a correction dU.
    pub fn complete(&mut self, contact: &mut ContactStates, u: &[f64], du: Option<&[f64]>) -> bool {
        let of_increment = (self.start, self.interval);
        contact.complete(self.problem, self.workspace, of_increment, u, du)
    }

    /// Compares residual and correction of a pass with their scales. Returns whether the pass has converged with a
    /// solve that passes its residual check.
    pub fn measure(
        &mut self,
        pass: &Pass,
        residual: &mut Residual,
        trace: &mut Trace,
    ) -> Result<bool, Cause> {
        let (problem, [u, _, du]) = (self.problem, pass.displacements);
        let (scales, errors) = pass.measure(problem, self.workspace, residual)?;
        let report = scales.report(&errors, pass.contact);
        let (position, dof_of) = (|node| problem.position(u, node), &problem.unknowns.dof);
        trace.worst = scales.worst(&errors, &residual.values, dof_of, position);
        trace.add(report, pass.contact);
        self.workspace.meter.count_pass(report.residual);
        let has_converged = scales.converged(&errors)
            && scales.closes_gaps(pass.contact, du)
            && self.obeys_friction(pass);
        if has_converged {
            self.workspace.k().check()?;
        }
        Ok(has_converged)
    }

    /// Whether the friction of a pass obeys the law at the slip rates and pressures after the pass, on which the
    /// coefficient of friction depends.
    fn obeys_friction(&self, pass: &Pass) -> bool {
        if !pass
            .contact
            .acting()
            .any(|(constraint, _)| constraint.mu_varies)
        {
            return true;
        }
        let (problem, [_, d, du]) = (self.problem, pass.displacements);
        let increment = (&self.start.u[..], &sum(d, du)[..], self.interval);
        let outside =
            (problem.frictions).outside(problem.coordinates, increment, pass.contact.acting());
        let largest = pass
            .contact
            .acting()
            .fold(0.0, |most, (_, pair)| larger(most, pair.force[0]));
        outside
            .iter()
            .all(|&outside| outside <= OWN_FRICTION * largest)
    }

    /// Motion and forces at the end of a converged increment d, from the vectors of its last pass; `is_balanced` tells
    /// whether the forces are in equilibrium at U0 + d.
    pub fn finish(
        &mut self,
        d: &[f64],
        mut contact: ContactStates,
        v: &mut Vectors,
        is_balanced: bool,
    ) -> Result<Solved, Cause> {
        contact.take_own_friction(self.problem, self.start, self.interval);
        contact.take_left_out(self.problem, &v.u);
        let v0p = (contact.impulses).velocity(self.workspace, self.start)?;
        let mut u = sum(&self.start.u, d);
        (self.problem.unknowns.turning).turn([&self.start.u, d], &mut u);
        let mut equilibrium = std::mem::take(&mut v.equilibrium);
        if is_balanced {
            // in the passes the impulses may have been separate from V0
            (self.problem).inertia(self.start, &v0p, d, self.interval, &mut equilibrium);
        } else {
            self.equilibrium(&v0p, [&u, d], &mut equilibrium)?;
        }
        let v0p = v0p.v0p.into_owned();
        let tangent = std::mem::take(&mut v.tangent);
        // V1 of eq. (4.2); at supports V1 comes from the amplitude
        let integration = &self.problem.integration;
        let mut v = integration.end_velocity(d, &v0p, self.interval.dt);
        (self.problem.unknowns).prescribe(self.interval.end, &mut u, &mut v);
        let a = equilibrium.acceleration.clone();
        let temperature = self.problem.temperatures.at(self.interval.end);
        let heating = [&equilibrium.temperature[..], &temperature];
        let Committed {
            updated,
            thermal_work,
        } = self.problem.commit(self.start, &u, heating);
        let end = State {
            u,
            v,
            a,
            internal: updated.variables,
            temperature,
            contact: contact.forces.closed.clone(),
        };
        Ok(Solved {
            d: d.to_vec(),
            v0p,
            equilibrium,
            contact,
            end,
            material_dissipation: updated.dissipated,
            thermal_work,
            tangent,
            passes: Vec::new(),
            returned: Returned::default(),
            held: HeldMotions::default(),
            pairs_stiffen: false,
            rates: StaticRates::default(),
            tells_stability: false,
            has_tipped: false,
        })
    }
}
