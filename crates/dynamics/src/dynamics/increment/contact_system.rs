//! Complementarity problem of some constraints with one of the two system matrices: K* for the
//! contact forces of a pass, M for the impulses. See docs/theory/complementarity.md and docs/theory/impacts.md.
//!
//! Problems of many constraints are solved by blocks, one for each set of bodies. The solve under way gives the effect
//! of all forces on all constraints, also between blocks. docs/numerics.md, Blocks.
//!
//! The correction of a pass during its solve: gaps and slips at the contacts are known before the solve ends, and
//! contact forces are added to its right-hand side. See docs/numerics.md, Solves of a pass.

use std::collections::BTreeMap;

use super::equal_forces::FIRST_WEIGHT;
use crate::contact::{ClosedPair, ClosedPairs, Constraint, ConstraintGroup};
use crate::dynamics::results::{Cause, FailedLcp};
use crate::dynamics::step::{FreeMotions, ResponseVectors, System};
use crate::lcp::{
    BlockIteration, BlockStart, ContactState, FrictionalLcp, LcpBlock, LcpMethod, Progress,
};
use crate::linear::LinearError;

/// Starting point of a complementarity problem.
#[derive(Debug, Clone, Default)]
pub(crate) struct Guess {
    /// State of every constraint.
    pub states: Vec<ContactState>,
    /// Forces of every constraint, if known: of several solutions, the solution near these forces is sought.
    pub forces: Option<Vec<[f64; 2]>>,
    /// Weight by which the answer is kept near the known forces; without a weight the known forces matter only if the
    /// problem has no answer otherwise.
    pub weight: Option<f64>,
}

impl Guess {
    /// Sets the forces to the forces of the pairs closed `before`; with a weight the answer is sought near these forces.
    pub fn take_over(
        &mut self,
        constraints: &[&Constraint],
        before: &ClosedPairs,
        weight: Option<f64>,
    ) {
        let forces = self.forces.get_or_insert_default();
        forces.clear();
        forces.extend(constraints.iter().map(|c| before.force(c.key)));
        self.weight = weight;
    }

    /// Whether the guess has forces but no weight; with a weight the answer may be another.
    fn has_forces_only(&self) -> bool {
        self.forces.is_some() && self.weight.is_none()
    }

    /// The same guess with a weight, so that the answer is sought near the forces.
    fn near(&self) -> Self {
        Guess {
            weight: Some(FIRST_WEIGHT),
            ..self.clone()
        }
    }
}

impl System<'_> {
    /// Solves for the forces of the given constraints from the constant terms of their gaps and slips. The function
    /// writes the pairs that carry a force to `closed`, and returns the number of pivots. With a `response`, problems
    /// of many constraints are solved by blocks where that is faster.
    ///
    /// If the problem with derivative rows has no solution, the problem with force rows in place of the derivative rows
    /// is solved. With force rows Q is symmetric and the theorem of docs/theory/complementarity.md holds, so a ray
    /// means that pairs contradict each other. If pairs are so nearly the same that round-off spoils both problems, the
    /// answer near the last forces is used.
    pub(super) fn solve_contact(
        &mut self,
        constraints: &[&Constraint],
        constant_terms: &[[f64; 2]],
        guess: &Guess,
        closed: &mut ClosedPairs,
        response: Option<&mut Response>,
    ) -> Result<usize, Cause> {
        if let Some(response) = response
            && let Some(pivots) =
                self.solve_by_bodies(response, constraints, constant_terms, guess, closed)?
        {
            return Ok(pivots);
        }
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

    /// Solves with the derivative rows and, if this fails, with the force rows.
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
                let with_force_rows = |&c: &&Constraint| c.clone().with_force_rows();
                let symmetric: Vec<Constraint> = constraints.iter().map(with_force_rows).collect();
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
        let mut problem =
            self.frictional_lcp(&ConstraintGroup::All, constraints, constant_terms)?;
        if let (Some(forces), Some(weight)) = (&guess.forces, guess.weight) {
            add_proximal_term(&mut problem, forces, weight);
        }
        match self.solve_lcp(&problem, constraints, &guess.states) {
            Ok(solution) => {
                if let Some(free) = self.free_mut() {
                    free.answer(&problem, &solution);
                }
                self.take_back(problem);
                let forces = solution.pn.iter().zip(&solution.pt);
                let forces = forces.map(|(&pn, &pt)| [pn, pt]);
                closed.set(closed_of(constraints, forces, &solution.state));
                let pivots = solution.counters.pivots;
                self.take_back_solution(solution);
                Ok(pivots)
            }
            Err(error) => {
                let failed = FailedLcp::new(error, problem, constraints);
                Err(Cause::Lcp(Box::new(failed)))
            }
        }
    }
}

