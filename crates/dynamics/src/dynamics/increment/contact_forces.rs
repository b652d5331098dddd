//! Contact forces of a pass, the solution of a frictional complementarity problem of the
//! constraints of the iterate. See docs/theory/complementarity.md, Problem of a pass (paper eqs 36 to 47).

use smallvec::SmallVec;

use super::contact_system::{FEW, Guess, Response};
use crate::contact::tolerances::{LIMIT_SLIP, SETTLED_OVERLAP, SOLVED_GAP};
use crate::contact::{ClosedPair, ClosedPairs, Constraint};
use crate::dynamics::results::Cause;
use crate::dynamics::step::System;
use crate::lcp::{ContactState, Stability};
use crate::linear::larger;

/// Number of constraints by which the problem of a pass grows at least, if its constraints leave a body free.
const FEWEST: usize = 3;
/// Number of times that the problem of a pass grows because a body is unstable under the constraints of the problem.
const TIPS: usize = 3;

/// Constraints, and the forces (or impulses) of the closed constraints.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactForces {
    /// The constraints of the iterate, with increasing keys. At the end of an increment the
    /// constraints of far nodes, which are open, follow the other constraints.
    pub constraints: Vec<Constraint>,
    /// The closed constraints, as pairs.
    pub closed: ClosedPairs,
    /// Number of constraints that entered the complementarity problem.
    pub problem_size: usize,
    /// Number of pivots of the solution.
    pub pivots: usize,
    choice: Choice,
}

/// Choice of the constraints in the complementarity problem of a pass, in memory that the next pass uses again.
#[derive(Debug, Clone, Default)]
struct Choice {
    /// For every constraint whether it is in the problem.
    inside: Vec<bool>,
    /// States of all constraints, from which the problem starts.
    states: Vec<ContactState>,
    /// Gaps and slips without contact forces.
    free: Vec<[f64; 2]>,
    /// Gaps and slips with the contact forces.
    after: Vec<[f64; 2]>,
    /// Gaps and slips without contact forces of the constraints in the problem.
    terms: Vec<[f64; 2]>,
    guess: Guess,
    /// The pairs that the last pass closed.
    before: ClosedPairs,
}

impl ContactForces {
    /// Constraints with only the forces of the last increment, before the first linearisation.
    pub fn without_constraints(closed: &ClosedPairs) -> Self {
        ContactForces {
            closed: closed.clone(),
            ..ContactForces::default()
        }
    }

    /// Replaces the constraints by the constraints of the next iterate, with the available forces, and returns the old
    /// constraints in `constraints`.
    pub fn relinearize(&mut self, constraints: &mut Vec<Constraint>) {
        std::mem::swap(&mut self.constraints, constraints);
    }

    /// Whether every available force belongs to a constraint of the iterate.
    pub fn all_have_constraints(&self) -> bool {
        self.acting().count() == self.closed.len()
    }

    /// Whether the last pass closed the same pairs as the pass before it.
    pub fn are_of_same_pairs(&self) -> bool {
        self.closed.keys().eq(self.choice.before.keys())
    }

    /// All constraints, each with its closed pair; `None` for an open constraint.
    pub fn iter(&self) -> impl Iterator<Item = (&Constraint, Option<&ClosedPair>)> + Clone {
        let mut closed = self.closed.iter().peekable();
        let constraints = self.constraints.iter();
        constraints.map(move |constraint| {
            while closed.next_if(|pair| pair.key < constraint.key).is_some() {}
            let own = closed.next_if(|pair| pair.key == constraint.key);
            (constraint, own)
        })
    }

    /// The closed constraints with their forces.
    pub fn acting(&self) -> impl Iterator<Item = (&Constraint, &ClosedPair)> + Clone {
        self.iter()
            .filter_map(|(constraint, pair)| Some((constraint, pair?)))
    }

