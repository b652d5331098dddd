//! Solution of one increment: predictor and corrector passes with contact forces, impulses and the
//! checks after convergence. Sections 4 to 6 of docs/theory.md (paper eqs 27, 29 and 36 to 49).

use super::active_constraints::ActiveConstraints;
use super::closed_pairs::ClosedPairs;
use super::contact_forces::ContactForces;
use super::convergence::{Errors, Lengths, Scales, largest_forces};
use super::impulses::Impulses;
use crate::contact::{NodeContact, Pair, Pairing, Penetration};
use crate::dynamics::results::{Cause, PassReport, State, Worst};
use crate::dynamics::step::{
    Equilibrium, Interval, StepProblem, Workspace, check_finite, difference, sum,
};
use crate::elements::Updated;
use crate::linear::{LinearError, larger, largest};
use crate::model::Factorization;

/// Passes that one factorisation serves within an increment.
const KEPT_PASSES: usize = 8;
/// Relative difference of lengths between which pieces of an increment share the factors of K*.
const SAME_LENGTH: f64 = 1e-3;
/// Passes after which the pairs keep their segments.
const SEARCHING_PASSES: usize = 4;

/// A converged increment.
#[derive(Default)]
pub(crate) struct Solved {
    /// Displacement increment d = U1 - U0.
    pub d: Vec<f64>,
    /// Velocity V0+ after the impulses.
    pub v0p: Vec<f64>,
    /// Forces in equilibrium.
    pub equilibrium: Equilibrium,
    /// Contact forces.
    pub forces: ContactForces,
    /// Slots and segments that touched at the start, where impacts end the pieces of an increment.
    pub touching: Vec<[usize; 2]>,
    /// Impact impulses at the start.
    pub impulses: ContactForces,
    /// Motion at the end.
    pub end: State,
    /// Energy that the materials have dissipated.
    pub material_dissipation: f64,
    /// Its passes.
    pub passes: Vec<PassReport>,
}

impl Solved {
    /// A = (2/dt²) (d - dt V0+), eq. (4.1), of an increment of length `dt`, at the supports too.
    pub fn mean_acceleration(&self, dt: f64) -> Vec<f64> {
        let both = self.d.iter().zip(&self.v0p);
        both.map(|(d, v0p)| 2.0 / (dt * dt) * (d - dt * v0p))
            .collect()
    }
}

/// Why an attempt failed, and how far it came.
pub(crate) struct Failed {
    pub cause: Cause,
    pub worst: Option<Worst>,
    pub passes: Vec<PassReport>,
}

/// An attempt at one increment.
pub(crate) struct Attempt<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
    pub start: &'a State,
    pub interval: Interval,
    /// The pairs that are constraints; without it all, and nodes land within the increment.
    pub active: Option<&'a ActiveConstraints>,
}

/// What an attempt leaves behind even when it fails.
#[derive(Default)]
struct Trace {
    passes: Vec<PassReport>,
    worst: Option<Worst>,
    /// Largest force that the passes were to balance, of the first pass and of the last.
    unbalanced: Option<[f64; 2]>,
}

impl Trace {
    fn balance(&mut self, force: f64) {
        let [first, _] = self.unbalanced.unwrap_or([force; 2]);
        self.unbalanced = Some([first, force]);
    }

    /// The cause as it is, or that passes with ever larger forces have made numbers overflow.
    fn explain(&self, cause: Cause) -> Cause {
        let has_grown = |[first, last]: [f64; 2]| last > first || last.is_nan();
        // where an element is wrecked, there are no forces to compare
        let is_wrecked = matches!(cause, Cause::Inverted { .. }) && !self.passes.is_empty();
        let diverged = is_wrecked || self.unbalanced.is_some_and(has_grown);
        match cause.is_overflow() && diverged {
            true => Cause::Diverged,
            false => cause,
        }
    }
}

