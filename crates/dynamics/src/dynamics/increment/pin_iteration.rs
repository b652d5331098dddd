//! A pass of a static increment with pins: contact forces and correction as they would be without them. Section 12 of
//! docs/theory.md, Pins.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use super::contact_forces::ContactForces;
use super::linear_pass::{Vectors, close_hinges};
use crate::contact::{Constraint, ConstraintKey};
use crate::dynamics::results::Cause;
use crate::dynamics::step::{
    Equilibrium, HeldMotions, Parts, SoftPins, StepProblem, Workspace, add_pin_forces, difference,
};
use crate::linear::largest;

/// Steps in a pass that take the forces of pins out.
const PIN_STEPS: usize = 30;
/// The least of them before forces count as settled.
const LEAST_PIN_STEPS: usize = 4;
/// Parts of the stiffness of pins with which they are made, one after the other.
const SOFTER: [f64; 3] = [1.0, 1e-2, 1e-4];
/// The last of them.
const SOFTEST_PART: f64 = SOFTER[SOFTER.len() - 1];
/// Part of the tolerance up to which forces of pins are left to the next pass.
const WITHIN_TOLERANCE: f64 = 0.1;
/// Part of small forces of pins above which steps that go farther have changed nothing.
const SLOW_PIN: f64 = 0.5;
/// Forces of pins that are none, beside the other forces.
const PIN_FORCE: f64 = 1e-13;
/// Those that the next pass may take out.
const SMALL_PIN_FORCE: f64 = 1e-8;
/// Change of forces of pins, beside them, that become no smaller.
const SETTLED_PIN: f64 = 1e-3;
/// Part of a force of pins that a step leaves from which on the next one goes farther.
const HARDLY_FALLS: f64 = 0.9;
/// Passes with the same closed pairs in which forces of pins stay after which there is no equilibrium.
const FREE_PASSES: usize = 3;
/// Constraints of a body that the stiffness of its pins is taken from.
const NEAR: usize = 12;

/// How much farther than its own motion the pins of a body go in the next step of a pass, beside that motion, `last`
/// being what it was in this one and f, f_last the forces of the pins: to where they vanish if all components go on as the
/// largest one does, at most twice as far and its own motion once more.
///
/// ```text
/// p <- S^T dU + w (S^T dU - p),   w = r/(1 - r),   1 - r = (1 - f.f_last/|f_last|²)/(1 + w_last)      eq. (12.6)
/// ```
fn stride(last: f64, f: &[f64], f_last: &[f64]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let falls = 1.0 - product(f, f_last) / product(f_last, f_last);
    let r = 1.0 - falls / (1.0 + last);
    if r.is_nan() || r <= HARDLY_FALLS {
        return 0.0;
    }
    let most = 2.0 * last + 1.0;
    if r < 1.0 {
        most.min(r / (1.0 - r))
    } else {
        most
    }
}

fn product(matrix: &DMatrix<f64>, vector: &[f64]) -> Vec<f64> {
    let product = matrix * DVector::from_column_slice(vector);
    product.as_slice().to_vec()
}

/// Whether forces of pins have settled since `before`; or grow with the way of a body that goes too far, as they do where
/// it slides off without friction.
fn stay(f: &[f64], before: &[f64], goes_too_far: bool) -> bool {
    let (size, change) = (largest(f), largest(&difference(f, before)));
    change < SETTLED_PIN * size || (goes_too_far && size > largest(before))
}

/// Passes in a row in which forces of pins stay.
#[derive(Default)]
struct FreePasses {
    count: usize,
    closed: Vec<ConstraintKey>,
}

impl FreePasses {
    /// A pass has balanced its bodies.
    fn ends(&mut self) {
        self.count = 0;
    }

    /// Takes in a pass that has not; whether there is no equilibrium: with closed pairs at once, as a body that tips
    /// or slides would look for another one in the passes that follow. `closed` are its closed pairs.
    fn fail(&mut self, closed: Vec<ConstraintKey>) -> bool {
        self.count = if closed == self.closed {
            self.count + 1
        } else {
            1
        };
        self.closed = closed;
        !self.closed.is_empty() || self.count >= FREE_PASSES
    }
}