    /// Contact force Bn^T Pn + Bt^T Pt of eq. (3.1), over all dofs.
    pub fn resultant(&self, dofs: usize) -> Vec<f64> {
        let mut force = Vec::new();
        self.write_resultant(dofs, &mut force);
        force
    }

    /// Writes [`Self::resultant`].
    pub fn write_resultant(&self, dofs: usize, force: &mut Vec<f64>) {
        force.clear();
        force.resize(dofs, 0.0);
        for (constraint, pair) in self.acting() {
            constraint.add_force(pair.force, force);
        }
    }

    /// Solves for the contact forces of a pass, which replace the forces of the last pass, and writes the correction dU
    /// = d_p + W (r + Bn^T Pn + Bt^T Pt). Here d_p is the motion of the supports, and r is the sum of all forces except
    /// contact forces (all dofs).
    ///
    /// Constraints that the last pass left open stay out of the problem at first. In the first pass, constraints that
    /// the motion y = d_p + W r leaves open stay out. Constraints that overlap under the forces of the problem enter
    /// afterwards, so the answer is the answer for all constraints. Once the passes have settled, the equal-force rule
    /// has a `weight`, and constraints enter only if they would overlap by more than round-off. Otherwise a force that
    /// two nodes facing each other can both carry would go to and fro between them.
    pub fn solve(
        &mut self,
        [d_p, r]: [&[f64]; 2],
        weight: Option<f64>,
        system: &mut System,
        du: &mut Vec<f64>,
    ) -> Result<(), Cause> {
        (self.problem_size, self.pivots) = (0, 0);
        let overlap = weight.map_or(0.0, |_| SETTLED_OVERLAP);
        let mut choice = std::mem::take(&mut self.choice);
        let Choice {
            inside,
            states,
            free,
            after,
            terms,
            guess,
            before,
        } = &mut choice;
        std::mem::swap(before, &mut self.closed);
        self.closed.clear();
        let keys: SmallVec<[_; FEW]> = self.constraints.iter().map(|c| c.key).collect();
        states.clear();
        states.extend(before.states_among(&keys));
        inside.clear();
        inside.extend(states.iter().map(|state| state.is_closed()));
        // g + Gn y and Dt + Gt y, eq. (5.2)
        let mut response = Response::begin(system, [d_p, r], &self.constraints)?;
        response.gaps_and_slips(system, self.constraints.iter(), free);
        response.show_pins(system);
        let mut entered = inside.contains(&true)
            || self.enter(inside, free, (overlap, 0))
            || system.free().is_some();
        let mut tips = 0..TIPS;
        let mut least = 1;
        while entered {
            let constraints: SmallVec<[_; FEW]> = chosen(&self.constraints, inside).collect();
            terms.clear();
            terms.extend(chosen(free, inside));
            guess.states.clear();
            guess.states.extend(chosen(states, inside));
            guess.take_over(&constraints, before, weight);
            let solved = system.solve_contact(
                &constraints,
                terms,
                guess,
                &mut self.closed,
                Some(&mut response),
            );
            if let Some(free) = system.free()
                && (solved.is_err()
                    || free.goes_too_far()
                    || (free.stability() == Stability::Unstable && tips.next().is_some()))
                && self.enter_nearest(inside)
            {
                continue;
            }
            self.pivots += solved?;
            self.problem_size = constraints.len();
            let acting = self
                .acting()
                .map(|(constraint, pair)| (constraint, pair.force));
            response.set_forces(system, acting);
            response.gaps_and_slips(system, self.constraints.iter(), after);
            self.take_states(states);
            entered = self.enter(inside, after, (overlap, least));
            least *= 2;
        }
        self.mark_slips(&choice);
        self.choice = choice;
        Ok(response.end(system, du)?)
    }

    /// Sets the states of all constraints to those of the answer.
    fn take_states(&self, states: &mut [ContactState]) {
        let pairs = self.iter().map(|(_, pair)| pair);
        for (state, pair) in states.iter_mut().zip(pairs) {
            *state = pair.map_or(ContactState::Open, |pair| pair.state);
        }
    }

