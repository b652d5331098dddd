//! Solution of one increment: predictor and corrector passes with contact forces and impulses.
//! Section 4 of docs/theory.md (paper eqs 27, 29 and 36 to 49).

use super::acceleration::{CorrectionProgress, PassAcceleration};
use super::contact_forces::ContactForces;
use super::contact_states::ContactStates;
use super::convergence::PartNoise;
use super::equal_forces::EqualForces;
use super::impulses::EarlierPass;
use super::linear_pass::{SkewPart, Vectors, close_hinges};
use super::pass::{Iterate, Pass, PassStage, Residual};
use super::pin_iteration::{PinIteration, PinState};
use super::refactorization::{FactorRule, Refactorization, SEARCHING_PASSES};
use super::returned::Returned;
use super::rigid_predictor::rigid_predictor;
use super::rigid_velocity::carry_nodes;
use super::trace::{Failed, Trace};
use crate::contact::tolerances::{KEPT_BEYOND_ENDS, KEPT_WHEN_SETTLED};
use crate::contact::{ClosedPair, ClosedPairs, Constraint, ConstraintSet, SlaveChoice};
use crate::dynamics::results::{Cause, PassReport, State};
use crate::dynamics::step::{
    ClosedConstraints, Equilibrium, ForceChange, HeldMotions, Interval, StartVelocity, StepProblem,
    StiffnessForm, Workspace, sum, write_difference, write_sum,
};
use crate::elements::{Motion, Updated};
use crate::linear::{larger, largest};

/// Passes of an attempt that are made in any case; further ones only while they will end within MAX PASSES.
const PATIENCE: usize = 25;
/// The same in a static step, whose passes converge quadratically, once corrections are small.
const STATIC_PATIENCE: usize = 8;
/// Passes after which slave nodes keep their targets in a static step.
const STATIC_SEARCHING_PASSES: usize = 3;
/// Passes after which those that follow are accelerated, and slave nodes that go to and fro between two targets keep both.
const SLOW_PASSES: usize = 10;

/// Relative difference of lengths between which subincrements between impacts share the factors of K*.
const SAME_LENGTH: f64 = 1e-3;
/// Largest error of the friction after the last pass, as a part of the largest normal force. It is a tenth of the bound of
/// the certificate.
const OWN_FRICTION: f64 = 1e-10;

/// Overrun beyond the ends of a segment (segment lengths) up to which slave nodes keep their targets in a pass, even
/// if others hold them now.
fn kept_beyond_ends(pass: usize, has_rates: bool) -> Option<f64> {
    let searching = if has_rates {
        SEARCHING_PASSES
    } else {
        STATIC_SEARCHING_PASSES
    };
    if pass < searching {
        None
    } else if pass < SLOW_PASSES {
        Some(KEPT_WHEN_SETTLED)
    } else {
        Some(KEPT_BEYOND_ENDS)
    }
}

/// Relative difference of lengths within which factors of K* are kept: the trials for the time of an impact differ
/// by little.
fn length_tolerance(set: ConstraintSet) -> f64 {
    match set {
        ConstraintSet::All => 0.0,
        ConstraintSet::Active(_) => SAME_LENGTH,
    }
}

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
    /// Motion at the end.
    pub end: State,
    /// Energy that the materials have dissipated.
    pub material_dissipation: f64,
    /// Displacement increment after the first pass, by the tangent of its start; where contact alone holds a body, after
    /// the first one with closed pairs.
    pub tangent: Vec<f64>,
    /// Its passes.
    pub passes: Vec<PassReport>,
    /// What is given back once it has converged.
    pub returned: Returned,
    /// Motions that are held in it.
    pub held: HeldMotions,
    /// Whether K* held the closed pairs.
    pub holds_pairs: bool,
}

/// The motion of a converged increment between its ends, which another attempt from the same start may begin
/// with.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Path {
    /// Velocity V0+.
    pub v: Vec<f64>,
    /// Acceleration A, at the supports too.
    pub a: Vec<f64>,
    /// The pairs closed at the end.
    pub closed: ClosedPairs,
    /// Motions that are held.
    pub held: HeldMotions,
    /// Whether K* held the closed pairs.
    pub holds_pairs: bool,
}

