//! Contact forces of a pass and impact impulses, each the solution of a frictional complementarity
//! problem. Sections 5 and 6 of docs/theory.md (paper eqs 30 and 36 to 47).

use super::closed_pairs::ClosedPairs;
use crate::contact::tolerances::SETTLED_OVERLAP;
use crate::contact::{Pair, add_contact_forces};
use crate::dynamics::results::{Cause, FailedLcp};
use crate::dynamics::step::{System, Unknowns};
use crate::lcp::{ContactState, FrictionalLcp, LcpMethod};

/// Part of the compliance of a pair that holds its force near that of the pass before.
const PROXIMAL_WEIGHT: f64 = 1e-5;

/// Pairs with their contact forces (or impulses).
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactForces {
    pub pairs: Vec<Pair>,
    /// Normal force Pn >= 0 of every pair.
    pub normal: Vec<f64>,
    /// Tangential force Pt of every pair.
    pub tangential: Vec<f64>,
    /// State of every pair.
    pub state: Vec<ContactState>,
    /// Number of pairs that entered the complementarity problem.
    pub problem_size: usize,
}

impl ContactForces {
    /// Pairs without forces.
    pub fn open(pairs: Vec<Pair>) -> Self {
        let n = pairs.len();
        ContactForces {
            pairs,
            normal: vec![0.0; n],
            tangential: vec![0.0; n],
            state: vec![ContactState::Open; n],
            problem_size: 0,
        }
    }

    /// With further pairs that carry no force.
    pub fn with_open(mut self, pairs: Vec<Pair>) -> Self {
        let open = ContactForces::open(pairs);
        self.pairs.extend(open.pairs);
        self.normal.extend(open.normal);
        self.tangential.extend(open.tangential);
        self.state.extend(open.state);
        self
    }

    /// Contact force Bn^T Pn + Bt^T Pt of eq. (3.1), over all dofs.
    pub fn resultant(&self, dofs: usize) -> Vec<f64> {
        let mut force = vec![0.0; dofs];
        for (k, pair) in self.pairs.iter().enumerate() {
            if self.is_closed(k) {
                add_contact_forces(pair, self.normal[k], self.tangential[k], &mut force);
            }
        }
        force
    }

    /// Whether a pair carries a force.
    pub fn is_closed(&self, k: usize) -> bool {
        self.normal[k] > 0.0
    }

    /// Numbers of closed and of sticking pairs.
    pub fn count(&self) -> (usize, usize) {
        let closed = (0..self.pairs.len()).filter(|&k| self.is_closed(k));
        closed.fold((0, 0), |(closed, sticking), k| {
            (
                closed + 1,
                sticking + usize::from(self.state[k] == ContactState::Stick),
            )
        })
    }

    /// Solves the complementarity problem of the pairs listed in `chosen`, with the given constant
    /// terms, and stores their forces; with `nearest`, of several solutions that near these forces.
    fn solve(
        &mut self,
        chosen: &[usize],
        constants: (Vec<f64>, Vec<f64>),
        (warm, nearest): (Vec<ContactState>, Option<Vec<[f64; 2]>>),
        system: &mut System,
        method: LcpMethod,
    ) -> Result<(), Cause> {
        let pairs: Vec<Pair> = chosen.iter().map(|&k| self.pairs[k]).collect();
        let mut problem = system.frictional_lcp(&pairs, constants.0, constants.1)?;
        if let Some(forces) = nearest {
            add_proximal_term(&mut problem, &forces);
        }
        let solution = system.solve_lcp(&problem, &warm, method);
        let solution = solution.map_err(|error| {
            let nodes = |[s, a, b, _]: [usize; 4]| [s, a, b];
            let pairs = pairs.iter().map(|pair| nodes(pair.target.nodes)).collect();
            Cause::Lcp(Box::new(FailedLcp {
                error,
                problem,
                pairs,
            }))
        })?;
        self.problem_size = pairs.len();
        for (i, &k) in chosen.iter().enumerate() {
            self.normal[k] = solution.pn[i];
            self.tangential[k] = solution.pt[i];
            self.state[k] = solution.state[i];
        }
        Ok(())
    }

