//! Motion and energies of every body; see docs/theory/impacts.md, Ledger.
//!
//! Resultant reactions of rigid surfaces at their reference nodes. See docs/theory/impacts.md, Ledger.

use crate::dynamics::results::{BodyResult, Momentum, RigidReaction, State};
use crate::dynamics::step::{Mass, StepProblem, TurningBody};
use crate::elements::ElementResult;
use crate::model::{Bodies, Model};
use crate::vectors::dot;

/// Masses of the bodies of a model, constant over a run.
pub(crate) struct BodyMasses {
    pub bodies: Bodies,
    /// Turning bodies with elements: number of the body, centre of mass and moment of inertia about the centre of mass.
    turning: Vec<(usize, usize, f64)>,
    /// Mass of every body.
    mass: Vec<f64>,
    /// Row sums of the consistent mass matrix, `N` entries: int rho h_a dOmega.
    share: Vec<f64>,
}

/// Displacement and velocity of the nodes, their momentum p = M V, and the results of the elements.
pub(crate) struct Moving<'a> {
    pub u: &'a [f64],
    pub v: &'a [f64],
    pub p: &'a [f64],
    pub elements: &'a [ElementResult],
}

impl BodyMasses {
    /// Masses of the bodies of a model.
    pub fn new(model: &Model, mass: &Mass, turning: &[TurningBody]) -> Self {
        let bodies = Bodies::new(&model.mesh);
        let with_elements = model.rigid_bodies.iter().zip(turning);
        let turning = with_elements.filter_map(|(rigid, turning)| {
            let element = *rigid.elements.first()?;
            Some((bodies.of_element[element], turning.centre, turning.inertia))
        });
        let mut masses = BodyMasses {
            turning: turning.collect(),
            mass: vec![0.0; bodies.count],
            share: mass.shares.clone(),
            bodies,
        };
        let mut of_body = std::mem::take(&mut masses.mass);
        for (node, body) in masses.nodes() {
            of_body[body] += masses.share[node];
        }
        BodyMasses {
            mass: of_body,
            ..masses
        }
    }

    /// Motion and energies of every body, without contact forces.
    ///
    /// ```text
    /// x_c = sum_a m_a x_a / m,  v_c = sum_a p_a / m,  r_a = x_a - x_c
    /// H = sum_a r_a x p_a,  I = sum_ab r_a.M_ab r_b,  omega = H / I     eq. (9.7)
    /// ```
    ///
    /// Here p = M v with the consistent mass, m_a are the row sums of M, and positions are current positions.
    pub fn results(&self, problem: &StepProblem, moving: &Moving) -> Vec<BodyResult> {
        let Moving { u, v, p, elements } = *moving;
        let centers = self.centers(problem, u);
        let mut results: Vec<BodyResult> = (centers.iter())
            .map(|&center| BodyResult {
                center,
                ..BodyResult::default()
            })
            .collect();
        let mut arms = vec![0.0; u.len()];
        for (node, body) in self.nodes() {
            let (x, c) = (problem.position(u, node), centers[body]);
            let (i, j) = (2 * node, 2 * node + 1);
            (arms[i], arms[j]) = (x[0] - c[0], x[1] - c[1]);
            let result = &mut results[body];
            result.velocity[0] += p[i];
            result.velocity[1] += p[j];
            result.angular_velocity += arms[i] * p[j] - arms[j] * p[i];
            result.kinetic += (v[i] * p[i] + v[j] * p[j]) / 2.0;
        }
        let mut inertia = self.moments_of_inertia(problem, &arms);
        // I and omega of the bodies that turn, about their own centres of mass
        for &(body, centre, own) in &self.turning {
            let spin = 2 * (centre + 1);
            let omega = v[spin] / own_length(problem, spin);
            results[body].angular_velocity += own * omega;
            results[body].kinetic += own * omega * omega / 2.0;
            inertia[body] += own;
        }
        for (body, result) in results.iter_mut().enumerate() {
            result.velocity = result.velocity.map(|p| p / self.mass[body]);
            result.angular_velocity /= inertia[body];
        }
        for (&body, element) in self.bodies.of_element.iter().zip(elements) {
            results[body].strain += element.energy;
        }
        if problem.model.mesh.is_axisymmetric() {
            results.iter_mut().for_each(BodyResult::keep_to_axis);
        }
        results
    }

