//! Equation of motion of a step, eq. (3.1) (paper eq. 21), evaluated at an iterate: loads, internal and
//! inertia forces, and contact pairs. See docs/theory/contact.md and docs/theory/time.md.
//!
//! Discretization of a model, constant over a run: elements, mass, bodies with their parts, contact
//! surfaces.

use std::borrow::Cow;

use super::fits::Fits;
use super::friction::Frictions;
use super::hinges::Hinges;
use super::integration::Integration;
use super::loads::{Interval, Loads};
use super::mass::Mass;
use super::parts::{DofRun, Parts};
use super::temperatures::Temperatures;
use super::turning::TurningBody;
use super::unknowns::Unknowns;
use crate::contact::tolerances::COLLAPSED_LENGTH;
use crate::contact::{
    Configurations, Constraint, ContactSurfaces, PairTarget, Positions, position,
};
use crate::dynamics::results::{Cause, State};
use crate::elements::{Elements, Motion};
use crate::lcp::LcpMethod;
use crate::linear::{LinearError, largest};
use crate::model::{Impact, ImpactTime, LandingRule, Model, Settings, Step};
use crate::prepare::{PreparedModel, Redistribution};
use crate::vectors::distance;

/// The equation of motion of a step.
pub(crate) struct StepProblem<'m> {
    pub model: &'m Model,
    /// Reference coordinates of the nodes, followed by the coordinates of the nodes of bodies that turn.
    pub coordinates: &'m [[f64; 2]],
    pub elements: &'m Elements,
    pub mass: &'m Mass,
    pub redistribution: &'m Redistribution,
    pub parts: &'m Parts,
    pub contacts: &'m [ContactSurfaces],
    pub frictions: Frictions<'m>,
    pub settings: Settings,
    pub integration: Integration,
    pub unknowns: Unknowns<'m>,
    /// Runs of the unknowns of each part.
    pub parts_of_unknowns: Vec<DofRun>,
    pub loads: Loads<'m>,
    pub fits: Fits<'m>,
    pub hinges: Hinges,
    pub temperatures: Temperatures<'m>,
}

/// Velocity at the start of an increment.
pub(crate) struct StartVelocity<'a> {
    /// The velocity is V0+, or V0 if the impulses are given separately.
    pub v0p: Cow<'a, [f64]>,
    /// Impulses J = M (V0+ - V0) that the velocity does not contain, over all dofs; empty if the velocity contains the
    /// impulses.
    pub impulse: &'a [f64],
}

/// Load, internal force and inertia of an iterate.
#[derive(Debug, Clone, Default)]
pub(crate) struct Equilibrium {
    /// Displacement U_theta.
    pub u_theta: Vec<f64>,
    /// Temperature of every node at which the materials are evaluated; empty if the deck gives no temperatures.
    pub temperature: Vec<f64>,
    /// Forces lambda of the hinges.
    pub hinges: Vec<f64>,
    /// Forces that hold motions in a static step, each with its dof.
    pub held: Vec<(usize, f64)>,
    /// Load R_theta, including the forces C^T lambda of the hinges and the forces that hold
    /// motions.
    pub load: Vec<f64>,
    /// Internal force F_theta, including damping.
    pub internal: Vec<f64>,
    /// Acceleration A.
    pub acceleration: Vec<f64>,
    /// Inertia force M A.
    pub inertia: Vec<f64>,
    /// Out-of-balance force r without contact.
    pub out_of_balance: Vec<f64>,
}

impl Equilibrium {
    /// Displacements U_theta and the temperatures of the nodes with them.
    pub fn place(&self) -> [&[f64]; 2] {
        [&self.u_theta, &self.temperature]
    }

    /// Sets the length of the vectors to `dofs`.
    fn resize(&mut self, dofs: usize) {
        for vector in [
            &mut self.u_theta,
            &mut self.load,
            &mut self.internal,
            &mut self.acceleration,
            &mut self.inertia,
            &mut self.out_of_balance,
        ] {
            vector.resize(dofs, 0.0);
        }
    }

