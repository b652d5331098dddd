//! Complementarity problems of many constraints by blocks, one for each set of bodies that constraints are
//! between; what the forces of all do to all is computed by the solve that is under way. Section 8 of
//! docs/theory.md, Blocks.

use std::collections::BTreeMap;

use smallvec::SmallVec;

use super::contact_system::{ContactSystem, Guess, closed_of, names};
use super::response::Response;
use crate::contact::{ClosedPairs, Constraint, Scope};
use crate::dynamics::results::Cause;
use crate::lcp::{BlockIteration, BlockStart, LcpBlock, LcpMethod, Progress};
use crate::linear::LinearError;

/// Constraints from which on their problem is solved by blocks.
const LEAST: usize = 100;

/// Constraints whose list takes no memory from the system.
const FEW: usize = 128;

/// Part of the entries of Q within the blocks at most, or blocks gain nothing.
const WITHIN: f64 = 0.25;

/// Whether a problem of so many constraints may be solved by blocks.
pub(super) fn is_large(count: usize) -> bool {
    count >= LEAST
}

/// The constraints that enter a problem, by their places among all.
pub(super) struct Chosen<'a> {
    pub all: &'a [Constraint],
    pub places: &'a [usize],
}

impl<'a> Chosen<'a> {
    /// The constraints that enter.
    pub fn constraints(&self) -> SmallVec<[&'a Constraint; FEW]> {
        self.places.iter().map(|&place| &self.all[place]).collect()
    }

    /// Whether their problem is to be solved by blocks.
    pub fn are_by_bodies(&self, system: &ContactSystem) -> bool {
        self.by_bodies(system).is_some()
    }

    /// Their positions by the bodies that they are between, if their problem is to be solved by blocks.
    fn by_bodies(&self, system: &ContactSystem) -> Option<BTreeMap<Scope, Vec<usize>>> {
        if !is_large(self.places.len()) || system.method != LcpMethod::Hybrid {
            return None;
        }
        let mut blocks: BTreeMap<Scope, Vec<usize>> = BTreeMap::new();
        for (k, constraint) in self.constraints().into_iter().enumerate() {
            let scope = system.system.scope_of(constraint);
            blocks.entry(scope).or_default().push(k);
        }
        let square = |count: usize| (count as f64).powi(2);
        let within: f64 = blocks.values().map(|block| square(block.len())).sum();
        (within <= WITHIN * square(self.places.len())).then_some(blocks)
    }
}

/// Gaps and slips of the constraints of a problem under any forces.
struct Motion<'r, 'a> {
    response: &'r mut Response<'a>,
    chosen: &'r Chosen<'r>,
    /// eps Q_kk of eq. (5.3), zero without a weight.
    held: Vec<[f64; 2]>,
    /// P^0 of eq. (5.3).
    near: Vec<[f64; 2]>,
}

impl Motion<'_, '_> {
    /// g + G W B^T P + eps diag(Q) (P - P^0), g being gaps and slips without these forces.
    fn under(&mut self, system: &mut ContactSystem, forces: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let acting = self.chosen.constraints().into_iter();
        self.response
            .set_forces(system, acting.zip(forces.iter().copied()));
        let mut all = Vec::new();
        (self.response).gaps_and_slips(system, self.chosen.all, &mut all);
        let of = |(k, &place): (usize, &usize)| {
            let held = |i: usize| self.held[k][i] * (forces[k][i] - self.near[k][i]);
            [0, 1].map(|i| all[place][i] + held(i))
        };
        self.chosen.places.iter().enumerate().map(of).collect()
    }
}

impl ContactSystem<'_> {
    /// Forces of the chosen constraints by blocks, `free` being gaps and slips of all constraints without
    /// them: the pairs that carry one are `closed`. The pivots that it took; none where blocks gain nothing or are
    /// coupled too strongly.
    pub(super) fn solve_by_bodies(
        &mut self,
        response: &mut Response,
        chosen: &Chosen,
        free: &[[f64; 2]],
        guess: &Guess,
        closed: &mut ClosedPairs,
    ) -> Result<Option<usize>, Cause> {
        let Some(by_bodies) = chosen.by_bodies(self) else {
            return Ok(None);
        };
        let count = chosen.places.len();
        let near = (guess.forces.clone()).unwrap_or_else(|| vec![[0.0; 2]; count]);
        let (blocks, held) = self.blocks(chosen, &by_bodies, guess)?;
        let mut motion = Motion {
            response,
            chosen,
            held,
            near: near.clone(),
        };
        let free: Vec<[f64; 2]> = chosen.places.iter().map(|&place| free[place]).collect();
        let start = BlockStart {
            states: guess.states.clone(),
            motion: match guess.forces {
                Some(_) => motion.under(self, &near),
                None => free.clone(),
            },
            forces: near,
            free,
        };
        let mut iteration = BlockIteration::new(blocks, start, self.method);
        let mut progress = Progress::GoesOn;
        while progress == Progress::GoesOn {
            progress = match self.system.solve_blocks(&mut iteration) {
                Ok(forces) => iteration.take_in(&motion.under(self, &forces)),
                Err(_) => Progress::Fails,
            };
        }
        let (solution, blocks) = iteration.end();
        for (scope, block) in by_bodies.into_keys().zip(blocks) {
            self.system.keep(scope, block.kept);
        }
        self.system.count_lcp(count, solution.counters);
        if progress != Progress::Solved {
            return Ok(None);
        }
        let forces = solution.forces.into_iter();
        closed.set(closed_of(&chosen.constraints(), forces, &solution.states));
        Ok(Some(solution.counters.pivots))
    }

    /// The blocks, with eps Q_kk of all constraints.
    fn blocks(
        &mut self,
        chosen: &Chosen,
        by_bodies: &BTreeMap<Scope, Vec<usize>>,
        guess: &Guess,
    ) -> Result<(Vec<LcpBlock>, Vec<[f64; 2]>), LinearError> {
        let all = chosen.constraints();
        let mut held = vec![[0.0; 2]; all.len()];
        let mut blocks = Vec::with_capacity(by_bodies.len());
        for (scope, contacts) in by_bodies {
            let constraints: Vec<&Constraint> = contacts.iter().map(|&k| all[k]).collect();
            let n = constraints.len();
            let terms = vec![[0.0; 2]; n];
            let mut problem = self.system.frictional_lcp(scope, &constraints, &terms)?;
            for (k, &contact) in contacts.iter().enumerate() {
                held[contact] = [k, k + n].map(|i| {
                    let part = guess.weight.unwrap_or(0.0) * problem.q[(i, i)];
                    problem.q[(i, i)] += part;
                    part
                });
            }
            let mut kept = self.system.take_kept(scope);
            kept.name_contacts(names(&constraints));
            blocks.push(LcpBlock {
                contacts: contacts.clone(),
                problem,
                kept,
            });
        }
        Ok((blocks, held))
    }
}