/// The constraints that carry a force, as closed pairs.
pub(super) fn closed_of<'a>(
    constraints: &'a [&Constraint],
    forces: impl Iterator<Item = [f64; 2]> + 'a,
    states: &'a [ContactState],
) -> impl Iterator<Item = ClosedPair> + 'a {
    let of_constraint = constraints.iter().zip(forces).zip(states);
    let closed = of_constraint.filter(|((_, force), _)| force[0] > 0.0);
    closed.map(|((constraint, force), state)| ClosedPair::new(constraint, force, *state))
}

/// Equal-force rule, eq. (5.3): adds eps Q_kk (P_k - P_k^0) to gaps and slips, where P^0 are the forces of the last
/// pass. If several pairs can carry the same force, the rule selects the solution near the forces of the last pass; the
/// term of the rule vanishes as the passes converge.
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

/// Number of constraints from which on a problem is solved by blocks.
const LEAST: usize = 100;

/// Number of constraints up to which their list needs no allocation.
pub(super) const FEW: usize = 128;

/// Least mean number of constraints in a block. The solves of a block iteration cost the same for blocks of any size,
/// so with smaller blocks the iteration is no faster than one solution with all of Q. Two flush faces have up to four
/// constraints of corners, which seldom carry a force.
const LEAST_BLOCK: usize = 8;

/// Largest part of the entries of Q within the blocks; with a larger part blocks save no time.
const WITHIN: f64 = 0.25;

/// Number of constraints between the same bodies from which on they are divided along the surfaces.
const LEAST_PARTED: usize = 240;

/// Number of slave nodes of a part.
const PART: usize = 64;

/// Coupling of two constraints of every part, the entry of Q relative to the root of their own compliances, below which
/// the parts are coupled weakly.
const COUPLING: f64 = 0.1;

/// Gaps and slips of the constraints of a problem as functions of the forces.
struct GapsAndSlips<'r, 'a> {
    response: &'r mut Response<'a>,
    constraints: &'r [&'r Constraint],
    /// Terms eps Q_kk of the equal-force rule, eq. (5.3), zero without a weight.
    proximal: Vec<[f64; 2]>,
    /// Forces P^0 of the last pass, for eq. (5.3).
    near: Vec<[f64; 2]>,
}

impl GapsAndSlips<'_, '_> {
    /// Gaps and slips g + G W B^T P + eps diag(Q) (P - P^0), where g are the gaps and slips without contact forces.
    fn under(&mut self, system: &mut System, forces: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let constraints = self.constraints.iter().copied();
        let acting = constraints.clone().zip(forces.iter().copied());
        self.response.set_forces(system, acting);
        let mut all = Vec::new();
        self.response.gaps_and_slips(system, constraints, &mut all);
        for (k, at) in all.iter_mut().enumerate() {
            *at = [0, 1].map(|i| at[i] + self.proximal[k][i] * (forces[k][i] - self.near[k][i]));
        }
        all
    }
}

/// The blocks of a problem, and eps Q_kk of all its constraints.
type ProblemBlocks = (Vec<LcpBlock>, Vec<[f64; 2]>);

