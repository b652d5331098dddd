//! Work, impulses and slip of every contact since the start; see docs/theory/impacts.md, Ledger.
//!
//! Errors of the pairs against the contact law at the end of a converged increment. See
//! docs/theory/complementarity.md, Problem of a pass.

use std::collections::BTreeMap;

use super::nodal_results::{MasterMeans, forces_on_side};
use super::pair_work::{PairWork, given_back};
use crate::archive::{Archive, ArchiveError};
use crate::contact::{ClosedPair, Constraint, ConstraintKey, Search, crossed_edges, sunk_nodes};
use crate::dynamics::increment::{PairReturn, Solved};
use crate::dynamics::results::{
    ContactImpulse, ContactOnBody, ContactResultant, ContactViolation, ReturnedImpulse, State,
};
use crate::dynamics::step::{Interval, StepProblem};
use crate::linear::larger;
use crate::model::{Bodies, Model};
use crate::vectors::cross;

/// Sums over the run of one contact.
#[derive(Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
struct Sums {
    normal_work: f64,
    handover_work: f64,
    friction_dissipation: f64,
    /// Sum of normal force times sliding path of the pairs (energy).
    sliding: f64,
    landing_return: f64,
    release_loss: f64,
    impulse: ContactImpulse,
}

/// Sums over the run of every contact, and the accumulated slip of every slave node.
pub(crate) struct ContactLedger {
    contacts: Vec<Sums>,
    /// Slip of every node, `N` entries; NaN at nodes that are not slave nodes.
    pub slip: Vec<f64>,
    /// Reference node of every contact whose master is a rigid surface.
    reference: Vec<Option<usize>>,
}

impl ContactLedger {
    /// Opens the ledger; `slip` is the accumulated slip of every node.
    pub fn new(model: &Model, slip: Vec<f64>) -> Self {
        let reference = |master: usize| {
            let mut bodies = model.rigid_bodies.iter();
            bodies.find(|body| body.has_surface(master))
        };
        ContactLedger {
            contacts: vec![Sums::default(); model.contacts.len()],
            slip,
            reference: (model.contacts.iter())
                .map(|contact| reference(contact.master).map(|body| body.reference))
                .collect(),
        }
    }

