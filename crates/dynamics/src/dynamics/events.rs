//! Event-driven integration of impacts: subincrements [t, t + tau] that end at the next impact. Their length tau solves
//! T(tau) = tau, where T is the time of the impact in a trial of length tau. See docs/theory/impacts.md, Impacts as
//! events.

use super::impact_search::{EventTrial, ImpactSearch};
use super::increment::{Attempt, Failed, Path, Solved, StaticRates};
use super::ledger::node_path;
use super::results::State;
use super::step::{HeldMotions, Interval, StepProblem, TimePoint, Workspace};
use crate::contact::tolerances::{CLOSED_GAP, CROSSING_BEYOND_ENDS, IMPACT_GAP};
use crate::contact::{
    ActiveConstraints, ClosedPairs, Constraint, ConstraintSet, Crossing, CrossingSense, Lift,
    ListedSlave, NodeAtSegment, Projection, QuadraticMotion, crossings, line_crossings, project,
};

/// Part of a nominal increment within which impacts are treated as simultaneous; no subincrement is
/// shorter.
const IMPACT_GROUPING_TIME: f64 = 1e-3;
/// Accuracy of the time of an impact, in nominal increments.
const TIME_ACCURACY: f64 = 1e-10;
/// Largest number of attempts to find the time of an impact.
const MOST_TRIALS: usize = 12;

/// A converged part of an increment that ends at the next impact, or at the end of the increment.
pub(crate) struct Subincrement {
    pub interval: Interval,
    pub solved: Solved,
    /// Whether an impact ends the subincrement.
    pub is_cut: bool,
}

/// A subincrement that failed, with its times.
pub(crate) type FailedSubincrement = Box<(Interval, Failed)>;

/// Solves the next subincrement.
pub(crate) struct Subincrements<'a, 'm> {
    pub problem: &'a StepProblem<'m>,
    pub workspace: &'a mut Workspace<'m>,
    pub start: &'a State,
    /// The part of a nominal increment that is still to be solved.
    pub rest: Interval,
    /// Length of the nominal increment.
    pub nominal: f64,
}

/// Event of a node that enters a body, or of a mean gap (surface to surface) that becomes negative.
#[derive(Debug, Clone, Copy)]
struct Intrusion {
    pair: NodeAtSegment,
    /// Lift of the node over the chord of the segment; `None` for a mean gap.
    lift: Option<Lift>,
    /// Time of the event since the start of the subincrement, by the motion between its ends.
    time: f64,
}

impl Intrusion {
    /// Gap of the pair at the end of a trial and the length to which it is relative; NaN for a mean gap over no
    /// segment.
    fn gap(&self, problem: &StepProblem, trial: &EventTrial) -> [f64; 2] {
        match self.lift {
            Some(lift) => {
                let place = lift.of(problem.positions(&trial.u).place(self.pair.nodes));
                [place.gap, place.length]
            }
            None => trial.mean(self.pair.key),
        }
    }
}

/// Second-order motion of all nodes from the start of a subincrement.
struct FreeMotion<'a> {
    path: &'a Path,
    /// End of the converged subincrement to which the motion belongs; 0 for another motion.
    end: f64,
    /// Time for which the motion is followed.
    duration: f64,
}

