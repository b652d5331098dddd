//! Work of the contact forces of an increment for each pair. See docs/theory/impacts.md, Ledger.

use std::collections::BTreeMap;

use crate::contact::{Constraint, ConstraintKey, SlaveKey, SurfaceParts};
use crate::dynamics::increment::{ContactForces, PairReturn, Solved};
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{StepProblem, difference, dot};

/// Work of the contact forces of a pair in an increment.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PairWork {
    /// The pair.
    pub key: ConstraintKey,
    /// Work of the normal force, without the work at fits.
    pub normal: f64,
    /// Work of the normal force that separates the surfaces of a fit.
    pub fit: f64,
    /// Energy that friction dissipates.
    pub friction: f64,
    /// Normal force times the sliding path of the pair (energy).
    pub sliding: f64,
    /// Nodes on the slave surface and on the master at which the pair acts. The nodes are stored because a pair that
    /// has opened is no longer a pair at the end.
    pub surfaces: [SurfaceParts; 2],
}

/// Work of the pairs in an increment over which their forces are constant:
///
/// ```text
/// Pn.(Bn d) - Pn (a0 - a1), eq. (9.2), Pn (a0 - a1), eq. (9.14), and -Pt.(Bt d), eq. (9.3)
/// ```
pub(super) fn steady_works(solved: &Solved) -> Vec<PairWork> {
    let work = |(constraint, [pn, pt]): (&Constraint, [f64; 2])| {
        let slip = constraint.tangential_motion(&solved.d);
        PairWork {
            key: constraint.key,
            normal: pn * (constraint.normal_motion(&solved.d) - constraint.shrinkage),
            fit: pn * constraint.shrinkage,
            friction: -(pt * slip),
            sliding: constraint.stretch * pn * slip.abs(),
            surfaces: constraint.surface_parts(),
        }
    };
    let acting = solved
        .contact
        .forces
        .acting()
        .map(|(c, pair)| (c, pair.force));
    acting.map(work).collect()
}

/// Work of friction that landing returns take back, for pairs in contact and for pairs that have opened.
pub(super) fn given_back(solved: &Solved) -> Vec<PairWork> {
    if solved.returned.pairs.is_empty() {
        return Vec::new();
    }
    let acting = solved.contact.forces.acting().map(|(c, _)| c);
    let opened = solved.returned.release.opened.iter().map(|(c, _)| c);
    let constraints: BTreeMap<ConstraintKey, &Constraint> =
        acting.chain(opened).map(|c| (c.key, c)).collect();
    let work = |pair: &PairReturn| {
        let constraint = constraints.get(&pair.key)?;
        let sliding = match constraint.mu > 0.0 {
            true => pair.friction / constraint.mu,
            false => 0.0,
        };
        Some(PairWork {
            key: pair.key,
            normal: 0.0,
            fit: 0.0,
            friction: -pair.friction,
            sliding: -sliding,
            surfaces: constraint.surface_parts(),
        })
    };
    solved.returned.pairs.iter().filter_map(work).collect()
}

/// Work of impulses that separates the surfaces of fits in an increment of length `dt`: the surfaces move with the rate
/// of the allowed overlap.
///
/// ```text
/// Phi (a0 - a1)/dt, eq. (9.14)
/// ```
pub(super) fn fit_impulse_work(solved: &Solved, dt: f64) -> f64 {
    let fitted = solved.contact.impulses.acting();
    let fitted = fitted.filter(|(constraint, _)| constraint.shrinkage != 0.0);
    fitted
        .map(|(constraint, pair)| pair.force[0] * constraint.shrinkage / dt)
        .sum()
}

/// Forces in an equilibrium from which the work of the next static increment is computed.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct EndForces {
    /// Load and internal force over all dofs (force).
    pub load: Vec<f64>,
    pub internal: Vec<f64>,
    /// The pairs in contact with their forces.
    pairs: Vec<(Constraint, [f64; 2])>,
    /// Forces of the supports (dof, force), see [`Self::of_supports`].
    pub reactions: Vec<(usize, f64)>,
}

impl EndForces {
    /// Forces in an equilibrium with the given contact forces.
    pub fn new(load: Vec<f64>, internal: Vec<f64>, forces: &ContactForces) -> Self {
        let acting = forces.acting().map(|(c, pair)| (c.clone(), pair.force));
        EndForces {
            load,
            internal,
            pairs: acting.collect(),
            reactions: Vec::new(),
        }
    }

    /// Forces at a state that does not come from a static increment: the forces that balance the internal force count
    /// as load.
    pub fn at(problem: &StepProblem, state: &State) -> Result<Self, Cause> {
        let motion = state.motion();
        let internal = problem.elements.internal_force(motion)?;
        Ok(EndForces {
            load: internal.clone(),
            internal,
            pairs: Vec::new(),
            reactions: Vec::new(),
        })
    }

    /// Force F - R - B^T P of supports and equations, over all dofs (force).
    pub fn missing(&self, dofs: usize) -> Vec<f64> {
        let mut missing = difference(&self.internal, &self.load);
        let contact = self.contact(dofs);
        missing.iter_mut().zip(&contact).for_each(|(f, p)| *f -= p);
        missing
    }

    /// Forces of supports (dof, force), including forces that equations and turning bodies hand on to supports. The
    /// forces belong to the displacements `u`, at the end of an increment `d` or at its start.
    pub fn of_supports(&self, problem: &StepProblem, [u, d]: [&[f64]; 2]) -> Vec<(usize, f64)> {
        let unknowns = &problem.unknowns;
        let mut missing = unknowns.passed_on(&self.missing(d.len())).into_owned();
        unknowns.turning.hand_over([u, d], false, &mut missing);
        unknowns.prescribed().map(|p| (p, missing[p])).collect()
    }

