use super::contact_forces::ContactForces;
use super::dofs::DofMap;
use super::effective::Effective;
use super::loads::{Loads, Moment};
use super::mass::{Mass, largest};
use super::meter::Meter;
use super::scheme::Weights;
use super::supports::Supports;
use super::{Cause, PassReport, State, Worst};
use crate::contact::{ContactSurfaces, Pair, find_pairs};
use crate::elements::Body;
use crate::lcp::{ContactState, LcpMethod};
use crate::linear::LinearError;
use crate::model::{Factorization, Impact, Model, Settings};

/// Passes that one factorisation serves within an increment.
const KEPT_PASSES: usize = 8;
/// Passes after which the pairs keep their segments.
const SEARCHING_PASSES: usize = 10;
/// Changes of the set of impulses after which it is kept.
const SET_CHANGES: usize = 5;
/// Round-off of a sum of some terms, in units of its largest term.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// What stays the same over a step.
pub(super) struct StepProblem<'m> {
    pub model: &'m Model,
    pub body: &'m Body,
    pub mass: &'m Mass,
    pub contacts: &'m [ContactSurfaces],
    pub settings: Settings,
    pub weights: Weights,
    pub dofs: DofMap,
    pub loads: Loads<'m>,
    pub supports: Supports<'m>,
}

/// Times of an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub start: Moment,
    pub end: Moment,
    pub dt: f64,
}

/// A converged increment.
pub(super) struct Solved {
    /// Displacement increment d = U1 - U0.
    pub d: Vec<f64>,
    /// Velocity V0+ after the impulses.
    pub v0p: Vec<f64>,
    /// Displacement U_theta of the equilibrium.
    pub u_theta: Vec<f64>,
    /// Load R_theta.
    pub load: Vec<f64>,
    /// Internal force F_theta.
    pub internal: Vec<f64>,
    /// Acceleration A.
    pub acceleration: Vec<f64>,
    /// Inertia force M A.
    pub inertia: Vec<f64>,
    /// End of the increment.
    pub end: State,
    /// Contact forces.
    pub forces: ContactForces,
    /// Its passes.
    pub passes: Vec<PassReport>,
}

/// Why an attempt failed, and how far it came.
pub(super) struct Failed {
    pub cause: Cause,
    pub worst: Option<Worst>,
    pub passes: Vec<PassReport>,
}

/// Forces of an iterate.
struct Equilibrium {
    u_theta: Vec<f64>,
    load: Vec<f64>,
    internal: Vec<f64>,
    acceleration: Vec<f64>,
    inertia: Vec<f64>,
}