/// The constraints of every body with the smallest gaps in their lengths.
fn nearest(contact: &ContactForces, parts: &Parts) -> Vec<Constraint> {
    let mut all: Vec<&Constraint> = contact.constraints.iter().collect();
    all.sort_by(|a, b| (a.gap / a.scale).total_cmp(&(b.gap / b.scale)));
    let mut of_bodies = vec![0; parts.bodies()];
    let is_near = |constraint: &&Constraint| {
        let bodies: BTreeSet<usize> = constraint.nodes().map(|n| parts.of_nodes()[n]).collect();
        let is_among = bodies.iter().any(|&body| of_bodies[body] < NEAR);
        bodies.iter().for_each(|&body| of_bodies[body] += 1);
        is_among
    };
    all.into_iter().filter(is_near).cloned().collect()
}

/// What the steps of a pass have come to.
enum Pinned {
    /// Pins carry nothing but what is held.
    Balanced(Pushed),
    /// Their forces still fall.
    Falling,
    /// They stay.
    Stays(Stays),
}

/// Forces at pins, and normal forces of all bodies with pins, before the bodies have gone anywhere in a pass.
#[derive(Default)]
struct Pushed {
    pins: Vec<f64>,
    bodies: Vec<f64>,
}

/// Forces at pins that stay, with the correction and the closed pairs that belong to them, and the other forces.
struct Stays {
    force: Vec<f64>,
    du: Vec<f64>,
    closed: Vec<ConstraintKey>,
    others: f64,
}

/// What the passes of an increment know of bodies that pins hold.
#[derive(Default)]
pub(super) struct PinState {
    free: FreePasses,
    /// What was seen before motions were held.
    before: Option<Stays>,
    /// Motions that are held.
    pub held: HeldMotions,
}

impl PinState {
    /// That of an increment whose passes start with motions that are held.
    pub fn new(held: HeldMotions) -> Self {
        PinState {
            held,
            ..PinState::default()
        }
    }
}

/// Passes of a static step whose bodies pins hold.
pub(super) struct PinIteration<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
}

impl PinIteration<'_, '_> {
    /// Contact forces and correction of a pass in which pins hold bodies that no support holds. Where they stay in a motion
    /// that only the facets of the mesh resist, it is held.
    ///
    /// Gives the forces by which hinges close their gaps.
    pub fn iterate(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        state: &mut PinState,
        v: &mut Vectors,
    ) -> Result<Vec<f64>, Cause> {
        let problem = self.problem;
        let near = nearest(contact, problem.parts);
        let near: Vec<&Constraint> = near.iter().collect();
        let PinState { free, before, held } = state;
        self.follow_held(contact, held, v);
        let [mut has_held, mut has_held_back] = [false; 2];
        loop {
            let (closing, result) = self.balance_pins(contact, weight, (&near, held), v)?;
            let stays = match result {
                // in balance other pairs may be closed
                Pinned::Balanced(_) if self.follow_held(contact, held, v) => continue,
                Pinned::Balanced(pushed) => {
                    if !has_held_back && let Some(force) = self.left_behind(contact, pushed) {
                        has_held_back = true;
                        self.hold(contact, weight, (&near, held, (&force, 0.0)), v)?;
                        continue;
                    }
                    free.ends();
                    return Ok(closing);
                }
                Pinned::Falling => return Ok(closing),
                Pinned::Stays(stays) => stays,
            };
            let may_hold = !has_held && !stays.closed.is_empty();
            let large = (&stays.force[..], SMALL_PIN_FORCE * stays.others);
            if may_hold && self.hold(contact, weight, (&near, held, large), v)? {
                has_held = true;
                *before = Some(stays);
                continue;
            }
            let seen = if has_held { before.take() } else { None };
            let Stays {
                force, du, closed, ..
            } = seen.unwrap_or(stays);
            return match free.fail(closed) {
                true => Err((self.workspace.pins).unbalanceable(problem, &v.u, &du, &force)),
                false => Ok(closing),
            };
        }
    }

