use super::contact_forces::ContactForces;
use super::convergence::{Scales, worst};
use super::effective::Effective;
use super::hold::Hold;
use super::impact::Impulses;
use super::mass::largest;
use super::meter::Meter;
use super::step_problem::{Equilibrium, Interval, StepProblem, difference, sum};
use super::touching::Touching;
use super::{Cause, PassReport, State, Worst};
use crate::contact::{Pair, Pairing, Search, Touch, find_passage};
use crate::linear::LinearError;
use crate::model::Factorization;

/// Passes that one factorisation serves within an increment.
const KEPT_PASSES: usize = 8;
/// Relative difference of lengths between which pieces of an increment share the factors of K*.
const NEAR: f64 = 1e-3;
/// Passes after which the pairs keep their segments.
const SEARCHING_PASSES: usize = 4;

/// A converged increment.
#[derive(Default)]
pub(super) struct Solved {
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
    /// Its passes.
    pub passes: Vec<PassReport>,
}

impl Solved {
    /// A = (2/dt²)(d - dt V0+) of an increment of length `dt`, at the supports too.
    pub fn mean_acceleration(&self, dt: f64) -> Vec<f64> {
        let both = self.d.iter().zip(&self.v0p);
        both.map(|(d, v0p)| 2.0 / (dt * dt) * (d - dt * v0p))
            .collect()
    }
}

/// Why an attempt failed, and how far it came.
pub(super) struct Failed {
    pub cause: Cause,
    pub worst: Option<Worst>,
    pub passes: Vec<PassReport>,
}

/// An attempt at one increment.
pub(super) struct Attempt<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub effective: &'a mut Effective,
    pub search: &'a mut Search<'m>,
    pub start: &'a State,
    pub interval: Interval,
    pub meter: &'a mut Meter,
    /// The pairs that are constraints; without it all, and nodes land within the increment.
    pub hold: Option<&'a Hold>,
}

/// What an attempt leaves behind even when it fails.
#[derive(Default)]
struct Trace {
    passes: Vec<PassReport>,
    worst: Option<Worst>,
}

impl Attempt<'_, '_> {
    /// Solves the increment; `contact` holds the states of the last one, per slot.
    pub fn solve(mut self, contact: &Touching) -> Result<Solved, Failed> {
        let mut trace = Trace::default();
        let solved = self.passes(contact, &mut trace);
        let Trace { passes, worst } = trace;
        match solved {
            Ok(solved) => Ok(Solved { passes, ..solved }),
            Err(cause) => Err(Failed {
                cause,
                worst,
                passes,
            }),
        }
    }

    /// Predictor and correctors, which share one form (paper eqs 27, 29 and 36 to 49).
    fn passes(&mut self, contact: &Touching, trace: &mut Trace) -> Result<Solved, Cause> {
        let problem = self.problem;
        let (u0, dt) = (&self.start.u, self.interval.dt);

        // k = 0: from U0; the supports move by their prescribed increment in the predictor
        let mut d = vec![0.0; u0.len()];
        let mut prescribed = problem.support_increment(u0, self.interval);
        let mut state = contact.clone();
        let touching = self.hold.map_or(Vec::new(), Hold::keys);
        let mut impulses = Impulses::new(contact, touching);
        let mut pairing = Pairing::default();
        self.search.start(&self.start.v, dt);

        for pass in 0..problem.settings.max_passes {
            // contact geometry of the iterate U^k
            let u = sum(u0, &d);
            problem.check_segments(&u)?;
            let search = &mut *self.search;
            self.meter.time(|t| &mut t.search, || search.cover(&u));
            let pairs = self.meter.time(
                |t| &mut t.contact,
                || problem.pairs(search, u0, &u, &pairing),
            );
            let [pairs, left_out] = match self.hold {
                Some(hold) => hold.split(problem, u0, pairs),
                None => [pairs, Vec::new()],
            };

            // V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi) for the pairs in contact
            let (effective, meter) = (&mut *self.effective, &mut *self.meter);
            let v0p = impulses.velocity(problem, effective, &pairs, self.start, dt, meter)?;

            // r = R_theta - F(U_theta) - M A,  A = (2/dt²)(d - dt V0+)
            let iterate = self.meter.time(
                |t| &mut t.assembly,
                || problem.equilibrium(self.start, &v0p, &d, self.interval),
            )?;
            let mut r = iterate.out_of_balance();

            // y = K*^-1 r; in the predictor the supports move by d_p, with the force -theta2 K d_p
            self.refresh(pass, &u, &iterate.u_theta)?;
            let mut y = std::mem::replace(&mut prescribed, vec![0.0; d.len()]);
            let support_force = self.support_force(&y, &u, &iterate.u_theta);
            r = difference(&r, &support_force);
            let free = problem.dofs.restrict(&r);
            let k = &mut self.effective.k;
            let solution = self
                .meter
                .time(|t| &mut t.solve, || k.solver.solve(&free))?;
            problem.dofs.add(&solution, &mut y);

            // Pn, Pt of the complementarity problem; dU = y + K*^-1 (Bn^T Pn + Bt^T Pt)
            let pivots = self.meter.counts.pivots;
            let method = problem.method();
            let (forces, du) = ContactForces::of_pass(
                pairs,
                (&state, pairing.settled),
                &y,
                &problem.dofs,
                k,
                method,
                self.meter,
            )?;
            let pivots = self.meter.counts.pivots - pivots;

            // residual with the contact forces of this pass
            let contact_force = forces.resultant(d.len());
            r = problem.dofs.restrict(&sum(&r, &contact_force));
            let force = iterate
                .largest()
                .max(largest(&contact_force))
                .max(largest(&support_force));
            let scales = self.scales(force, &u, largest(&d).max(largest(&du)), &forces);
            let report = scales.report(&r, &du, &forces, pivots);
            let position = |node| problem.position(&u, node);
            trace.worst = worst(&r, &problem.dofs.dof, position, report.residual);
            trace.passes.push(report);
            self.meter.counts.passes += 1;
            self.meter.counts.residual = report.residual;
            if !(report.residual.is_finite() && report.correction.is_finite()) {
                return Err(Cause::NotFinite("the residual of a pass"));
            }

            // U^{k+1} = U^k + dU
            d = sum(&d, &du);
            state = Touching::new(&forces);
            let rest = impulses.rest(problem, &state);
            if rest && scales.converged(&report) {
                trace.worst = None;
                if self.hold.is_none() {
                    self.check_ways(&d, contact, &forces)?;
                }
                // a free node past a vertex may be behind the line of the segment it came from
                let is_over = |pair: &Pair| {
                    let [s, a, b, _] = pair.at.nodes;
                    (0.0..=1.0).contains(&problem.place(&u, [s, a, b]).xi)
                };
                let open = left_out.into_iter();
                let open = open.filter(|pair| pair.gap >= 0.0 || is_over(pair));
                return self.finish(v0p, d, forces.with_open(open.collect()), impulses);
            }
            pairing = Pairing {
                sites: forces.pairs.iter().map(|pair| pair.at).collect(),
                settled: pass + 1 >= SEARCHING_PASSES,
            };
        }
        Err(Cause::NotConverged)
    }