impl Path {
    /// t V0+ + t²/2 A, eq. (6.3).
    pub fn displacement(&self, t: f64) -> Vec<f64> {
        let both = self.v.iter().zip(&self.a);
        both.map(|(v, a)| t * (v + t / 2.0 * a)).collect()
    }
}

impl Solved {
    /// The motion of a static increment of length `dt` at a constant rate, which the next one begins with.
    pub fn static_path(&self, dt: f64) -> Path {
        Path {
            v: self.d.iter().map(|d| d / dt).collect(),
            a: vec![0.0; self.d.len()],
            closed: self.end.contact.clone(),
            held: self.held.clone(),
            holds_pairs: self.holds_pairs,
        }
    }

    /// The motion of an increment of length `dt`, A = (2/dt²) (d - dt V0+), eq. (4.1).
    pub fn path(&self, dt: f64) -> Path {
        let both = self.d.iter().zip(&self.v0p);
        let a = both.map(|(d, v0p)| 2.0 / (dt * dt) * (d - dt * v0p));
        Path {
            a: a.collect(),
            v: self.v0p.clone(),
            closed: self.end.contact.clone(),
            held: self.held.clone(),
            holds_pairs: false,
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

/// An attempt at one increment.
pub(crate) struct Attempt<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
    pub start: &'a State,
    pub interval: Interval,
    pub set: ConstraintSet<'a>,
    /// What the passes start from, in place of the rigid motion of the bodies.
    pub guess: Option<&'a Path>,
}

impl<'m> Attempt<'_, 'm> {
    /// Solves the increment.
    pub fn solve(mut self) -> Result<Solved, Failed> {
        let mut trace = Trace::new(self.problem.settings.max_passes);
        let mut vectors = Vectors::default();
        let mut failed = Cause::NotConverged;
        (self.workspace.stiffness).start(self.problem, &self.start.u);
        for &rule in self.factor_rules() {
            let may_be_digits = matches!(
                failed,
                Cause::NotConverged | Cause::Diverged | Cause::Lcp(_)
            );
            if rule == FactorRule::Held && !may_be_digits {
                break;
            }
            trace.begin();
            let v = match self.guess {
                Some(path) if !self.problem.integration.has_rates => &path.v,
                _ => &self.start.v,
            };
            (self.workspace.search).start(v, self.interval.dt);
            if !self.problem.fits.are_none() {
                let allowed = self.problem.fits.allowed(self.interval);
                self.workspace.search.allow(allowed);
            }
            let mut factors = Refactorization::new(rule, self.problem.settings.tolerance);
            match self.passes(self.choice(rule), &mut factors, &mut trace, &mut vectors) {
                Ok(solved) => {
                    return Ok(Solved {
                        passes: trace.passes,
                        holds_pairs: rule == FactorRule::Held,
                        ..solved
                    });
                }
                Err(cause) => failed = cause,
            }
            self.guess = None;
        }
        Err(trace.failed(failed, self.problem.settings.tolerance))
    }

    /// Rules of the factors in the order in which they are tried: in a static step, whose tangent is exact, new ones
    /// in every pass, from the motion of the last increment and then from rest; then with closed pairs held, since K
    /// alone, soft in bending, leaves the contact forces of slender bodies few digits.
    fn factor_rules(&self) -> &'static [FactorRule] {
        match (self.problem.integration.has_rates, self.guess) {
            (true, _) => FactorRule::order(self.problem.settings.factorization),
            (false, Some(path)) if path.holds_pairs => &[FactorRule::Held, FactorRule::EveryPass],
            (false, Some(_)) => &[
                FactorRule::EveryPass,
                FactorRule::EveryPass,
                FactorRule::Held,
            ],
            (false, None) => &[FactorRule::EveryPass, FactorRule::Held],
        }
    }