    /// Contact forces of a pass and the correction dU = y + W (Bn^T Pn + Bt^T Pt), y = W r being
    /// the correction without them (all dofs).
    ///
    /// Pairs that were open before (or without any before, that y leaves open) stay out of the problem
    /// first; those that would overlap with the forces of the others enter afterwards, so that the
    /// answer is that of all pairs. When the passes have settled, they enter only if they would
    /// overlap by more than round-off: two nodes that face each other may carry the same force, and
    /// it must not go to and fro between them.
    pub fn of_pass(
        pairs: Vec<Pair>,
        (warm, settled): (&ClosedPairs, bool),
        y: &[f64],
        unknowns: &Unknowns,
        mut system: System,
        method: LcpMethod,
    ) -> Result<(Self, Vec<f64>), Cause> {
        let mut forces = ContactForces::open(pairs);
        let gap_after = |pair: &Pair, du: &[f64]| pair.gap + pair.normal_of(du);
        let closed_before = |pair: &Pair| warm.closes(&pair.target);
        let overlap = |pair: &Pair| {
            if settled {
                SETTLED_OVERLAP * pair.length
            } else {
                0.0
            }
        };
        let mut inside: Vec<bool> = forces.pairs.iter().map(closed_before).collect();
        let mut du = y.to_vec();
        let mut entered = inside.contains(&true);
        let mut may_enter = !entered;
        loop {
            for (pair, inside) in forces.pairs.iter().zip(&mut inside) {
                if may_enter && !*inside && gap_after(pair, &du) < -overlap(pair) {
                    (*inside, entered) = (true, true);
                }
            }
            may_enter = true;
            if !entered {
                return Ok((forces, du));
            }
            entered = false;
            let chosen: Vec<usize> = (0..inside.len()).filter(|&k| inside[k]).collect();
            let at = |k: &usize| &forces.pairs[*k];
            // g + Bn y and Dt + Bt y, eq. (5.2)
            let constants = (
                chosen.iter().map(|k| gap_after(at(k), y)).collect(),
                chosen
                    .iter()
                    .map(|k| at(k).slip + at(k).tangent_of(y))
                    .collect(),
            );
            let states = chosen.iter().map(|k| warm.state(&at(k).target)).collect();
            let last = || chosen.iter().map(|k| warm.force(&at(k).target)).collect();
            let warm = (states, settled.then(last));
            forces.solve(&chosen, constants, warm, &mut system, method)?;
            let load = unknowns.restrict(&forces.resultant(y.len()));
            let correction = system.solve(&load)?;
            du.copy_from_slice(y);
            unknowns.add(&correction, &mut du);
        }
    }

    /// Impact impulses Phi, Psi of pairs at the start of an increment and the velocity after them,
    /// V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1) (paper eq. 30), posed as eq. (6.2):
    ///
    /// ```text
    /// 0 <= Phi  complementary to  Bn V0+ + (2/dt) max(g0, 0) >= 0
    /// |Psi| <= mu Phi, Psi opposes Bt V0+
    /// ```
    ///
    /// so that kinetic energy never grows. Gives the velocity and the impulses.
    pub fn impulses(
        pairs: Vec<Pair>,
        v0: &[f64],
        dt: f64,
        unknowns: &Unknowns,
        mut mass: System,
        method: LcpMethod,
    ) -> Result<(Vec<f64>, Self), Cause> {
        let approach = |p: &Pair| p.normal_of(v0) + 2.0 / dt * p.start_gap.max(0.0);
        let mut v0p = v0.to_vec();
        if pairs.iter().all(|pair| approach(pair) >= 0.0) {
            return Ok((v0p, ContactForces::default()));
        }
        if !mass.is_factorized() {
            mass.factorize()?;
        }
        // Bn V0 + (2/dt) max(g0, 0) and Bt V0, eq. (6.2)
        let constants = (
            pairs.iter().map(approach).collect(),
            pairs.iter().map(|pair| pair.tangent_of(v0)).collect(),
        );
        let chosen: Vec<usize> = (0..pairs.len()).collect();
        let states = vec![ContactState::Stick; pairs.len()];
        let mut impulses = ContactForces::open(pairs);
        impulses.solve(&chosen, constants, (states, None), &mut mass, method)?;
        let load = unknowns.restrict(&impulses.resultant(v0.len()));
        let jump = mass.solve(&load)?;
        unknowns.add(&jump, &mut v0p);
        Ok((v0p, impulses))
    }
}

/// Equal-force rule, eq. (5.3): adds eps Q_kk (P_k - P_k^0) to gaps and slips, P^0 being the forces of
/// the pass before. Where several pairs can carry the same force, the solution near that of the pass
/// before is taken; the term vanishes as the passes converge.
fn add_proximal_term(problem: &mut FrictionalLcp, forces: &[[f64; 2]]) {
    let n = forces.len();
    for (k, [pn, pt]) in forces.iter().enumerate() {
        let [normal, tangential] = [k, k + n].map(|i| PROXIMAL_WEIGHT * problem.q[(i, i)]);
        problem.q[(k, k)] += normal;
        problem.q[(k + n, k + n)] += tangential;
        problem.gap[k] -= normal * pn;
        problem.slip[k] -= tangential * pt;
    }
}