    /// No node may have gone into a body on its way from U0 to U0 + d.
    pub fn check_ways(
        &mut self,
        d: &[f64],
        contact: &Touching,
        forces: &ContactForces,
    ) -> Result<(), Cause> {
        let mut touch = vec![Touch::default(); self.search.slots()];
        for (slot, touch) in touch.iter_mut().enumerate() {
            touch.before = contact.holds(slot);
        }
        for (k, pair) in forces.pairs.iter().enumerate() {
            if forces.is_closed(k) {
                touch[pair.at.slot].now.extend(pair.at.site.segments());
            }
        }
        let (u0, u1) = (&self.start.u, sum(&self.start.u, d));
        let search = &mut *self.search;
        self.meter
            .time(|t| &mut t.search, || search.cover_way(u0, &u1));
        let tolerance = self.problem.settings.tolerance * largest(d);
        let passage = self.meter.time(
            |t| &mut t.contact,
            || find_passage(search, u0, &u1, &touch, tolerance),
        );
        passage.map_or(Ok(()), |passage| Err(passage.into()))
    }

    /// theta2 K d_p, the force of the supports' motion in the predictor.
    fn support_force(&mut self, prescribed: &[f64], u: &[f64], u_theta: &[f64]) -> Vec<f64> {
        let StepProblem { weights, body, .. } = self.problem;
        let (start, u) = weights.configuration(&self.start.u, u, u_theta);
        let product = || body.tangent_product(start, u, prescribed);
        let mut force = self.meter.time(|t| &mut t.assembly, product);
        force.iter_mut().for_each(|f| *f *= weights.theta2);
        force
    }

    /// Factorises K* anew when the rules say so.
    fn refresh(&mut self, pass: usize, u: &[f64], u_theta: &[f64]) -> Result<(), Cause> {
        let StepProblem {
            settings,
            weights,
            body,
            dofs,
            ..
        } = self.problem;
        let (effective, dt) = (&mut *self.effective, self.interval.dt);
        let every = settings.factorization == Factorization::EveryPass;
        let worn = pass > 0 && pass.is_multiple_of(KEPT_PASSES);
        let near = self.hold.map_or(0.0, |_| NEAR);
        if effective.fits(dt, near) && !every && !worn {
            return Ok(());
        }
        let configuration = weights.configuration(&self.start.u, u, u_theta);
        self.meter.time(
            |t| &mut t.assembly,
            || effective.assemble(body, *weights, dt, configuration),
        );
        self.meter.counts.factorizations += 1;
        let factorized = self
            .meter
            .time(|t| &mut t.factorization, || effective.k.factorize());
        factorized.map_err(|error| match error {
            LinearError::NotPositiveDefinite { unknown, .. } => Cause::Indefinite {
                node: dofs.dof[unknown] / 2,
            },
            other => other.into(),
        })
    }

    fn scales(&self, force: f64, u: &[f64], increment: f64, contact: &ContactForces) -> Scales {
        let closed = (0..contact.pairs.len()).filter(|&k| contact.is_closed(k));
        let position = closed
            .flat_map(|k| contact.pairs[k].at.nodes)
            .map(|node| largest(&self.problem.position(u, node)))
            .fold(0.0, f64::max);
        let diagonals = (self.effective.stiffness, self.effective.inertia);
        let lengths = (largest(u), increment, position);
        Scales::new(force, diagonals, lengths, self.problem.settings.tolerance)
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
        let equilibrium = self.meter.time(
            |t| &mut t.assembly,
            || problem.equilibrium(start, &v0p, &d, interval),
        )?;
        // V1 = (2/dt) d - V0+; at supports from the amplitude
        let rate = 2.0 / interval.dt;
        let mut v: Vec<f64> = d.iter().zip(&v0p).map(|(d, v0p)| rate * d - v0p).collect();
        let mut u = sum(&start.u, &d);
        for (dof, u1, v1) in problem.supports.motion(interval.end) {
            (u[dof], v[dof]) = (u1, v1);
        }
        let end = State {
            u,
            v,
            a: equilibrium.acceleration.clone(),
        };
        Ok(Solved {
            d,
            v0p,
            equilibrium,
            forces,
            touching: impulses.touching,
            impulses: impulses.acting,
            end,
            passes: Vec::new(),
        })
    }
}