    /// Sets r = R_theta - F(U_theta) - M A, eq. (4.5).
    fn set_out_of_balance(&mut self) {
        let forces = self.load.iter().zip(&self.internal).zip(&self.inertia);
        for (r, ((load, internal), inertia)) in self.out_of_balance.iter_mut().zip(forces) {
            *r = load - internal - inertia;
        }
    }
}

impl<'m> StepProblem<'m> {
    /// The problem of a step; `start` are the displacements and velocities at its start.
    pub fn new(discretization: &'m Discretization<'m>, step: &'m Step, start: [&[f64]; 2]) -> Self {
        let Discretization {
            model,
            elements,
            mass,
            redistribution,
            parts,
            turning,
            coordinates,
            overlaps,
            ..
        } = discretization;
        let unknowns = Unknowns::new(model, (elements, turning), step, start);
        StepProblem {
            model,
            coordinates,
            elements,
            mass,
            redistribution,
            parts,
            contacts: discretization.contacts_of(step),
            frictions: Frictions::new(model, step),
            settings: step.settings,
            integration: Integration::new(step),
            parts_of_unknowns: parts.of_unknowns(&unknowns.dof),
            unknowns,
            hinges: Hinges::new(model, step),
            loads: Loads::new(model, step, elements, redistribution),
            temperatures: Temperatures::new(model, step),
            fits: Fits::new(model, step, overlaps, |contact| {
                discretization.contacts[contact].slaves.len()
            }),
        }
    }
}

