//! Workspace of the increments of a step: effective stiffness with its factors, contact search,
//! times and counts. Each operation on the workspace measures its own time. See
//! docs/theory/time.md.

use super::held_motions::HeldMotions;
use super::loads::TimePoint;
use super::matrices::{ClosedConstraints, EffectiveStiffness, StiffnessForm, System};
use super::meter::Meter;
use super::pins::Pins;
use super::seen::Seen;
use super::step_problem::{StepProblem, difference, sum};
use super::wear::Wear;
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::contact::{
    ClosedPairs, Constraint, NodeAtSegment, PairTarget, Search, SlaveChoice, find_means,
    find_penetration, find_targets,
};
use crate::dynamics::results::State;
use crate::elements::Motion;
use crate::lcp::Stability;
use crate::linear::LinearError;

/// Matrices, contact search and meter of a step.
pub(crate) struct Workspace<'m> {
    pub stiffness: EffectiveStiffness,
    pub search: Search<'m>,
    pub meter: Meter,
    /// Pins that hold rigid motions in K*.
    pub pins: Pins,
    /// Largest displacements and forces of the run so far, on which tolerances are based.
    pub seen: Seen,
    /// Wear of the factors of K* in dynamic increments.
    pub wear: Wear,
    /// The pairs of the last pass.
    pairs: Vec<PairTarget>,
}

impl<'m> Workspace<'m> {
    /// The workspace of a step, without factors and without lists of candidates.
    pub fn new(problem: &StepProblem<'m>, seen: Seen) -> Self {
        let x = &problem.model.mesh.coordinates;
        let mut search = match problem.integration.velocities_tell() {
            true => Search::new(problem.contacts, x),
            false => Search::without_velocities(problem.contacts, x),
        };
        for (contact, overlap) in problem.fits.largest() {
            search.reach_into(contact, overlap);
        }
        Workspace {
            stiffness: EffectiveStiffness::new(problem),
            search,
            meter: Meter::default(),
            pins: Pins::new(problem),
            seen,
            wear: Wear::default(),
            pairs: Vec::new(),
        }
    }