impl System<'_> {
    /// Positions of constraints, grouped by the bodies between which they act or by parts of surfaces; `None` if the
    /// problem of the constraints is not to be solved by blocks.
    pub(super) fn by_bodies(
        &self,
        constraints: &[&Constraint],
    ) -> Option<BTreeMap<ConstraintGroup, Vec<usize>>> {
        let may_be_parted =
            self.method() == LcpMethod::Hybrid && !self.couples_bodies() && self.free().is_none();
        if constraints.len() < LEAST || !may_be_parted {
            return None;
        }
        let blocks_by = |scope_of: &dyn Fn(&Constraint) -> ConstraintGroup| {
            let mut blocks: BTreeMap<ConstraintGroup, Vec<usize>> = BTreeMap::new();
            for (k, constraint) in constraints.iter().enumerate() {
                blocks.entry(scope_of(constraint)).or_default().push(k);
            }
            let square = |count: usize| (count as f64).powi(2);
            let within: f64 = blocks.values().map(|block| square(block.len())).sum();
            let are_small = within <= WITHIN * square(constraints.len());
            (are_small && LEAST_BLOCK * blocks.len() <= constraints.len()).then_some(blocks)
        };
        let by_bodies = blocks_by(&|constraint| self.scope_of(constraint));
        by_bodies.or_else(|| {
            if constraints.len() < LEAST_PARTED || are_in_both_orders(constraints) {
                return None;
            }
            blocks_by(&|constraint| self.part_of(constraint, PART))
        })
    }

    /// Solves for the forces of constraints by blocks, where `free` are their gaps and slips without these forces; the
    /// pairs that carry a force are written to `closed`. Returns the number of pivots, or `None` if a solution by
    /// blocks saves no time or the blocks are coupled too strongly.
    fn solve_by_bodies(
        &mut self,
        response: &mut Response,
        constraints: &[&Constraint],
        free: &[[f64; 2]],
        guess: &Guess,
        closed: &mut ClosedPairs,
    ) -> Result<Option<usize>, Cause> {
        let Some(by_bodies) = self.by_bodies(constraints) else {
            return Ok(None);
        };
        let count = constraints.len();
        let near = (guess.forces.clone()).unwrap_or_else(|| vec![[0.0; 2]; count]);
        let Some((blocks, proximal)) = self.blocks(constraints, &by_bodies, guess)? else {
            return Ok(None);
        };
        let mut motion = GapsAndSlips {
            response,
            constraints,
            proximal,
            near: near.clone(),
        };
        let start = BlockStart {
            states: guess.states.clone(),
            motion: match guess.forces {
                Some(_) => motion.under(self, &near),
                None => free.to_vec(),
            },
            forces: near,
            free: free.to_vec(),
        };
        let mut iteration = BlockIteration::new(blocks, start, self.method());
        let mut progress = Progress::GoesOn;
        while progress == Progress::GoesOn {
            progress = match self.solve_blocks(&mut iteration) {
                Ok(forces) => iteration.take_in(&motion.under(self, &forces)),
                Err(_) => Progress::Fails,
            };
        }
        let (solution, blocks) = iteration.end();
        for (scope, block) in by_bodies.into_keys().zip(blocks) {
            self.keep(scope, block.kept);
        }
        self.count_lcp(count, solution.counters);
        if progress != Progress::Solved {
            return Ok(None);
        }
        let forces = solution.forces.into_iter();
        closed.set(closed_of(constraints, forces, &solution.states));
        Ok(Some(solution.counters.pivots))
    }

    /// The blocks, and eps Q_kk of all constraints; `None` if parts of surfaces are coupled strongly.
    fn blocks(
        &mut self,
        all: &[&Constraint],
        by_bodies: &BTreeMap<ConstraintGroup, Vec<usize>>,
        guess: &Guess,
    ) -> Result<Option<ProblemBlocks>, LinearError> {
        let mut proximal = vec![[0.0; 2]; all.len()];
        let mut blocks = Vec::with_capacity(by_bodies.len());
        for (scope, contacts) in by_bodies {
            let constraints: Vec<&Constraint> = contacts.iter().map(|&k| all[k]).collect();
            let n = constraints.len();
            let terms = vec![[0.0; 2]; n];
            let mut problem = self.frictional_lcp(scope, &constraints, &terms)?;
            if matches!(scope, ConstraintGroup::Part(..)) && n >= PART / 2 && is_coupled(&problem) {
                return Ok(None);
            }
            for (k, &contact) in contacts.iter().enumerate() {
                proximal[contact] = [k, k + n].map(|i| {
                    let part = guess.weight.unwrap_or(0.0) * problem.q[(i, i)];
                    problem.q[(i, i)] += part;
                    part
                });
            }
            let kept = self.take_kept(scope);
            blocks.push(LcpBlock {
                contacts: contacts.clone(),
                problem,
                kept,
            });
        }
        Ok(Some((blocks, proximal)))
    }
}

/// Whether a slave node of one contact is a target of another. Two pairs in both orders that face each other are almost
/// the same, and a division along the surfaces would separate them.
fn are_in_both_orders(constraints: &[&Constraint]) -> bool {
    let mut contacts = BTreeMap::new();
    for constraint in constraints {
        let contact = constraint.key.slave().contact();
        contacts.extend(constraint.nodes().take(1).map(|node| (node, contact)));
    }
    constraints.iter().any(|constraint| {
        let own = constraint.key.slave().contact();
        let is_of_other = |node: usize| contacts.get(&node).is_some_and(|&other| other != own);
        constraint.nodes().skip(1).any(is_of_other)
    })
}

/// Whether the first constraint of a part is coupled strongly to all other constraints of the part; if so, the part is
/// also coupled strongly to its neighbours.
fn is_coupled(part: &FrictionalLcp) -> bool {
    let q = |i: usize, j: usize| part.q[(i, j)];
    let coupling = |j: usize| q(0, j).abs() / (q(0, 0) * q(j, j)).sqrt();
    (1..part.len()).map(coupling).fold(1.0, f64::min) > COUPLING
}