impl StepProblem<'_> {
    /// Lets forces that acted at the end of the last step fade over this step (dof, force).
    pub fn release(&mut self, forces: &[(usize, f64)]) {
        let load = |&(dof, force): &(usize, f64)| {
            let length = self.unknowns.turning.length_of(dof);
            (dof, length.map_or(force, |length| length * force))
        };
        self.loads.release(forces.iter().map(load).collect());
    }

    /// Solver of the complementarity problems.
    pub fn method(&self) -> LcpMethod {
        self.settings.lcp
    }

    /// Whether damping acts.
    pub fn has_damping(&self) -> bool {
        self.integration.has_rates && self.elements.has_damping()
    }

    /// Whether the step treats the velocity of landing nodes: it does so if it has rates and does not use the backward
    /// Euler rule.
    fn has_impacts(&self) -> bool {
        self.integration.has_rates && !self.integration.backward_euler
    }

    /// Whether impact impulses act.
    pub fn has_impulses(&self) -> bool {
        self.has_impacts() && self.settings.impact == Impact::Impulse
    }

    /// Whether impacts end subincrements.
    pub fn ends_at_impacts(&self) -> bool {
        self.has_impacts() && self.settings.impact_time == ImpactTime::Event
    }

    /// Whether the energy that landings remove is given back.
    pub fn returns_landings(&self) -> bool {
        self.has_impacts() && self.settings.landing == LandingRule::Return
    }

    /// Replaces the velocities V by P V: nodes without mass follow their donors, except where they are prescribed.
    pub fn follow_donors(&self, v: &mut [f64]) {
        self.redistribution
            .follow(v, |dof| self.unknowns.depends(dof));
    }

    /// Error of the displacement of every node that the tolerance of the passes leaves in an increment `d`.
    pub fn unsolved(&self, d: &[f64]) -> Vec<f64> {
        let largest = self.parts.largest_of_bodies(d);
        let unsolved = |&body: &usize| self.settings.tolerance * largest[body];
        self.parts.of_nodes().iter().map(unsolved).collect()
    }

    /// Current position of a node.
    pub fn position(&self, u: &[f64], node: usize) -> [f64; 2] {
        position(self.coordinates, u, node)
    }

    /// Current positions of all nodes.
    pub fn positions<'a>(&'a self, u: &'a [f64]) -> Positions<'a> {
        Positions::new(&self.model.mesh.coordinates, u)
    }

    /// Cause of the failure of a factorisation or of a solve.
    pub fn unsolvable(&self, error: LinearError) -> Cause {
        match error {
            LinearError::NotPositiveDefinite { unknown, .. } => Cause::Indefinite {
                node: self.unknowns.dof[unknown] / 2,
            },
            other => other.into(),
        }
    }

    /// Checks that every segment has a length, and so a normal.
    ///
    /// # Errors
    /// Returns [`Cause::Collapsed`] with the first segment that has almost no length.
    pub fn check_segments(&self, u: &[f64]) -> Result<(), Cause> {
        let x = &self.model.mesh.coordinates;
        let length = |[p, q]: [[f64; 2]; 2]| distance(p, q);
        let has_collapsed = |segment: &&[usize; 2]| {
            let now = length(segment.map(|node| self.position(u, node)));
            let least = COLLAPSED_LENGTH * length(segment.map(|node| x[node]));
            now.is_nan() || now <= least
        };
        let mut segments = self.contacts.iter().flat_map(|contact| &contact.segments);
        match segments.find(has_collapsed) {
            Some(&segment) => Err(Cause::Collapsed { segment }),
            None => Ok(()),
        }
    }

    /// Checks that no element is turned inside out at the end of an increment. The passes detect inverted elements
    /// themselves in the energy-momentum form, and if both weights are 1; in other schemes the passes evaluate only
    /// U_theta.
    ///
    /// # Errors
    /// Returns [`Cause::Inverted`] with the first element that is turned inside out.
    pub fn check_end(&self, end: &State) -> Result<(), Cause> {
        let Integration {
            theta1,
            theta2,
            energy_momentum,
            ..
        } = self.integration;
        if energy_momentum || [theta1, theta2] == [1.0; 2] {
            return Ok(());
        }
        self.elements.internal_force(end.motion())?;
        Ok(())
    }

    /// Writes the constraints of pairs between the displacements `u0` and `u` of an increment; there are no constraints
    /// between rigid surfaces.
    pub fn constraints(
        &self,
        pairs: &[PairTarget],
        [u0, u]: [&[f64]; 2],
        constraints: &mut Vec<Constraint>,
    ) {
        let configurations = self.configurations(u0, u);
        constraints.clear();
        constraints.reserve(pairs.len());
        let moves = |pair: &&PairTarget| pair.any_node(|node| self.unknowns.moves(&[node]));
        for source in pairs.iter().filter(moves) {
            let constraint = Constraint::new(source.clone(), &configurations);
            if self.unknowns.opens(&constraint) {
                constraints.push(constraint);
            }
        }
    }

    /// The configurations between which the scheme linearises constraints.
    pub fn configurations<'a>(&'a self, u0: &'a [f64], u: &'a [f64]) -> Configurations<'a> {
        Configurations {
            form: self.integration.row_form(),
            x: self.coordinates,
            u0,
            u,
        }
    }

    /// Writes load, internal force and inertia of the iterate U = U0 + d.
    pub fn equilibrium(
        &self,
        start: &State,
        velocity: &StartVelocity,
        [u, d]: [&[f64]; 2],
        interval: Interval,
        equilibrium: &mut Equilibrium,
    ) -> Result<(), Cause> {
        self.load_and_internal_force(start, &velocity.v0p, [u, d], interval, equilibrium)?;
        self.inertia(start, velocity, d, interval, equilibrium);
        Ok(())
    }

    /// Writes load and internal force of the iterate U = U0 + d. Load and internal force depend on V0+ only if U_theta
    /// depends on V0+.
    fn load_and_internal_force(
        &self,
        start: &State,
        v0p: &[f64],
        [u, d]: [&[f64]; 2],
        interval: Interval,
        equilibrium: &mut Equilibrium,
    ) -> Result<(), Cause> {
        equilibrium.resize(u.len());
        let Equilibrium {
            u_theta,
            temperature,
            hinges,
            held,
            load,
            internal,
            ..
        } = equilibrium;
        let theta1 = self.integration.theta1;
        (self.temperatures).write_weighted(theta1, start, interval, temperature);
        (self.integration).write_displacement([&start.u, d, v0p], interval.dt, u_theta);
        (self.unknowns.turning).correct_angles(d, self.integration.theta2, u_theta);
        let motion = (self.integration).motion(start, u, [&*u_theta, &*temperature]);
        self.elements.write_internal_force(motion, internal)?;
        if self.has_damping() {
            let damping = (self.elements).damping_force([&start.u, u], d, interval.dt);
            internal.iter_mut().zip(&damping).for_each(|(f, c)| *f += c);
        }
        // without loads the load vector is still zero
        if !self.loads.are_none() {
            (self.loads).write_weighted(theta1, interval, u_theta, load);
            self.unknowns.turning.scale_moments(d, load);
        } else if !self.hinges.are_none() || !held.is_empty() {
            load.fill(0.0);
        }
        hinges.resize(self.hinges.count(), 0.0);
        self.hinges.add_forces(hinges, load);
        held.iter().for_each(|(dof, force)| load[*dof] += force);
        Ok(())
    }

    /// Writes the inertia of the iterate U = U0 + d, and the out-of-balance force with the available load and internal
    /// force.
    pub fn inertia(
        &self,
        start: &State,
        StartVelocity { v0p, impulse }: &StartVelocity,
        d: &[f64],
        interval: Interval,
        equilibrium: &mut Equilibrium,
    ) {
        let Equilibrium {
            acceleration,
            inertia,
            ..
        } = equilibrium;
        // without inertia both vectors are still zero
        if !self.integration.has_rates {
            return equilibrium.set_out_of_balance();
        }
        // A = (2/dt²) (d - dt V0+), eq. (4.1); at supports (V1 - V0)/dt, eq. (4.9)
        let dt = interval.dt;
        let c = self.integration.mass_factor(dt);
        for (a, (d, v0p)) in acceleration.iter_mut().zip(d.iter().zip(v0p.iter())) {
            *a = c * (d - dt * v0p);
        }
        let turning = &self.unknowns.turning;
        let own = match turning.is_empty() {
            true => Vec::new(),
            false => acceleration.clone(),
        };
        (self.unknowns).prescribe_acceleration(interval.end, &start.v, dt, acceleration);
        turning.carry(
            [&start.u, d],
            &own,
            |dof| self.unknowns.is_prescribed(dof),
            acceleration,
        );
        turning.drive([&start.u, d], &start.v, dt, acceleration);
        self.unknowns.follow(acceleration);
        self.mass.write_product(acceleration, inertia);
        // the part -(2/dt) J of impulses J = M (V0+ - V0) that are not in V0+ yet
        for (inertia, impulse) in inertia.iter_mut().zip(*impulse) {
            *inertia -= c * dt * impulse;
        }
        equilibrium.set_out_of_balance();
    }
}

