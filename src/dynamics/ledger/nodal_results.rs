//! Postprocessing of a converged increment: nodal quantities, resultants of the contacts and
//! landings, the latter by paper eq. 50 with the exact crossing (section 10 of docs/theory.md,
//! Crossing).

use crate::contact::{
    ContactSurfaces, Crossing, Direction, Motion, Pair, RowForm, crossings, line_crossings, project,
};
use crate::dynamics::increment::{ClosedPairs, Solved};
use crate::dynamics::results::{ContactResultant, Landing, NodalResults, NodeStatus, State};
use crate::dynamics::step::{Equilibrium, Interval, StepProblem};
use crate::lcp::ContactState;
use crate::linear::larger;
use crate::vectors::cross;

/// Change of velocity, relative to the largest velocity of the two bodies, from which an impulse is
/// an impact.
const STRUCK: f64 = 1e-9;

/// Reactions, contact forces, gaps and status at the nodes; reactions of rigid surfaces still stand
/// at the nodes of these.
pub(crate) fn nodal_results(problem: &StepProblem, solved: &Solved) -> NodalResults {
    let dofs = solved.d.len();
    let contact_force = solved.forces.resultant(dofs);
    let Equilibrium {
        load,
        internal,
        inertia,
        ..
    } = &solved.equilibrium;
    let mut reaction = vec![0.0; dofs];
    for &p in problem.unknowns.constrained() {
        reaction[p] = inertia[p] + internal[p] - load[p] - contact_force[p];
    }
    let mut results = NodalResults {
        reaction,
        contact_force,
        gap: vec![f64::NAN; dofs / 2],
        status: vec![NodeStatus::None; dofs / 2],
        ..NodalResults::default()
    };
    for (k, pair) in solved.forces.pairs.iter().enumerate() {
        let slave = pair.target.nodes[0];
        results.gap[slave] = results.gap[slave].min(end_gap(problem, solved, pair));
        let status = match (solved.forces.is_closed(k), solved.forces.state[k]) {
            (false, _) => NodeStatus::Open,
            (true, ContactState::Stick) => NodeStatus::Stick,
            (true, _) => NodeStatus::Slip,
        };
        results.status[slave] = results.status[slave].max(status);
    }
    results
}

fn end_gap(problem: &StepProblem, solved: &Solved, pair: &Pair) -> f64 {
    let u = &solved.end.u;
    Pair::new(
        pair.target,
        RowForm::End,
        &problem.model.mesh.coordinates,
        u,
        u,
    )
    .gap
}

/// Resultants of every contact; moments about the origin, forces acting at U_theta.
pub(crate) fn contact_resultants(problem: &StepProblem, solved: &Solved) -> Vec<ContactResultant> {
    let none = ContactResultant {
        min_gap: f64::NAN,
        ..ContactResultant::default()
    };
    let mut resultants = vec![none; problem.contacts.len()];
    let mut largest_normal = vec![0.0_f64; resultants.len()];
    let contact_of = contact_of_slots(problem.contacts);
    let forces = &solved.forces;
    for (k, pair) in forces.pairs.iter().enumerate() {
        let contact = contact_of[pair.target.slave_index];
        let r = &mut resultants[contact];
        r.min_gap = r.min_gap.min(end_gap(problem, solved, pair));
        if !forces.is_closed(k) {
            continue;
        }
        let (pn, pt) = (forces.normal[k], forces.tangential[k]);
        let f = [0, 1].map(|i| pair.normal[i] * pn + pair.tangent[i] * pt);
        let x = problem.position(&solved.equilibrium.u_theta, pair.target.nodes[0]);
        r.force[0] += f[0];
        r.force[1] += f[1];
        r.moment += cross(x, f);
        r.normal += pn;
        r.tangential += pt;
        r.closed += 1;
        r.sticking += usize::from(forces.state[k] == ContactState::Stick);
        r.cone_violation = larger(r.cone_violation, pt.abs() - pair.target.friction * pn);
        largest_normal[contact] = larger(largest_normal[contact], pn);
    }
    for (r, largest) in resultants.iter_mut().zip(largest_normal) {
        if largest > 0.0 {
            r.cone_violation /= largest;
        }
    }
    resultants
}