/// The response u + W (f + B^T P) for some constraints, where W is the inverse of the system matrix. The response is
/// available at the nodes of the constraints at any time, and everywhere at the end.
pub(super) struct Response<'a> {
    /// Displacements u, over all dofs.
    start: &'a [f64],
    vectors: ResponseVectors,
}

impl<'a> Response<'a> {
    /// Begins a response with the forces `f`, over all dofs, and without contact forces (P = 0).
    ///
    /// # Errors
    /// Returns an error if the matrix has no factors.
    pub fn begin(
        system: &mut System,
        [start, f]: [&'a [f64]; 2],
        constraints: &[Constraint],
    ) -> Result<Self, LinearError> {
        let mut vectors = system.take_vectors();
        let ResponseVectors {
            nodes,
            unknowns,
            forces,
            at_nodes,
            ..
        } = &mut vectors;
        let pinned = system.free().into_iter().flat_map(|free| &free.dofs);
        let of_constraints = constraints.iter().flat_map(Constraint::nodes);
        replace(nodes, of_constraints.chain(pinned.map(|dof| dof / 2)));
        let dofs = nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]);
        let terms = dofs.flat_map(|dof| system.map().row(dof));
        replace(unknowns, terms.map(|term| term.0));
        forces.clear();
        at_nodes.resize(start.len(), 0.0);
        system.begin(f)?;
        Ok(Response { start, vectors })
    }

    /// Writes g + Gn y and Dt + Gt y of every constraint, where y is the response so far; negligible values become 0.
    pub fn gaps_and_slips<'c>(
        &mut self,
        system: &mut System,
        constraints: impl Iterator<Item = &'c Constraint>,
        found: &mut Vec<[f64; 2]>,
    ) {
        let start = self.start;
        let ResponseVectors {
            nodes,
            unknowns,
            values,
            at_nodes: y,
            ..
        } = &mut self.vectors;
        system.partial(unknowns, values);
        let value = |unknown: &usize| values[unknowns.partition_point(|u| u < unknown)];
        for &node in nodes.iter() {
            let of_dof = |dof: usize| -> f64 {
                let terms = system.map().derivative_row(dof);
                terms.map(|(unknown, c)| c * value(&unknown)).sum()
            };
            let mut own = [of_dof(2 * node), of_dof(2 * node + 1)];
            system.rotation().turn_node(node, &mut own);
            (y[2 * node], y[2 * node + 1]) =
                (start[2 * node] + own[0], start[2 * node + 1] + own[1]);
        }
        let after = |c: &Constraint| {
            [c.gap + c.gap_change(y), c.slip + c.slip_change(y)].map(|length| c.resolved(length))
        };
        found.clear();
        found.extend(constraints.map(after));
    }

    /// Tells the free motions the positions of their pins without contact forces; [`Self::gaps_and_slips`] must have
    /// been called before.
    pub fn show_pins(&self, system: &mut System) {
        let at_nodes = &self.vectors.at_nodes;
        if let Some(free) = system.free_mut() {
            free.alone = free.dofs.iter().map(|&dof| at_nodes[dof]).collect();
        }
    }

    /// Replaces the forces of the given constraints and of the pins in the right-hand side. Gaps and slips without
    /// contact forces must have been asked for before.
    pub fn set_forces<'c>(
        &mut self,
        system: &mut System,
        acting: impl Iterator<Item = (&'c Constraint, [f64; 2])>,
    ) {
        let forces = &mut self.vectors.forces;
        forces.iter_mut().for_each(|force| force.1 = -force.1);
        let before = forces.len();
        for (constraint, force) in acting {
            for (node, mut force) in constraint.nodal_forces(force) {
                system.rotation().turn_node_back(node, &mut force);
                for (dof, force) in [2 * node, 2 * node + 1].into_iter().zip(force) {
                    let terms = system.map().row(dof).iter();
                    forces.extend(terms.map(|&(unknown, c)| (unknown, c * force)));
                }
            }
        }
        for (dof, force) in system.free().into_iter().flat_map(FreeMotions::forces) {
            let terms = system.map().row(dof).iter();
            forces.extend(terms.map(|&(unknown, c)| (unknown, c * force)));
        }
        system.add(forces);
        forces.drain(..before);
    }

    /// Writes the response u + W (f + B^T P), over all dofs.
    ///
    /// # Errors
    /// Returns an error if the solution is not finite.
    pub fn end(self, system: &mut System, response: &mut Vec<f64>) -> Result<(), LinearError> {
        system.give_back(self.vectors);
        system.end(self.start, response)
    }
}

/// Replaces a list by the given numbers, in increasing order, each once.
fn replace(list: &mut Vec<usize>, numbers: impl Iterator<Item = usize>) {
    list.clear();
    list.extend(numbers);
    list.sort_unstable();
    list.dedup();
}