    /// Transfers the sums and slips to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let Self {
            contacts,
            slip,
            reference: _,
        } = self;
        archive.transfer_values(contacts)?;
        archive.transfer_values(slip)
    }

    /// Enters a converged increment of length `dt` and completes the resultants of the contacts.
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        bodies: &Bodies,
        solved: &Solved,
        works: &[PairWork],
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
        for work in works {
            let sums = &mut self.contacts[work.key.contact()];
            sums.normal_work += work.normal;
            sums.friction_dissipation += work.friction;
            sums.sliding += work.sliding;
        }
        for (constraint, pair) in solved.contact.forces.acting() {
            let contact = pair.key.contact();
            let result = &mut resultants[contact];
            let impulse = pair.force.map(|p| dt * p);
            let on_side = forces_on_side(problem.model, bodies, constraint, impulse);
            let both = constraint.normal_and_tangential(impulse);
            result.impulse.add(both, on_side);
            if !result.bodies.is_empty() {
                let forces = constraint.nodal_forces(pair.force);
                add_to_bodies(problem, bodies, u, forces, &mut result.bodies);
            }
        }
        for (constraint, pair) in solved.contact.impulses.acting() {
            let impulse = &mut resultants[pair.key.contact()].impulse;
            let on_side = forces_on_side(problem.model, bodies, constraint, pair.force);
            let [phi, psi] = constraint.normal_and_tangential(pair.force);
            impulse.add([phi, psi], on_side);
            impulse.impact_normal += phi;
            impulse.impact_tangential += psi;
        }
        for (c, result) in resultants.iter_mut().enumerate() {
            let sums = &mut self.contacts[c];
            sums.impulse.sum(&result.impulse);
            result.impulse_sum = sums.impulse;
            result.normal_work = sums.normal_work;
            sums.handover_work += result.handover_work;
            result.handover_work = sums.handover_work;
            result.friction_dissipation = sums.friction_dissipation;
            result.landing_return = sums.landing_return;
            result.release_loss = sums.release_loss;
            if let Some(node) = self.reference[c] {
                let x = problem.position(u, node);
                result.reference_moment = result.moment - cross(x, result.force);
            }
        }
    }

    /// For every contact the energy that friction has dissipated, and the sum of normal force times sliding path of the
    /// pairs.
    pub fn slid(&self) -> impl Iterator<Item = (f64, f64)> {
        let sums = self.contacts.iter();
        sums.map(|sums| (sums.friction_dissipation, sums.sliding))
    }

    /// Enters the landing and release returns of an increment; the increment itself must be entered later. Returns the
    /// total impulses of the pairs with returns.
    pub fn enter_returns(
        &mut self,
        model: &Model,
        bodies: &Bodies,
        solved: &Solved,
        interval: Interval,
        resultants: &mut [ContactResultant],
    ) -> Vec<ReturnedImpulse> {
        let totals = match solved.returned.pairs.is_empty() {
            true => Totals::new(),
            false => total_impulses(solved, interval.dt),
        };
        for pair in &solved.returned.pairs {
            let contact = pair.key.contact();
            self.contacts[contact].landing_return += pair.energy;
            self.contacts[contact].friction_dissipation -= pair.friction;
            let constraint = totals.get(&pair.key).map(|(constraint, _)| *constraint);
            let side = constraint.map_or(1.0, |c| side_of_slave(model, bodies, c));
            resultants[contact].impulse.add_return(pair, side);
        }
        for work in given_back(solved) {
            self.contacts[work.key.contact()].sliding += work.sliding;
        }
        for (key, loss) in solved.returned.release.losses() {
            self.contacts[key.contact()].release_loss += loss;
        }
        if solved.returned.pairs.is_empty() {
            return Vec::new();
        }
        Self::measure_cones(&totals, resultants);
        let total = |pair: &PairReturn| {
            let (constraint, [normal, tangential, _]) = totals.get(&pair.key)?;
            let [slave, a, b] = constraint.pair().nodes;
            Some(ReturnedImpulse {
                time: interval.end.total,
                slave,
                segment: [a, b],
                normal: *normal,
                tangential: *tangential,
                returned_normal: pair.normal,
                returned_tangential: pair.tangential,
            })
        };
        solved.returned.pairs.iter().filter_map(total).collect()
    }

    /// Distance of the total impulses from Coulomb's cone, for each contact. Without returns the total impulses are in
    /// the cone, since both the impulses of forces and the impulses of impacts are in it.
    fn measure_cones(totals: &Totals, resultants: &mut [ContactResultant]) {
        let mut largest = vec![0.0_f64; resultants.len()];
        for (key, (constraint, [normal, tangential, size])) in totals {
            let contact = key.contact();
            let outside = larger(tangential.abs() - constraint.mu * normal, -normal);
            let violation = &mut resultants[contact].impulse_cone_violation;
            *violation = larger(*violation, outside);
            largest[contact] = larger(largest[contact], *size);
        }
        for (result, largest) in resultants.iter_mut().zip(largest) {
            if largest > 0.0 {
                result.impulse_cone_violation /= largest;
            }
        }
    }

    /// Adds |Bt d| of the closed pairs to the slip of their slave nodes, and its mean to the slip of master nodes, eq.
    /// (9.16). If a node has several pairs, the largest of their slips is added.
    fn slide(&mut self, solved: &Solved) {
        let mut increments = vec![0.0_f64; self.slip.len()];
        let mut of_masters = MasterMeans::new(self.slip.len());
        for (constraint, _) in solved.contact.forces.acting() {
            let slip = constraint.tangential_motion(&solved.d).abs();
            of_masters.add(constraint, slip);
            let node = constraint.named_slave();
            increments[node] = increments[node].max(slip);
        }
        let increments = increments.into_iter().zip(of_masters.values());
        for (slip, (increment, mean)) in self.slip.iter_mut().zip(increments) {
            *slip += increment.max(mean);
        }
    }
}

/// The sign 1 if the slave surface of a constraint is the side whose forces are reported, -1 if it is the other side,
/// and 0 within one body.
fn side_of_slave(model: &Model, bodies: &Bodies, constraint: &Constraint) -> f64 {
    let on_side = forces_on_side(model, bodies, constraint, [1.0, 0.0]);
    let slave = constraint.forces_on_slave_surface([1.0, 0.0]).next();
    match slave {
        _ if on_side.is_empty() => 0.0,
        Some((slave, _)) if on_side.iter().any(|(node, _)| *node == slave) => 1.0,
        _ => -1.0,
    }
}

/// Normal and tangential impulses of pairs in an increment, and the sum of the absolute normal impulses. If all of a
/// force is taken back, the total normal impulse is only the round-off of its parts.
type Totals<'s> = BTreeMap<ConstraintKey, (&'s Constraint, [f64; 3])>;

/// Total impulses of every pair: dt P + (Phi, Psi) plus the return.
fn total_impulses<'s>(solved: &'s Solved, dt: f64) -> Totals<'s> {
    let mut totals = Totals::new();
    let mut add = |constraint: &'s Constraint, impulse: [f64; 2]| {
        let (_, sum) = (totals.entry(constraint.key)).or_insert((constraint, [0.0; 3]));
        add_impulse(sum, constraint.normal_and_tangential(impulse));
    };
    for (constraint, pair) in solved.contact.forces.acting() {
        add(constraint, pair.force.map(|p| dt * p));
    }
    for (constraint, pair) in solved.contact.impulses.acting() {
        add(constraint, pair.force);
    }
    for (constraint, _) in &solved.returned.release.opened {
        add(constraint, [0.0; 2]);
    }
    for pair in &solved.returned.pairs {
        if let Some((_, sum)) = totals.get_mut(&pair.key) {
            add_impulse(sum, [pair.normal, pair.tangential]);
        }
    }
    totals
}