impl FreeMotion<'_> {
    /// Displacement U0 + t V + t²/2 A at the end of the motion.
    fn displacement(&self, u0: &[f64]) -> Vec<f64> {
        let travel = self.path.displacement(self.duration);
        u0.iter().zip(&travel).map(|(u, d)| u + d).collect()
    }

    /// Whether node and segment move far enough relative to each other to meet. The distance of a node from the place
    /// xi where it will meet a segment is at most (1 - xi) times its path relative to the end a, plus xi times its path
    /// relative to the end b.
    fn may_meet(&self, start: &Projection, [s, a, b]: [usize; 3]) -> bool {
        let Path {
            v, a: acceleration, ..
        } = self.path;
        let travel = |end: usize| {
            let size = |x: &[f64]| (x[2 * s] - x[2 * end]).hypot(x[2 * s + 1] - x[2 * end + 1]);
            self.duration * (size(v) + self.duration / 2.0 * size(acceleration))
        };
        let round_off = CROSSING_BEYOND_ENDS * start.length;
        let beyond = (start.xi - start.xi.clamp(0.0, 1.0)) * start.length;
        beyond.hypot(start.gap) <= travel(a).max(travel(b)) + round_off
    }

    /// Motions of a node raised over a segment by its lift, and of the ends of the segment. The share of the bulge in
    /// the lift is interpolated from the places of the node at the start, in the middle and at the end.
    fn motions(
        &self,
        problem: &StepProblem,
        u0: &[f64],
        nodes: [usize; 3],
        lift: Lift,
    ) -> [QuadraticMotion; 3] {
        let Path { v, a, .. } = self.path;
        let [mut s, a, b] = nodes.map(|node| node_path(problem, u0, v, a, node));
        if lift.is_none() {
            return [s, a, b];
        }
        let raised = |time: f64| {
            let [x, a, b] = [&s, &a, &b].map(|motion| motion.at(time));
            let p = project(x, a, b);
            p.normal.map(|n| n * lift.at(p.xi))
        };
        let from = raised(0.0);
        if !lift.bulge.is_flat() && self.duration > 0.0 {
            let t = self.duration;
            let [middle, end] = [t / 2.0, t].map(raised);
            for i in 0..2 {
                s.velocity[i] += (4.0 * middle[i] - 3.0 * from[i] - end[i]) / t;
                s.acceleration[i] += 4.0 * (from[i] - 2.0 * middle[i] + end[i]) / (t * t);
            }
        }
        s.position = [0, 1].map(|i| s.position[i] + from[i]);
        [s, a, b]
    }

    /// Time at which a slave node with an allowed overlap enters through a segment.
    fn entry(
        &self,
        problem: &StepProblem,
        u0: &[f64],
        (pair, lift): (NodeAtSegment, Lift),
    ) -> Option<f64> {
        let motions = self.motions(problem, u0, pair.nodes, lift);
        self.first_to_stay(&crossings(&motions, self.duration))
    }

    /// Time at which an inactive constraint that ends with an overlap has closed: its slave node has moved behind the
    /// line of the segment.
    fn overlap(&self, problem: &StepProblem, u0: &[f64], constraint: &Constraint) -> Option<f64> {
        let Some(lift) = constraint.lift_at_start() else {
            return constraint.closing_time([&self.path.v, &self.path.a], self.duration);
        };
        let motions = self.motions(problem, u0, constraint.pair().nodes, lift);
        self.first_to_stay(&line_crossings(&motions, self.end))
    }

    /// Time of the first entry of a node that stays inside. A node that leaves the body again before the end of the
    /// subincrement does not count, since the motion within the subincrement is an estimate.
    fn first_to_stay(&self, found: &[Crossing]) -> Option<f64> {
        let stays = |&(k, crossing): &(usize, &Crossing)| {
            let is_out = |c: &Crossing| c.direction == CrossingSense::Leaving && c.time < self.end;
            crossing.direction == CrossingSense::Entering && !found[k..].iter().any(is_out)
        };
        let mut numbered = found.iter().enumerate();
        numbered.find(stays).map(|(_, crossing)| crossing.time)
    }
}

