//! Complementarity problem of some constraints with one of the two system matrices: K* for the
//! contact forces of a pass, M for the impulses. Sections 5 and 6 of docs/theory.md.

use super::equal_forces::FIRST_WEIGHT;
use crate::contact::{ClosedPair, ClosedPairs, Constraint, Scope};
use crate::dynamics::results::{Cause, FailedLcp};
use crate::dynamics::step::{System, sum};
use crate::lcp::{ContactState, FrictionalLcp, FrictionalSolution, LcpMethod};
use crate::linear::{LinearError, Transformation};

/// A system matrix with what its complementarity problems need.
pub(crate) struct ContactSystem<'a> {
    /// T of the unknowns.
    pub map: &'a Transformation,
    pub system: System<'a>,
    pub method: LcpMethod,
}

/// What a complementarity problem starts from.
#[derive(Clone)]
pub(crate) struct Guess {
    /// State of every constraint.
    pub states: Vec<ContactState>,
    /// Forces of every constraint near which, of several solutions, the answer may lie, if there are any.
    pub forces: Option<Vec<[f64; 2]>>,
    /// Weight with which it lies there; without, only where there is no answer otherwise.
    pub weight: Option<f64>,
}

/// What is closed, and the pivots that it took.
pub(crate) struct ContactSolution {
    pub closed: ClosedPairs,
    pub pivots: usize,
}

impl Guess {
    /// States and forces of the pairs closed `before`, near which the answer lies with a weight.
    pub fn from_pass(
        constraints: &[&Constraint],
        before: &ClosedPairs,
        weight: Option<f64>,
    ) -> Self {
        let forces = constraints.iter().map(|c| before.force(c.key));
        Guess {
            states: constraints.iter().map(|c| before.state(c.key)).collect(),
            forces: Some(forces.collect()),
            weight,
        }
    }

    /// The same, with an answer near the forces before.
    fn near(&self) -> Option<Self> {
        let is_other = self.forces.is_some() && self.weight.is_none();
        is_other.then(|| Guess {
            weight: Some(FIRST_WEIGHT),
            ..self.clone()
        })
    }
}

impl ContactSystem<'_> {
    /// Forces of the given constraints from the constant terms of their gaps and slips.
    ///
    /// Where a problem with derivative rows has no solution, that with the force rows in their place is
    /// solved: Q is then symmetric and the theorem of section 8 holds, so that a ray says that pairs
    /// contradict each other. Where pairs are so nearly one that round-off spoils both problems, the answer
    /// near the forces before is taken.
    pub fn solve(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: [Vec<f64>; 2],
        guess: &Guess,
    ) -> Result<ContactSolution, Cause> {
        let solved = self.solve_with_rows(constraints, &constant_terms, guess);
        match (&solved, guess.near()) {
            (Err(Cause::Lcp(failed)), Some(near)) if !failed.is_contradiction() => {
                let found = self.solve_with_rows(constraints, &constant_terms, &near);
                found.or(solved)
            }
            _ => solved,
        }
    }

    /// With the derivative rows, else with the force rows.
    fn solve_with_rows(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: &[Vec<f64>; 2],
        guess: &Guess,
    ) -> Result<ContactSolution, Cause> {
        let with_derivatives = self.solve_once(constraints, constant_terms.clone(), guess);
        let are_other = constraints
            .iter()
            .any(|c| c.other_derivative_rows.is_some());
        match with_derivatives {
            Err(Cause::Lcp(_)) if are_other => {
                let symmetric: Vec<Constraint> =
                    constraints.iter().map(|c| c.with_force_rows()).collect();
                let symmetric: Vec<&Constraint> = symmetric.iter().collect();
                self.solve_once(&symmetric, constant_terms.clone(), guess)
            }
            solved => solved,
        }
    }

    fn solve_once(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: [Vec<f64>; 2],
        guess: &Guess,
    ) -> Result<ContactSolution, Cause> {
        let mut problem = (self.system).frictional_lcp(&Scope::All, constraints, constant_terms)?;
        if let (Some(forces), Some(weight)) = (&guess.forces, guess.weight) {
            add_proximal_term(&mut problem, forces, weight);
        }
        let mut kept = self.system.take_kept(&Scope::All);
        kept.name_contacts(names(constraints));
        self.system.keep(Scope::All, kept);
        match self.system.solve_lcp(&problem, &guess.states, self.method) {
            Ok(solution) => {
                self.system.take_back(problem);
                Ok(ContactSolution {
                    closed: closed_of(constraints, &forces_of(&solution), &solution.state),
                    pivots: solution.counters.pivots,
                })
            }
            Err(error) => {
                let failed = FailedLcp::new(error, problem, constraints);
                Err(Cause::Lcp(Box::new(failed)))
            }
        }
    }

    /// y + W load, both over all dofs, W being the inverse of the matrix.
    pub fn respond(&mut self, y: &[f64], load: &[f64]) -> Result<Vec<f64>, LinearError> {
        let response = self.system.respond(self.map, load)?;
        Ok(sum(y, &response))
    }
}

/// What tells constraints from others in a row of complementarity problems.
pub(super) fn names(constraints: &[&Constraint]) -> impl Iterator<Item = [usize; 2]> {
    let keys = constraints.iter().map(|constraint| constraint.key);
    keys.map(|key| [key.slave_index, key.segment])
}

/// Pn and Pt of every constraint.
fn forces_of(solution: &FrictionalSolution) -> Vec<[f64; 2]> {
    let forces = solution.pn.iter().zip(&solution.pt);
    forces.map(|(&pn, &pt)| [pn, pt]).collect()
}

/// The constraints that carry a force.
pub(super) fn closed_of(
    constraints: &[&Constraint],
    forces: &[[f64; 2]],
    states: &[ContactState],
) -> ClosedPairs {
    let of_constraint = constraints.iter().zip(forces).zip(states);
    let closed = of_constraint.filter(|((_, force), _)| force[0] > 0.0);
    let pairs =
        closed.map(|((constraint, force), state)| ClosedPair::new(constraint, *force, *state));
    let mut all = Vec::with_capacity(constraints.len());
    all.extend(pairs);
    all.into_iter().collect()
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
