//! Postprocessing of a converged increment: nodal quantities, resultants of the contacts, and
//! landings by paper eq. 50 with the exact crossing (docs/theory/geometry.md, Crossing).
//!
//! Contact pressure at slave nodes: normal force over the area of a node.

use std::collections::HashSet;

use smallvec::SmallVec;

use crate::contact::tolerances::SOLVED_GAP;
use crate::contact::{
    ClosedPair, Configurations, Constraint, Crossing, CrossingSense, QuadraticMotion, RowForm,
    crossings, line_crossings, project,
};
use crate::dynamics::increment::{ContactForces, Solved};
use crate::dynamics::results::{
    ContactResultant, FrictionResults, Landing, NodalResults, NodeMass, NodeStatus, State,
};
use crate::dynamics::step::{Equilibrium, Interval, SlaveFaces, StepProblem};
use crate::linear::larger;
use crate::model::{Bodies, ContactMass, Model};
use crate::vectors::{cross, length};

/// Change of velocity, relative to the largest velocity of the two bodies, from which on an impulse
/// is an impact.
const STRUCK: f64 = 1e-9;

/// Reactions, contact forces, gaps and status at the nodes; reactions of rigid surfaces are at the nodes of the
/// surfaces, not at their reference nodes.
pub(crate) fn nodal_results(problem: &StepProblem, solved: &Solved) -> NodalResults {
    let dofs = solved.d.len();
    let contact_force = solved.contact.forces.resultant(dofs);
    let Equilibrium {
        load,
        internal,
        inertia,
        hinges,
        held,
        ..
    } = &solved.equilibrium;
    // M A + F - R - B^T P at the supports, with what equations pass on to them, eq. (9.12)
    let missing = |p: usize| inertia[p] + internal[p] - load[p] - contact_force[p];
    let missing: Vec<f64> = (0..dofs).map(missing).collect();
    let tie_force = tie_forces(problem.model, |dof| missing[dof]);
    let mut missing = problem.unknowns.passed_on(&missing).into_owned();
    let turning = &problem.unknowns.turning;
    turning.hand_over([&solved.end.u, &solved.d], false, &mut missing);
    let mut reaction = vec![0.0; dofs];
    for p in problem.unknowns.prescribed() {
        reaction[p] = missing[p];
    }
    // only nodes have held forces, angles of bodies that turn have none
    for &(dof, force) in held {
        reaction[dof] += force;
    }
    let mut results = NodalResults {
        reaction,
        contact_force,
        tie_force,
        hinge_force: hinges.chunks(2).map(|force| [force[0], force[1]]).collect(),
        gap: vec![f64::NAN; dofs / 2],
        status: vec![NodeStatus::None; dofs / 2],
        friction: FrictionResults {
            coefficient: friction_coefficients(problem, &solved.contact.forces),
            ..FrictionResults::default()
        },
        mass: node_masses(problem),
        ..NodalResults::default()
    };
    let mut of_masters = MasterMeans::new(dofs / 2);
    for (constraint, pair) in solved.contact.forces.iter() {
        let gap = end_gap(problem, solved, constraint);
        of_masters.add(constraint, gap);
        let status = match pair.map(|pair| pair.slips) {
            None => NodeStatus::Open,
            Some(false) => NodeStatus::Stick,
            Some(true) => NodeStatus::Slip,
        };
        let slave = constraint.named_slave();
        results.gap[slave] = results.gap[slave].min(gap);
        results.status[slave] = results.status[slave].max(status);
        for (node, _) in (constraint.shares_of_masters()).filter(|(_, share)| *share > 0.0) {
            results.status[node] = results.status[node].max(status);
        }
    }
    for (gap, mean) in results.gap.iter_mut().zip(of_masters.values()) {
        *gap = gap.min(mean);
    }
    results
}

/// Means of values of constraints (surface to surface) at the master nodes, weighted by the parts of the normal forces
/// on these nodes.
///
/// ```text
/// g = sum_j |Bn_j| g_j / sum_j |Bn_j|    eq. (9.16)
/// ```
pub(super) struct MasterMeans {
    sums: Vec<[f64; 2]>,
}

impl MasterMeans {
    pub fn new(nodes: usize) -> Self {
        MasterMeans {
            sums: vec![[0.0; 2]; nodes],
        }
    }

    /// Adds a value of a constraint to the means at its master nodes.
    pub fn add(&mut self, constraint: &Constraint, value: f64) {
        for (node, share) in constraint.shares_of_masters() {
            let [sum, whole] = &mut self.sums[node];
            *sum += share * value;
            *whole += share;
        }
    }

    /// The mean at every node; NaN at nodes without values.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let mean = |[sum, whole]: &[f64; 2]| match *whole > 0.0 {
            true => sum / whole,
            // the sign of 0/0 depends on the processor
            false => f64::NAN,
        };
        self.sums.iter().map(mean)
    }
}

