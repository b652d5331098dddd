//! Solution of one increment: predictor and corrector passes with contact forces and impulses.
//! See docs/theory/time.md (paper eqs 27, 29 and 36 to 49).

use super::acceleration::{CorrectionProgress, PassAcceleration};
use super::contact_forces::ContactForces;
use super::contact_states::ContactStates;
use super::corrections::SEARCHING_PASSES;
use super::equal_forces::EqualForces;
use super::linear_pass::{Vectors, close_hinges};
use super::pass::{Iterate, PassStage};
use super::passes::{Passes, SLOW_PASSES};
use super::refactorization::{FactorRule, Refactorization};
use super::rigid_predictor::rigid_predictor;
use super::rigid_velocity::carry_nodes;
use super::solved::{Path, Solved};
use super::static_attempt::StaticAttempt;
use super::trace::{Failed, Trace};
use crate::contact::{ConstraintSet, SlaveChoice};
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{
    ClosedConstraints, FactoredState, HeldMotions, Interval, StepProblem, Workspace,
};

/// Number of passes that an attempt always makes; it makes further passes only if the passes will converge within MAX
/// PASSES.
const PATIENCE: usize = 25;

/// Relative difference of lengths up to which subincrements between impacts share the factors of K*.
const SAME_LENGTH: f64 = 1e-3;

/// Relative difference of lengths within which factors of K* are kept; the lengths of trials for the time of an impact
/// differ by little.
fn length_tolerance(set: ConstraintSet) -> f64 {
    match set {
        ConstraintSet::All => 0.0,
        ConstraintSet::Active(_) => SAME_LENGTH,
    }
}

/// An attempt at one increment.
pub(crate) struct Attempt<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
    pub start: &'a State,
    pub interval: Interval,
    pub set: ConstraintSet<'a>,
    /// The path from which the passes start; if `None`, they start from the rigid motion of the bodies.
    pub guess: Option<&'a Path>,
}

impl Attempt<'_, '_> {
    /// Solves the increment by the procedure of its step.
    pub fn solve(self) -> Result<Solved, Failed> {
        let Attempt {
            problem,
            workspace,
            start,
            interval,
            set,
            guess,
        } = self;
        (workspace.stiffness).start(problem, &start.u);
        let passes = Passes {
            problem,
            workspace,
            start,
            interval,
            set,
        };
        match problem.integration.has_rates {
            true => DynamicAttempt { passes, guess }.solve(),
            false => StaticAttempt { passes, guess }.solve(),
        }
    }
}

/// An attempt at one dynamic increment.
struct DynamicAttempt<'a, 'm> {
    passes: Passes<'a, 'm>,
    guess: Option<&'a Path>,
}

impl DynamicAttempt<'_, '_> {
    /// Solves the increment with the available factors of K* as long as this pays, then with new factors in every pass.
    fn solve(mut self) -> Result<Solved, Failed> {
        let settings = &self.passes.problem.settings;
        let mut trace = Trace::new(settings.max_passes);
        let mut vectors = Vectors::default();
        let mut failed = Cause::NotConverged;
        for &rule in FactorRule::order(settings.factorization) {
            trace.begin();
            self.passes.start_search(&self.passes.start.v);
            let are_due = self.passes.workspace.wear.is_due();
            let mut factors = Refactorization::new(rule, are_due, settings.tolerance);
            let choice = self.choice(rule);
            match self.solve_with(choice, &mut factors, &mut trace, &mut vectors) {
                Ok(solved) => {
                    if rule == FactorRule::Kept && factors.are_of_all_passes() {
                        self.passes.workspace.wear.take_in(trace.passes.len());
                    }
                    return Ok(Solved {
                        passes: trace.passes,
                        ..solved
                    });
                }
                Err(cause) => failed = cause,
            }
            self.guess = None;
        }
        Err(trace.failed(failed, settings.tolerance))
    }

    /// The slave nodes whose constraints the passes find at first. The choice is the near nodes if all pairs count,
    /// factors are kept and velocities tell how far nodes go; otherwise the choice is all nodes.
    fn choice(&self, rule: FactorRule) -> SlaveChoice {
        match (self.passes.set, rule) {
            (ConstraintSet::All, FactorRule::Kept)
                if self.passes.problem.integration.velocities_tell() =>
            {
                SlaveChoice::Near
            }
            _ => SlaveChoice::All,
        }
    }

