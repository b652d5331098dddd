//! A pass of a static increment with bodies that no support holds: contact forces, correction and rigid motions of the
//! bodies. A motion that only the facets of the mesh resist is held; for a motion that nothing resists there is no
//! equilibrium. See docs/theory/bodies.md, Pins.

use super::contact_forces::ContactForces;
use super::linear_pass::{Vectors, close_hinges};
use crate::dynamics::results::Cause;
use crate::dynamics::step::{
    Equilibrium, HeldMotions, Loose, StepProblem, Workspace, difference, sum,
};
use crate::lcp::Stability;
use crate::linear::{larger, largest};

/// Largest force, relative to the largest of the other forces, that is ignored if it acts along a motion that nothing
/// resists and that cannot be held.
const SMALL_FORCE: f64 = 1e-9;
/// Force at the pins of a body that counts as zero, relative to the largest force at all pins.
const NO_PART: f64 = 1e-12;
/// Number of passes in a row with a body that touches nothing and is not in balance after which there is no
/// equilibrium.
const FREE_PASSES: usize = 3;

/// A body that is not in balance: forces at all pins, and a correction that shows its motion.
struct Unbalance {
    force: Vec<f64>,
    du: Vec<f64>,
}

/// Data that the passes of an increment keep of bodies that no support holds.
#[derive(Default)]
pub(super) struct PinState {
    /// Number of last passes, in a row, in which a body that touches nothing was not in balance.
    free_passes: usize,
    /// The forces that were not balanced before motions were held.
    before: Option<Unbalance>,
    /// Motions that are held.
    pub held: HeldMotions,
    /// Whether a body has tipped over from one contact to another.
    pub has_tipped: bool,
}

impl PinState {
    /// The state of an increment whose passes start with held motions.
    pub fn new(held: HeldMotions) -> Self {
        PinState {
            held,
            ..PinState::default()
        }
    }
}

/// Passes of a static step.
pub(super) struct PinIteration<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
}

impl PinIteration<'_, '_> {
    /// Solves a pass: contact forces, correction and rigid motions. A motion that a force drives is held if only the
    /// facets of the mesh resist the motion. If nothing resists a motion that a force drives, there is no equilibrium.
    ///
    /// Returns the forces by which hinges close their gaps.
    pub fn iterate(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        state: &mut PinState,
        v: &mut Vectors,
    ) -> Result<Vec<f64>, Cause> {
        if self.workspace.pins.are_none() {
            return self.balance(contact, weight, v);
        }
        let of_pairs = contact.resultant(v.u.len());
        let unbalanced = sum(&v.equilibrium.out_of_balance, &of_pairs);
        self.follow_held(contact, &mut state.held, v);
        let mut may_hold = true;
        loop {
            self.free_pins(&unbalanced, &state.held, v)?;
            let closing = self.balance(contact, weight, v)?;
            state.has_tipped |= self.tips();
            self.take_held(&mut state.held, v);
            // the solve may have closed other pairs, with which a held motion is released
            if self.follow_held(contact, &mut state.held, v) {
                continue;
            }
            let driven = self.driven(contact, v);
            if driven.is_empty() {
                state.free_passes = 0;
                return Ok(closing);
            }
            let unbalance = self.unbalance(&driven, v);
            if std::mem::take(&mut may_hold) {
                if self.hold(contact, weight, (&mut state.held, &unbalance.force), v)? {
                    state.before = Some(unbalance);
                }
                continue;
            }
            let others = self.others(contact, v);
            let is_moving =
                |loose: &Loose| loose.is_unresisted && loose.force.abs() > SMALL_FORCE * others;
            if !driven.iter().any(is_moving) {
                state.free_passes = 0;
                return Ok(closing);
            }
            state.free_passes += 1;
            if state.free_passes >= FREE_PASSES || self.touches(contact, &unbalance.force) {
                let Unbalance { force, du } = unbalance;
                let pins = &self.workspace.pins;
                return Err(pins.unbalanceable(self.problem, &v.u, &du, &force));
            }
            return Ok(closing);
        }
    }