/// Checks that all values of some quantities, each over all dofs, are finite.
///
/// # Errors
/// Returns [`Cause::NotFinite`] with the first quantity and node whose value is not finite.
pub(crate) fn check_finite(quantities: &[(&'static str, &Vec<f64>)]) -> Result<(), Cause> {
    for &(what, values) in quantities {
        if !largest(values).is_finite()
            && let Some(dof) = values.iter().position(|value| !value.is_finite())
        {
            let node = dof / 2;
            return Err(Cause::NotFinite { what, node });
        }
    }
    Ok(())
}

impl State {
    /// Motion to the displacements of a state, with the internal variables and temperatures of this state.
    pub fn motion(&self) -> Motion<'_> {
        Motion::at(&self.u, &self.internal).heated(&self.temperature)
    }

    /// Checks that displacement, velocity and acceleration are finite.
    ///
    /// # Errors
    /// [`Cause::NotFinite`].
    pub(crate) fn check_finite(&self) -> Result<(), Cause> {
        check_finite(&[
            ("the displacement", &self.u),
            ("the velocity", &self.v),
            ("the acceleration", &self.a),
        ])
    }
}

/// Writes the sum a + b.
pub(crate) fn write_sum(a: &[f64], b: &[f64], sum: &mut Vec<f64>) {
    sum.clear();
    sum.extend(a.iter().zip(b).map(|(a, b)| a + b));
}

/// Writes the difference a - b.
pub(crate) fn write_difference(a: &[f64], b: &[f64], difference: &mut Vec<f64>) {
    difference.clear();
    difference.extend(a.iter().zip(b).map(|(a, b)| a - b));
}

/// The sum a + b.
pub(crate) fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// The difference a - b.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// A prepared model with its elements, their mass, and the bodies and parts for which convergence
/// is scaled.
pub(crate) struct Discretization<'m> {
    pub model: &'m Model,
    contacts: &'m [ContactSurfaces],
    /// For each set of contacts that some steps have removed: their indices, and the surfaces of all contacts, where
    /// the removed contacts have no nodes and no segments.
    remaining: Vec<(&'m [usize], Vec<ContactSurfaces>)>,
    pub elements: Elements,
    pub mass: Mass,
    pub redistribution: &'m Redistribution,
    pub parts: Parts,
    pub turning: Vec<TurningBody>,
    /// Reference coordinates of the nodes, followed by the coordinates of the nodes of bodies that turn.
    pub coordinates: Vec<[f64; 2]>,
    /// Overlaps of slave nodes at the start, for contacts with shrink fits (length).
    pub overlaps: &'m [Vec<f64>],
}

/// The contacts in the steps that have removed contacts.
fn remaining(prepared: &PreparedModel) -> Vec<(&[usize], Vec<ContactSurfaces>)> {
    let mut all: Vec<(&[usize], Vec<ContactSurfaces>)> = Vec::new();
    for step in &prepared.model.steps {
        let removed = step.contacts.removed.as_slice();
        if removed.is_empty() || all.iter().any(|(known, _)| *known == removed) {
            continue;
        }
        let of_contact =
            |(index, surfaces): (usize, &ContactSurfaces)| match removed.contains(&index) {
                true => ContactSurfaces::new(Vec::new(), &[], Vec::new()),
                false => surfaces.clone(),
            };
        let surfaces = prepared.surfaces.iter().enumerate();
        all.push((removed, surfaces.map(of_contact).collect()));
    }
    all
}

impl<'m> Discretization<'m> {
    /// Surfaces of the contacts in a step.
    fn contacts_of(&self, step: &Step) -> &[ContactSurfaces] {
        let mut remaining = self.remaining.iter();
        let found = remaining.find(|(removed, _)| *removed == step.contacts.removed);
        found.map_or(self.contacts, |(_, contacts)| contacts)
    }

    /// Whether there are other dofs than the dofs of the nodes.
    pub fn has_more_dofs(&self) -> bool {
        !self.turning.is_empty()
    }

    /// The discretization of a model.
    pub fn new(prepared: &'m PreparedModel) -> Self {
        let model = &prepared.model;
        let mut elements = Elements::new(model);
        let redistribution = &prepared.redistribution;
        let mut turning = TurningBody::all(model, &elements);
        let deforming = (0..elements.len()).filter(|&element| !elements.is_rigid(element));
        let nodes = deforming.flat_map(|element| elements.nodes(element));
        let donors = nodes.filter_map(|&node| redistribution.donors(node));
        let carriers: Vec<usize> = donors.flatten().map(|donor| donor.0).collect();
        turning.iter_mut().for_each(|body| body.load(&carriers));
        elements.measure_angles(turning.iter().map(|body| (body.spin / 2, body.length)));
        let mut coordinates = model.mesh.coordinates.clone();
        for body in &turning {
            let centre = body.centre_from(coordinates[body.reference]);
            coordinates.extend([centre; 2]);
        }
        Discretization {
            model,
            contacts: &prepared.surfaces,
            remaining: remaining(prepared),
            mass: Mass::new((&elements, &turning), redistribution, coordinates.len()),
            redistribution,
            parts: Parts::new(model),
            elements,
            turning,
            coordinates,
            overlaps: &prepared.overlaps,
        }
    }
}