/// Mean coefficient of friction, weighted by Pn, from three numbers: the first coefficient, the sum of Pn, and the sum
/// of Pn times the difference from the first coefficient.
#[derive(Clone, Copy, Default)]
struct MeanCoefficient {
    first: f64,
    sums: [f64; 2],
}

impl MeanCoefficient {
    fn add(&mut self, mu: f64, pn: f64) {
        if self.sums[0] == 0.0 {
            self.first = mu;
        }
        self.sums[0] += pn;
        self.sums[1] += pn * (mu - self.first);
    }

    /// Mean coefficient; NaN if no force was added. NaN is not computed as 0/0, whose sign depends
    /// on the processor.
    fn value(&self) -> f64 {
        match self.sums[0] == 0.0 {
            true => f64::NAN,
            false => self.first + self.sums[1] / self.sums[0],
        }
    }
}

/// Coefficients of friction at the nodes; empty if no friction varies.
fn friction_coefficients(problem: &StepProblem, forces: &ContactForces) -> Vec<f64> {
    if !problem.model.has_varying_friction() {
        return Vec::new();
    }
    let mut means = vec![MeanCoefficient::default(); problem.model.mesh.node_count()];
    for (constraint, pair) in forces.acting() {
        means[constraint.named_slave()].add(constraint.mu, pair.force[0]);
        for (node, share) in constraint.shares_of_masters() {
            means[node].add(constraint.mu, share * pair.force[0]);
        }
    }
    means.iter().map(MeanCoefficient::value).collect()
}

/// The part of the constraint forces on the dofs that comes from ties; empty if there are no ties.
pub(crate) fn tie_forces(model: &Model, force: impl Fn(usize) -> f64) -> Vec<f64> {
    if model.ties.is_empty() {
        return Vec::new();
    }
    let mut all = vec![0.0; model.dof_count()];
    for tie in &model.ties {
        let nodes = tie.nodes.iter().map(|tied| tied.node);
        let slaves: HashSet<usize> = nodes.clone().collect();
        for dof in nodes.flat_map(|node| [2 * node, 2 * node + 1]) {
            let equation = model.equations.binary_search_by_key(&dof, |e| e.dof);
            // a support replaces the equation of a dof
            let Ok(equation) = equation else { continue };
            all[dof] += force(dof);
            // a tied node may also be a term in the equations of its neighbours
            for &(to, c) in &model.equations[equation].terms {
                if slaves.contains(&(to / 2)) {
                    all[to] -= c * force(dof);
                }
            }
        }
    }
    all
}

/// Kind of mass of every node, if masses are redistributed.
pub(crate) fn node_masses(problem: &StepProblem) -> Vec<NodeMass> {
    if problem.settings.contact_mass == ContactMass::Consistent {
        return Vec::new();
    }
    let mut masses = vec![NodeMass::Own; problem.model.mesh.node_count()];
    for &node in problem.redistribution.kept() {
        masses[node] = NodeMass::Kept;
    }
    for node in problem.redistribution.massless() {
        masses[node] = NodeMass::None;
    }
    masses
}

/// Gap of a constraint at the end of the increment.
fn end_gap(problem: &StepProblem, solved: &Solved, constraint: &Constraint) -> f64 {
    let at = end_rows_at(problem, &solved.end.u);
    constraint.gap_and_scale(&at).0
}

/// A single configuration as start and end; constraints in it have the gradients of gap and slip as rows.
fn end_rows_at<'a>(problem: &'a StepProblem, u: &'a [f64]) -> Configurations<'a> {
    Configurations {
        form: RowForm::End,
        ..problem.configurations(u, u)
    }
}

/// Forces of a constraint on the slave surface of its contact. If the surface touches itself, the forces are the forces
/// on the body with the smaller number, and zero within one body.
pub(super) fn forces_on_side(
    model: &Model,
    bodies: &Bodies,
    constraint: &Constraint,
    force: [f64; 2],
) -> SmallVec<[(usize, [f64; 2]); 8]> {
    if !model.contacts[constraint.key.contact()].is_self_contact() {
        return constraint.forces_on_slave_surface(force).collect();
    }
    let body = |node: usize| bodies.of_node[node];
    let first = constraint.nodes().map(body).min().flatten();
    let is_within = constraint.nodes().all(|node| body(node) == first);
    let all = constraint.nodal_forces(force);
    all.filter(|(node, _)| !is_within && body(*node) == first)
        .collect()
}

