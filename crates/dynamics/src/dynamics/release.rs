//! Rest of nodes without mass at the end of an increment in which pairs open. See
//! docs/theory/impacts.md, Releases.

use super::free_nodes::FreeNodes;
use super::increment::{ContactForces, Release, Solved};
use super::results::State;
use super::step::{Interval, StepProblem, System, Workspace, difference, dot, sum};
use crate::contact::{ClosedPair, Constraint, SlaveChoice};
use crate::elements::Motion;
use crate::linear::{larger, largest};

/// Largest number of Newton steps until the free nodes are at rest.
const MOST_STEPS: usize = 10;
/// Length of a Newton step, relative to the path so far, from which on the next step is round-off.
const LAST_STEP: f64 = 1e-6;
/// Overlap, in lengths of the segment, that is round-off of positions.
const OVERLAP_ROUND_OFF: f64 = 1e-12;
/// Relative round-off of displacements, and of the sums of a strain energy.
const SUM_ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// Brings nodes without mass that carry no force to rest at the end of an increment in which pairs have opened. The
/// mid-point rule fixes only the mean of start and end, so without the rest the deviation of nodes without mass would
/// change its sign in every increment. If no state of rest is found, or a node would pass through a surface on the way,
/// the nodes stay as they are. Returns the energy that is lost as the nodes come to rest.
pub(crate) fn bring_to_rest(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &State,
    interval: Interval,
    solved: &mut Solved,
) -> Release {
    if problem.redistribution.is_empty() || !problem.integration.energy_momentum {
        return Release::default();
    }
    let still = &solved.end.contact;
    let has_opened = |pair: &&ClosedPair| still.of_slave(pair.key.slave()).is_empty();
    let opened: Vec<&ClosedPair> = start.contact.iter().filter(has_opened).collect();
    if opened.is_empty() {
        return Release::default();
    }
    let open = solved
        .contact
        .forces
        .iter()
        .filter(|(_, pair)| pair.is_none());
    let mut releasing = Releasing {
        problem,
        workspace,
        interval,
        end: &solved.end,
        free: FreeNodes::new(problem, solved, &opened),
        open: open.map(|(c, _)| c.clone()).collect(),
    };
    let found = releasing.rest();
    let safe = found.filter(|u| !releasing.goes_through(start, u));
    let found = safe.and_then(|u| Some((releasing.release(&u)?, u)));
    let Some(((mut release, internal), u)) = found else {
        return Release::default();
    };
    let at = problem.configurations(&u, &u);
    release.opened = (opened.iter().map(|pair| (pair.constraint(&at), pair.force))).collect();
    (solved.end.u, solved.end.internal) = (u, internal);
    release
}

/// The free nodes of an increment on their way to rest.
struct Releasing<'a, 'm> {
    problem: &'a StepProblem<'a>,
    workspace: &'a mut Workspace<'m>,
    interval: Interval,
    /// State at the end of the increment before the nodes come to rest.
    end: &'a State,
    free: FreeNodes,
    /// The open constraints of the last pass.
    open: Vec<Constraint>,
}

impl Releasing<'_, '_> {
    /// Displacements with the free nodes at rest, which minimise W - R.u with all gaps >= min(g1, 0). Newton steps
    /// include the contact forces of the pairs that the nodes meet. `None` if the steps do not converge.
    fn rest(&mut self) -> Option<Vec<f64>> {
        let mut u = self.end.u.clone();
        for _ in 0..MOST_STEPS {
            let du = self.newton_step(&u)?;
            u = sum(&u, &du);
            let (step, travel) = (largest(&du), largest(&difference(&u, &self.end.u)));
            let of_bodies = self.problem.parts.largest_of_bodies(&u);
            let seen = largest(&self.workspace.seen.displacements(of_bodies));
            if step <= larger(LAST_STEP * travel, SUM_ROUND_OFF * seen) {
                let overlaps = |c: &Constraint| c.gap < -OVERLAP_ROUND_OFF * c.scale;
                return (!self.constraints(&u).iter().any(overlaps)).then_some(u);
            }
        }
        None
    }

