//! Work, impulses and slip of every contact since the start, section 9 of docs/theory.md.

use super::nodal_results::contact_of_slots;
use crate::contact::{ContactSurfaces, Pair};
use crate::dynamics::increment::Solved;
use crate::dynamics::results::{ContactImpulse, ContactOnBody, ContactResultant};
use crate::dynamics::step::StepProblem;
use crate::model::{Bodies, Model};
use crate::vectors::cross;

/// Sums over the run of one contact.
#[derive(Clone, Copy, Default)]
struct Sums {
    normal_work: f64,
    friction_dissipation: f64,
    impulse: ContactImpulse,
}

/// Sums over the run of every contact, and the accumulated slip of every slave node.
pub(crate) struct ContactLedger {
    contacts: Vec<Sums>,
    /// `N` entries; NaN at nodes that are no slave nodes.
    pub slip: Vec<f64>,
    /// Contact of every slave_index.
    contact_of: Vec<usize>,
    /// Reference node of every contact whose master is a rigid surface.
    reference: Vec<Option<usize>>,
}

impl ContactLedger {
    /// Opens the ledger; `slip` is the slip of every node accumulated so far.
    pub fn new(model: &Model, surfaces: &[ContactSurfaces], slip: Vec<f64>) -> Self {
        let reference = |master: usize| {
            let mut bodies = model.rigid_bodies.iter();
            bodies.find(|body| body.surface == master)
        };
        ContactLedger {
            contacts: vec![Sums::default(); surfaces.len()],
            slip,
            contact_of: contact_of_slots(surfaces),
            reference: (model.contacts.iter())
                .map(|contact| reference(contact.master).map(|body| body.reference))
                .collect(),
        }
    }

    /// Enters a converged increment of length `dt` and completes the resultants of the contacts.
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        bodies: &Bodies,
        solved: &Solved,
        dt: f64,
        resultants: &mut [ContactResultant],
    ) {
        self.slide(solved);
        let u = &solved.equilibrium.u_theta;
        for (contact, result) in problem.model.contacts.iter().zip(resultants.iter_mut()) {
            if contact.is_self_contact() {
                result.bodies = vec![ContactOnBody::default(); bodies.count];
            }
        }
        let forces = &solved.forces;
        for (k, pair) in forces.pairs.iter().enumerate() {
            if !forces.is_closed(k) {
                continue;
            }
            let contact = self.contact_of[pair.target.slave_index];
            let [pn, pt] = [forces.normal[k], forces.tangential[k]];
            // Pn.(Bn d) and -Pt.(Bt d)
            let sums = &mut self.contacts[contact];
            sums.normal_work += pn * pair.normal_of(&solved.d);
            sums.friction_dissipation -= pt * pair.tangent_of(&solved.d);
            let result = &mut resultants[contact];
            result.impulse.add(pair, [dt * pn, dt * pt]);
            if !result.bodies.is_empty() {
                let position = |node| problem.position(u, node);
                add_to_bodies(bodies, position, pair, [pn, pt], &mut result.bodies);
            }
        }
        let impacts = &solved.impulses;
        for (k, pair) in impacts.pairs.iter().enumerate() {
            let impulse = &mut resultants[self.contact_of[pair.target.slave_index]].impulse;
            let [phi, psi] = [impacts.normal[k], impacts.tangential[k]];
            impulse.add(pair, [phi, psi]);
            impulse.impact_normal += phi;
            impulse.impact_tangential += psi;
        }
        for (c, result) in resultants.iter_mut().enumerate() {
            let sums = &mut self.contacts[c];
            sums.impulse.sum(&result.impulse);
            result.impulse_sum = sums.impulse;
            result.normal_work = sums.normal_work;
            result.friction_dissipation = sums.friction_dissipation;
            if let Some(node) = self.reference[c] {
                let x = problem.position(u, node);
                result.reference_moment = result.moment - cross(x, result.force);
            }
        }
    }

    /// Adds |Bt d| of the closed pairs to the slip of their slave nodes; of several pairs of a node
    /// the largest.
    fn slide(&mut self, solved: &Solved) {
        let forces = &solved.forces;
        let mut increments = vec![0.0_f64; self.slip.len()];
        for (k, pair) in forces.pairs.iter().enumerate() {
            if forces.is_closed(k) {
                let slip = &mut increments[pair.target.nodes[0]];
                *slip = slip.max(pair.tangent_of(&solved.d).abs());
            }
        }
        for (slip, increment) in self.slip.iter_mut().zip(increments) {
            *slip += increment;
        }
    }
}

impl ContactImpulse {
    /// Adds the normal and tangential impulse of a pair.
    fn add(&mut self, pair: &Pair, [normal, tangential]: [f64; 2]) {
        for i in 0..2 {
            self.vector[i] += pair.normal[i] * normal + pair.tangent[i] * tangential;
        }
        self.normal += normal;
        self.tangential += tangential;
    }

    /// Adds the impulses of another increment.
    fn sum(&mut self, other: &ContactImpulse) {
        for i in 0..2 {
            self.vector[i] += other.vector[i];
        }
        self.normal += other.normal;
        self.tangential += other.tangential;
        self.impact_normal += other.impact_normal;
        self.impact_tangential += other.impact_tangential;
    }
}

/// Adds the forces [Pn, Pt] of a pair to those on the bodies of its nodes; moments about the origin
/// with the nodes at their `position`.
fn add_to_bodies(
    bodies: &Bodies,
    position: impl Fn(usize) -> [f64; 2],
    pair: &Pair,
    [pn, pt]: [f64; 2],
    results: &mut [ContactOnBody],
) {
    for (k, &node) in pair.target.nodes.iter().enumerate() {
        let Some(body) = bodies.of_node[node] else {
            continue;
        };
        let x = position(node);
        let [fx, fy] = [2 * k, 2 * k + 1].map(|i| pair.normal[i] * pn + pair.tangent[i] * pt);
        let result = &mut results[body];
        result.force[0] += fx;
        result.force[1] += fy;
        result.moment += cross(x, [fx, fy]);
    }
}