impl<'m> Attempt<'_, 'm> {
    /// Solves the increment; `contact` holds the states of the last one, per slave_index.
    pub fn solve(mut self, contact: &ClosedPairs) -> Result<Solved, Failed> {
        let mut trace = Trace::default();
        let solved = self.passes(contact, &mut trace);
        match solved {
            Ok(solved) => Ok(Solved {
                passes: trace.passes,
                ..solved
            }),
            Err(cause) => Err(Failed {
                cause: trace.explain(cause),
                worst: trace.worst,
                passes: trace.passes,
            }),
        }
    }

    /// Predictor and correctors, which share one form (paper eqs 27, 29 and 36 to 49).
    fn passes(&mut self, contact: &ClosedPairs, trace: &mut Trace) -> Result<Solved, Cause> {
        let problem = self.problem;
        let (u0, dt) = (&self.start.u, self.interval.dt);

        // k = 0: from U0; the supports move by their prescribed increment in the predictor
        let mut d = vec![0.0; u0.len()];
        let mut prescribed = problem.unknowns.prescribed_increment(u0, self.interval.end);
        let mut state = contact.clone();
        let touching = self.active.map_or(Vec::new(), ActiveConstraints::keys);
        let mut impulses = Impulses::new(contact, touching);
        let mut pairing = Pairing::default();
        self.workspace.search.start(&self.start.v, dt);

        for pass in 0..problem.settings.max_passes {
            // contact geometry of the iterate U^k
            let u = sum(u0, &d);
            problem.check_segments(&u)?;
            let pairs = self.workspace.pairs(problem, u0, &u, &pairing);
            let [pairs, left_out] = match self.active {
                Some(active) => active.split(problem, u0, pairs),
                None => [pairs, Vec::new()],
            };

            // V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi) for the pairs in contact, eq. (6.1)
            let v0p = impulses.velocity(problem, self.workspace, &pairs, self.start, dt)?;

            // r = R_theta - F(U_theta) - M A, eq. (4.5)
            let iterate =
                (self.workspace).equilibrium(problem, self.start, [&v0p, &d], self.interval)?;
            let mut r = iterate.out_of_balance();
            trace.balance(largest(&problem.unknowns.restrict(&r)));

            // y = K*^-1 r; in the predictor the supports move by d_p, with the force -theta2 K d_p
            self.refresh(pass, &u, &iterate.u_theta)?;
            let mut y = std::mem::replace(&mut prescribed, vec![0.0; d.len()]);
            let support_force = self.support_force(&y, &u, &iterate.u_theta);
            r = difference(&r, &support_force);
            let free = problem.unknowns.restrict(&r);
            problem
                .unknowns
                .add(&self.workspace.k().solve(&free)?, &mut y);

            // Pn, Pt of the complementarity problem, eq. (5.2);
            // dU = y + K*^-1 (Bn^T Pn + Bt^T Pt), eq. (4.7)
            let pivots = self.workspace.meter.counts.pivots;
            let method = problem.method();
            let (forces, du) = ContactForces::of_pass(
                pairs,
                (&state, pairing.settled),
                &y,
                &problem.unknowns,
                self.workspace.k(),
                method,
            )?;
            let pivots = self.workspace.meter.counts.pivots - pivots;

            // residual r + Bn^T Pn + Bt^T Pt with the contact forces of this pass, eq. (4.7)
            let contact_force = forces.resultant(d.len());
            r = problem.unknowns.restrict(&sum(&r, &contact_force));
            let forces_of = [
                ("the load", &iterate.load),
                ("the internal force", &iterate.internal),
                ("the inertia force", &iterate.inertia),
                ("the contact force", &contact_force),
                ("the force of the supports", &support_force),
                ("the displacement correction", &du),
            ];
            check_finite(&forces_of)?;
            let force = forces_of[..5].iter();
            let force: Vec<_> = force
                .map(|(_, force)| problem.unknowns.magnitudes(force))
                .collect();
            let force = largest_forces(problem.parts, force.iter().map(|force| force.as_ref()));
            let scales = self.scales(force, &u, [&d, &du], &forces);
            let errors = Errors::new(problem.parts, &r, &problem.unknowns.dof, &du);
            let report = scales.report(&errors, &forces, pivots);
            let position = |node| problem.position(&u, node);
            trace.worst = scales.worst(&r, &problem.unknowns.dof, position);
            trace.passes.push(report);
            self.workspace.meter.count_pass(report.residual);

            // U^{k+1} = U^k + dU
            d = sum(&d, &du);
            state = ClosedPairs::new(&forces);
            let rest = impulses.rest(problem, &state);
            if rest && scales.converged(&errors) {
                trace.worst = None;
                if self.active.is_none() {
                    self.check_ways(&d, contact, &forces)?;
                }
                // a free node past a corner may be behind the line of the segment it came from
                let is_over = |pair: &Pair| {
                    let [s, a, b, _] = pair.target.nodes;
                    (0.0..=1.0).contains(&problem.place(&u, [s, a, b]).xi)
                };
                let open = left_out.into_iter();
                let open = open.filter(|pair| pair.gap >= 0.0 || is_over(pair));
                return self.finish(v0p, d, forces.with_open(open.collect()), impulses);
            }
            pairing = Pairing {
                targets: forces.pairs.iter().map(|pair| pair.target).collect(),
                settled: pass + 1 >= SEARCHING_PASSES,
            };
        }
        Err(Cause::NotConverged)
    }

    /// No node may have gone into a body on its way from U0 to U0 + d.
    pub fn check_ways(
        &mut self,
        d: &[f64],
        contact: &ClosedPairs,
        forces: &ContactForces,
    ) -> Result<(), Cause> {
        let mut touch = vec![NodeContact::default(); self.workspace.search.slave_count()];
        for (slave_index, touch) in touch.iter_mut().enumerate() {
            touch.before = contact.holds(slave_index);
        }
        for (k, pair) in forces.pairs.iter().enumerate() {
            if forces.is_closed(k) {
                touch[pair.target.slave_index]
                    .now
                    .extend(pair.target.target.segments());
            }
        }
        let (u0, u1) = (&self.start.u, sum(&self.start.u, d));
        let StepProblem {
            parts, settings, ..
        } = self.problem;
        let ways = parts.largest_of_bodies(d);
        let unsolved = |&body: &usize| settings.tolerance * ways[body];
        let unsolved: Vec<f64> = parts.of_nodes().iter().map(unsolved).collect();
        let passage = (self.workspace).find_penetration([u0, &u1], &touch, &unsolved);
        passage.map_or(Ok(()), |Penetration { slave, segment }| {
            let [a, b] = segment;
            Err(Cause::Crossed {
                slave,
                segment,
                prescribed: !self.problem.unknowns.moves(&[slave, a, b]),
            })
        })
    }

    /// theta2 K d_p, the force of the supports' motion in the predictor.
    fn support_force(&mut self, prescribed: &[f64], u: &[f64], u_theta: &[f64]) -> Vec<f64> {
        let weights = &self.problem.weights;
        let motion = weights.motion(self.start, u, u_theta);
        let mut force = (self.workspace).tangent_product(self.problem, motion, prescribed);
        force.iter_mut().for_each(|f| *f *= weights.theta2);
        force
    }

    /// Factorises K* anew when the rules say so.
    fn refresh(&mut self, pass: usize, u: &[f64], u_theta: &[f64]) -> Result<(), Cause> {
        let StepProblem {
            settings,
            weights,
            unknowns,
            ..
        } = self.problem;
        let (workspace, dt) = (&mut *self.workspace, self.interval.dt);
        let every = settings.factorization == Factorization::EveryPass;
        let worn = pass > 0 && pass.is_multiple_of(KEPT_PASSES);
        let near = self.active.map_or(0.0, |_| SAME_LENGTH);
        if workspace.stiffness.fits(dt, near) && !every && !worn {
            return Ok(());
        }
        let motion = weights.motion(self.start, u, u_theta);
        let factorized = workspace.factorize(self.problem, dt, motion);
        factorized.map_err(|error| match error {
            LinearError::NotPositiveDefinite { unknown, .. } => Cause::Indefinite {
                node: unknowns.dof[unknown] / 2,
            },
            other => other.into(),
        })
    }

    /// What a pass with the given forces of all parts and the increments `d` and `du` is measured
    /// against.
    fn scales(
        &self,
        force: Vec<f64>,
        u: &[f64],
        [d, du]: [&[f64]; 2],
        contact: &ContactForces,
    ) -> Scales<'m> {
        let StepProblem {
            parts, settings, ..
        } = self.problem;
        let closed = (0..contact.pairs.len()).filter(|&k| contact.is_closed(k));
        let mut positions = vec![0.0; u.len()];
        for k in closed {
            let nodes = contact.pairs[k].target.nodes;
            let of_nodes = nodes.map(|node| largest(&self.problem.position(u, node)));
            for node in nodes {
                positions[2 * node] = larger(positions[2 * node], largest(&of_nodes));
            }
        }
        let [d, du] = [d, du].map(|d| parts.largest_of_bodies(d));
        let lengths = Lengths {
            displacement: parts.largest_of_bodies(u),
            increment: d.into_iter().zip(du).map(|(d, du)| larger(d, du)).collect(),
            position: parts.largest_of_bodies(&positions),
        };
        let diagonals = (
            self.workspace.stiffness.stiffness.as_slice(),
            self.workspace.stiffness.inertia.as_slice(),
        );
        Scales::new(parts, force, diagonals, lengths, settings.tolerance)
    }

    /// Motion and forces at the end of a converged increment.
    fn finish(
        &mut self,
        v0p: Vec<f64>,
        d: Vec<f64>,
        forces: ContactForces,
        impulses: Impulses,
    ) -> Result<Solved, Cause> {
        let (problem, start, interval) = (self.problem, self.start, self.interval);
        let equilibrium = (self.workspace).equilibrium(problem, start, [&v0p, &d], interval)?;
        // V1 = (2/dt) d - V0+, eq. (4.2); of what is prescribed from the amplitude
        let rate = 2.0 / interval.dt;
        let mut v: Vec<f64> = d.iter().zip(&v0p).map(|(d, v0p)| rate * d - v0p).collect();
        let mut u = sum(&start.u, &d);
        problem.unknowns.prescribe(interval.end, &mut u, &mut v);
        let Updated {
            variables: internal,
            dissipated,
        } = problem.elements.update(&u, &start.internal);
        let end = State {
            u,
            v,
            a: equilibrium.acceleration.clone(),
            internal,
        };
        end.check_finite()?;
        Ok(Solved {
            d,
            v0p,
            equilibrium,
            forces,
            touching: impulses.touching,
            impulses: impulses.acting,
            end,
            material_dissipation: dissipated,
            passes: Vec::new(),
        })
    }
}