/// Resultants of every contact in an increment from the displacements `u0`; forces act at U_theta, and moments are
/// about the origin. The distance of friction from the cone is measured with the coefficients of the law.
pub(crate) fn contact_resultants(
    problem: &StepProblem,
    bodies: &Bodies,
    solved: &Solved,
    u0: &[f64],
    interval: Interval,
) -> Vec<ContactResultant> {
    let none = ContactResultant {
        min_gap: f64::NAN,
        friction_coefficient: f64::NAN,
        ..ContactResultant::default()
    };
    let mut resultants = vec![none; problem.contacts.len()];
    let mut largest_normal = vec![0.0_f64; resultants.len()];
    let mut coefficients = vec![MeanCoefficient::default(); resultants.len()];
    for (constraint, _) in solved.contact.forces.iter() {
        let r = &mut resultants[constraint.key.contact()];
        r.min_gap = r.min_gap.min(end_gap(problem, solved, constraint));
    }
    let acting = solved.contact.forces.acting();
    let increment = (u0, &solved.d[..], interval);
    let outside = (problem.frictions).outside(problem.coordinates, increment, acting.clone());
    for ((constraint, pair), outside) in acting.zip(outside) {
        let contact = constraint.key.contact();
        let r = &mut resultants[contact];
        let [pn, pt] = constraint.normal_and_tangential(pair.force);
        for (node, [fx, fy]) in forces_on_side(problem.model, bodies, constraint, pair.force) {
            let x = problem.position(&solved.equilibrium.u_theta, node);
            r.force[0] += fx;
            r.force[1] += fy;
            r.moment += cross(x, [fx, fy]);
        }
        r.normal += pn;
        r.tangential += pt;
        r.closed += 1;
        r.sticking += usize::from(!pair.slips);
        r.cone_violation = larger(r.cone_violation, outside);
        largest_normal[contact] = larger(largest_normal[contact], pn);
        coefficients[contact].add(constraint.mu, pn);
    }
    for (r, (largest, mean)) in
        (resultants.iter_mut()).zip(largest_normal.into_iter().zip(coefficients))
    {
        r.friction_coefficient = mean.value();
        if largest > 0.0 {
            r.cone_violation /= largest;
        }
    }
    resultants
}

/// Landings of pairs that were open before and carry a force at the end, or had an impulse at the start. Time and place
/// come from the second-order motion of the start (paper eq. 50) with the exact crossing condition.
pub(crate) fn landings(
    problem: &StepProblem,
    start: &State,
    solved: &Solved,
    interval: Interval,
) -> Vec<Landing> {
    let fastest = problem.parts.largest_of_bodies(&start.v);
    let landing_of = |(constraint, pair): (&Constraint, Option<&ClosedPair>)| {
        // a motion of less than a solved gap in the increment is no approach
        let none = SOLVED_GAP * constraint.scale / interval.dt;
        let least = larger(
            STRUCK * problem.parts.most(&fastest, constraint.nodes()),
            none,
        );
        let touched = solved.contact.impulses.touches(constraint.key);
        let is_struck = || {
            let rows = constraint.at_start(&end_rows_at(problem, &start.u));
            let [before, after] = [&start.v, &solved.v0p].map(|v| rows.gap_change(v));
            before < -least && after > before + least
        };
        let was_closed = !start.contact.of_slave(constraint.key.slave()).is_empty();
        let lands = !was_closed && (pair.is_some() || (touched && is_struck()));
        lands.then(|| landing(problem, start, constraint, interval, touched))
    };
    solved
        .contact
        .forces
        .iter()
        .filter_map(landing_of)
        .collect()
}

fn landing(
    problem: &StepProblem,
    start: &State,
    constraint: &Constraint,
    interval: Interval,
    touched: bool,
) -> Landing {
    let [slave, a, b] = constraint.nearer_pair().nodes;
    let motions = [slave, a, b].map(|node| node_path(problem, &start.u, &start.v, &start.a, node));
    let of_mean = constraint.is_mean();
    let time = match of_mean {
        true => constraint.closing_time([&start.v, &start.a], interval.dt),
        false => Some(impact_time(&motions, interval.dt)),
    };
    let tau = match time.unwrap_or(interval.dt) {
        // the pair touches at the start, so its node does not cross the segment
        tau if touched && (of_mean || tau == interval.dt) => 0.0,
        tau => tau,
    };
    let [x_s, x_a, x_b] = motions.map(|m| m.at(tau));
    let p = project(x_s, x_a, x_b);
    // -e_n.(v_s - (1 - xi) v_a - xi v_b)
    let [v_s, v_a, v_b] = motions.map(|m| m.velocity_at(tau));
    let relative = |i: usize| v_s[i] - (1.0 - p.xi) * v_a[i] - p.xi * v_b[i];
    let speed = match of_mean {
        true => constraint.normal_motion(&start.v) + tau * constraint.normal_motion(&start.a),
        false => p.normal[0] * relative(0) + p.normal[1] * relative(1),
    };
    Landing {
        time: interval.start.total + tau,
        slave,
        segment: [a, b],
        xi: p.xi,
        approach_speed: -speed,
    }
}