fn add_impulse([normal, tangential, size]: &mut [f64; 3], impulse: [f64; 2]) {
    *normal += impulse[0];
    *tangential += impulse[1];
    *size += impulse[0].abs();
}

impl ContactImpulse {
    /// Adds the normal and tangential impulse of a constraint; `on_side` gives the impulses of the constraint at the
    /// nodes of the reported side.
    fn add(
        &mut self,
        [normal, tangential]: [f64; 2],
        on_side: impl IntoIterator<Item = (usize, [f64; 2])>,
    ) {
        for (_, [x, y]) in on_side {
            self.vector[0] += x;
            self.vector[1] += y;
        }
        self.normal += normal;
        self.tangential += tangential;
    }

    /// Adds the impulse of a landing return; the slave node is on the reported side (1), on the other side (-1) or on
    /// both sides (0).
    fn add_return(&mut self, returned: &PairReturn, side: f64) {
        self.vector[0] += side * returned.vector[0];
        self.vector[1] += side * returned.vector[1];
        self.normal += returned.normal;
        self.tangential += returned.tangential;
        self.landing_return += returned.normal;
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
        self.landing_return += other.landing_return;
    }
}

/// Adds forces at nodes to the forces on their bodies; moments are about the origin.
fn add_to_bodies(
    problem: &StepProblem,
    bodies: &Bodies,
    u: &[f64],
    forces: impl Iterator<Item = (usize, [f64; 2])>,
    results: &mut [ContactOnBody],
) {
    for (node, [fx, fy]) in forces {
        let Some(body) = bodies.of_node[node] else {
            continue;
        };
        let x = problem.position(u, node);
        let result = &mut results[body];
        result.force[0] += fx;
        result.force[1] += fy;
        result.moment += cross(x, [fx, fy]);
    }
}

/// The largest violations of the contact law at the end of an increment that began at `start`; the candidate lists must
/// be valid at the end.
pub(crate) fn contact_violation(
    problem: &StepProblem,
    search: &Search,
    start: &State,
    solved: &Solved,
) -> ContactViolation {
    let at = problem.configurations(&start.u, &solved.end.u);
    let of_pair = |(constraint, pair): (&Constraint, Option<&ClosedPair>)| match pair {
        None => {
            let (gap, scale) = constraint.gap_and_scale(&at);
            violation_of_open_pair(gap, scale)
        }
        Some(pair) => violation_of_closed_pair(&constraint.relinearized(&at), pair.slips),
    };
    let pairs = solved.contact.forces.iter();
    let largest = pairs
        .map(of_pair)
        .fold(ContactViolation::default(), ContactViolation::larger);
    let u = &solved.end.u;
    let inside = larger(crossed_edges(search, u), sunk_nodes(search, u));
    ContactViolation {
        penetration: larger(largest.overlap, inside),
        ..largest
    }
}

/// Violation of an open pair, which must not overlap.
fn violation_of_open_pair(gap: f64, scale: f64) -> ContactViolation {
    ContactViolation {
        overlap: (-gap).max(0.0) / scale,
        ..ContactViolation::default()
    }
}

/// Violation of a closed pair, which must have no gap and, if it sticks, no slip.
fn violation_of_closed_pair(constraint: &Constraint, slips: bool) -> ContactViolation {
    let part = |length: f64| length / constraint.scale;
    let sticks = !slips && constraint.mu > 0.0;
    ContactViolation {
        overlap: 0.0,
        gap: part(constraint.gap.abs()),
        slip: if sticks {
            part(constraint.slip.abs())
        } else {
            0.0
        },
        ..ContactViolation::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::testing;

    /// Violation of the constraint [`testing::at_face`].
    fn violation(gap_and_slip: [f64; 2], mu: f64, slips: Option<bool>) -> ContactViolation {
        let mut constraint = testing::at_face(gap_and_slip);
        constraint.mu = mu;
        match slips {
            None => violation_of_open_pair(constraint.gap, constraint.scale),
            Some(slips) => violation_of_closed_pair(&constraint, slips),
        }
    }

    #[test]
    fn overlaps_gaps_and_slips_count_where_the_law_forbids_them() {
        let near = |found: ContactViolation, overlap: f64, gap: f64, slip: f64| {
            let expected = [overlap, gap, slip];
            for (found, expected) in [found.overlap, found.gap, found.slip].iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{found:?} {expected}");
            }
        };
        let [stick, slides] = [Some(false), Some(true)];
        near(violation([4e-3, 2e-3], 0.5, None), 0.0, 0.0, 0.0);
        near(violation([-4e-3, 2e-3], 0.5, None), 2e-3, 0.0, 0.0);
        near(violation([-4e-3, 2e-3], 0.5, stick), 0.0, 2e-3, 1e-3);
        near(violation([4e-3, -2e-3], 0.5, stick), 0.0, 2e-3, 1e-3);
        near(violation([4e-3, 2e-3], 0.5, slides), 0.0, 2e-3, 0.0);
        near(violation([4e-3, 2e-3], 0.0, stick), 0.0, 2e-3, 0.0);
    }
}