    /// Solves for contact forces and correction of a pass; returns the forces by which hinges close their gaps.
    ///
    /// ```text
    /// dU = d_p + W (r + N dU + B^T P) + Z p      eq. (12.4)
    /// ```
    fn balance(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        v: &mut Vectors,
    ) -> Result<Vec<f64>, Cause> {
        let closing = close_hinges(self.problem, self.workspace, v)?;
        let Equilibrium { load, internal, .. } = &v.equilibrium;
        let others = largest(load).max(largest(internal));
        loop {
            let mut load = v.load.clone();
            v.skew.add_to(&mut load);
            let mut k_star = self.workspace.k();
            contact.solve([&v.closing, &load], weight, &mut k_star, &mut v.du)?;
            // the motion Z p already contains its N Z p
            let elastic = match k_star.free() {
                Some(free) => difference(&v.du, &free.motion(&free.p())),
                None => v.du.clone(),
            };
            // if several answers exist, each solve could return other forces
            if contact.pivots > 0 || v.skew.take_in(&elastic, others) {
                return Ok(closing);
            }
        }
    }

    /// Whether a body has tipped over or is about to tip over.
    fn tips(&self) -> bool {
        let free = self.workspace.stiffness.k.free();
        free.is_some_and(|free| free.stability() != Stability::Stable)
    }

    /// Makes the rigid motions of the bodies unknowns, except the motions that are held.
    fn free_pins(
        &mut self,
        unbalanced: &[f64],
        held: &HeldMotions,
        v: &Vectors,
    ) -> Result<(), Cause> {
        let (problem, workspace) = (self.problem, &mut *self.workspace);
        let skew = |motion: &[f64]| v.skew.product(motion);
        let freed = workspace.free_pins(problem, (&v.u, unbalanced), held, &skew);
        freed.map_err(|error| problem.unsolvable(error))
    }

    /// Largest load, internal or normal contact force.
    fn others(&self, contact: &ContactForces, v: &Vectors) -> f64 {
        let Equilibrium { load, internal, .. } = &v.equilibrium;
        let of_pairs = contact.acting().map(|(_, pair)| pair.force[0]);
        [largest(load), largest(internal)]
            .into_iter()
            .chain(of_pairs)
            .fold(0.0, larger)
    }

    /// Motions along which a force drives a body although contact resists the motion not at all, or only as little as
    /// facets may. A motion that facets resist counts only if facets may cause a force as large as the force along the
    /// motion.
    fn driven(&mut self, contact: &ContactForces, v: &Vectors) -> Vec<Loose> {
        let others = self.others(contact, v);
        let problem = self.problem;
        let at = |node: usize| problem.position(&v.u, node);
        let acting: Vec<_> = contact.acting().collect();
        let Workspace {
            pins, stiffness, ..
        } = &*self.workspace;
        let Some(free) = stiffness.k.free() else {
            return Vec::new();
        };
        let facets = |motion: &[f64]| pins.facets(&acting, &at, motion);
        let is_driven = |loose: &Loose| {
            let size = loose.force.abs();
            let [most, _] = facets(&free.motion(loose.pins.as_slice()));
            size > free.none_beside(others) && (loose.is_unresisted || size <= most)
        };
        let all = free.loose(&|motion| facets(motion)[1]).into_iter();
        all.filter(is_driven).collect()
    }

    /// Forces that drive motions of bodies, and a correction along these motions that stays within the reach of the
    /// search.
    fn unbalance(&self, driven: &[Loose], v: &Vectors) -> Unbalance {
        let reach = self.workspace.search.reach();
        let (mut force, mut du) = (Vec::new(), vec![0.0; v.du.len()]);
        for loose in driven {
            let Some(free) = self.workspace.stiffness.k.free() else {
                continue;
            };
            let own = free.force_along(loose);
            force.resize(own.len(), 0.0);
            force.iter_mut().zip(&own).for_each(|(f, own)| *f += own);
            let motion = free.motion(loose.pins.as_slice());
            let both = du.iter_mut().zip(&motion);
            both.for_each(|(d, m)| *d += m * loose.force.signum());
        }
        let part = reach / largest(&du);
        if part.is_finite() {
            du.iter_mut().for_each(|d| *d *= part);
        }
        Unbalance { force, du }
    }