/// Second-order motion of a node from the displacements `u`.
pub(crate) fn node_path(
    problem: &StepProblem,
    u: &[f64],
    v: &[f64],
    a: &[f64],
    node: usize,
) -> QuadraticMotion {
    let of = |v: &[f64]| [v[2 * node], v[2 * node + 1]];
    QuadraticMotion {
        position: problem.position(u, node),
        velocity: of(v),
        acceleration: of(a),
    }
}

/// First time in [0, dt] at which the node reaches the segment, or else the line of the segment, from outside; 0 if the
/// node is inside at the start, dt if it stays outside.
fn impact_time(motions: &[QuadraticMotion; 3], dt: f64) -> f64 {
    let [s, a, b] = motions.map(|m| m.position);
    if project(s, a, b).gap <= 0.0 {
        return 0.0;
    }
    let first = |found: Vec<Crossing>| {
        let from_outside = |c: &&Crossing| c.direction != CrossingSense::Leaving;
        found.iter().find(from_outside).map(|c| c.time)
    };
    first(crossings(motions, dt))
        .or_else(|| first(line_crossings(motions, dt)))
        .unwrap_or(dt)
}

/// Contact pressure |N|/A of every node, `N` entries (force/length^2), in the configuration of displacements `u`. The
/// pressure is NaN at nodes without area, and at all nodes except nodes of slave surfaces and of masters in contact
/// from surface to surface.
///
/// ```text
/// N = sum Bn^T Pn,  p = |N|/A    eq. (9.8)
/// ```
///
/// The normal force N is summed over all pairs of the node. `largest`, the largest |N| of the run so far, is updated;
/// forces below the tolerance of the passes times `largest` count as zero.
pub(crate) fn contact_pressure(
    faces: &SlaveFaces,
    problem: &StepProblem,
    u: &[f64],
    forces: &ContactForces,
    largest: &mut f64,
) -> Vec<f64> {
    let mut normal = vec![0.0; u.len()];
    for (constraint, pair) in forces.acting() {
        constraint.add_force([pair.force[0], 0.0], &mut normal);
    }
    let force_of = |node: usize| [normal[2 * node], normal[2 * node + 1]];
    let nodes = 0..faces.start.len();
    *largest = nodes
        .map(|node| length(force_of(node)))
        .fold(*largest, larger);
    let least = problem.settings.tolerance * *largest;
    let mut pressure = faces.start.clone();
    for (node, pressure) in pressure.iter_mut().enumerate() {
        let force = force_of(node);
        let size = length(force);
        if size > least {
            let area = faces.area(node, force, |node| problem.position(u, node));
            *pressure += if area > 0.0 { size / area } else { f64::NAN };
        }
    }
    pressure
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time at which a node that is thrown from the height `c`, y = a t² + b t + c, lands on a
    /// segment.
    fn landing_time(a: f64, b: f64, c: f64, dt: f64) -> f64 {
        let s = QuadraticMotion {
            position: [0.2, c],
            velocity: [0.0, b],
            acceleration: [0.0, 2.0 * a],
        };
        let rest = |x: f64| QuadraticMotion {
            position: [x, 0.0],
            ..QuadraticMotion::default()
        };
        impact_time(&[s, rest(1.0), rest(-1.0)], dt)
    }

    #[test]
    fn a_mean_of_no_force_has_the_bits_of_nan_itself() {
        let mut mean = MeanCoefficient::default();
        assert_eq!(mean.value().to_bits(), f64::NAN.to_bits());
        mean.add(0.3, 0.0);
        assert_eq!(mean.value().to_bits(), f64::NAN.to_bits());
        mean.add(0.3, 2.0);
        mean.add(0.1, 2.0);
        assert!((mean.value() - 0.2).abs() < 1e-15);
    }

    #[test]
    fn the_first_meeting_within_the_increment() {
        let near = |time: f64, expected: f64| (time - expected).abs() < 1e-14;
        assert!(near(landing_time(0.0, -2.0, 1.0, 1.0), 0.5));
        assert!(
            near(landing_time(1.0, -3.0, 2.0, 5.0), 1.0),
            "the smaller of 1 and 2"
        );
        assert!(near(landing_time(-1.0, 1.0, 2.0, 5.0), 2.0), "falling back");
        assert_eq!(landing_time(1.0, 0.0, 1.0, 3.0), 3.0, "none");
        assert_eq!(landing_time(0.0, -1.0, 4.0, 3.0), 3.0, "later");
        assert_eq!(landing_time(0.0, -1.0, -1e-9, 3.0), 0.0, "already there");
    }
}
