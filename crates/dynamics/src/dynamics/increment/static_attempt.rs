//! Solution of a static increment: passes with an exact tangent, in which bodies that no support holds move as contact
//! allows. See docs/theory/bodies.md, Static steps.

use super::acceleration::{CorrectionProgress, PassAcceleration};
use super::contact_forces::ContactForces;
use super::contact_states::ContactStates;
use super::corrections::Corrections;
use super::equal_forces::EqualForces;
use super::linear_pass::{SkewPart, Vectors};
use super::pass::{Iterate, PassStage};
use super::passes::{Passes, SLOW_PASSES};
use super::pin_iteration::{PinIteration, PinState};
use super::refactorization::FactorRule;
use super::rigid_predictor::rigid_predictor;
use super::solved::{Path, Solved};
use super::static_factors::{StaticFactors, StaticRates};
use super::trace::{Failed, Trace};
use crate::contact::{ClosedPair, Constraint, SlaveChoice};
use crate::dynamics::results::Cause;
use crate::dynamics::step::{ClosedConstraints, ForceChange, HeldMotions, StiffnessForm};
use crate::model::Factorization;

/// Number of passes that are made in any case while corrections are small. Passes converge quadratically, so an attempt
/// goes on only if its passes will end within MAX PASSES.
const PATIENCE: usize = 8;
/// Number of passes that are made in any case while corrections are large.
const LARGE_PATIENCE: usize = 25;
/// Number of passes after which slave nodes keep their targets.
const SEARCHING_PASSES: usize = 3;
/// Number of passes from which on the equal-force rule makes the forces of pairs settle.
const SETTLED_PASSES: usize = 4;

/// An attempt at one static increment.
pub(super) struct StaticAttempt<'a, 'm> {
    pub passes: Passes<'a, 'm>,
    /// The path from which the passes start; if `None`, they start from the rigid motion of the bodies.
    pub guess: Option<&'a Path>,
}