impl StepProblem<'_> {
    /// One increment: predictor and correctors (formulas: paper eqs 27, 29 and 36 to 49).
    ///
    /// `contact` holds the states of the last increment, per slot.
    pub fn solve_increment(
        &self,
        effective: &mut Effective,
        start: &State,
        interval: Interval,
        contact: &[ContactState],
        meter: &mut Meter,
    ) -> Result<Solved, Failed> {
        let mut passes = Vec::new();
        let mut worst = None;
        self.passes(
            effective,
            start,
            interval,
            contact,
            meter,
            &mut passes,
            &mut worst,
        )
        .map_err(|cause| Failed {
            cause,
            worst,
            passes: passes.clone(),
        })
        .map(|solved| Solved { passes, ..solved })
    }

    #[allow(clippy::too_many_arguments)] // the two last ones survive a failure
    fn passes(
        &self,
        effective: &mut Effective,
        start: &State,
        interval: Interval,
        contact: &[ContactState],
        meter: &mut Meter,
        passes: &mut Vec<PassReport>,
        worst: &mut Option<Worst>,
    ) -> Result<Solved, Cause> {
        let Interval { dt, .. } = interval;
        let u0 = &start.u;
        let method = LcpMethod::from(self.settings.lcp);

        // k = 0: from U0, the supports at their prescribed displacements
        let mut d = self.support_increment(u0, interval);
        let mut state = contact.to_vec();
        let mut impulse_set: Vec<usize> = closed(contact);
        let mut set_changes = 0;
        let mut kept: Option<Vec<Option<usize>>> = None;

        for pass in 0..self.settings.max_passes {
            // contact geometry of the iterate U^k
            let u = sum(u0, &d);
            let pairs = meter.time(|t| &mut t.contact, || self.pairs(u0, &u, kept.as_deref()));

            // V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi) for the pairs in contact
            let v0p = self.impulses(effective, &pairs, &impulse_set, start, dt, meter)?;

            // r = R_theta - F(U_theta) - M A, A = (2/dt²)(d - dt V0+)
            let iterate = self.equilibrium(start, &v0p, &d, interval, meter)?;
            let r: Vec<f64> = (0..d.len())
                .map(|i| iterate.load[i] - iterate.internal[i] - iterate.inertia[i])
                .collect();

            // y = K*^-1 r
            self.refresh(effective, pass, u0, &u, &iterate.u_theta, dt, meter)?;
            let mut y = vec![0.0; d.len()];
            let free = self.dofs.restrict(&r);
            let k = &mut effective.k;
            let solution = meter.time(|t| &mut t.solve, || k.solver.solve(&free))?;
            self.dofs.add(&solution, &mut y);

            // Pn, Pt from the complementarity problem; dU = y + K*^-1 (Bn^T Pn + Bt^T Pt)
            let pivots = meter.counts.pivots;
            let (forces, du) =
                ContactForces::of_pass(pairs, &state, &y, &self.dofs, k, method, meter)?;

            // convergence, on residual and correction, with a set of impulses that rests
            let contact_force = forces.resultant(d.len());
            let r: Vec<f64> = sum(&r, &contact_force);
            let scale = self.scales(effective, &iterate, &contact_force, &u, &d, &du);
            let residual = self.dofs.restrict(&r);
            let report = scale.report(&residual, &du, &forces, meter.counts.pivots - pivots);
            *worst = Some(self.worst(&residual, &report, &u));
            passes.push(report);
            meter.counts.passes += 1;
            meter.counts.residual = report.residual;
            if !(report.residual.is_finite() && report.correction.is_finite()) {
                return Err(Cause::NotFinite("the residual of a pass"));
            }
            d.iter_mut().zip(&du).for_each(|(d, du)| *d += du);
            remember(&forces, &mut state);
            let set = forces.closed_slots();
            let rests = self.settings.impact == Impact::None
                || set == impulse_set
                || set_changes >= SET_CHANGES;
            if rests && scale.converged(&report) {
                return self.finish(start, v0p, d, interval, forces, meter);
            }
            if !rests {
                impulse_set = set;
                set_changes += 1;
            }
            if pass + 1 >= SEARCHING_PASSES {
                kept = Some(segments(&forces.pairs, contact.len()));
            }
        }
        Err(Cause::NotConverged)
    }

    /// Acceleration at the start of the analysis, M A = R - F (unloaded supports at rest).
    pub fn start_acceleration(
        &self,
        effective: &mut Effective,
        start: &State,
        now: Moment,
    ) -> Vec<f64> {
        let mut a = vec![0.0; start.u.len()];
        let load = self.loads.weighted(self.body, 1.0, now, now, &start.u);
        let Ok(internal) = self.body.internal_force(None, &start.u) else {
            return a;
        };
        let r: Vec<f64> = load.iter().zip(&internal).map(|(r, f)| r - f).collect();
        let m = &mut effective.m;
        let solved = m
            .factorize()
            .and_then(|()| m.solver.solve(&self.dofs.restrict(&r)));
        // Without it only the estimate of the first landings would be less good.
        if let Ok(acceleration) = solved {
            self.dofs.add(&acceleration, &mut a);
        }
        a
    }

    /// Displacement increment of the supports; zero at all other dofs.
    fn support_increment(&self, u0: &[f64], interval: Interval) -> Vec<f64> {
        let mut d = vec![0.0; u0.len()];
        for (dof, u, _) in self.supports.motion(interval.end) {
            d[dof] = u - u0[dof];
        }
        d
    }

    /// Pairs between `u0` and the iterate `u`.
    fn pairs(&self, u0: &[f64], u: &[f64], kept: Option<&[Option<usize>]>) -> Vec<Pair> {
        let x = &self.model.mesh.coordinates;
        let form = self.weights.row_form();
        let sites = find_pairs(self.contacts, x, u, kept);
        sites
            .into_iter()
            .map(|site| Pair::new(site, form, x, u0, u))
            .collect()
    }

    /// Velocity after the impulses of the pairs whose slots are in `set`.
    fn impulses(
        &self,
        effective: &mut Effective,
        pairs: &[Pair],
        set: &[usize],
        start: &State,
        dt: f64,
        meter: &mut Meter,
    ) -> Result<Vec<f64>, Cause> {
        if self.settings.impact == Impact::None {
            return Ok(start.v.clone());
        }
        let (x, u0) = (&self.model.mesh.coordinates, &start.u);
        let form = self.weights.row_form();
        let at_start = |pair: &Pair| match self.weights.impulses_at_start() {
            true => Pair::new(pair.site(), form, x, u0, u0),
            false => *pair,
        };
        let struck = pairs
            .iter()
            .filter(|pair| set.binary_search(&pair.slot).is_ok());
        let struck: Vec<Pair> = struck.map(at_start).collect();
        let method = LcpMethod::from(self.settings.lcp);
        ContactForces::impulses(
            struck,
            &start.v,
            dt,
            &self.dofs,
            &mut effective.m,
            method,
            meter,
        )
    }

    /// Load, internal force and inertia of an iterate.
    fn equilibrium(
        &self,
        start: &State,
        v0p: &[f64],
        d: &[f64],
        interval: Interval,
        meter: &mut Meter,
    ) -> Result<Equilibrium, Cause> {
        let Interval {
            start: t0,
            end: t1,
            dt,
        } = interval;
        let u_theta = self.weights.displacement(&start.u, d, v0p, dt);
        meter.time(
            |t| &mut t.assembly,
            || {
                let u = sum(&start.u, d);
                let internal = self
                    .weights
                    .internal_force(self.body, &start.u, &u, &u_theta)?;
                let load = self
                    .loads
                    .weighted(self.body, self.weights.theta1, t0, t1, &u_theta);
                // A = (2/dt²)(d - dt V0+); at supports (V1 - V0)/dt
                let c = 2.0 / (dt * dt);
                let mut acceleration: Vec<f64> =
                    (0..d.len()).map(|i| c * (d[i] - dt * v0p[i])).collect();
                for (dof, _, v1) in self.supports.motion(t1) {
                    acceleration[dof] = (v1 - start.v[dof]) / dt;
                }
                let inertia = self.mass.times(&acceleration);
                Ok(Equilibrium {
                    u_theta,
                    load,
                    internal,
                    acceleration,
                    inertia,
                })
            },
        )
    }

    /// Factorises K* anew when the rules say so.
    #[allow(clippy::too_many_arguments)] // the configuration is three vectors
    fn refresh(
        &self,
        effective: &mut Effective,
        pass: usize,
        u0: &[f64],
        u: &[f64],
        u_theta: &[f64],
        dt: f64,
        meter: &mut Meter,
    ) -> Result<(), Cause> {
        let every = self.settings.factorization == Factorization::EveryPass;
        let worn = pass > 0 && pass % KEPT_PASSES == 0;
        if effective.fits(dt) && !every && !worn {
            return Ok(());
        }
        let configuration = self.weights.configuration(u0, u, u_theta);
        meter.time(
            |t| &mut t.assembly,
            || effective.assemble(self.body, self.weights, dt, configuration),
        );
        meter.counts.factorizations += 1;
        let factorized = meter.time(|t| &mut t.factorization, || effective.k.factorize());
        factorized.map_err(|error| match error {
            LinearError::NotPositiveDefinite { unknown, .. } => Cause::Indefinite {
                node: self.dofs.dof[unknown] / 2,
            },
            other => other.into(),
        })
    }

    fn scales(
        &self,
        effective: &Effective,
        iterate: &Equilibrium,
        contact_force: &[f64],
        u: &[f64],
        d: &[f64],
        du: &[f64],
    ) -> Scales {
        let forces = [&iterate.load, &iterate.internal, &iterate.inertia];
        let force = forces
            .into_iter()
            .fold(largest(contact_force), |m, f| m.max(largest(f)));
        let increment = largest(d).max(largest(du));
        // A force from displacements of size U carries the round-off of K U; M A that of (2/dt²) M d.
        let noise = ROUND_OFF * (effective.stiffness * largest(u) + effective.inertia * increment);
        let tolerance = self.settings.tolerance;
        Scales {
            force,
            noise,
            increment,
            resolution: ROUND_OFF * largest(u),
            tolerance,
        }
    }

    /// The node with the largest residual.
    fn worst(&self, residual: &[f64], report: &PassReport, u: &[f64]) -> Worst {
        let mut at = 0;
        for i in 0..residual.len() {
            if residual[i].abs() > residual[at].abs() {
                at = i;
            }
        }
        let node = self.dofs.dof.get(at).map_or(0, |dof| dof / 2);
        let x = self.model.mesh.coordinates[node];
        let position = [x[0] + u[2 * node], x[1] + u[2 * node + 1]];
        Worst {
            node,
            position,
            quantity: "force residual",
            value: report.residual,
        }
    }

    /// Motion and forces at the end of a converged increment.
    fn finish(
        &self,
        start: &State,
        v0p: Vec<f64>,
        d: Vec<f64>,
        interval: Interval,
        forces: ContactForces,
        meter: &mut Meter,
    ) -> Result<Solved, Cause> {
        let Equilibrium {
            u_theta,
            load,
            internal,
            acceleration,
            inertia,
        } = self.equilibrium(start, &v0p, &d, interval, meter)?;
        // V1 = (2/dt) d - V0+; at supports from the amplitude
        let rate = 2.0 / interval.dt;
        let mut v: Vec<f64> = (0..d.len()).map(|i| rate * d[i] - v0p[i]).collect();
        let mut u = sum(&start.u, &d);
        for (dof, u1, v1) in self.supports.motion(interval.end) {
            (u[dof], v[dof]) = (u1, v1);
        }
        let end = State {
            u,
            v,
            a: acceleration.clone(),
        };
        let passes = Vec::new();
        Ok(Solved {
            d,
            v0p,
            u_theta,
            load,
            internal,
            acceleration,
            inertia,
            end,
            forces,
            passes,
        })
    }
}

