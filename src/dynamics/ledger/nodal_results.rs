//! Postprocessing of a converged increment: nodal quantities, resultants of the contacts and
//! landings, the latter by paper eq. 50 with the exact crossing (section 10 of docs/theory.md,
//! Crossing).
//!
//! Contact pressure at slave nodes: normal force over the area of a node.

use std::collections::BTreeSet;

use crate::contact::{
    ClosedPair, Configurations, Constraint, Crossing, Direction, Motion, RowForm, crossings,
    line_crossings, project,
};
use crate::dynamics::increment::{ContactForces, Solved};
use crate::dynamics::results::{
    ContactResultant, Landing, NodalResults, NodeMass, NodeStatus, State,
};
use crate::dynamics::step::{Equilibrium, Interval, StepProblem};
use crate::lcp::ContactState;
use crate::linear::larger;
use crate::model::{ContactMass, Face, Model, Segment, SurfaceKind};
use crate::vectors::cross;

/// Change of velocity, relative to the largest velocity of the two bodies, from which an impulse is
/// an impact.
const STRUCK: f64 = 1e-9;

/// Reactions, contact forces, gaps and status at the nodes; reactions of rigid surfaces are still at
/// their own nodes.
pub(crate) fn nodal_results(problem: &StepProblem, solved: &Solved) -> NodalResults {
    let dofs = solved.d.len();
    let contact_force = solved.contact.forces.resultant(dofs);
    let Equilibrium {
        load,
        internal,
        inertia,
        ..
    } = &solved.equilibrium;
    // M A + F - R - B^T P at the supports, with what equations pass on to them, eq. (9.12)
    let missing = |p: usize| inertia[p] + internal[p] - load[p] - contact_force[p];
    let mut missing: Vec<f64> = (0..dofs).map(missing).collect();
    let tie_force = tie_forces(problem.model, |dof| missing[dof]);
    let turning = &problem.unknowns.turning;
    turning.hand_over([&solved.end.u, &solved.d], false, &mut missing);
    let passed_on = problem.unknowns.passed_on(&missing);
    let mut reaction = vec![0.0; dofs];
    for p in problem.unknowns.prescribed() {
        reaction[p] = passed_on[p];
    }
    let mut results = NodalResults {
        reaction,
        contact_force,
        tie_force,
        gap: vec![f64::NAN; dofs / 2],
        status: vec![NodeStatus::None; dofs / 2],
        mass: node_masses(problem),
        ..NodalResults::default()
    };
    for (constraint, pair) in solved.contact.forces.iter() {
        let gap = end_gap(problem, solved, constraint);
        let status = match pair.map(|pair| pair.state) {
            None => NodeStatus::Open,
            Some(ContactState::Stick) => NodeStatus::Stick,
            Some(_) => NodeStatus::Slip,
        };
        for slave in constraint.slave_nodes() {
            results.gap[slave] = results.gap[slave].min(gap);
            results.status[slave] = results.status[slave].max(status);
        }
    }
    results
}

/// What of the forces of constraints on the dofs is that of ties; none where there are no ties.
pub(crate) fn tie_forces(model: &Model, force: impl Fn(usize) -> f64) -> Vec<f64> {
    if model.ties.is_empty() {
        return Vec::new();
    }
    let mut all = vec![0.0; model.dof_count()];
    for tied in model.ties.iter().flat_map(|tie| &tie.nodes) {
        for dof in [2 * tied.node, 2 * tied.node + 1] {
            // a support takes the place of an equation
            if model
                .equations
                .binary_search_by_key(&dof, |e| e.dof)
                .is_ok()
            {
                all[dof] = force(dof);
            }
        }
    }
    all
}

/// Masses of the nodes, where they are redistributed.
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
    constraint.relinearized(&at).gap
}

/// One configuration, with the gradients of gap and slip as rows.
fn end_rows_at<'a>(problem: &'a StepProblem, u: &'a [f64]) -> Configurations<'a> {
    Configurations {
        form: RowForm::End,
        ..problem.configurations(u, u)
    }
}

/// Resultants of every contact; moments about the origin, forces acting at U_theta.
pub(crate) fn contact_resultants(problem: &StepProblem, solved: &Solved) -> Vec<ContactResultant> {
    let none = ContactResultant {
        min_gap: f64::NAN,
        ..ContactResultant::default()
    };
    let mut resultants = vec![none; problem.contacts.len()];
    let mut largest_normal = vec![0.0_f64; resultants.len()];
    for (constraint, pair) in solved.contact.forces.iter() {
        let contact = constraint.key.contact();
        let r = &mut resultants[contact];
        r.min_gap = r.min_gap.min(end_gap(problem, solved, constraint));
        let Some(pair) = pair else { continue };
        let [pn, pt] = pair.force;
        for (node, [fx, fy]) in constraint.slave_forces(pair.force) {
            let x = problem.position(&solved.equilibrium.u_theta, node);
            r.force[0] += fx;
            r.force[1] += fy;
            r.moment += cross(x, [fx, fy]);
        }
        r.normal += pn;
        r.tangential += pt;
        r.closed += 1;
        r.sticking += usize::from(pair.state == ContactState::Stick);
        r.cone_violation = larger(r.cone_violation, pt.abs() - constraint.mu * pn);
        largest_normal[contact] = larger(largest_normal[contact], pn);
    }
    for (r, largest) in resultants.iter_mut().zip(largest_normal) {
        if largest > 0.0 {
            r.cone_violation /= largest;
        }
    }
    resultants
}