/// The contact that every slave_index belongs to.
pub(crate) fn contact_of_slots(contacts: &[ContactSurfaces]) -> Vec<usize> {
    let numbered = contacts.iter().enumerate();
    numbered
        .flat_map(|(c, surfaces)| std::iter::repeat_n(c, surfaces.slaves.len()))
        .collect()
}

/// Pairs that carry force now, or were struck at the start, and were open before: time and place
/// from the second-order motion of the start (paper eq. 50), with the exact condition of meeting.
pub(crate) fn landings(
    problem: &StepProblem,
    start: &State,
    before: &ClosedPairs,
    solved: &Solved,
    interval: Interval,
) -> Vec<Landing> {
    let forces = &solved.forces;
    let fastest = problem.parts.largest_of_bodies(&start.v);
    let landing = |k: usize| {
        let pair = &forces.pairs[k];
        let least = STRUCK * problem.parts.most(&fastest, pair.target.nodes);
        let touched = solved.touching.binary_search(&pair.target.key()).is_ok();
        let is_struck = || {
            let x = &problem.model.mesh.coordinates;
            let rows = Pair::new(pair.target, RowForm::End, x, &start.u, &start.u);
            let [before, after] = [&start.v, &solved.v0p].map(|v| rows.normal_of(v));
            before < -least && after > before + least
        };
        let lands = !before.holds(pair.target.slave_index)
            && (forces.is_closed(k) || (touched && is_struck()));
        lands.then(|| landing(problem, start, pair, interval, touched))
    };
    (0..forces.pairs.len()).filter_map(landing).collect()
}

fn landing(
    problem: &StepProblem,
    start: &State,
    pair: &Pair,
    interval: Interval,
    touched: bool,
) -> Landing {
    let [s, a, b, _] = pair.target.nodes;
    let motions = [s, a, b].map(|node| motion(problem, &start.u, &start.v, &start.a, node));
    let tau = match impact_time(&motions, interval.dt) {
        // it touches and does not meet again
        tau if touched && tau == interval.dt => 0.0,
        tau => tau,
    };
    let [s, a, b] = motions.map(|m| m.at(tau));
    let p = project(s, a, b);
    // -e_n.(v_s - (1 - xi) v_a - xi v_b)
    let [s, a, b] = motions.map(|m| m.velocity_at(tau));
    let relative = |i: usize| s[i] - (1.0 - p.xi) * a[i] - p.xi * b[i];
    Landing {
        time: interval.start.total + tau,
        slave: pair.target.nodes[0],
        segment: [pair.target.nodes[1], pair.target.nodes[2]],
        xi: p.xi,
        approach_speed: -(p.normal[0] * relative(0) + p.normal[1] * relative(1)),
    }
}

/// Second-order motion of a node from the displacements `u`.
pub(crate) fn motion(
    problem: &StepProblem,
    u: &[f64],
    v: &[f64],
    a: &[f64],
    node: usize,
) -> Motion {
    let of = |v: &[f64]| [v[2 * node], v[2 * node + 1]];
    Motion {
        position: problem.position(u, node),
        velocity: of(v),
        acceleration: of(a),
    }
}

/// First time in [0, dt] at which the node meets the segment, or else its line, from outside; 0
/// when it is not outside at the start, dt when it stays there.
fn impact_time(motions: &[Motion; 3], dt: f64) -> f64 {
    let [s, a, b] = motions.map(|m| m.position);
    if project(s, a, b).gap <= 0.0 {
        return 0.0;
    }
    let first = |found: Vec<Crossing>| {
        let from_outside = |c: &&Crossing| c.direction != Direction::Leaving;
        found.iter().find(from_outside).map(|c| c.time)
    };
    first(crossings(motions, dt))
        .or_else(|| first(line_crossings(motions, dt)))
        .unwrap_or(dt)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time at which a node thrown from the height `c`, y = a t² + b t + c, lands on a segment.
    fn landing_time(a: f64, b: f64, c: f64, dt: f64) -> f64 {
        let s = Motion {
            position: [0.2, c],
            velocity: [0.0, b],
            acceleration: [0.0, 2.0 * a],
        };
        let rest = |x: f64| Motion {
            position: [x, 0.0],
            ..Motion::default()
        };
        impact_time(&[s, rest(1.0), rest(-1.0)], dt)
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