    /// Contact force over all dofs (force).
    pub fn contact(&self, dofs: usize) -> Vec<f64> {
        let mut force = vec![0.0; dofs];
        for (constraint, pair) in &self.pairs {
            constraint.add_force(*pair, &mut force);
        }
        force
    }

    /// Turns the forces of removed contacts, and of supports that the next step does not have, into loads; returns
    /// these loads (dof, force), eq. (12.9).
    pub fn release(
        &mut self,
        removed: &[usize],
        is_gone: impl Fn(usize) -> bool,
    ) -> Vec<(usize, f64)> {
        let mut force = vec![0.0; self.load.len()];
        self.pairs.retain(|(constraint, pair)| {
            let is_out = removed.contains(&constraint.key.contact());
            if is_out {
                constraint.add_force(*pair, &mut force);
            }
            !is_out
        });
        let gone = self.reactions.iter().filter(|(dof, _)| is_gone(*dof));
        gone.for_each(|&(dof, reaction)| force[dof] += reaction);
        let acts = |(_, force): &(usize, f64)| *force != 0.0;
        let released: Vec<_> = force.into_iter().enumerate().filter(acts).collect();
        (released.iter()).for_each(|&(dof, force)| self.load[dof] += force);
        released
    }

    /// Sums of the normal and of the tangential forces of every slave node.
    fn of_slaves(&self) -> BTreeMap<SlaveKey, [f64; 2]> {
        let mut sums: BTreeMap<SlaveKey, [f64; 2]> = BTreeMap::new();
        for (constraint, force) in &self.pairs {
            let [pn, pt] = constraint.normal_and_tangential(*force);
            let sum = sums.entry(constraint.key.slave()).or_default();
            *sum = [sum[0] + pn, sum[1] + pt];
        }
        sums
    }

    /// Work of the pairs in a static increment that starts from the equilibrium `self`, and the part of the trapezoidal
    /// work of tangential forces that friction does not dissipate:
    ///
    /// ```text
    /// (Pn0.(Bn0 d) + Pn1.(Bn1 d))/2
    /// -(1 + Pn*/Pn1)/2 Pt1.(Bt1 d),   max(0, -Pt0.(Bt0 d)/2) where Pn1 = 0              eq. (12.8)
    /// ```
    ///
    /// Here Pn* = Pn0 + tau (Pn1 - Pn0) is the normal force at which the pair begins to slide, with tau = (1 -+ Pt0/(mu
    /// Pn0))/2. While the pair slides, |Pt| = mu Pn changes linearly, so the pair slides with the mean of its forces. A
    /// pair that opens has a force only at the start.
    pub fn works(&self, solved: &Solved, end: &EndForces) -> (Vec<PairWork>, f64) {
        let d = &solved.d;
        let (before, after) = (self.of_slaves(), end.of_slaves());
        // the mean of Pn while the node slides, as a part of the force at the start or at the end
        let mean = |slave: SlaveKey, mu: f64, is_end: bool| {
            let of =
                |sums: &BTreeMap<SlaveKey, [f64; 2]>| sums.get(&slave).copied().unwrap_or_default();
            match (of(&before), of(&after)) {
                ([p0, t0], [p1, t1]) if p1 > 0.0 && is_end => {
                    let tau = match mu * p0 {
                        0.0 => 0.0,
                        limit => (1.0 - (t0 * t1.signum() / limit).clamp(-1.0, 1.0)) / 2.0,
                    };
                    (1.0 + (p0 + (p1 - p0) * tau) / p1) / 2.0
                }
                (_, [p1, _]) if p1 > 0.0 || is_end => 0.0,
                _ => 0.5,
            }
        };
        let all = solved.contact.forces.iter();
        let fitted = all.filter(|(constraint, _)| constraint.shrinkage != 0.0);
        let shrinkage: BTreeMap<SlaveKey, f64> = fitted
            .map(|(constraint, _)| (constraint.key.slave(), constraint.shrinkage))
            .collect();
        let mut tangential = 0.0;
        let mut works = Vec::new();
        for (forces, is_end) in [(self, false), (end, true)] {
            for (constraint, [pn, pt]) in &forces.pairs {
                let slave = constraint.key.slave();
                let (slip, mean) = (
                    constraint.tangential_motion(d),
                    mean(slave, constraint.mu, is_end),
                );
                let work = pt * slip;
                let parts = shrinkage.get(&slave).unwrap_or(&0.0);
                tangential += work / 2.0;
                let friction = match is_end {
                    true => -mean * work,
                    false => (-mean * work).max(0.0),
                };
                // a pair that opens slides as far as corresponds to its work of friction
                let sliding = match is_end || constraint.mu == 0.0 {
                    true => mean * constraint.stretch * pn * slip.abs(),
                    false => friction / constraint.mu,
                };
                works.push(PairWork {
                    key: constraint.key,
                    normal: pn * (constraint.normal_motion(d) - parts) / 2.0,
                    fit: pn * parts / 2.0,
                    friction,
                    sliding,
                    surfaces: constraint.surface_parts(),
                });
            }
        }
        let friction: f64 = works.iter().map(|work| work.friction).sum();
        (works, tangential + friction)
    }

    /// Work, along the path d, of a force that changes linearly from its value at the start to its value at the end.
    pub fn trapezoid(d: &[f64], [from, to]: [&[f64]; 2]) -> f64 {
        (dot(d, from) + dot(d, to)) / 2.0
    }
}