    /// A Newton step dU = K_ii^-1 (R - F + Bn^T Pn), eq. (6.14), with Pn from the complementarity
    /// problem of the gaps.
    fn newton_step(&mut self, u: &[f64]) -> Option<Vec<f64>> {
        let (problem, end) = (self.problem, self.interval.end);
        let motion = Motion {
            end: u,
            ..self.end.motion()
        };
        let internal = problem.elements.internal_force(motion).ok()?;
        let load = (problem.loads).at(end, u);
        let mut constraints = self.constraints(u);
        let (free, meter) = (&self.free, &mut self.workspace.meter);
        let mut stiffness = meter.time(|t| &mut t.assembly, || free.stiffness(problem, motion));
        let mut system = System::new(&mut stiffness, meter);
        system.factorize().ok()?;
        let mut forces = ContactForces::default();
        forces.relinearize(&mut constraints);
        let (still, r) = (vec![0.0; u.len()], difference(&load, &internal));
        let mut du = Vec::new();
        (forces.solve([&still, &r], None, &mut system, &mut du)).ok()?;
        system.check().ok()?;
        Some(du)
    }

    /// Constraints at the displacements `u` that the free nodes can close, without friction: new constraints and the
    /// constraints of the last pass. The gaps of constraints that free nodes can close are measured from their least
    /// allowed value.
    fn constraints(&mut self, u: &[f64]) -> Vec<Constraint> {
        let start = &self.end.u;
        let (increment, mut found) = ([start.as_slice(), u], Vec::new());
        (self.workspace).constraints(
            self.problem,
            increment,
            &[],
            (&self.end.contact, None),
            SlaveChoice::All,
            &mut found,
        );
        let opens = |constraint: &Constraint| self.free.open(constraint);
        let above_least = |mut constraint: Constraint| {
            constraint.gap -= constraint.start_gap.min(0.0);
            constraint.mu = 0.0;
            constraint
        };
        let at = self.problem.configurations(start, u);
        let kept = self.open.iter().map(|constraint| constraint.untilted(&at));
        let mut all: Vec<Constraint> = found.into_iter().chain(kept).filter(opens).collect();
        all.sort_by_key(|constraint| constraint.key);
        all.dedup_by_key(|constraint| constraint.key);
        all.into_iter().map(above_least).collect()
    }

    /// Whether a node enters a body on its straight path from the start to the displacements `u`.
    fn goes_through(&mut self, start: &State, u: &[f64]) -> bool {
        let unsolved = self.problem.unsolved(&difference(u, &start.u));
        let closed = [&start.contact, &self.end.contact];
        let found = (self.workspace).find_penetration([&start.u, u], closed, &unsolved);
        found.is_some()
    }

    /// Energy that is lost if the nodes are at rest at the displacements `u`, eq. (6.15), and the internal variables at
    /// rest; `None` if the rest would add energy.
    fn release(&self, u: &[f64]) -> Option<(Release, Vec<f64>)> {
        let (elements, end) = (self.problem.elements, self.interval.end);
        let before = elements.evaluate(self.end.motion());
        let internal = (elements.update(Motion {
            start: Some(&self.end.u),
            end: u,
            ..self.end.motion()
        }))
        .variables;
        let at_rest = Motion {
            end: u,
            committed: &internal,
            ..self.end.motion()
        };
        let after = elements.evaluate(at_rest);
        let both = before.iter().zip(&*after);
        let of_springs = elements.spring_energy(&self.end.u) - elements.spring_energy(u);
        let taken = both.map(|(b, a)| b.energy - a.energy).sum::<f64>() + of_springs;
        let strain: f64 = before.iter().map(|element| element.energy).sum();
        let load = (self.problem.loads).at(end, u);
        let load_work = dot(&load, &difference(u, &self.end.u));
        let loss = taken + load_work;
        let release = Release {
            loss,
            load_work,
            opened: Vec::new(),
        };
        (loss >= -SUM_ROUND_OFF * strain).then_some((release, internal))
    }
}
