//! Data of the pairs of an increment by their keys: constraint, contact force and state, impulse, and whether the pair
//! touches at the start. The pairs closed at the start belong to the state at the start of the increment.

use super::contact_forces::ContactForces;
use super::impulses::Impulses;
use crate::contact::{ClosedPairs, Constraint, ConstraintSet, SlaveChoice};
use crate::dynamics::results::State;
use crate::dynamics::step::{BeforeIterate, Interval, StepProblem, Workspace};

/// The pairs of an increment.
#[derive(Default)]
pub(crate) struct ContactStates {
    /// Contact forces Pn and Pt of the last pass.
    pub forces: ContactForces,
    /// Impact impulses Phi and Psi at the start.
    pub impulses: Impulses,
    /// Constraints of the iterate until they are handed over to `forces`, then the constraints of the last pass.
    pub found: Vec<Constraint>,
    /// Constraints of the iterate that take no part in the passes (inactive pairs).
    pub left_out: Vec<Constraint>,
    /// Whether the coefficient of friction of a pair differs from its coefficient in the last pass.
    pub friction_moves: bool,
    /// The slave nodes whose constraints the passes find.
    choice: SlaveChoice,
}

/// Relative change of a coefficient of friction from which on the coefficient counts as changed.
const MOVES: f64 = 1e-9;

impl ContactStates {
    /// The pairs before the first pass: the closed pairs, and the pairs that touch at the start. The passes begin with
    /// the constraints of the slave nodes in `choice`.
    pub fn new(closed: &ClosedPairs, set: ConstraintSet, choice: SlaveChoice) -> Self {
        ContactStates {
            choice,
            forces: ContactForces::without_constraints(closed),
            impulses: Impulses::new(closed, set.touching()),
            ..ContactStates::default()
        }
    }

    /// Writes the constraints of the iterate U, both the active and the inactive constraints; `begins` is true in the
    /// first pass. Pairs that have not slipped get the coefficient of friction at rest, other pairs the coefficient at
    /// their slip rate. Slave nodes keep their targets up to the overrun `kept` beyond the ends (segment lengths).
    pub fn find(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        (start, interval, begins): (&State, Interval, bool),
        u: &[f64],
        (set, kept): (ConstraintSet, Option<f64>),
    ) {
        let (last, closed) = (&self.forces.constraints, (&start.contact, kept));
        let (increment, choice) = ([&start.u[..], u], self.choice);
        workspace.constraints(problem, increment, last, closed, choice, &mut self.found);
        let has_start_rate = begins && problem.integration.has_rates;
        let before = BeforeIterate {
            u0: &start.u,
            interval,
            closed: &self.forces.closed,
            v0: has_start_rate.then_some(&start.v[..]),
        };
        (problem.frictions).give(problem.coordinates, before, &mut self.found);
        let moves = |constraint: &Constraint| {
            let before = (self.forces.closed).last_of(constraint.key);
            before.is_some_and(|pair| (constraint.mu - pair.mu).abs() > MOVES * pair.mu)
        };
        self.friction_moves = !begins && self.found.iter().any(|c| c.mu_varies && moves(c));
        set.split(
            problem.positions(&start.u),
            &mut self.found,
            &mut self.left_out,
        );
    }

    /// Adds the constraints of far slave nodes at the iterate U before an increment ends. Returns whether the
    /// constraints of far nodes stay open (after the correction dU, if it is given). If a constraint of a far node
    /// closes, the passes go on with the constraints of all nodes. A far node behind the line of a segment and beyond
    /// its ends has gone past the corner, so it has no constraint there.
    pub fn complete(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        (start, interval): (&State, Interval),
        u: &[f64],
        du: Option<&[f64]>,
    ) -> bool {
        if self.choice == SlaveChoice::All {
            return true;
        }
        let (near, closed) = (&self.forces.constraints, (&start.contact, None));
        let (increment, far) = ([&start.u[..], u], &mut self.found);
        workspace.constraints(problem, increment, near, closed, SlaveChoice::Far, far);
        let before = BeforeIterate {
            u0: &start.u,
            interval,
            closed: &self.forces.closed,
            v0: None,
        };
        (problem.frictions).give(problem.coordinates, before, far);
        let change = |constraint: &Constraint| du.map_or(0.0, |du| constraint.gap_change(du));
        let is_open = |constraint: &Constraint| constraint.gap + change(constraint) >= 0.0;
        let at = problem.configurations(&start.u, u);
        far.retain(|constraint| is_open(constraint) || !constraint.is_beyond_ends(&at));
        let stay_open = far.iter().all(is_open);
        let constraints = &mut self.forces.constraints;
        constraints.append(far);
        if !stay_open {
            constraints.sort_by_key(|constraint| constraint.key);
            self.choice = SlaveChoice::All;
        }
        stay_open
    }

    /// Sets the coefficients of friction to the values of the law at the slips and forces of the last solution, at the
    /// end of an increment.
    pub fn take_own_friction(&mut self, problem: &StepProblem, start: &State, interval: Interval) {
        let ContactForces {
            constraints,
            closed,
            ..
        } = &mut self.forces;
        let before = BeforeIterate {
            u0: &start.u,
            interval,
            closed,
            v0: None,
        };
        (problem.frictions).give(problem.coordinates, before, constraints);
    }

    /// Replaces the constraints by the constraints of the iterate, with the available forces.
    pub fn relinearize(&mut self) {
        self.forces.relinearize(&mut self.found);
    }

    /// Whether the pairs that the last pass closed are the pairs with impulses, and whether these impulses are exact.
    pub fn rest(&mut self, problem: &StepProblem) -> bool {
        self.impulses.rest(problem, &self.forces)
    }

    /// Adds the inactive constraints to the active constraints at the end of an increment. A free node at or past a
    /// corner gets no constraint there if the corner lies behind the line of the segment from which the node came.
    pub fn take_left_out(&mut self, problem: &StepProblem, u: &[f64]) {
        let at = problem.positions(u);
        let left_out = self.left_out.drain(..);
        (self.forces.constraints).extend(left_out.filter(|c| c.gap >= 0.0 || c.is_over(at)));
    }
}
