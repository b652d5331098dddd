//! Frictional problems of many contacts by blocks: each block is solved exactly with the forces of the others held,
//! until the motion that it expects is that under the forces of all; accelerated by the last steps. docs/numerics.md, Blocks.
//!
//! Ten bodies with 2000 pairs on one strip take 0.4 s per increment with it. As one problem the first increment took
//! 420 s, nearly all of them for the compliance between the bodies through the strip (docs/numerics.md).

use super::anderson::{Acceleration, IterationStep};
use super::dense::{add_sizes, max_abs};
use super::hybrid::{LcpMethod, solve_similar};
use super::kept::KeptFactors;
use super::known::Known;
use super::problems::{ContactState, Counters, FrictionalLcp, LcpError};
use super::residual::{ROUNDING, TOLERANCE, law_residual};
use crate::linear::largest;

/// Difference between motion and expected motion that is round-off, relative to the terms of either.
const CONVERGED: f64 = 1e-14;

/// Iterations at most.
const MOST: usize = 60;

/// Number of iterations in which the difference must fall to [`FALLEN`] of the first; otherwise the coupling of the blocks
/// is too strong.
const TRIAL: usize = 15;

/// Number of iterations after which the difference must fall fast enough for that.
const FIRST_TRIAL: usize = 6;

/// See [`TRIAL`].
const FALLEN: f64 = 1e-2;

/// Iterations without a smaller difference after which it is taken for round-off.
const STAGNANT: usize = 4;

/// Growth of the difference beyond the smallest one that ends the acceleration by the steps before.
const GROWTH: f64 = 10.0;

/// Changes from step to step that are remembered.
const MEMORY: usize = 20;

/// Part of a change of the residual, beside what is along those before, below which it is round-off.
const DEPENDENT: f64 = 1e-8;

/// A block of the contacts of a larger problem.
pub struct LcpBlock {
    /// Positions of its contacts in the larger problem.
    pub contacts: Vec<usize>,
    /// Its part of Q and its friction; the iteration sets gaps and slips.
    pub problem: FrictionalLcp,
    /// Factors of a similar problem before.
    pub kept: KeptFactors,
}

/// What a block iteration starts from, for all contacts.
pub struct BlockStart {
    /// States.
    pub states: Vec<ContactState>,
    /// Forces Pn and Pt.
    pub forces: Vec<[f64; 2]>,
    /// Gaps and slips under these forces.
    pub motion: Vec<[f64; 2]>,
    /// Gaps and slips without forces.
    pub free: Vec<[f64; 2]>,
}

/// The answer of a block iteration, for all contacts.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockSolution {
    /// Forces Pn and Pt.
    pub forces: Vec<[f64; 2]>,
    /// States.
    pub states: Vec<ContactState>,
    /// Scaled residual of the contact conditions.
    pub residual: f64,
    /// Work of all blocks.
    pub counters: Counters,
}

/// Where an iteration stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// The forces are those of the answer.
    Solved,
    /// It goes on.
    GoesOn,
    /// It does not converge.
    Fails,
}

/// How the difference of motion and expected motion falls.
#[derive(Debug, Clone, Copy, Default)]
struct Fall {
    first: f64,
    least: f64,
    iterations: usize,
    /// Iterations since it was half the least before.
    since_least: usize,
}

impl Fall {
    /// Takes in the difference of an iteration.
    fn take_in(&mut self, difference: f64) -> Self {
        if self.iterations == 0 {
            (self.first, self.least) = (difference, difference);
        }
        let falls = difference < 0.5 * self.least;
        self.since_least = if falls { 0 } else { self.since_least + 1 };
        self.least = self.least.min(difference);
        self.iterations += 1;
        *self
    }

    /// Whether the coupling of the blocks is too strong.
    fn is_slow(self) -> bool {
        let part = self.iterations.min(TRIAL) as f64 / TRIAL as f64;
        self.iterations >= FIRST_TRIAL && self.least > FALLEN.powf(part) * self.first
    }
}

/// Iteration over the blocks of a problem, all at once, accelerated by its last steps. It knows Q within
/// the blocks only; what all forces do to all contacts it is told:
///
/// ```text
/// P <- forces(P):   block c solved with g + Q P - Q_cc P_c as gaps and slips without its forces
/// ```
pub struct BlockIteration {
    blocks: Vec<LcpBlock>,
    method: LcpMethod,
    free: f64,
    length: f64,
    states: Vec<ContactState>,
    /// Forces that the blocks are solved at, by contact, and the motion under them.
    at: [Vec<f64>; 2],
    /// Forces of the blocks, and the motion that each expects.
    answer: [Vec<f64>; 2],
    /// Largest sum of the sizes of the terms of Q P within the blocks.
    terms: f64,
    acceleration: Acceleration<2>,
    course: Fall,
    residual: f64,
    counters: Counters,
}

impl BlockIteration {
    /// Starts an iteration over blocks that have each contact once.
    pub fn new(blocks: Vec<LcpBlock>, start: BlockStart, method: LcpMethod) -> Self {
        let free = start.free.as_flattened();
        let deepest = start.free.iter().fold(0.0_f64, |l, [gap, _]| l.max(-gap));
        BlockIteration {
            blocks,
            method,
            free: max_abs(free),
            length: deepest,
            states: start.states,
            answer: [vec![0.0; free.len()], vec![0.0; free.len()]],
            at: [start.forces, start.motion].map(|values| values.as_flattened().to_vec()),
            terms: 0.0,
            acceleration: Acceleration::new(MEMORY, DEPENDENT),
            course: Fall::default(),
            residual: f64::INFINITY,
            counters: Counters::default(),
        }
    }

