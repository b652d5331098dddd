//! Event-driven integration of impacts: subincrements [t, t + tau] that end at the next impact,
//! its time being the solution of T(tau) = tau. Section 6 of docs/theory.md, Impacts as events.

use super::impact_time::ImpactTime;
use crate::contact::tolerances::IMPACT_GAP;
use crate::contact::{ClosedPairs, Crossing, Direction, ListedSlave, Projection, crossings};
use crate::dynamics::increment::{ActiveConstraints, Attempt, ConstraintSet, Failed, Solved};
use crate::dynamics::ledger::motion;
use crate::dynamics::results::State;
use crate::dynamics::step::{Interval, StepProblem, TimePoint, Workspace};

/// Part of a nominal increment within which impacts are taken together; no subincrement is
/// shorter.
const IMPACT_GROUPING_TIME: f64 = 1e-3;
/// Accuracy of the time of an impact, in nominal increments.
const ACCURACY: f64 = 1e-10;
/// How long the motion of a subincrement is followed to find the next impact, in its lengths.
const MOTION_HORIZON: f64 = 2.0;
/// Attempts to find the time of an impact.
const TRIALS: usize = 12;

/// A converged part of an increment that ends at the next impact, or at the end of the increment.
pub(crate) struct Subincrement {
    pub interval: Interval,
    pub solved: Solved,
    /// Whether an impact ends it.
    pub is_cut: bool,
}

/// A subincrement that failed, with its times.
pub(crate) type FailedSubincrement = Box<(Interval, Failed)>;

/// Solves the next subincrement.
pub(crate) struct Subincrements<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
    pub start: &'a State,
    /// The pairs that carried forces up to the start.
    pub contact: &'a ClosedPairs,
    /// What is left of the increment.
    pub rest: Interval,
    /// Length of the nominal increment.
    pub nominal: f64,
}

/// A node goes into a body.
#[derive(Clone, Copy)]
struct PredictedImpact {
    /// Time since the start of the subincrement.
    time: f64,
    slave_index: usize,
    segment: usize,
    nodes: [usize; 3],
}

/// Second-order motion of all nodes from the start of a subincrement.
struct FreeMotion<'a> {
    v: &'a [f64],
    a: &'a [f64],
    /// End of the subincrement, where this is its own converged motion.
    end: f64,
    /// How long it is followed.
    duration: f64,
}

impl FreeMotion<'_> {
    /// U0 + t V + t²/2 A at the end.
    fn displacement(&self, u0: &[f64]) -> Vec<f64> {
        let t = self.duration;
        let at = |i: usize| u0[i] + t * (self.v[i] + t / 2.0 * self.a[i]);
        (0..u0.len()).map(at).collect()
    }

    /// Whether the displacements of the nodes are large enough for them to meet.
    fn may_meet(&self, start: &Projection, [s, a, b]: [usize; 3]) -> bool {
        let displacement = |node: usize| {
            let size = |x: &[f64]| x[2 * node].hypot(x[2 * node + 1]);
            self.duration * (size(self.v) + self.duration / 2.0 * size(self.a))
        };
        start.gap.abs() <= displacement(s) + displacement(a).max(displacement(b))
    }

    /// The impact of a slave node on a segment, unless one is kept out of the other as a constraint.
    fn impact(
        &self,
        problem: &StepProblem,
        u0: &[f64],
        active: &ActiveConstraints,
        listed: &ListedSlave,
        segment: usize,
    ) -> Option<PredictedImpact> {
        let (slave_index, s) = (listed.slave_index, listed.node());
        let [a, b] = listed.surfaces.segments[segment];
        let nodes = [s, a, b];
        let p = problem.place(u0, nodes);
        let is_free = self.may_meet(&p, nodes)
            && s != a
            && s != b
            && problem.unknowns.moves(&nodes)
            && !active.holds(slave_index, &p);
        if !is_free {
            return None;
        }
        let time = self.entry(problem, u0, nodes)?;
        Some(PredictedImpact {
            time,
            slave_index,
            segment,
            nodes,
        })
    }

    /// When the node s goes in through the segment from a to b. One that comes out again before the
    /// end of the subincrement has not gone in: between its ends its motion is an estimate.
    fn entry(&self, problem: &StepProblem, u0: &[f64], nodes: [usize; 3]) -> Option<f64> {
        let motions = nodes.map(|node| motion(problem, u0, self.v, self.a, node));
        let found = crossings(&motions, self.duration);
        let stays = |&(k, crossing): &(usize, &Crossing)| {
            let is_out = |c: &Crossing| c.direction == Direction::Leaving && c.time < self.end;
            crossing.direction == Direction::Entering && !found[k..].iter().any(is_out)
        };
        found
            .iter()
            .enumerate()
            .find(stays)
            .map(|(_, crossing)| crossing.time)
    }
}

