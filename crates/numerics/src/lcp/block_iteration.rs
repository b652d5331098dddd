//! Solves frictional problems of many contacts by blocks. Each block is solved exactly with the forces of the others
//! held, until the motion that it expects agrees with the motion under all forces; the last steps accelerate this
//! iteration. See docs/numerics.md, Blocks.
//!
//! With blocks, ten bodies with 2000 pairs on one strip need 0.4 s per increment. Solved as one problem, the first
//! increment took 420 s, nearly all for the compliance between the bodies through the strip (docs/numerics.md).

use super::anderson::{Acceleration, IterationStep};
use super::dense::{add_sizes, max_abs};
use super::hybrid::{LcpMethod, solve_similar};
use super::kept::KeptFactors;
use super::known::Known;
use super::problems::{ContactState, Counters, FrictionalLcp, LcpError};
use super::residual::{ROUNDING, TOLERANCE, law_residual};
use crate::linear::largest;

/// Largest difference between motion and expected motion that counts as round-off, relative to the terms of both.
const CONVERGED: f64 = 1e-14;

/// Largest number of iterations.
const MOST: usize = 60;

/// Number of iterations within which the difference must fall to [`FALLEN`] times the first difference; otherwise the
/// coupling of the blocks is too strong.
const TRIAL: usize = 15;

/// Number of iterations from which on the rate of this fall is checked.
const FIRST_TRIAL: usize = 6;

/// Fall of the difference that is required within [`TRIAL`] iterations.
const FALLEN: f64 = 1e-2;

/// Number of iterations without a smaller difference after which the difference counts as round-off.
const STAGNANT: usize = 4;

/// Ratio of the difference to the smallest difference so far above which earlier steps are forgotten.
const GROWTH: f64 = 10.0;

/// Number of changes from step to step that are remembered.
const MEMORY: usize = 20;

/// Relative size of the part of a change of the residual that is orthogonal to earlier changes, below which this change
/// counts as round-off.
const DEPENDENT: f64 = 1e-8;

/// A block of the contacts of a larger problem.
pub struct LcpBlock {
    /// Positions of the contacts of the block in the larger problem.
    pub contacts: Vec<usize>,
    /// The part of Q and the friction of the block; the iteration sets its gaps and slips.
    pub problem: FrictionalLcp,
    /// Factors that are kept from an earlier, similar problem.
    pub kept: KeptFactors,
}

/// Start of a block iteration, for all contacts.
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

/// State of an iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// The last forces are the answer.
    Solved,
    /// The iteration goes on.
    GoesOn,
    /// The iteration does not converge.
    Fails,
}

/// Course of the difference between motion and expected motion.
#[derive(Debug, Clone, Copy, Default)]
struct Fall {
    first: f64,
    least: f64,
    iterations: usize,
    /// Number of iterations since the difference last fell below half of the smallest one before.
    since_least: usize,
}

impl Fall {
    /// Enters the difference of an iteration.
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

/// Iteration over the blocks of a problem, which are solved independently of each other; its last steps accelerate it.
/// The iteration knows Q within the blocks only; its caller computes the motion of all contacts under all forces:
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
    /// Forces at which the blocks are solved, by contact, and the motion under these forces.
    at: [Vec<f64>; 2],
    /// Forces that the blocks find, and the motion that each block expects under them.
    answer: [Vec<f64>; 2],
    /// Largest sum of the sizes of the terms of Q P within the blocks.
    terms: f64,
    acceleration: Acceleration<2>,
    course: Fall,
    residual: f64,
    counters: Counters,
}

impl BlockIteration {
    /// Starts an iteration over blocks that contain each contact once.
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

    /// Solves all blocks; returns the forces Pn and Pt of all contacts, whose motion must be passed to
    /// [`Self::take_in`].
    ///
    /// # Errors
    /// A block has no solution.
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

    /// Enters gaps and slips under the last forces; returns whether the iteration goes on.
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

    /// Sets the forces at which the blocks are solved next, and the motion under these forces.
    fn go_on(&mut self, motion: &[f64]) {
        let [forces, _] = &self.answer;
        let residual = forces.iter().zip(&self.at[0]).map(|(f, x)| f - x);
        self.at = self.acceleration.next(IterationStep {
            residual: residual.collect(),
            images: [forces.clone(), motion.to_vec()],
        });
    }

    /// Residual of the contact law for the last forces and the motion under them.
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

    /// The answer of a solved problem, and the blocks with their factors.
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
    /// Sets gaps and slips under the forces of all other blocks, without those of this block: v_c - Q_cc P_c.
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

/// Values as pairs of a normal and a tangential one.
fn pairs(values: &[f64]) -> &[[f64; 2]] {
    values.as_chunks().0
}