    /// Slave nodes whose constraints the passes begin with. They are the near ones where velocities tell how far nodes go, and
    /// all of them with the last rule.
    fn choice(&self, rule: FactorRule) -> SlaveChoice {
        match (self.set, rule) {
            (ConstraintSet::All, FactorRule::Kept)
                if self.problem.integration.velocities_tell() =>
            {
                SlaveChoice::Near
            }
            _ => SlaveChoice::All,
        }
    }

    /// Predictor and correctors, which share one form (paper eqs 27, 29 and 36 to 49), with the constraints of the chosen
    /// slave nodes; all of them take part before they end.
    fn passes(
        &mut self,
        choice: SlaveChoice,
        factors: &mut Refactorization,
        trace: &mut Trace,
        v: &mut Vectors,
    ) -> Result<Solved, Cause> {
        let (problem, start, dt) = (self.problem, self.start, self.interval.dt);
        let closed = self.guess.map_or(&start.contact, |path| &path.closed);
        let mut contact = ContactStates::new(closed, self.set, choice);
        let mut equal_forces = EqualForces::new(problem.settings.tolerance);
        let mut acceleration = PassAcceleration::new();
        let mut pins = PinState::new(
            self.guess
                .map_or(HeldMotions::default(), |path| path.held.clone()),
        );
        let mut has_no_pairs = true;
        v.equilibrium.hinges.clear();
        let all = self.workspace.pins.dofs();
        v.equilibrium.held = all.zip(pins.held.forces(&self.workspace.pins)).collect();
        // the passes start from the rigid motion of the bodies, or from a motion that is known
        let mut d = match self.guess {
            Some(path) => path.displacement(dt),
            None => rigid_predictor(problem, start, self.interval),
        };
        for number in 0..problem.settings.max_passes {
            let is_late = match problem.integration.has_rates {
                false if factors.are_near() => number >= STATIC_PATIENCE,
                _ => number >= PATIENCE,
            };
            if is_late && !trace.will_end(&problem.settings) {
                break;
            }
            // g, Dt and their rows, V0+ and r in the iterate U = U0 + d
            let settled = number >= SEARCHING_PASSES;
            self.evaluate(number, &mut d, &mut contact, v)?;
            let map = self.workspace.stiffness.k.map();
            trace.balance(map.largest_restricted(&v.equilibrium.out_of_balance));

            // the forces at hand may balance r and close the gaps of the iterate
            contact.relinearize();
            let iterate = Iterate::new(&v.equilibrium, &contact.forces, [&v.u, &d]);
            let stage = PassStage {
                settled,
                stagnates: factors.stagnate(),
            };
            let may_end = contact.impulses.are_at_rest() && factors.are_near();
            if may_end
                && let Some(residual) = self.residual(&iterate, stage, &mut v.residual)?
                && self.complete(&mut contact, &v.u, None)
            {
                trace.solved(residual);
                self.pins().check_held(&contact.forces, &pins, v)?;
                return self.finish(&d, contact, pins.held, v, true);
            }

            // K* of eq. (4.6), and d_p at the supports, which takes the force theta2 K d_p
            self.refresh(factors, v, &contact.forces, trace.correction())?;
            self.supports(number, v);

            // Pn, Pt of the complementarity problem, eq. (5.2);
            // dU = d_p + K*^-1 (r - theta2 K d_p + Bn^T Pn + Bt^T Pt), eq. (4.7)
            let weight = equal_forces.weight(settled);
            let hinge_forces = match self.workspace.pins.are_none() {
                true => self.balance(&mut contact.forces, weight, v)?,
                false => self
                    .pins()
                    .iterate(&mut contact.forces, weight, &mut pins, v)?,
            };
            // the last equilibrium shows facets as they are
            if number == 0 && self.guess.is_none() {
                self.pins().check_held(&contact.forces, &pins, v)?;
            }
            self.take_hinge_forces(hinge_forces, v);

            // residual r + Bn^T Pn + Bt^T Pt and correction dU beside their scales
            let iterate = Iterate::new(&v.equilibrium, &contact.forces, [&v.u, &d]);
            let pass = iterate.pass(&v.support_force, &v.du);
            let has_converged = self.measure(&pass, &mut v.residual, trace)?;

            let ends = contact.rest(problem)
                && has_converged
                && self.complete(&mut contact, &v.u, Some(&v.du));
            self.pins().move_finitely(v);
            let correction = trace.correction();
            if !ends {
                equal_forces.take_in(correction, settled);
                // friction that falls with the slip rate moves away from that at rest
                let may_grow = equal_forces.moves_more() || contact.friction_moves;
                factors.take_in(correction, may_grow)?;
                if number >= SLOW_PASSES {
                    let progress = CorrectionProgress {
                        correction,
                        rate: factors.rate(),
                        tolerance: problem.settings.tolerance,
                        same_pairs: contact.forces.are_of_same_pairs(),
                    };
                    acceleration.improve(problem.parts, &d, progress, &mut v.du);
                }
            }
            // d <- d + dU, eq. (4.7)
            d.iter_mut().zip(&v.du).for_each(|(d, du)| *d += du);
            let begins = number == 0 || (has_no_pairs && !self.workspace.pins.are_none());
            if begins && !self.problem.integration.has_rates {
                v.tangent.clone_from(&d);
            }
            has_no_pairs &= contact.forces.closed.is_empty();
            if ends {
                self.pins().check_held(&contact.forces, &pins, v)?;
                return self.finish(&d, contact, pins.held, v, false);
            }
        }
        Err(Cause::NotConverged)
    }