    /// Adds the contact forces on the nodes (2 N entries), which act in the configuration of
    /// displacements `u`; moments are about the centres of mass.
    pub fn add_contact(
        &self,
        problem: &StepProblem,
        u: &[f64],
        force: &[f64],
        results: &mut [BodyResult],
    ) {
        let centers = self.centers(problem, u);
        for (node, body) in self.nodes() {
            let (x, c) = (problem.position(u, node), centers[body]);
            let [fx, fy] = [force[2 * node], force[2 * node + 1]];
            let result = &mut results[body];
            result.contact_force[0] += fx;
            result.contact_force[1] += fy;
            result.contact_moment += (x[0] - c[0]) * fy - (x[1] - c[1]) * fx;
        }
        if problem.model.mesh.is_axisymmetric() {
            results.iter_mut().for_each(BodyResult::keep_to_axis);
        }
    }

    /// Nodes that belong to a body, each with its body.
    fn nodes(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let numbered = self.bodies.of_node.iter().enumerate();
        let centres = self.turning.iter().map(|&(body, centre, _)| (centre, body));
        numbered
            .filter_map(|(node, body)| Some((node, (*body)?)))
            .chain(centres)
    }

    /// Centres of mass of the bodies.
    fn centers(&self, problem: &StepProblem, u: &[f64]) -> Vec<[f64; 2]> {
        let mut centers = vec![[0.0; 2]; self.bodies.count];
        for (node, body) in self.nodes() {
            let x = problem.position(u, node);
            for i in 0..2 {
                centers[body][i] += self.share[node] * x[i];
            }
        }
        for (center, mass) in centers.iter_mut().zip(&self.mass) {
            *center = center.map(|sum| sum / mass);
        }
        centers
    }

    /// Moments of inertia of the bodies about their centres of mass, from the arms of the nodes (2
    /// N entries).
    fn moments_of_inertia(&self, problem: &StepProblem, arms: &[f64]) -> Vec<f64> {
        let weighted = problem.mass.times(arms);
        let mut inertia = vec![0.0; self.bodies.count];
        for (node, body) in self.nodes() {
            let (i, j) = (2 * node, 2 * node + 1);
            inertia[body] += arms[i] * weighted[i] + arms[j] * weighted[j];
        }
        inertia
    }
}

/// Length by which the rotation dof of a turning body must be divided to give the body's angle.
fn own_length(problem: &StepProblem, spin: usize) -> f64 {
    let mut bodies = problem.unknowns.turning.bodies.iter();
    bodies
        .find(|body| body.spin == spin)
        .map_or(1.0, |body| body.length)
}

/// Linear momentum sum p and angular momentum sum x cross p about the origin of all bodies, with p = M V. For bodies of
/// revolution only the momentum along the axis is given; the other components are zero.
pub(crate) fn momentum(problem: &StepProblem, u: &[f64], p: &[f64]) -> Momentum {
    let mut momentum = Momentum::default();
    let bodies = problem.unknowns.turning.bodies.iter();
    // I omega is L times the momentum that belongs to s = L c
    bodies.for_each(|body| momentum.angular += body.length * p[body.spin]);
    let centres = problem
        .unknowns
        .turning
        .bodies
        .iter()
        .map(|body| body.centre);
    for node in (0..problem.model.mesh.node_count()).chain(centres) {
        let position = problem.position(u, node);
        let [px, py] = [p[2 * node], p[2 * node + 1]];
        momentum.linear[0] += px;
        momentum.linear[1] += py;
        momentum.angular += position[0] * py - position[1] * px;
    }
    if problem.model.mesh.is_axisymmetric() {
        (momentum.linear[0], momentum.angular) = (0.0, 0.0);
    }
    momentum
}

/// The motion of the rigid bodies, and the forces `reaction` at their reference nodes and angles, which include the
/// forces that nodes hand over to them, eq. (9.9).
pub(crate) fn rigid_reactions(
    problem: &StepProblem,
    state: &State,
    reaction: &[f64],
) -> Vec<RigidReaction> {
    let of_body = |own: &TurningBody| {
        let v = [0, 1].map(|i| state.v[2 * own.centre + i]);
        let angular_velocity = state.v[own.spin] / own.length;
        RigidReaction {
            force: [0, 1].map(|i| reaction[2 * own.reference + i]),
            moment: reaction[own.spin] * own.length,
            angle: state.u[own.spin] / own.length,
            angular_velocity,
            center: problem.position(&state.u, own.centre),
            kinetic: (own.mass * dot(v, v) + own.inertia * angular_velocity.powi(2)) / 2.0,
        }
    };
    let bodies = problem.unknowns.turning.bodies.iter();
    bodies.map(of_body).collect()
}