impl<'m> StaticAttempt<'_, 'm> {
    /// Solves the increment, starting from the motion of the last increment, with factors that are kept as long as they
    /// pay, then with new factors in every pass. If both ways fail, the increment starts from rest, and then with K*
    /// stiffened by closed pairs. K alone is soft in bending and leaves the contact forces of slender bodies few
    /// digits.
    pub fn solve(mut self) -> Result<Solved, Failed> {
        let settings = &self.passes.problem.settings;
        let mut trace = Trace::new(settings.max_passes);
        let mut vectors = Vectors::default();
        let mut failed = Cause::NotConverged;
        let mut rates = self.guess.map_or(StaticRates::default(), |path| path.rates);
        for &(pairs_stiffen, rule) in self.orders() {
            let may_be_digits = matches!(
                failed,
                Cause::NotConverged | Cause::Diverged | Cause::Lcp(_)
            );
            if pairs_stiffen && !may_be_digits {
                break;
            }
            trace.begin();
            let v = self.guess.map_or(&self.passes.start.v, |path| &path.v);
            self.passes.start_search(v);
            let mut factors = StaticFactors::new(rates, rule, settings.tolerance);
            let solved = self.solve_with(pairs_stiffen, &mut factors, &mut trace, &mut vectors);
            rates = factors.rates();
            match solved {
                Ok(solved) => {
                    return Ok(Solved {
                        passes: trace.passes,
                        pairs_stiffen,
                        rates,
                        tells_stability: factors.are_near(),
                        ..solved
                    });
                }
                Err(cause) => failed = cause,
            }
            if !factors.have_been_kept() {
                self.guess = None;
            }
        }
        Err(trace.failed(failed, settings.tolerance))
    }

    /// Attempts in their order; each states whether closed pairs stiffen K*, and the rule for the factors of the
    /// passes.
    fn orders(&self) -> &'static [(bool, FactorRule)] {
        use FactorRule::{EveryPass, Kept};
        let may_keep = self.passes.problem.settings.factorization == Factorization::Keep;
        match self.guess {
            Some(path) if path.pairs_stiffen => &[(true, EveryPass), (false, EveryPass)],
            // the effect of facets shows only with exact tangents
            Some(path) if may_keep && path.held.are_none() => &[
                (false, Kept),
                (false, EveryPass),
                (false, EveryPass),
                (true, EveryPass),
            ],
            Some(_) => &[(false, EveryPass), (false, EveryPass), (true, EveryPass)],
            None if may_keep => &[(false, Kept), (false, EveryPass), (true, EveryPass)],
            None => &[(false, EveryPass), (true, EveryPass)],
        }
    }

    /// Solves the increment with the given choice of whether closed pairs stiffen K* and whether factors are kept.
    fn solve_with(
        &mut self,
        pairs_stiffen: bool,
        factors: &mut StaticFactors,
        trace: &mut Trace,
        v: &mut Vectors,
    ) -> Result<Solved, Cause> {
        let (problem, start) = (self.passes.problem, self.passes.start);
        let interval = self.passes.interval;
        let settings = &problem.settings;
        let closed = self.guess.map_or(&start.contact, |path| &path.closed);
        let mut contact = ContactStates::new(closed, self.passes.set, SlaveChoice::All);
        let mut equal_forces = EqualForces::new(settings.tolerance);
        let mut acceleration = PassAcceleration::new();
        let mut corrections = Corrections::new();
        let held = self.guess.map(|path| path.held.clone());
        let mut pins = PinState::new(held.unwrap_or_default());
        let mut has_no_pairs = true;
        v.equilibrium.hinges.clear();
        let all = self.passes.workspace.pins.dofs();
        let forces = pins.held.forces(&self.passes.workspace.pins);
        v.equilibrium.held = all.zip(forces).collect();
        // the passes start from the rigid motion of the bodies, or from the motion of an earlier
        // solution
        let mut d = match self.guess {
            Some(path) => path.displacement(interval.dt),
            None => rigid_predictor(problem, start, interval),
        };
        for number in 0..settings.max_passes {
            let patience = match corrections.are_near() {
                true => PATIENCE,
                false => LARGE_PATIENCE,
            };
            if number >= patience && !trace.will_end(settings) {
                break;
            }
            // g, Dt, their rows and r in the iterate U = U0 + d
            let settled = number >= SETTLED_PASSES;
            self.passes
                .evaluate((number, SEARCHING_PASSES), &mut d, &mut contact, v)?;
            let map = self.passes.workspace.stiffness.k.map();
            trace.balance(map.largest_restricted(&v.equilibrium.out_of_balance));

            // the available contact forces may already balance r and close the gaps of the iterate
            contact.relinearize();
            let iterate = Iterate::new(&v.equilibrium, &contact.forces, [&v.u, &d]);
            let stage = PassStage {
                settled,
                stagnates: corrections.stagnate(),
            };
            if corrections.are_near()
                && let Some(residual) = self.passes.residual(&iterate, stage, &mut v.residual)?
                && self.passes.complete(&mut contact, &v.u, None)
            {
                trace.solved(residual);
                self.pins().check_held(&contact.forces, &pins, v)?;
                return self.finish(&d, contact, pins, v, true);
            }

            // K - (C + C^T)/2 of eq. (12.1), and d_p at the supports, with the force K d_p
            let is_first = number == 0 && self.guess.is_none();
            let is_new = is_first || !self.fits(pairs_stiffen) || factors.are_worn();
            factors.begin(is_new);
            let changes = self.tangent((pairs_stiffen, is_new), v, &contact.forces)?;
            v.skew = self.skew_part(changes, trace.correction());
            self.passes.supports(number, v);

            // Pn, Pt and p of the complementarity problem, dU of eq. (12.3)
            let weight = equal_forces.weight(settled);
            let hinge_forces = self
                .pins()
                .iterate(&mut contact.forces, weight, &mut pins, v)?;
            // in the first pass the facets are those of the last equilibrium
            if number == 0 && self.guess.is_none() {
                self.pins().check_held(&contact.forces, &pins, v)?;
            }
            self.passes.take_hinge_forces(hinge_forces, v);

            // residual r + Bn^T Pn + Bt^T Pt and correction dU, relative to their scales
            let iterate = Iterate::new(&v.equilibrium, &contact.forces, [&v.u, &d]);
            let pass = iterate.pass(&v.support_force, &v.du);
            let ends = self.passes.measure(&pass, &mut v.residual, trace)?
                && self.passes.complete(&mut contact, &v.u, Some(&v.du));
            self.pins().move_finitely(v);
            let correction = trace.correction();
            if ends {
                factors.end(correction);
            } else {
                equal_forces.take_in(correction, settled);
                // a coefficient of friction that falls with the slip rate moves away from the
                // coefficient at rest
                let may_grow = equal_forces.moves_more() || contact.friction_moves;
                corrections.take_in(correction, may_grow)?;
                factors.take_in(correction)?;
                if number >= SLOW_PASSES {
                    let progress = CorrectionProgress {
                        correction,
                        rate: corrections.rate(),
                        tolerance: settings.tolerance,
                        same_pairs: contact.forces.are_of_same_pairs(),
                    };
                    acceleration.improve(problem.parts, &d, progress, &mut v.du);
                }
            }
            // d <- d + dU, eq. (4.7)
            d.iter_mut().zip(&v.du).for_each(|(d, du)| *d += du);
            if number == 0 || (has_no_pairs && !self.passes.workspace.pins.are_none()) {
                v.tangent.clone_from(&d);
            }
            has_no_pairs &= contact.forces.closed.is_empty();
            if ends {
                self.pins().check_held(&contact.forces, &pins, v)?;
                return self.finish(&d, contact, pins, v, false);
            }
        }
        Err(Cause::NotConverged)
    }

    /// The passes with the motions of bodies that no support holds.
    fn pins(&mut self) -> PinIteration<'_, 'm> {
        PinIteration {
            problem: self.passes.problem,
            workspace: self.passes.workspace,
        }
    }

    /// Whether the available factors belong to the kind of K* that the next pass needs.
    fn fits(&self, pairs_stiffen: bool) -> bool {
        let stiffness = &self.passes.workspace.stiffness;
        let is_tangent = stiffness.form == StiffnessForm::Tangent && !pairs_stiffen;
        is_tangent && stiffness.k.solver.is_factorized()
    }

    /// Computes the changes C of the forces of loads and pairs at the iterate; factorises K - (C +
    /// C^T)/2 if new factors are due (`is_new`).
    fn tangent(
        &mut self,
        (pairs_stiffen, is_new): (bool, bool),
        v: &Vectors,
        contact: &ContactForces,
    ) -> Result<Vec<ForceChange>, Cause> {
        let Passes {
            problem,
            start,
            interval,
            ..
        } = self.passes;
        let Vectors { u, equilibrium, .. } = v;
        let at = problem.configurations(&start.u, u);
        let mut changes = (problem.loads).changes(interval.end, u);
        if is_new {
            let motion = (problem.integration).motion(start, u, equilibrium.place());
            let closed = ClosedConstraints {
                acting: contact.acting().collect(),
                at,
                pairs_stiffen,
                followers: &changes,
                out_of_balance: &equilibrium.out_of_balance,
                held: &HeldMotions::default(),
            };
            let workspace = &mut *self.passes.workspace;
            let factorized = workspace.factorize(problem, interval.dt, motion, &closed);
            factorized.map_err(|error| problem.unsolvable(error))?;
        }
        let of_pair = |(constraint, pair): (&Constraint, &ClosedPair)| ForceChange {
            dofs: constraint.dofs.to_vec(),
            matrix: constraint.change(pair.force, &at),
        };
        changes.extend(contact.acting().map(of_pair));
        Ok(changes)
    }

    /// The part N of the changes C that K* omits.
    fn skew_part(&self, changes: Vec<ForceChange>, correction: f64) -> SkewPart {
        match self.passes.workspace.stiffness.form {
            StiffnessForm::Positive => SkewPart::default(),
            _ => SkewPart::new(&changes, correction),
        }
    }

    /// State at the end of the increment, at rest.
    fn finish(
        &mut self,
        d: &[f64],
        contact: ContactStates,
        pins: PinState,
        v: &mut Vectors,
        is_balanced: bool,
    ) -> Result<Solved, Cause> {
        let mut solved = self.passes.finish(d, contact, v, is_balanced)?;
        (solved.held, solved.has_tipped) = (pins.held, pins.has_tipped);
        solved.end.v.fill(0.0);
        solved.end.check_finite()?;
        Ok(solved)
    }
}