    /// Whether a pair presses on the body that has the largest force at its pins.
    fn touches(&self, contact: &ContactForces, force: &[f64]) -> bool {
        let pins = &self.workspace.pins;
        let acting: Vec<_> = contact.acting().collect();
        let sizes = pins.of_bodies().into_iter().map(|own| largest(&force[own]));
        let of_bodies = sizes.zip(pins.normal_forces(&acting));
        let most = of_bodies.max_by(|(f, _), (g, _)| f.total_cmp(g));
        most.is_some_and(|(_, pressed)| pressed > 0.0)
    }

    /// Holds the free motions of bodies with forces at their pins; returns whether there are any such motions. The free
    /// motions are found in a configuration in which the bodies have not moved away from their contacts.
    fn hold(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        (held, force): (&mut HeldMotions, &[f64]),
        v: &mut Vectors,
    ) -> Result<bool, Cause> {
        *self.workspace.k().free_mut() = None;
        self.balance(contact, weight, v)?;
        let at = |node: usize| self.problem.position(&v.u, node);
        let acting: Vec<_> = contact.acting().collect();
        let least = NO_PART * largest(force);
        Ok(held.hold(&self.workspace.pins, &at, &acting, (force, least)))
    }

    /// Checks that the forces that hold motions in a converged increment are no larger than facets may cause under the
    /// normal forces of the increment.
    pub fn check_held(
        &self,
        contact: &ContactForces,
        PinState { held, before, .. }: &PinState,
        v: &Vectors,
    ) -> Result<(), Cause> {
        if held.are_none() {
            return Ok(());
        }
        let (problem, pins) = (self.problem, &self.workspace.pins);
        let at = |node: usize| problem.position(&v.u, node);
        let acting: Vec<_> = contact.acting().collect();
        let noise = pins.round_off(&self.workspace.stiffness.pins);
        let errors = [problem.settings.tolerance, noise];
        if held.beside_facets(pins, &at, &acting, errors) <= 1.0 {
            return Ok(());
        }
        Err(match before {
            Some(Unbalance { force, du }) => pins.unbalanceable(problem, &v.u, du, force),
            None => (held.strongest(pins, problem, &v.u))
                .map_or(Cause::NotConverged, Cause::Unbalanceable),
        })
    }

    /// Turns the held motions with the surfaces of the iterate; returns whether any held motion is
    /// released.
    fn follow_held(
        &self,
        contact: &ContactForces,
        held: &mut HeldMotions,
        v: &mut Vectors,
    ) -> bool {
        if held.are_none() {
            return false;
        }
        let at = |node: usize| self.problem.position(&v.u, node);
        let acting: Vec<_> = contact.acting().collect();
        let lets_go = held.follow(&self.workspace.pins, &at, &acting);
        self.set_held(held, v);
        lets_go
    }

    /// Adds the forces of the pins along held motions in a pass to the equilibrium.
    fn take_held(&mut self, held: &mut HeldMotions, v: &mut Vectors) {
        let Some(free) = self.workspace.stiffness.k.free() else {
            return;
        };
        if held.are_none() {
            return;
        }
        let change: Vec<f64> = free.carried(&v.du).iter().map(|f| -f).collect();
        held.add_forces(&self.workspace.pins, &change);
        self.set_held(held, v);
    }

    /// Sets the forces that hold motions in the equilibrium and the load of a pass.
    fn set_held(&self, held: &HeldMotions, v: &mut Vectors) {
        let pins = &self.workspace.pins;
        let now: Vec<_> = pins.dofs().zip(held.forces(pins)).collect();
        let before = std::mem::replace(&mut v.equilibrium.held, now.clone());
        for (k, (dof, force)) in now.into_iter().enumerate() {
            let change = force - before.get(k).map_or(0.0, |(_, force)| *force);
            for forces in [
                &mut v.equilibrium.load,
                &mut v.equilibrium.out_of_balance,
                &mut v.load,
            ] {
                forces[dof] += change;
            }
        }
    }

    /// Makes the rigid part of the correction of a pinned body a finite motion.
    pub fn move_finitely(&self, v: &mut Vectors) {
        let at = |node: usize| self.problem.position(&v.u, node);
        let reach = self.workspace.search.reach();
        self.workspace.pins.make_finite(&at, reach, &mut v.du);
    }
}