    /// Predictor and correctors, which have the same form (paper eqs 27, 29 and 36 to 49), with the constraints of the
    /// chosen slave nodes. Before the passes end, all slave nodes take part.
    fn solve_with(
        &mut self,
        choice: SlaveChoice,
        factors: &mut Refactorization,
        trace: &mut Trace,
        v: &mut Vectors,
    ) -> Result<Solved, Cause> {
        let (problem, start) = (self.passes.problem, self.passes.start);
        let interval = self.passes.interval;
        let settings = &problem.settings;
        let closed = self.guess.map_or(&start.contact, |path| &path.closed);
        let mut contact = ContactStates::new(closed, self.passes.set, choice);
        let mut equal_forces = EqualForces::new(settings.tolerance);
        let mut acceleration = PassAcceleration::new();
        v.equilibrium.hinges.clear();
        // the passes start from the rigid motion of the bodies, or from the motion of an earlier
        // solution
        let mut d = match self.guess {
            Some(path) => path.displacement(interval.dt),
            None => rigid_predictor(problem, start, interval),
        };
        for number in 0..settings.max_passes {
            if number >= PATIENCE && !trace.will_end(settings) {
                break;
            }
            // g, Dt and their rows, V0+ and r in the iterate U = U0 + d
            let settled = number >= SEARCHING_PASSES;
            self.passes
                .evaluate((number, SEARCHING_PASSES), &mut d, &mut contact, v)?;
            let map = self.passes.workspace.stiffness.k.map();
            trace.balance(map.largest_restricted(&v.equilibrium.out_of_balance));

            // the available contact forces may already balance r and close the gaps of the iterate
            contact.relinearize();
            let iterate = Iterate::new(&v.equilibrium, &contact.forces, [&v.u, &d]);
            let corrections = factors.corrections();
            let stage = PassStage {
                settled,
                stagnates: corrections.stagnate(),
            };
            let may_end = contact.impulses.are_at_rest() && corrections.are_near();
            if may_end
                && let Some(residual) = self.passes.residual(&iterate, stage, &mut v.residual)?
                && self.passes.complete(&mut contact, &v.u, None)
            {
                trace.solved(residual);
                return self.finish(&d, contact, v, true);
            }

            // K* of eq. (4.6), and d_p at the supports, with the force theta2 K d_p
            self.refresh(factors, v, &contact.forces)?;
            self.passes.supports(number, v);

            // Pn, Pt of the complementarity problem, eq. (5.2);
            // dU = d_p + K*^-1 (r - theta2 K d_p + Bn^T Pn + Bt^T Pt), eq. (4.7)
            let weight = equal_forces.weight(settled);
            let hinge_forces = self.balance(&mut contact.forces, weight, v)?;
            self.passes.take_hinge_forces(hinge_forces, v);

            // residual r + Bn^T Pn + Bt^T Pt and correction dU, relative to their scales
            let iterate = Iterate::new(&v.equilibrium, &contact.forces, [&v.u, &d]);
            let pass = iterate.pass(&v.support_force, &v.du);
            let has_converged = self.passes.measure(&pass, &mut v.residual, trace)?;
            let ends = contact.rest(problem)
                && has_converged
                && self.passes.complete(&mut contact, &v.u, Some(&v.du));
            if !ends {
                let correction = trace.correction();
                equal_forces.take_in(correction, settled);
                // a coefficient of friction that falls with the slip rate moves away from the
                // coefficient at rest
                let may_grow = equal_forces.moves_more() || contact.friction_moves;
                factors.take_in(correction, may_grow)?;
                if number >= SLOW_PASSES {
                    let progress = CorrectionProgress {
                        correction,
                        rate: factors.corrections().rate(),
                        tolerance: settings.tolerance,
                        same_pairs: contact.forces.are_of_same_pairs(),
                    };
                    acceleration.improve(problem.parts, &d, progress, &mut v.du);
                }
            }
            // d <- d + dU, eq. (4.7)
            d.iter_mut().zip(&v.du).for_each(|(d, du)| *d += du);
            if ends {
                return self.finish(&d, contact, v, false);
            }
        }
        Err(Cause::NotConverged)
    }

    /// Solves for contact forces and correction of a pass; returns the forces by which hinges close their gaps.
    fn balance(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        v: &mut Vectors,
    ) -> Result<Vec<f64>, Cause> {
        let workspace = &mut *self.passes.workspace;
        let closing = close_hinges(self.passes.problem, workspace, v)?;
        contact.solve([&v.closing, &v.load], weight, &mut workspace.k(), &mut v.du)?;
        Ok(closing)
    }

    /// Factorises K* anew if the rules for factors demand this, else turns the factors of K* with the bodies.
    fn refresh(
        &mut self,
        factors: &mut Refactorization,
        Vectors { u, equilibrium, .. }: &mut Vectors,
        contact: &ContactForces,
    ) -> Result<(), Cause> {
        let Passes {
            problem,
            start,
            interval,
            set,
            ..
        } = self.passes;
        let workspace = &mut *self.passes.workspace;
        let fits = (workspace.stiffness).fits(interval.dt, length_tolerance(set));
        let motion = (problem.integration).motion(start, u, equilibrium.place());
        if fits && !factors.are_worn() {
            workspace.turn(problem, motion);
            return Ok(());
        }
        let state = match fits && factors.may_be_kept() {
            true => workspace.wear.renew(factors.are_first()),
            false => workspace.wear.begin(),
        };
        factors.renew();
        let closed = ClosedConstraints {
            acting: match state {
                FactoredState::Iterate => contact.acting().collect(),
                FactoredState::Unstrained => Vec::new(),
            },
            at: problem.configurations(&start.u, u),
            pairs_stiffen: false,
            followers: &[],
            out_of_balance: &equilibrium.out_of_balance,
            held: &HeldMotions::default(),
        };
        let factorized = match state {
            FactoredState::Iterate => workspace.factorize(problem, interval.dt, motion, &closed),
            FactoredState::Unstrained => {
                workspace.factorize_unstrained(problem, interval.dt, motion, &closed)
            }
        };
        factorized.map_err(|error| problem.unsolvable(error))
    }

    /// State at the end of the increment, with the velocities of the nodes of rigid bodies.
    fn finish(
        &mut self,
        d: &[f64],
        contact: ContactStates,
        v: &mut Vectors,
        is_balanced: bool,
    ) -> Result<Solved, Cause> {
        let mut solved = self.passes.finish(d, contact, v, is_balanced)?;
        let Solved { v0p, end, .. } = &mut solved;
        let start = (&v0p[..], self.passes.interval.dt);
        carry_nodes(self.passes.problem, start, (&end.u, &end.a), &mut end.v);
        end.check_finite()?;
        Ok(solved)
    }
}