    /// Transfers the data that the increments of the step hand on to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Self { [stiffness, search, seen] wear; meter, pins, pairs })
    }

    /// The effective stiffness K*.
    pub fn k(&mut self) -> System<'_> {
        System::new(&mut self.stiffness.k, &mut self.meter)
    }

    /// Makes the motions of the pins at the displacements `u` free unknowns of the complementarity problems;
    /// `unbalanced` are the forces there, and `skew` gives N x: the changes of forces, for a motion x, that K* omits.
    pub fn free_pins(
        &mut self,
        problem: &StepProblem,
        (u, unbalanced): (&[f64], &[f64]),
        held: &HeldMotions,
        skew: &dyn Fn(&[f64]) -> Vec<f64>,
    ) -> Result<(), LinearError> {
        let Workspace {
            stiffness,
            meter,
            pins,
            search,
            ..
        } = self;
        let EffectiveStiffness { k, pins: a, .. } = stiffness;
        let reach = search.reach();
        // forces that equations and rigid bodies hand on are balanced within them
        let mut at_unknowns = vec![0.0; unbalanced.len()];
        let restricted = k.map().restrict(unbalanced);
        let both = problem.unknowns.dof.iter().zip(restricted);
        both.for_each(|(&dof, force)| at_unknowns[dof] = force);
        let at = |node: usize| problem.position(u, node);
        System::new(k, meter).free_pins(
            (pins, a, held.projection(pins)),
            (&at, &at_unknowns),
            skew,
            reach,
        )
    }

    /// The mass M.
    pub fn m(&mut self) -> System<'_> {
        System::new(&mut self.stiffness.m, &mut self.meter)
    }

    /// Assembles and factorises K* for increments of length `dt`, in the configuration of a motion and with the given
    /// closed constraints. The first positive definite form of K* is factorised.
    ///
    /// # Errors
    /// Returns the error of the last form, or the first error that is not an indefinite matrix.
    pub fn factorize(
        &mut self,
        problem: &StepProblem,
        dt: f64,
        motion: Motion,
        contact: &ClosedConstraints,
    ) -> Result<(), LinearError> {
        let mut result = Ok(());
        for &form in StiffnessForm::forms(contact.pairs_stiffen) {
            result = self.factorize_form(problem, (dt, form), motion, contact);
            if !matches!(result, Err(LinearError::NotPositiveDefinite { .. })) {
                break;
            }
        }
        result
    }

    /// Assembles and factorises K* for the bodies without displacements and internal variables, and turns the factors
    /// with the bodies to the configuration of a motion.
    pub fn factorize_unstrained(
        &mut self,
        problem: &StepProblem,
        dt: f64,
        motion: Motion,
        contact: &ClosedConstraints,
    ) -> Result<(), LinearError> {
        let at_rest = vec![0.0; motion.end.len()];
        let variables = problem.elements.initial_variables();
        let unstrained = Motion {
            start: motion.start.and(Some(&at_rest)),
            increment: motion.increment.and(Some([&at_rest; 2])),
            ..Motion::at(&at_rest, &variables)
        };
        self.factorize(problem, dt, unstrained, contact)?;
        self.turn(problem, motion);
        Ok(())
    }

    /// Checks that an equilibrium is stable. The check does nothing if the last factors belong to a state near the
    /// equilibrium without stiffening by closed pairs, and the last complementarity problem with free pins was stable.
    ///
    /// # Errors
    /// Returns an error if K* is not positive definite.
    pub fn check_stability(
        &mut self,
        problem: &StepProblem,
        motion: Motion,
        contact: &ClosedConstraints,
        are_near: bool,
    ) -> Result<(), LinearError> {
        let EffectiveStiffness { k, form, .. } = &self.stiffness;
        let is_tangent = *form == StiffnessForm::Tangent;
        let tips = (k.free()).is_some_and(|free| free.stability() == Stability::Unstable);
        if is_tangent && are_near && !tips {
            return Ok(());
        }
        let form = match self.pins.are_none() && is_tangent {
            true => StiffnessForm::Tangent,
            false => StiffnessForm::Stability,
        };
        self.factorize_form(problem, (self.stiffness.dt(), form), motion, contact)
    }

    /// Assembles and factorises one form of K* for an increment of length `dt`.
    fn factorize_form(
        &mut self,
        problem: &StepProblem,
        (dt, form): (f64, StiffnessForm),
        motion: Motion,
        contact: &ClosedConstraints,
    ) -> Result<(), LinearError> {
        let Workspace {
            stiffness,
            meter,
            pins,
            ..
        } = self;
        let assemble = || {
            stiffness.assemble(problem, dt, motion, form);
            stiffness.add_contact(problem, contact, form, pins);
        };
        meter.time(|t| &mut t.assembly, assemble);
        meter.counts.factorizations += 1;
        self.k().factorize()
    }

    /// Turns the factors of K* with the bodies, to the configuration of a motion.
    pub fn turn(&mut self, problem: &StepProblem, motion: Motion) {
        let Workspace {
            stiffness, meter, ..
        } = self;
        meter.time(|t| &mut t.solve, || stiffness.turn(problem, motion));
    }

    /// The product (K + Cd/(theta2 dt)) x in the configuration of a motion, where K is the tangent, Cd the damping
    /// matrix and dt the increment of K*.
    pub fn tangent_product(
        &mut self,
        problem: &StepProblem,
        motion: Motion,
        x: &[f64],
    ) -> Vec<f64> {
        let (elements, theta2) = (problem.elements, problem.integration.theta2);
        let weight = 1.0 / (theta2 * self.stiffness.dt());
        let product = || match motion.increment {
            Some(increment) if problem.has_damping() => {
                let damping = elements.damping_product(increment, self.stiffness.dt(), x);
                let damping: Vec<f64> = damping.iter().map(|c| weight * c).collect();
                sum(&elements.tangent_product(motion, x), &damping)
            }
            _ => elements.tangent_product(motion, x),
        };
        self.meter.time(|t| &mut t.assembly, product)
    }

    /// Writes the constraints of the chosen slave nodes between the displacements `u0` and `u` of an increment.
    /// `before` are the constraints of the last pass, and `closed_at_start` the pairs closed at the start. Slave nodes
    /// keep their targets up to the overrun `kept` beyond the ends (segment lengths).
    pub fn constraints(
        &mut self,
        problem: &StepProblem,
        increment: [&[f64]; 2],
        before: &[Constraint],
        (closed_at_start, kept): (&ClosedPairs, Option<f64>),
        choice: SlaveChoice,
        constraints: &mut Vec<Constraint>,
    ) {
        let Workspace {
            search,
            meter,
            pairs,
            ..
        } = self;
        meter.time(|t| &mut t.search, || search.cover(increment[1]));
        let write = || {
            let form = (problem.integration.row_form(), choice);
            find_targets(
                search,
                increment,
                before,
                (closed_at_start, kept),
                form,
                pairs,
            );
            problem.constraints(pairs, increment, constraints);
        };
        meter.time(|t| &mut t.contact, write);
    }

    /// The constraints from surface to surface between the displacements `u0` and `u`.
    pub fn means(&mut self, problem: &StepProblem, increment: [&[f64]; 2]) -> Vec<Constraint> {
        let Workspace {
            search,
            meter,
            pairs,
            ..
        } = self;
        meter.time(|t| &mut t.search, || search.cover(increment[1]));
        let mut means = Vec::new();
        let write = || {
            find_means(search, increment, problem.integration.row_form(), pairs);
            problem.constraints(pairs, increment, &mut means);
        };
        meter.time(|t| &mut t.contact, write);
        means
    }

    /// Corrects the velocities at the start of a motion by impulses of the hinges, so that hinges keep their nodes
    /// together:
    ///
    /// ```text
    /// V <- V - M^-1 C^T (C M^-1 C^T)^-1 C V      eq. (11.11)
    /// ```
    ///
    /// # Errors
    /// Returns [`LinearError::Dependent`] with a hinge that other hinges make redundant.
    pub fn start_hinges(
        &mut self,
        problem: &StepProblem,
        start: &mut State,
    ) -> Result<(), LinearError> {
        if problem.hinges.are_none() {
            return Ok(());
        }
        self.stiffness.start(problem, &start.u);
        let mut mass = self.m();
        mass.factorize()?;
        let (_, change) = mass.close(&problem.hinges.gaps(&start.v))?;
        start.v.iter_mut().zip(&change).for_each(|(v, c)| *v += c);
        Ok(())
    }

    /// Acceleration at the start of a motion from M A = R + B^T P - F, with supports at rest. Forces on nodes without
    /// mass act on the nodes that carry their mass.
    pub fn start_acceleration(
        &mut self,
        problem: &StepProblem,
        start: &State,
        contact: &[f64],
        now: TimePoint,
    ) -> Vec<f64> {
        let mut a = vec![0.0; start.u.len()];
        let motion = start.motion();
        let Ok(internal) = problem.elements.internal_force(motion) else {
            return a;
        };
        let load = (problem.loads).at(now, &start.u);
        let mut load = load;
        problem.unknowns.turning.scale_moments(&a, &mut load);
        let mut r = sum(&difference(&load, &internal), contact);
        problem.redistribution.hand_on(&mut r);
        self.stiffness.start(problem, &start.u);
        let mut mass = self.m();
        // The acceleration only improves the estimate of the first landings.
        if let Ok(acceleration) = mass.factorize().and_then(|()| mass.respond(&r)) {
            a = acceleration;
            problem.follow_donors(&mut a);
        }
        if problem.contacts.is_empty() || !problem.has_impulses() {
            self.stiffness.m.solver.give_up_factors();
        }
        a
    }

    /// A node that has entered a body between the displacements `u0` and `u1`; see [`find_penetration`].
    pub fn find_penetration(
        &mut self,
        [u0, u1]: [&[f64]; 2],
        closed: [&ClosedPairs; 2],
        unsolved: &[f64],
    ) -> Option<NodeAtSegment> {
        let Workspace { search, meter, .. } = self;
        meter.time(|t| &mut t.search, || search.cover_path(u0, u1));
        meter.time(
            |t| &mut t.contact,
            || find_penetration(search, [u0, u1], closed, unsolved),
        )
    }
}