impl<'m> Subincrements<'_, 'm> {
    /// The subincrement up to the earliest impact of a pair that does not touch at the start.
    ///
    /// Its length tau is predicted from the second-order motion of the start (paper eq. 50), with
    /// the exact condition of meeting. The motion of the converged subincrement,
    ///
    /// ```text
    /// U(t) = U0 + t V0+ + t²/2 A,   A = (2/tau²) (d - tau V0+),   eq. (6.3)
    /// ```
    ///
    /// then tells when the pairs that stay out meet: at T(tau). The subincrement ends at the impact when
    /// T(tau) = tau, which secants find; without elastic forces T does not depend on tau.
    ///
    /// `last` is the length of the last subincrement.
    pub fn next(&mut self, last: f64) -> Result<Subincrement, FailedSubincrement> {
        let (rest, group) = (self.rest.dt, IMPACT_GROUPING_TIME * self.nominal);
        let search = &mut self.workspace.search;
        search.start(&self.start.v, rest);
        search.cover(&self.start.u);
        let mut active = ActiveConstraints::new(self.problem, search, &self.start.u, self.contact);
        let mut tau = self.predicted(&mut active, last);
        let mut root = ImpactTime::new(rest);
        for _ in 0..TRIALS {
            let solved = self.attempt(tau, ConstraintSet::Active(&active))?;
            let a = solved.mean_acceleration(tau);
            let motion = FreeMotion {
                v: &solved.v0p,
                a: &a,
                end: tau,
                duration: rest.min(MOTION_HORIZON * tau),
            };
            let entry = self.first_entry(&active, motion);
            let met = match entry {
                None => rest,
                Some(entry) if entry.time < group => {
                    self.join_at_start(&mut active, entry);
                    root = ImpactTime::new(rest);
                    continue;
                }
                Some(entry) if entry.time > rest - group => {
                    if tau == rest {
                        // it lands within the subincrement, at its very end
                        active.join(entry.slave_index);
                        root = ImpactTime::new(rest);
                        continue;
                    }
                    rest
                }
                Some(entry) => {
                    let gap = self.problem.place(&solved.end.u, entry.nodes);
                    if gap.gap.abs() <= IMPACT_GAP * gap.length {
                        tau
                    } else {
                        entry.time
                    }
                }
            };
            // T(tau) = tau, eq. (6.4)
            if (met - tau).abs() <= ACCURACY * self.nominal {
                return Ok(self.converged(tau, solved));
            }
            tau = root.next(tau, met, solved);
        }
        match root.before {
            // not as far as the impact
            Some((tau, solved)) if tau >= group => Ok(self.converged(tau, solved)),
            _ => self.rest(),
        }
    }

    /// All that is left of the increment; nodes land within it.
    pub fn rest(&mut self) -> Result<Subincrement, FailedSubincrement> {
        let solved = self.attempt(self.rest.dt, ConstraintSet::All)?;
        Ok(self.converged(self.rest.dt, solved))
    }

    /// Length of the subincrement by the motion of the start.
    fn predicted(&mut self, active: &mut ActiveConstraints, last: f64) -> f64 {
        let (rest, group) = (self.rest.dt, IMPACT_GROUPING_TIME * self.nominal);
        let start = self.start;
        loop {
            let motion = FreeMotion {
                v: &start.v,
                a: &start.a,
                end: 0.0,
                duration: rest.min(MOTION_HORIZON * last),
            };
            match self.first_entry(active, motion) {
                Some(entry) if entry.time < group => self.join_at_start(active, entry),
                Some(entry) if entry.time <= rest - group => return entry.time,
                _ => return rest,
            }
        }
    }

    fn join_at_start(&self, active: &mut ActiveConstraints, entry: PredictedImpact) {
        let p = self.problem.place(&self.start.u, entry.nodes);
        active.join_at_start(entry.slave_index, entry.segment, p.normal);
    }

    /// The first entry of a node into a body that is not kept out of it as a constraint.
    fn first_entry(
        &mut self,
        active: &ActiveConstraints,
        motion: FreeMotion,
    ) -> Option<PredictedImpact> {
        let (problem, u0) = (self.problem, &self.start.u);
        let Workspace { search, meter, .. } = &mut *self.workspace;
        let find = || {
            search.cover_path(u0, &motion.displacement(u0));
            let mut first: Option<PredictedImpact> = None;
            for listed in search.slaves() {
                for candidate in listed.candidates() {
                    let impact = motion.impact(problem, u0, active, &listed, candidate.segment);
                    if let Some(impact) = impact
                        && first.is_none_or(|first| impact.time < first.time)
                    {
                        first = Some(impact);
                    }
                }
            }
            first
        };
        meter.time(|t| &mut t.contact, find)
    }

    fn attempt(&mut self, tau: f64, set: ConstraintSet) -> Result<Solved, FailedSubincrement> {
        let interval = self.interval(tau);
        let attempt = Attempt {
            problem: self.problem,
            workspace: self.workspace,
            start: self.start,
            interval,
            set,
        };
        let solved = attempt.solve(self.contact);
        solved.map_err(|failed| Box::new((interval, failed)))
    }

    fn converged(&self, tau: f64, solved: Solved) -> Subincrement {
        Subincrement {
            interval: self.interval(tau),
            solved,
            is_cut: tau < self.rest.dt,
        }
    }

    /// The first part, of length `tau`, of what is left; all of it when that is its length.
    fn interval(&self, tau: f64) -> Interval {
        let Interval { start, end, dt } = self.rest;
        let end = match tau == dt {
            true => end,
            false => TimePoint {
                step: start.step + tau,
                total: start.total + tau,
                ..start
            },
        };
        Interval {
            start,
            end,
            dt: tau,
        }
    }
}