/// What residual and correction are measured against.
struct Scales {
    /// Largest of the forces in equilibrium.
    force: f64,
    /// Round-off of the residual.
    noise: f64,
    /// Largest displacement increment.
    increment: f64,
    /// Round-off of the displacements.
    resolution: f64,
    tolerance: f64,
}

impl Scales {
    /// Relative residual and correction; neither is measured finer than round-off allows.
    fn report(
        &self,
        residual: &[f64],
        du: &[f64],
        forces: &ContactForces,
        pivots: usize,
    ) -> PassReport {
        let relative = |value: f64, scale: f64, floor: f64| {
            let scale = scale.max(floor / self.tolerance);
            if scale == 0.0 { value } else { value / scale }
        };
        let (active, stick) = forces.count();
        PassReport {
            residual: relative(largest(residual), self.force, self.noise),
            correction: relative(largest(du), self.increment, self.resolution),
            active,
            stick,
            lcp_size: forces.pairs.len(),
            pivots,
        }
    }

    /// Both below the tolerance. A residual that is all round-off says the same of the correction.
    fn converged(&self, report: &PassReport) -> bool {
        let noise_only = self.noise > self.tolerance * self.force;
        report.residual <= self.tolerance && (report.correction <= self.tolerance || noise_only)
    }
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// Slots that are closed.
fn closed(state: &[ContactState]) -> Vec<usize> {
    (0..state.len())
        .filter(|&slot| state[slot].is_closed())
        .collect()
}

/// Stores the states of a pass per slot.
pub(super) fn remember(forces: &ContactForces, state: &mut [ContactState]) {
    state.fill(ContactState::Open);
    for (k, pair) in forces.pairs.iter().enumerate() {
        if forces.is_closed(k) {
            state[pair.slot] = forces.state[k];
        }
    }
}

/// Segment of every slot.
fn segments(pairs: &[Pair], slots: usize) -> Vec<Option<usize>> {
    let mut segments = vec![None; slots];
    for pair in pairs {
        segments[pair.slot] = Some(pair.segment);
    }
    segments
}