    /// Marks the closed pairs that slip in the solution; with slip Dt_f and gap g_f without contact forces,
    ///
    /// ```text
    /// |Dt| > 1e-10 max(|g_f|, |Dt_f|, |Dt - Dt_f|) + 1e-12 l    eq. (3.25)
    /// ```
    fn mark_slips(&mut self, Choice { free, after, .. }: &Choice) {
        let constraints = &self.constraints;
        self.closed.mark_slips(|key| {
            let place = constraints.binary_search_by_key(&key, |constraint| constraint.key);
            place.is_ok_and(|k| {
                let ([gap, free], [_, slip]) = (free[k], after[k]);
                let terms = [gap, free, slip - free].map(f64::abs);
                let round_off = LIMIT_SLIP * terms.into_iter().fold(0.0, larger)
                    + SOLVED_GAP * constraints[k].scale;
                slip.abs() > round_off
            })
        });
    }

    /// Doubles the number of constraints in the problem, by the constraints with the smallest gaps of the iterate. A
    /// body that the present constraints leave free moves on to the next constraints. Returns whether there were any
    /// constraints outside the problem.
    fn enter_nearest(&self, inside: &mut [bool]) -> bool {
        let count = inside.iter().filter(|inside| **inside).count().max(FEWEST);
        let gap = |k: usize| self.constraints[k].gap / self.constraints[k].scale;
        let mut outside: Vec<usize> = (0..inside.len()).filter(|&k| !inside[k]).collect();
        outside.sort_by(|&i, &k| gap(i).total_cmp(&gap(k)));
        outside.truncate(count);
        outside.iter().for_each(|&k| inside[k] = true);
        !outside.is_empty()
    }

    /// Adds a constraint to the problem if its gap `after` the correction would be an overlap of more than `overlap`
    /// times its scale. If fewer than `least` constraints overlap, the nearest of the other constraints enter, too: among
    /// nearly redundant constraints, each one that closes makes the next one overlap. Returns whether any constraint has
    /// entered the problem.
    fn enter(
        &self,
        inside: &mut [bool],
        after: &[[f64; 2]],
        (overlap, least): (f64, usize),
    ) -> bool {
        let gap = |k: usize| after[k][0] / self.constraints[k].scale;
        let outside = |k: &usize| !inside[*k];
        let overlaps = |k: &usize| gap(*k) < -overlap;
        let count = (0..inside.len()).filter(outside).filter(overlaps).count();
        if count == 0 {
            return false;
        }
        let mut nearest: Vec<usize> = (0..inside.len()).filter(outside).collect();
        nearest.sort_by(|&i, &k| gap(i).total_cmp(&gap(k)));
        nearest.truncate(count.max(least));
        nearest.iter().for_each(|&k| inside[k] = true);
        true
    }
}