    /// Solves all blocks: the forces Pn and Pt of all contacts whose motion [`Self::take_in`] wants.
    ///
    /// # Errors
    /// A block without solution.
    pub fn forces(&mut self) -> Result<&[[f64; 2]], LcpError> {
        let Self { at, answer, .. } = self;
        self.terms = 0.0;
        for block in &mut self.blocks {
            let states: Vec<ContactState> =
                block.contacts.iter().map(|&k| self.states[k]).collect();
            block.set_motion(at);
            let LcpBlock { problem, kept, .. } = &mut *block;
            let solved =
                solve_similar(problem, Some(Known::of_states(&states)), self.method, kept)?;
            self.counters += solved.counters;
            for (k, &contact) in block.contacts.iter().enumerate() {
                let [forces, motion] = answer.each_mut();
                forces[2 * contact..][..2].copy_from_slice(&[solved.pn[k], solved.pt[k]]);
                motion[2 * contact..][..2].copy_from_slice(&[solved.gap[k], solved.slip[k]]);
                self.states[contact] = solved.state[k];
            }
            let forces = solved.pn.iter().chain(&solved.pt);
            self.terms = self.terms.max(block.terms(forces));
        }
        Ok(pairs(&self.answer[0]))
    }

    /// Takes in gaps and slips under the last forces.
    pub fn take_in(&mut self, motion: &[[f64; 2]]) -> Progress {
        let motion = motion.as_flattened();
        let differences = motion.iter().zip(&self.answer[1]).map(|(v, e)| v - e);
        let difference = largest(&differences.collect::<Vec<f64>>());
        let course = self.course.take_in(difference);
        let ends = difference <= CONVERGED * (self.terms + self.free);
        if ends || course.since_least >= STAGNANT {
            self.residual = self.law_residual(motion);
            if self.residual <= TOLERANCE {
                return Progress::Solved;
            }
        }
        if !difference.is_finite() || course.iterations >= MOST || course.is_slow() {
            return Progress::Fails;
        }
        if difference > GROWTH * course.least {
            self.acceleration.clear();
        }
        self.go_on(motion);
        Progress::GoesOn
    }

    /// The forces that the blocks are solved at next, and the motion under them.
    fn go_on(&mut self, motion: &[f64]) {
        let [forces, _] = &self.answer;
        let residual = forces.iter().zip(&self.at[0]).map(|(f, x)| f - x);
        self.at = self.acceleration.next(IterationStep {
            residual: residual.collect(),
            images: [forces.clone(), motion.to_vec()],
        });
    }

    /// Residual of the contact law under the last forces, whose motion is given.
    fn law_residual(&self, motion: &[f64]) -> f64 {
        let (mut mu, mut compliance) = (vec![0.0; self.states.len()], 0.0);
        for LcpBlock {
            contacts, problem, ..
        } in &self.blocks
        {
            for (k, &contact) in contacts.iter().enumerate() {
                mu[contact] = problem.mu[k];
                compliance += problem.q[(k, k)] / self.states.len() as f64;
            }
        }
        let length = self.length + ROUNDING * self.terms;
        let contacts = pairs(motion).iter().zip(pairs(&self.answer[0])).zip(mu);
        let contacts = contacts.map(|((motion, force), mu)| (*motion, *force, mu));
        law_residual(contacts, compliance, length)
    }

    /// The answer, once it is solved, and the blocks with their factors.
    pub fn end(self) -> (BlockSolution, Vec<LcpBlock>) {
        let solution = BlockSolution {
            forces: pairs(&self.answer[0]).to_vec(),
            states: self.states,
            residual: self.residual,
            counters: self.counters,
        };
        (solution, self.blocks)
    }
}

impl LcpBlock {
    /// Sets gaps and slips without the forces of the block, under those of all others:
    /// v_c - Q_cc P_c.
    fn set_motion(&mut self, [forces, motion]: &[Vec<f64>; 2]) {
        let LcpBlock {
            contacts, problem, ..
        } = self;
        let of = |values: &[f64], i: usize| {
            let part = contacts.iter().map(|&contact| values[2 * contact + i]);
            part.collect::<Vec<f64>>().into()
        };
        (problem.gap, problem.slip) = (of(motion, 0), of(motion, 1));
        let (pn, pt) = (-of(forces, 0), -of(forces, 1));
        (problem.gap, problem.slip) = problem.motion(&pn, &pt);
    }

    /// Largest sum of the sizes of the terms of Q P.
    fn terms<'a>(&self, forces: impl Iterator<Item = &'a f64>) -> f64 {
        let rows = 2 * self.contacts.len();
        let mut terms = vec![0.0; rows];
        let columns = self.problem.q.as_slice().chunks_exact(rows.max(1));
        for (force, column) in forces.zip(columns) {
            add_sizes(*force, column, &mut terms);
        }
        max_abs(&terms)
    }
}

/// Values of a normal and a tangential direction.
fn pairs(values: &[f64]) -> &[[f64; 2]] {
    values.as_chunks().0
}
