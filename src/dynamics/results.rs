use super::increment::Solved;
use super::step_problem::{Equilibrium, Interval, StepProblem};
use super::{ContactResultant, Landing, NodalResults, NodeStatus, State};
use crate::contact::{Pair, project};
use crate::lcp::ContactState;

/// Reactions, contact forces, gaps and status at the nodes.
pub(super) fn nodal_results(problem: &StepProblem, solved: &Solved) -> NodalResults {
    let dofs = solved.d.len();
    let contact_force = solved.forces.resultant(dofs);
    let Equilibrium {
        load,
        internal,
        inertia,
        ..
    } = &solved.equilibrium;
    let mut reaction = vec![0.0; dofs];
    for p in problem.supports.dofs() {
        reaction[p] = inertia[p] + internal[p] - load[p] - contact_force[p];
    }
    let mut results = NodalResults {
        reaction,
        contact_force,
        gap: vec![f64::NAN; dofs / 2],
        status: vec![NodeStatus::None; dofs / 2],
    };
    for (k, pair) in solved.forces.pairs.iter().enumerate() {
        let slave = pair.nodes[0];
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
    let [s, a, b] = pair.nodes.map(|node| problem.position(&solved.end.u, node));
    project(s, a, b).gap
}

/// Resultants of every contact; moments about the origin, forces acting at U_theta.
pub(super) fn contact_resultants(problem: &StepProblem, solved: &Solved) -> Vec<ContactResultant> {
    let none = ContactResultant {
        min_gap: f64::NAN,
        ..ContactResultant::default()
    };
    let mut resultants = vec![none; problem.contacts.len()];
    let mut largest_normal = vec![0.0_f64; resultants.len()];
    let contact_of = contact_of_slots(problem);
    let forces = &solved.forces;
    for (k, pair) in forces.pairs.iter().enumerate() {
        let contact = contact_of[pair.slot];
        let r = &mut resultants[contact];
        r.min_gap = r.min_gap.min(end_gap(problem, solved, pair));
        if !forces.is_closed(k) {
            continue;
        }
        let (pn, pt) = (forces.normal[k], forces.tangential[k]);
        let f = [0, 1].map(|i| pair.normal[i] * pn + pair.tangent[i] * pt);
        let x = problem.position(&solved.equilibrium.u_theta, pair.nodes[0]);
        r.force[0] += f[0];
        r.force[1] += f[1];
        r.moment += x[0] * f[1] - x[1] * f[0];
        r.normal += pn;
        r.tangential += pt;
        r.closed += 1;
        r.sticking += usize::from(forces.state[k] == ContactState::Stick);
        r.cone_violation = r.cone_violation.max(pt.abs() - pair.friction * pn);
        largest_normal[contact] = largest_normal[contact].max(pn);
    }
    for (r, largest) in resultants.iter_mut().zip(largest_normal) {
        if largest > 0.0 {
            r.cone_violation /= largest;
        }
    }
    resultants
}

fn contact_of_slots(problem: &StepProblem) -> Vec<usize> {
    let of_contact = |(c, surfaces): (usize, &crate::contact::ContactSurfaces)| {
        std::iter::repeat_n(c, surfaces.slaves.len())
    };
    problem
        .contacts
        .iter()
        .enumerate()
        .flat_map(of_contact)
        .collect()
}

/// Pairs that carry force now and were open before: time and place from the second-order motion
/// of the start (paper eq. 50).
pub(super) fn landings(
    problem: &StepProblem,
    start: &State,
    before: &[ContactState],
    solved: &Solved,
    interval: Interval,
) -> Vec<Landing> {
    let forces = &solved.forces;
    (0..forces.pairs.len())
        .filter(|&k| forces.is_closed(k) && !before[forces.pairs[k].slot].is_closed())
        .map(|k| landing(problem, start, &forces.pairs[k], interval))
        .collect()
}

fn landing(problem: &StepProblem, start: &State, pair: &Pair, interval: Interval) -> Landing {
    let at = |tau: f64| {
        pair.nodes.map(|node| {
            let x = problem.model.mesh.coordinates[node];
            [0, 1].map(|i| {
                let dof = 2 * node + i;
                x[i] + start.u[dof] + (start.v[dof] + start.a[dof] * tau / 2.0) * tau
            })
        })
    };
    let [s, a, b] = at(0.0);
    let p = project(s, a, b);
    // e_n.(w_s - (1 - xi) w_a - xi w_b)
    let relative = |w: &[f64]| {
        let [s, a, b] = pair.nodes;
        (0..2)
            .map(|i| {
                let on_segment = (1.0 - p.xi) * w[2 * a + i] + p.xi * w[2 * b + i];
                p.normal[i] * (w[2 * s + i] - on_segment)
            })
            .sum::<f64>()
    };
    let (rate, acceleration) = (relative(&start.v), relative(&start.a));
    let tau = first_root(acceleration / 2.0, rate, p.gap, interval.dt);
    let [s, a, b] = at(tau);
    Landing {
        time: interval.start.total + tau,
        slave: pair.nodes[0],
        segment: [pair.nodes[1], pair.nodes[2]],
        xi: project(s, a, b).xi,
        approach_speed: -(rate + acceleration * tau),
    }
}

/// Smallest root of a tau² + b tau + c in [0, dt]; 0 when c <= 0, dt when there is none.
fn first_root(a: f64, b: f64, c: f64, dt: f64) -> f64 {
    if c <= 0.0 {
        return 0.0;
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return dt;
    }
    // 2c/(-b + sqrt) is the stable form of the smaller root when b < 0; when b >= 0 and a < 0 it
    // is the only positive one.
    let root = 2.0 * c / (-b + discriminant.sqrt());
    if root > 0.0 { root.min(dt) } else { dt }
}

#[cfg(test)]
mod tests {
    use super::first_root;

    #[test]
    fn the_first_root_within_the_increment() {
        assert_eq!(first_root(0.0, -2.0, 1.0, 1.0), 0.5);
        assert_eq!(
            first_root(1.0, -3.0, 2.0, 5.0),
            1.0,
            "the smaller of 1 and 2"
        );
        assert_eq!(first_root(-1.0, 1.0, 2.0, 5.0), 2.0, "falling back");
        assert_eq!(first_root(1.0, 0.0, 1.0, 3.0), 3.0, "none");
        assert_eq!(first_root(0.0, -1.0, 4.0, 3.0), 3.0, "later");
        assert_eq!(first_root(0.0, -1.0, -1e-9, 3.0), 0.0, "already there");
    }
}