/// Pairs that carry force now, or were struck at the start, and were open before: time and place
/// from the second-order motion of the start (paper eq. 50), with the exact condition of crossing.
pub(crate) fn landings(
    problem: &StepProblem,
    start: &State,
    solved: &Solved,
    interval: Interval,
) -> Vec<Landing> {
    let fastest = problem.parts.largest_of_bodies(&start.v);
    let landing_of = |(constraint, pair): (&Constraint, Option<&ClosedPair>)| {
        let least = STRUCK * problem.parts.most(&fastest, constraint.nodes());
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
    let motions = [slave, a, b].map(|node| motion(problem, &start.u, &start.v, &start.a, node));
    let tau = match impact_time(&motions, interval.dt) {
        // it touches at the start and does not cross
        tau if touched && tau == interval.dt => 0.0,
        tau => tau,
    };
    let [x_s, x_a, x_b] = motions.map(|m| m.at(tau));
    let p = project(x_s, x_a, x_b);
    // -e_n.(v_s - (1 - xi) v_a - xi v_b)
    let [v_s, v_a, v_b] = motions.map(|m| m.velocity_at(tau));
    let relative = |i: usize| v_s[i] - (1.0 - p.xi) * v_a[i] - p.xi * v_b[i];
    Landing {
        time: interval.start.total + tau,
        slave,
        segment: [a, b],
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

/// First time in [0, dt] at which the node reaches the segment, or else its line, from outside; 0
/// when it is inside at the start, dt when it stays outside.
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

/// A segment of a face on which slave nodes take pressure.
struct SlaveFace {
    nodes: Segment,
    /// Which of its two nodes take it.
    counts: [bool; 2],
    thickness: f64,
}

/// The slave nodes of all contacts with their faces.
pub(crate) struct SlaveFaces {
    /// 0 at slave nodes, NaN at others, `N` entries.
    pub start: Vec<f64>,
    faces: Vec<SlaveFace>,
}

impl SlaveFaces {
    /// Faces of the slave surfaces; slave nodes without such a face take the exterior faces of their
    /// elements.
    pub fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        let (mut start, mut own) = (vec![f64::NAN; mesh.node_count()], BTreeSet::new());
        for contact in &model.contacts {
            let slave = &model.surfaces[contact.slave];
            if let SurfaceKind::Faces(faces) = &slave.kind {
                own.extend(faces.iter().copied());
            }
            for node in slave.nodes(mesh) {
                start[node] = 0.0;
            }
        }
        let mut is_bare: Vec<bool> = start.iter().map(|start| !start.is_nan()).collect();
        for node in own.iter().flat_map(|face| face.nodes(mesh)) {
            is_bare[node] = false;
        }
        let slave_faces = |face: &Face, counts: &dyn Fn(usize) -> bool| -> Vec<SlaveFace> {
            let of_segment = |nodes: Segment| SlaveFace {
                nodes,
                counts: nodes.map(counts),
                thickness: thickness(model, face),
            };
            face.segments(mesh).into_iter().map(of_segment).collect()
        };
        let mut faces: Vec<SlaveFace> = (own.iter())
            .flat_map(|face| slave_faces(face, &|_| true))
            .collect();
        if is_bare.contains(&true) {
            let exterior = mesh.exterior_faces().into_iter();
            let bare = exterior.flat_map(|face| slave_faces(&face, &|node| is_bare[node]));
            faces.extend(bare.filter(|face| face.counts.contains(&true)));
        }
        SlaveFaces { start, faces }
    }

    /// Pressure |N| / A of every node, `N` entries (force/length^2), in the configuration of
    /// displacements `u`; NaN without area, and at all nodes but slave nodes.
    ///
    /// ```text
    /// N = sum Bn^T Pn,  A = sum over the faces max(-n.N/|N|, 0) t l/2,  p = |N|/A    eq. (9.8)
    /// ```
    ///
    /// The sum of N runs over all pairs of the node; n, l and t are outward normal, current length
    /// and thickness of a face.
    pub fn pressure(&self, problem: &StepProblem, u: &[f64], forces: &ContactForces) -> Vec<f64> {
        let mut pressure = self.start.clone();
        let mut normal = vec![0.0; u.len()];
        for (constraint, pair) in forces.acting() {
            constraint.add_force([pair.force[0], 0.0], &mut normal);
        }
        let of_node = |node: usize| [normal[2 * node], normal[2 * node + 1]];
        let size = |[x, y]: [f64; 2]| x.hypot(y);
        let mut area = vec![0.0; pressure.len()];
        for face in &self.faces {
            let [a, b] = face.nodes.map(|node| problem.position(u, node));
            // n l = (e_y, -e_x): on the right of the direction from a to b
            let e = [b[0] - a[0], b[1] - a[1]];
            for (node, _) in (face.nodes.iter().zip(face.counts)).filter(|(_, counts)| *counts) {
                let force = of_node(*node);
                let against = force[1] * e[0] - force[0] * e[1];
                if against > 0.0 {
                    area[*node] += face.thickness * against / size(force) / 2.0;
                }
            }
        }
        for (node, pressure) in pressure.iter_mut().enumerate() {
            let force = size(of_node(node));
            if force > 0.0 {
                *pressure += if area[node] > 0.0 {
                    force / area[node]
                } else {
                    f64::NAN
                };
            }
        }
        pressure
    }
}

fn thickness(model: &Model, face: &Face) -> f64 {
    let section = model.mesh.elements[face.element].section;
    model.sections[section].thickness
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