    /// Forces at the pins of bodies that were pushed away from all that touched them, before they went.
    fn left_behind(&self, contact: &ContactForces, pushed: Pushed) -> Option<Vec<f64>> {
        let pins = &self.workspace.pins;
        let acting: Vec<_> = contact.acting().collect();
        let now = pins.normal_forces(&acting);
        let mut force = pushed.pins;
        let mut is_any = false;
        let bodies = pins.of_bodies().into_iter();
        for (own, (before, now)) in bodies.zip(pushed.bodies.iter().zip(now)) {
            match *before > 0.0 && now <= SMALL_PIN_FORCE * before {
                true => is_any = true,
                false => force[own].fill(0.0),
            }
        }
        is_any.then_some(force)
    }

    /// Holds the free motions of bodies with forces at their pins, larger than a least one; whether there are any. What they
    /// are is seen before the bodies have gone anywhere.
    fn hold(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        (near, held, force): (&[&Constraint], &mut HeldMotions, (&[f64], f64)),
        v: &mut Vectors,
    ) -> Result<bool, Cause> {
        let problem = self.problem;
        let stiffness = (self.workspace)
            .soften(problem, near, (SOFTER[0], held))
            .map_err(|error| problem.unsolvable(error))?;
        let none = vec![0.0; stiffness.soft.len()];
        self.solve_with_pins(contact, weight, (&stiffness, &none), v)?;
        let at = |node: usize| problem.position(&v.u, node);
        let acting: Vec<_> = contact.acting().collect();
        Ok(held.hold(&self.workspace.pins, &at, &acting, force))
    }