impl<'m> Subincrements<'_, 'm> {
    /// The subincrement up to the earliest impact of a pair that does not touch at the start.
    ///
    /// The whole rest of the increment is tried first. Inactive pairs that overlap at the end of the trial of length
    /// tau show an impact; the subincrement ends at the first impact,
    ///
    /// ```text
    /// g(tau) = 0    eq. (6.4)
    /// ```
    ///
    /// Here g is the gap at the end of a subincrement of length tau. If the whole rest of the increment does not
    /// converge, the second-order motion of the start (paper eq. 50) predicts the length tau.
    pub fn next(&mut self) -> Result<Subincrement, FailedSubincrement> {
        let (rest, group) = (self.rest.dt, IMPACT_GROUPING_TIME * self.nominal);
        let search = &mut self.workspace.search;
        search.start(&self.start.v, rest);
        search.cover(&self.start.u);
        let (problem, start) = (self.problem, self.start);
        let means = self.workspace.means(problem, [&start.u; 2]);
        let search = &self.workspace.search;
        let mut active = ActiveConstraints::new(search, &start.u, &means, &start.contact);
        let begin = || EventTrial::new(0.0, &start.u, &means);
        let mut impact = ImpactSearch::new(begin());
        let (mut tau, mut guess, mut before) = (rest, None, None);
        let mut entries = Vec::new();
        for _ in 0..MOST_TRIALS {
            let solved = match self.attempt(tau, ConstraintSet::Active(&active), guess.as_ref()) {
                Ok(solved) => solved,
                Err(failed) if tau == rest => {
                    tau = self.predicted(&mut active);
                    if tau == rest {
                        return Err(failed);
                    }
                    continue;
                }
                Err(failed) => match before {
                    Some((tau, solved)) if tau >= group => return Ok(self.converged(tau, solved)),
                    _ => return Err(failed),
                },
            };
            let path = solved.path(tau);
            let found = self.entries(&active, &path, tau, Some(&solved));
            let is_before = found.is_empty();
            if !is_before {
                entries = found;
            } else if entries.is_empty() {
                return Ok(self.converged(tau, solved));
            }
            let trial = EventTrial::new(tau, &solved.end.u, &solved.contact.forces.constraints);
            impact.record(trial.clone(), is_before);
            // a node that has just bounced off has hardly a gap at the start: its motion then gives the time
            let expected = |entry: &Intrusion| {
                let gap = |trial: &EventTrial| entry.gap(problem, trial)[0];
                let root = impact.root(gap).filter(|root| *root >= group);
                root.unwrap_or(entry.time)
            };
            let first = entries
                .iter()
                .min_by(|e, f| expected(e).total_cmp(&expected(f)));
            let root = first.map(expected);
            let lands = |is_time: &dyn Fn(f64) -> bool| {
                entries
                    .iter()
                    .filter(|e| is_time(expected(e)))
                    .copied()
                    .collect::<Vec<_>>()
            };
            let at_start = lands(&|time| time < group);
            let at_end = lands(&|time| time > rest - group);
            if !at_start.is_empty() || root.is_none_or(|root| root > rest - group) {
                // both groups join the active pairs; the nodes of `at_end` land at the very end of
                // the rest of the increment
                at_start
                    .iter()
                    .for_each(|entry| self.join_at_start(&mut active, *entry));
                if at_start.is_empty() {
                    at_end
                        .iter()
                        .for_each(|entry| active.join(entry.pair.key.slave()));
                }
                (impact, before, guess) = (ImpactSearch::new(begin()), None, Some(path));
                tau = rest;
                entries.clear();
                continue;
            }
            let is_met = |entry: &Intrusion| {
                let [gap, length] = entry.gap(problem, &trial);
                gap.abs() <= IMPACT_GAP * length
            };
            let is_near = |root: f64| (root - tau).abs() <= TIME_ACCURACY * self.nominal;
            if first.is_some_and(is_met) || root.is_some_and(is_near) {
                return Ok(self.converged(tau, solved));
            }
            if is_before {
                before = Some((tau, solved));
            }
            tau = impact.next(tau, root);
            guess = Some(path);
        }
        match before {
            // this subincrement ends before the impact
            Some((tau, solved)) if tau >= group => Ok(self.converged(tau, solved)),
            _ => self.rest(),
        }
    }

    /// Solves the whole rest of the increment; nodes land within this subincrement.
    pub fn rest(&mut self) -> Result<Subincrement, FailedSubincrement> {
        let solved = self.attempt(self.rest.dt, ConstraintSet::All, None)?;
        Ok(self.converged(self.rest.dt, solved))
    }

    /// Length of the subincrement that is predicted by the motion of the start.
    fn predicted(&mut self, active: &mut ActiveConstraints) -> f64 {
        let (rest, group) = (self.rest.dt, IMPACT_GROUPING_TIME * self.nominal);
        let path = Path {
            v: self.start.v.clone(),
            a: self.start.a.clone(),
            closed: ClosedPairs::default(),
            held: HeldMotions::default(),
            pairs_stiffen: false,
            rates: StaticRates::default(),
        };
        loop {
            let entries = self.entries(active, &path, rest, None);
            let first = entries.iter().min_by(|e, f| e.time.total_cmp(&f.time));
            match first {
                Some(entry) if entry.time < group => self.join_at_start(active, *entry),
                Some(entry) if entry.time <= rest - group => return entry.time,
                _ => return rest,
            }
        }
    }

    fn join_at_start(&self, active: &mut ActiveConstraints, entry: Intrusion) {
        if entry.lift.is_none() {
            active.join_mean_at_start(entry.pair.key);
            return;
        }
        let p = self
            .problem
            .positions(&self.start.u)
            .place(entry.pair.nodes);
        active.join_at_start(entry.pair, p.normal);
    }

    /// Events of the nodes that enter bodies, and are not kept out of these, within the time tau of a motion. The
    /// motion is that of a converged subincrement, or a prediction. In a converged subincrement these are nodes that
    /// stay inside to its end, or go through the body.
    fn entries(
        &mut self,
        active: &ActiveConstraints,
        path: &Path,
        tau: f64,
        solved: Option<&Solved>,
    ) -> Vec<Intrusion> {
        let (problem, u0) = (self.problem, &self.start.u);
        let motion = FreeMotion {
            path,
            duration: tau,
            end: if solved.is_some() { tau } else { 0.0 },
        };
        let predicted = match solved {
            Some(_) => Vec::new(),
            None => (self.workspace).means(problem, [u0, &motion.displacement(u0)]),
        };
        let constraints = solved.map_or(&predicted, |solved| &solved.contact.forces.constraints);
        let counts = |c: &&Constraint| active.is_held(problem.positions(u0), c);
        let (counting, left_out): (Vec<_>, Vec<_>) = constraints.iter().partition(counts);
        let has_constraint = |slave: usize| counting.iter().any(|c| c.keeps_out(slave));
        let place = |u: &[f64], (pair, lift): (NodeAtSegment, Lift)| {
            lift.of(problem.positions(u).place(pair.nodes))
        };
        // between its ends the motion is an estimate: a node in front at the end has not entered
        let ends_behind = |at: (NodeAtSegment, Lift)| {
            solved.is_none_or(|solved| place(&solved.end.u, at).gap < 0.0)
        };
        let is_kept = |pair: &NodeAtSegment, place: &Projection| {
            active.holds(pair.key.slave(), place)
                && (solved.is_none()
                    || active.has_joined(pair.key.slave())
                    || has_constraint(pair.nodes[0]))
        };
        let mut entries: Vec<Intrusion> = Vec::new();
        for c in left_out {
            // nodes that have entered less deeply are found by their motion
            let lift = c.lift_at_start();
            let least = lift.map_or(0.0, |_| CLOSED_GAP);
            if c.gap < -least * c.scale {
                let entry = |time| Intrusion {
                    pair: c.pair(),
                    lift,
                    time,
                };
                entries.extend(motion.overlap(problem, u0, c).map(entry));
            }
        }
        let Workspace { search, meter, .. } = &mut *self.workspace;
        let find = || {
            search.cover_path(u0, &motion.displacement(u0));
            for listed in search.slaves().filter(ListedSlave::meets_segments) {
                for candidate in listed.candidates() {
                    let pair = listed.at(candidate.segment);
                    let lift = listed.lift(&pair);
                    let [s, a, b] = pair.nodes;
                    let place = place(u0, (pair, lift));
                    let may_enter = motion.may_meet(&place, pair.nodes)
                        && s != a
                        && s != b
                        && problem.unknowns.moves(&pair.nodes)
                        && ends_behind((pair, lift))
                        && !is_kept(&pair, &place);
                    if may_enter {
                        let time = motion.entry(problem, u0, (pair, lift));
                        let lift = Some(lift);
                        entries.extend(time.map(|time| Intrusion { pair, lift, time }));
                    }
                }
            }
        };
        meter.time(|t| &mut t.contact, find);
        if let (true, Some(solved)) = (entries.is_empty(), solved) {
            entries.extend(self.tunnelled(active, &motion, solved));
        }
        entries
    }

    /// The node that the penetration check of a converged subincrement finds inside or beyond a body, unless the node
    /// has joined the active pairs.
    fn tunnelled(
        &mut self,
        active: &ActiveConstraints,
        motion: &FreeMotion,
        solved: &Solved,
    ) -> Option<Intrusion> {
        let (problem, u0) = (self.problem, &self.start.u);
        let closed = [&self.start.contact, &solved.end.contact];
        let unsolved = problem.unsolved(&solved.d);
        let pair = (self.workspace).find_penetration([u0, &solved.end.u], closed, &unsolved)?;
        if active.has_joined(pair.key.slave()) || !problem.unknowns.moves(&pair.nodes) {
            return None;
        }
        let through = FreeMotion {
            end: 0.0,
            ..*motion
        };
        let mut slaves = self.workspace.search.slaves();
        let listed = slaves.find(|listed| listed.key == pair.key.slave())?;
        let lift = Lift {
            allowed: 0.0,
            ..listed.lift(&pair)
        };
        let time = through.entry(problem, u0, (pair, lift)).unwrap_or(0.0);
        let lift = Some(lift);
        Some(Intrusion { pair, lift, time })
    }

    fn attempt(
        &mut self,
        tau: f64,
        set: ConstraintSet,
        guess: Option<&Path>,
    ) -> Result<Solved, FailedSubincrement> {
        let interval = self.interval(tau);
        let attempt = Attempt {
            problem: self.problem,
            workspace: self.workspace,
            start: self.start,
            interval,
            set,
            guess,
        };
        let solved = attempt.solve();
        solved.map_err(|failed| Box::new((interval, failed)))
    }

    fn converged(&self, tau: f64, solved: Solved) -> Subincrement {
        Subincrement {
            interval: self.interval(tau),
            solved,
            is_cut: tau < self.rest.dt,
        }
    }

    /// The first part, of length `tau`, of the rest of the increment; the whole rest if `tau` is
    /// its length.
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