    /// Evaluates the iterate U = U0 + d: constraints, impulses and forces.
    fn evaluate(
        &mut self,
        pass: usize,
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
        let of_set = (
            self.set,
            kept_beyond_ends(pass, problem.integration.has_rates),
        );
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

    /// The passes with pins.
    fn pins(&mut self) -> PinIteration<'_, 'm> {
        PinIteration {
            problem: self.problem,
            workspace: self.workspace,
        }
    }

    /// Contact forces and correction of a pass without pins; gives the forces by which hinges close their gaps.
    fn balance(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        v: &mut Vectors,
    ) -> Result<Vec<f64>, Cause> {
        let closing = close_hinges(self.problem, self.workspace, v)?;
        let mut k_star = self.workspace.k();
        if self.problem.integration.has_rates {
            contact.solve([&v.closing, &v.load], weight, &mut k_star, &mut v.du)?;
            return Ok(closing);
        }
        let Equilibrium { load, internal, .. } = &v.equilibrium;
        let others = largest(load).max(largest(internal));
        loop {
            let mut load = v.load.clone();
            v.skew.add_to(&mut load);
            contact.solve([&v.closing, &load], weight, &mut k_star, &mut v.du)?;
            // forces of which several are answers would be others each time
            if contact.pivots > 0 || v.skew.take_in(&v.du, others) {
                return Ok(closing);
            }
        }
    }

    /// Writes what the predictor leaves of the prescribed motion, d_p, which the first pass makes, and its
    /// force theta2 K d_p, then zero; and r - theta2 K d_p.
    fn supports(&mut self, pass: usize, vectors: &mut Vectors) {
        self.move_supports(pass, vectors);
        let Vectors {
            equilibrium,
            support_force,
            load,
            ..
        } = vectors;
        write_difference(&equilibrium.out_of_balance, support_force, load);
    }

    /// Writes d_p and theta2 K d_p.
    fn move_supports(&mut self, pass: usize, vectors: &mut Vectors) {
        let (problem, integration) = (self.problem, &self.problem.integration);
        let Vectors {
            equilibrium: Equilibrium { u_theta, .. },
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
            let motion = integration.motion(self.start, u, u_theta);
            let product = (self.workspace).tangent_product(problem, motion, d_p);
            (force.iter_mut().zip(&product)).for_each(|(f, k)| *f = integration.theta2 * k);
        }
    }

    /// Adds the forces of a pass to those of the hinges: what closes their gaps, and what the other forces ask of them.
    fn take_hinge_forces(&mut self, closing: Vec<f64>, v: &mut Vectors) {
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

    /// Factorises K* anew when the rules say so, else turns its factors with the bodies.
    fn refresh(
        &mut self,
        factors: &mut Refactorization,
        Vectors {
            u,
            equilibrium,
            skew,
            ..
        }: &mut Vectors,
        contact: &ContactForces,
        correction: f64,
    ) -> Result<(), Cause> {
        let (problem, dt) = (self.problem, self.interval.dt);
        let fits = (self.workspace.stiffness).fits(dt, length_tolerance(self.set));
        let motion = (problem.integration).motion(self.start, u, &equilibrium.u_theta);
        if fits && !factors.are_worn() {
            self.workspace.turn(problem, motion);
            return Ok(());
        }
        factors.renew();
        let at = problem.configurations(&self.start.u, u);
        let mut followers = match problem.integration.has_rates {
            true => Vec::new(),
            false => (problem.loads).changes(problem.elements, self.interval.end, u),
        };
        let closed = ClosedConstraints {
            acting: contact.acting().collect(),
            at,
            are_held: factors.hold_pairs(),
            followers: &followers,
            out_of_balance: &equilibrium.out_of_balance,
            held: &HeldMotions::default(),
        };
        let factorized = (self.workspace).factorize(problem, dt, motion, &closed);
        factorized.map_err(|error| problem.unsolvable(error))?;
        if !problem.integration.has_rates {
            let of_pair = |(constraint, pair): (&Constraint, &ClosedPair)| ForceChange {
                dofs: constraint.dofs.to_vec(),
                matrix: constraint.change(pair.force, &at),
            };
            followers.extend(contact.acting().map(of_pair));
            *skew = match self.workspace.stiffness.form {
                StiffnessForm::Positive => SkewPart::default(),
                _ => SkewPart::new(&followers, correction),
            };
        }
        Ok(())
    }

    /// The relative residual, where the forces at hand balance the iterate and its gaps and slips are those of the contact
    /// law.
    fn residual(
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

    /// Takes in the constraints of the iterate U that were left out; whether they stay open, with a correction dU.
    fn complete(&mut self, contact: &mut ContactStates, u: &[f64], du: Option<&[f64]>) -> bool {
        let of_increment = (self.start, self.interval);
        contact.complete(self.problem, self.workspace, of_increment, u, du)
    }

    /// Compares residual and correction of a pass with their scales; whether it has converged, with a solve
    /// that passes its check.
    fn measure(
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

    /// Whether the friction of a pass is that of the law at the slip rates and pressures that the pass leads to, which change
    /// the coefficient that it had.
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

    /// Motion and forces at the end of a converged increment d from the vectors of its last pass; whether their
    /// equilibrium is that of U0 + d.
    fn finish(
        &mut self,
        d: &[f64],
        mut contact: ContactStates,
        held: HeldMotions,
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
            // its impulses may have stood beside V0
            (self.problem).inertia(self.start, &v0p, d, self.interval, &mut equilibrium);
        } else {
            self.equilibrium(&v0p, [&u, d], &mut equilibrium)?;
        }
        let v0p = v0p.v0p.into_owned();
        let tangent = std::mem::take(&mut v.tangent);
        // V1 of eq. (4.2); of what is prescribed from the amplitude; at rest in a static step
        let integration = &self.problem.integration;
        let mut v = integration.end_velocity(d, &v0p, self.interval.dt);
        (self.problem.unknowns).prescribe(self.interval.end, &mut u, &mut v);
        let a = equilibrium.acceleration.clone();
        match self.problem.integration.has_rates {
            true => carry_nodes(self.problem, (&v0p, self.interval.dt), (&u, &a), &mut v),
            false => v.fill(0.0),
        }
        let Updated {
            variables: internal,
            dissipated,
        } = (self.problem.elements).update(Motion {
            start: Some(&self.start.u),
            ..Motion::at(&u, &self.start.internal)
        });
        let end = State {
            u,
            v,
            a,
            internal,
            contact: contact.forces.closed.clone(),
        };
        end.check_finite()?;
        Ok(Solved {
            d: d.to_vec(),
            v0p,
            equilibrium,
            contact,
            end,
            material_dissipation: dissipated,
            tangent,
            passes: Vec::new(),
            returned: Returned::default(),
            held,
            holds_pairs: false,
        })
    }
}