    /// What holds motions in an increment that has converged must be within what facets make of its normal forces.
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
            Some(Stays { force, du, .. }) => pins.unbalanceable(problem, &v.u, du, force),
            None => (held.strongest(pins, problem, &v.u))
                .map_or(Cause::NotConverged, Cause::Unbalanceable),
        })
    }

    /// Contact forces and correction of a pass with pins: where the forces p of the pins, a' p, let the body move as it
    /// would without them, or stay where it is along what is held.
    ///
    /// ```text
    /// dU = y + W (N dU + B^T P + S a' p),  f = a' (S^T dU - p),  p <- S^T dU  until f vanishes    eq. (12.5)
    /// ```
    ///
    /// Gives the forces by which hinges close their gaps as well.
    fn balance_pins(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        (near, held): (&[&Constraint], &mut HeldMotions),
        v: &mut Vectors,
    ) -> Result<(Vec<f64>, Pinned), Cause> {
        let problem = self.problem;
        let dofs: Vec<usize> = self.workspace.pins.dofs().collect();
        let of_bodies = self.workspace.pins.of_bodies();
        let reach = self.workspace.search.reach();
        let tolerance = problem.settings.tolerance;
        let held_part = held.projection(&self.workspace.pins);
        let mut p = vec![0.0; dofs.len()];
        let (mut stays, mut closing) = (None, Vec::new());
        let mut pushed = None;
        // where f vanishes slowly, pins are too stiff for what holds the body
        'rounds: for part in SOFTER {
            let stiffness = (self.workspace)
                .soften(problem, near, (part, held))
                .map_err(|error| problem.unsolvable(error))?;
            closing = close_hinges(self.problem, self.workspace, v)?;
            let mut forces: Vec<Vec<f64>> = Vec::new();
            let mut strides = vec![0.0; of_bodies.len()];
            let (mut left, mut small) = (f64::INFINITY, None);
            let a = &self.workspace.stiffness.pins;
            // round-off is no force of pins
            let least = self.workspace.pins.round_off(a) / SMALL_PIN_FORCE;
            let mut holding = Vec::new();
            for step in 0..PIN_STEPS {
                self.solve_with_pins(contact, weight, (&stiffness, &p), v)?;
                let moved: Vec<f64> = dofs.iter().map(|&dof| v.du[dof]).collect();
                let way = difference(&moved, &p);
                let force = stiffness.forces(&way);
                let Equilibrium { load, internal, .. } = &v.equilibrium;
                let of_pairs = contact.acting().map(|(_, pair)| pair.force[0]);
                let all = [largest(load), largest(internal)].into_iter();
                let others = all.chain(of_pairs).fold(least, f64::max);
                // f where bodies are to move, the motion times a' where they are held
                holding = product(&held_part.transpose(), &force);
                let gone = product(&held_part, &moved);
                let soft = &stiffness.soft;
                let error = |k: usize| force[k] - holding[k] + soft[k] * gone[k];
                let error: Vec<f64> = (0..dofs.len()).map(error).collect();
                left = largest(&error) / others;
                let pushed = pushed.get_or_insert_with(|| Pushed {
                    pins: error.clone(),
                    bodies: (self.workspace.pins)
                        .normal_forces(&contact.acting().collect::<Vec<_>>()),
                });
                let is_settled = v.skew.take_in(&v.du, others);
                if left <= PIN_FORCE && is_settled {
                    self.take_held(held, &holding, v);
                    return Ok((closing, Pinned::Balanced(std::mem::take(pushed))));
                }
                let goes_too_far = largest(&moved) > reach;
                if let Some(before) = step.checked_sub(2).map(|before| &forces[before])
                    && step >= LEAST_PIN_STEPS
                    && left > SMALL_PIN_FORCE
                    && stay(&error, before, goes_too_far)
                {
                    stays.get_or_insert_with(|| Stays {
                        force: error.clone(),
                        du: v.du.clone(),
                        closed: contact.keys(),
                        others,
                    });
                    if goes_too_far {
                        break 'rounds;
                    }
                }
                if left <= SMALL_PIN_FORCE {
                    small.get_or_insert_with(|| (p.clone(), holding.clone(), left));
                }
                let of_held = product(&held_part, &way);
                for (pins, last) in of_bodies.iter().zip(&mut strides) {
                    let before = forces.last().map_or(&[][..], |force| &force[pins.clone()]);
                    *last = stride(*last, &error[pins.clone()], before);
                    for k in pins.clone() {
                        p[k] += (1.0 + *last) * (way[k] - of_held[k]) - gone[k];
                    }
                }
                forces.push(error);
            }
            let stayed = small.filter(|(_, _, before)| left > SLOW_PIN * before);
            let softer = left > WITHIN_TOLERANCE * tolerance && part > SOFTEST_PART;
            match stayed {
                _ if left > SMALL_PIN_FORCE => {}
                // a weak spring takes them over slowly
                Some(_) if softer => {}
                // what does not fall is round-off in a motion that nothing resists
                Some((p, holding, _)) => {
                    self.solve_with_pins(contact, weight, (&stiffness, &p), v)?;
                    self.take_held(held, &holding, v);
                    return Ok((closing, Pinned::Balanced(pushed.unwrap_or_default())));
                }
                None => {
                    self.take_held(held, &holding, v);
                    return Ok((closing, Pinned::Balanced(pushed.unwrap_or_default())));
                }
            }
        }
        let result = stays.map_or(Pinned::Falling, Pinned::Stays);
        Ok((closing, result))
    }

    /// Turns what is held with the surfaces of the iterate; whether something is let go.
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

    /// Takes what holds motions in a pass into the equilibrium, pins carrying the forces `carried` in its place.
    fn take_held(&self, held: &mut HeldMotions, carried: &[f64], v: &mut Vectors) {
        if held.are_none() {
            return;
        }
        let change: Vec<f64> = carried.iter().map(|f| -f).collect();
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

    /// Contact forces and correction of a pass with the forces a' p at the pins.
    fn solve_with_pins(
        &mut self,
        contact: &mut ContactForces,
        weight: Option<f64>,
        (stiffness, p): (&SoftPins, &[f64]),
        v: &mut Vectors,
    ) -> Result<(), Cause> {
        let mut load = v.load.clone();
        v.skew.add_to(&mut load);
        add_pin_forces(&self.workspace.pins, &stiffness.forces(p), &mut load);
        contact.solve(
            [&v.closing, &load],
            weight,
            &mut self.workspace.k(),
            &mut v.du,
        )
    }

    /// Makes the rigid part of the correction of a pinned body a finite motion.
    pub fn move_finitely(&self, v: &mut Vectors) {
        let at = |node: usize| self.problem.position(&v.u, node);
        let reach = self.workspace.search.reach();
        self.workspace.pins.make_finite(&at, reach, &mut v.du);
    }
}
