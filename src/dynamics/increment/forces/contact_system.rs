//! Complementarity problem of some constraints with one of the two system matrices: K* for the
//! contact forces of a pass, M for the impulses. Sections 5 and 6 of docs/theory.md.

use super::equal_forces::FIRST_WEIGHT;
use crate::contact::{ClosedPair, ClosedPairs, Constraint, Scope};
use crate::dynamics::results::{Cause, FailedLcp};
use crate::dynamics::step::System;
use crate::lcp::{ContactState, FrictionalLcp, LcpMethod};
use crate::linear::{LinearError, Transformation};

/// A system matrix with what its complementarity problems need.
pub(crate) struct ContactSystem<'a> {
    /// T of the unknowns.
    pub map: &'a Transformation,
    pub system: System<'a>,
    pub method: LcpMethod,
}

/// What a complementarity problem starts from.
#[derive(Debug, Clone, Default)]
pub(crate) struct Guess {
    /// State of every constraint.
    pub states: Vec<ContactState>,
    /// Forces of every constraint near which, of several solutions, the answer may lie, if there are any.
    pub forces: Option<Vec<[f64; 2]>>,
    /// Weight with which it lies there; without, only where there is no answer otherwise.
    pub weight: Option<f64>,
}

impl Guess {
    /// Takes over states and forces of the pairs closed `before`, near which the answer lies with a weight.
    pub fn take_over(
        &mut self,
        constraints: &[&Constraint],
        before: &ClosedPairs,
        weight: Option<f64>,
    ) {
        let forces = self.forces.get_or_insert_default();
        forces.clear();
        forces.extend(constraints.iter().map(|c| before.force(c.key)));
        self.states.clear();
        self.states
            .extend(constraints.iter().map(|c| before.state(c.key)));
        self.weight = weight;
    }

    /// Whether an answer near the forces before is another one.
    fn has_forces_only(&self) -> bool {
        self.forces.is_some() && self.weight.is_none()
    }

    /// The same, with an answer near the forces before.
    fn near(&self) -> Self {
        Guess {
            weight: Some(FIRST_WEIGHT),
            ..self.clone()
        }
    }
}

impl ContactSystem<'_> {
    /// Forces of the given constraints from the constant terms of their gaps and slips: the pairs that carry one are
    /// `closed`; returns the pivots that it took.
    ///
    /// Where a problem with derivative rows has no solution, that with the force rows in their place is
    /// solved: Q is then symmetric and the theorem of section 8 holds, so that a ray says that pairs
    /// contradict each other. Where pairs are so nearly one that round-off spoils both problems, the answer
    /// near the forces before is taken.
    pub fn solve(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: &[[f64; 2]],
        guess: &Guess,
        closed: &mut ClosedPairs,
    ) -> Result<usize, Cause> {
        let solved = self.solve_with_rows(constraints, constant_terms, guess, closed);
        match &solved {
            Err(Cause::Lcp(failed)) if guess.has_forces_only() && !failed.is_contradiction() => {
                let near = guess.near();
                let found = self.solve_with_rows(constraints, constant_terms, &near, closed);
                found.or(solved)
            }
            _ => solved,
        }
    }

    /// With the derivative rows, else with the force rows.
    fn solve_with_rows(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: &[[f64; 2]],
        guess: &Guess,
        closed: &mut ClosedPairs,
    ) -> Result<usize, Cause> {
        let with_derivatives = self.solve_once(constraints, constant_terms, guess, closed);
        let are_other = constraints
            .iter()
            .any(|c| c.other_derivative_rows.is_some());
        match with_derivatives {
            Err(Cause::Lcp(_)) if are_other => {
                let symmetric: Vec<Constraint> =
                    constraints.iter().map(|c| c.with_force_rows()).collect();
                let symmetric: Vec<&Constraint> = symmetric.iter().collect();
                self.solve_once(&symmetric, constant_terms, guess, closed)
            }
            solved => solved,
        }
    }

    fn solve_once(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: &[[f64; 2]],
        guess: &Guess,
        closed: &mut ClosedPairs,
    ) -> Result<usize, Cause> {
        let mut problem = (self.system).frictional_lcp(&Scope::All, constraints, constant_terms)?;
        if let (Some(forces), Some(weight)) = (&guess.forces, guess.weight) {
            add_proximal_term(&mut problem, forces, weight);
        }
        self.system.name_contacts(names(constraints));
        match self.system.solve_lcp(&problem, &guess.states, self.method) {
            Ok(solution) => {
                self.system.take_back(problem);
                let forces = solution.pn.iter().zip(&solution.pt);
                let forces = forces.map(|(&pn, &pt)| [pn, pt]);
                closed.set(closed_of(constraints, forces, &solution.state));
                let pivots = solution.counters.pivots;
                self.system.take_back_solution(solution);
                Ok(pivots)
            }
            Err(error) => {
                let failed = FailedLcp::new(error, problem, constraints);
                Err(Cause::Lcp(Box::new(failed)))
            }
        }
    }

    /// y + W load, both over all dofs, W being the inverse of the matrix.
    pub fn respond(&mut self, y: &[f64], load: &[f64]) -> Result<Vec<f64>, LinearError> {
        self.system.begin(self.map, load)?;
        let mut response = Vec::new();
        self.system.end(self.map, y, &mut response)?;
        self.system.check()?;
        Ok(response)
    }
}

/// What tells constraints from others in a row of complementarity problems.
pub(super) fn names(constraints: &[&Constraint]) -> impl Iterator<Item = [usize; 2]> {
    let keys = constraints.iter().map(|constraint| constraint.key);
    keys.map(|key| [key.slave_index, key.segment])
}

/// The constraints that carry a force.
pub(super) fn closed_of<'a>(
    constraints: &'a [&Constraint],
    forces: impl Iterator<Item = [f64; 2]> + 'a,
    states: &'a [ContactState],
) -> impl Iterator<Item = ClosedPair> + 'a {
    let of_constraint = constraints.iter().zip(forces).zip(states);
    let closed = of_constraint.filter(|((_, force), _)| force[0] > 0.0);
    closed.map(|((constraint, force), state)| ClosedPair::new(constraint, force, *state))
}

/// Equal-force rule, eq. (5.3): adds eps Q_kk (P_k - P_k^0) to gaps and slips, P^0 being the forces of
/// the pass before. Where several pairs can carry the same force, the solution near that of the pass
/// before is taken; the term vanishes as the passes converge.
fn add_proximal_term(problem: &mut FrictionalLcp, forces: &[[f64; 2]], weight: f64) {
    let n = forces.len();
    for (k, [pn, pt]) in forces.iter().enumerate() {
        let [normal, tangential] = [k, k + n].map(|i| weight * problem.q[(i, i)]);
        problem.q[(k, k)] += normal;
        problem.q[(k + n, k + n)] += tangential;
        problem.gap[k] -= normal * pn;
        problem.slip[k] -= tangential * pt;
    }
}