/// Entries of the constraints in the problem, selected from entries of all constraints.
fn chosen<'c, 'i, T>(
    all: &'c [T],
    inside: &'i [bool],
) -> impl Iterator<Item = &'c T> + use<'c, 'i, T> {
    let numbered = all.iter().zip(inside).filter(|(_, inside)| **inside);
    numbered.map(|(entry, _)| entry)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Rows, testing};
    use crate::dynamics::step::{FactoredMatrix, Meter};
    use crate::lcp::LcpMethod;
    use crate::linear::{Assembled, Transformation, linear_solver};
    use crate::model::SolverChoice;

    const DOFS: usize = 14;

    /// A constraint of 14 dofs with other derivative rows than force rows:
    /// Bn = 1, Bt = 1, -1, 1, ...; Gn = 1/2, Gt = 1/8 + Bt/4.
    fn wide(mu: f64) -> Constraint {
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let row = |entry: &dyn Fn(usize) -> f64| (0..DOFS).map(entry).collect::<Vec<f64>>();
        let dofs: Vec<usize> = (0..DOFS).collect();
        let derivative = Rows::new(&row(&|_| 0.5), &row(&|k| 0.125 + 0.25 * sign(k)));
        let mut wide = testing::made_up(&dofs, Rows::new(&row(&|_| 1.0), &row(&sign)));
        wide.slave_dofs = 6;
        wide.other_derivative_rows = Some(derivative);
        (wide.gap, wide.slip, wide.mu) = (-7.0, 0.5, mu);
        wide
    }

    /// Force and correction of the constraint with W = 1/2 and y = 1/2 at every dof.
    ///
    /// By hand: Q = G W B^T = [7/2, 0; 7/8, 7/4]; the constant terms are g + Gn y = -7/2 and Dt +
    /// Gt y = 11/8.
    fn solved(mu: f64, method: LcpMethod) -> (ClosedPair, Vec<f64>) {
        let map = Transformation::identity(DOFS);
        let elements: Vec<Vec<usize>> = (0..DOFS).map(|dof| vec![dof, (dof + 1) % DOFS]).collect();
        let mut stiffness = Assembled::new(&map, &elements);
        (0..DOFS).for_each(|dof| stiffness.add(dof, &[1.0, 0.0, 0.0, 1.0], 1.0));
        let mut matrix =
            FactoredMatrix::new((linear_solver(SolverChoice::Faer), method), stiffness, &map);
        matrix.factorize().expect("positive definite");
        let mut meter = Meter::default();
        let mut system = System::new(&mut matrix, &mut meter);
        let mut forces = ContactForces::default();
        forces.relinearize(&mut vec![wide(mu)]);
        let mut du = Vec::new();
        let solved = forces.solve([&[0.0; DOFS], &[1.0; DOFS]], None, &mut system, &mut du);
        solved.expect("solved");
        let pair = forces.closed.iter().next().expect("closed");
        (pair.clone(), du)
    }

    #[test]
    fn a_pair_at_its_limit_slips_only_if_it_is_pushed_beyond() {
        // it sticks with |Pt| = 9/7
        for method in [LcpMethod::Hybrid, LcpMethod::Lemke] {
            for (excess, slips) in [(0.0, false), (1e-14, false), (-1e-6, true)] {
                let (pair, _) = solved(9.0 / 7.0 + excess, method);
                assert_eq!(pair.slips, slips, "{method:?} {excess:e}");
            }
            assert!(solved(0.0, method).0.slips, "nothing holds it");
        }
    }

    #[test]
    fn a_wide_constraint_with_own_derivative_rows_has_the_forces_computed_by_hand() {
        for method in [LcpMethod::Hybrid, LcpMethod::Lemke] {
            // sticks: Pn = 1, Pt = -(7/8 + 11/8)/(7/4); slides: Pt = -mu Pn, the slip being positive
            for (mu, state, pt) in [
                (2.0, ContactState::Stick, -9.0 / 7.0),
                (0.5, ContactState::SlipPlus, -0.5),
            ] {
                let (pair, du) = solved(mu, method);
                let force = pair.force;
                assert_eq!(pair.state, state, "{method:?}");
                assert_eq!(pair.slips, state != ContactState::Stick, "{method:?}");
                assert!((force[0] - 1.0).abs() < 1e-13, "{method:?} {force:?}");
                assert!((force[1] - pt).abs() < 1e-13, "{method:?} {force:?}");
                for (dof, du) in du.iter().enumerate() {
                    // dU = y + W (Bn^T Pn + Bt^T Pt)
                    let sign = if dof.is_multiple_of(2) { 1.0 } else { -1.0 };
                    let expected = 0.5 + (1.0 + sign * pt) / 2.0;
                    assert!((du - expected).abs() < 1e-13, "{dof}: {du} {expected}");
                }
                let gap = wide(mu).gap + wide(mu).gap_change(&du);
                assert!(gap.abs() < 1e-12, "{gap:e}");
            }
        }
    }
}
