//! Results of a converged increment that are not energies: momentum, motion of the bodies, resultants of the contacts,
//! nodal quantities and reactions of rigid surfaces. See docs/theory/impacts.md, Ledger.

use super::bodies::{BodyMasses, Moving, momentum, rigid_reactions};
use super::contact_ledger::ContactLedger;
use super::energy::Ledger;
use super::nodal_results::{
    contact_pressure, contact_resultants, nodal_results, node_masses, tie_forces,
};
use super::surface_work::SurfaceWork;
use super::touches::Touches;
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::increment::Solved;
use crate::dynamics::results::{
    ContactOnBody, ContactResultant, FrictionResults, IncrementReport, Momentum, NodalResults,
    NodeStatus, State,
};
use crate::dynamics::step::{Discretization, Interval, Mass, SlaveFaces, StepProblem};
use crate::model::Contact;
use crate::prepare::Redistribution;

/// Accounts of a run in addition to the energy ledger: bodies and contacts.
pub(crate) struct Accounts {
    bodies: BodyMasses,
    faces: SlaveFaces,
    contacts: ContactLedger,
    touches: Touches,
    surface_work: SurfaceWork,
    /// The consistent mass, if the mass is redistributed.
    consistent: Option<Mass>,
    /// Momentum that mass-proportional damping has removed.
    damped: Momentum,
    /// Largest normal force of contact on a node so far (force).
    largest_normal: f64,
}

impl Accounts {
    /// Accounts at the start of a run.
    pub fn new(discretization: &Discretization) -> Self {
        let Discretization {
            model,
            mass,
            elements,
            redistribution,
            turning,
            ..
        } = discretization;
        let faces = SlaveFaces::new(model);
        let consistent = || {
            Mass::new(
                (elements, turning),
                &Redistribution::default(),
                mass.shares.len(),
            )
        };
        Accounts {
            bodies: BodyMasses::new(model, mass, turning),
            contacts: ContactLedger::new(model, faces.start.clone()),
            touches: Touches::new(&model.mesh),
            surface_work: SurfaceWork::new(model, &faces),
            consistent: (!redistribution.is_empty()).then(consistent),
            faces,
            damped: Momentum::default(),
            largest_normal: 0.0,
        }
    }

    /// Transfers the sums over the run to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Self {
            [contacts, touches, surface_work] damped, largest_normal; bodies, faces, consistent
        })
    }

    /// Enters the motion at the start with the energies of the ledger, without forces.
    pub fn start(&self, problem: &StepProblem, state: &State, ledger: &Ledger) -> IncrementReport {
        let (dofs, nodes) = (state.u.len(), state.u.len() / 2);
        let of_contact = |contact: &Contact| ContactResultant {
            min_gap: f64::NAN,
            friction_coefficient: f64::NAN,
            bodies: match contact.is_self_contact() {
                true => vec![ContactOnBody::default(); self.bodies.bodies.count],
                false => Vec::new(),
            },
            ..ContactResultant::default()
        };
        IncrementReport {
            nodal: NodalResults {
                reaction: vec![0.0; dofs],
                concentrated: vec![0.0; dofs],
                contact_force: vec![0.0; dofs],
                tie_force: tie_forces(problem.model, |_| 0.0),
                hinge_force: vec![[0.0; 2]; problem.model.hinges.len()],
                gap: vec![f64::NAN; nodes],
                status: vec![NodeStatus::None; nodes],
                pressure: self.faces.start.clone(),
                friction: FrictionResults {
                    coefficient: match problem.model.has_varying_friction() {
                        true => vec![f64::NAN; problem.model.mesh.node_count()],
                        false => Vec::new(),
                    },
                    ..self.surface_work.results()
                },
                slip: self.contacts.slip.clone(),
                mass: node_masses(problem),
            },
            contacts: problem.model.contacts.iter().map(of_contact).collect(),
            rigid: rigid_reactions(problem, state, &vec![0.0; dofs]),
            ..self.moving(problem, state, ledger)
        }
    }

    /// Enters a converged increment that began at `start`: results at nodes, of contacts, bodies and rigid surfaces.
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        start: &State,
        solved: &Solved,
        interval: Interval,
        ledger: &Ledger,
    ) -> IncrementReport {
        self.enter_damping(problem, solved);
        let bodies = &self.bodies.bodies;
        let mut contacts = contact_resultants(problem, bodies, solved, &start.u, interval);
        let mut report = self.moving(problem, &solved.end, ledger);
        let u = &solved.equilibrium.u_theta;
        // in a step without rates forces give no impulse
        let interval = match problem.integration.has_rates {
            true => interval,
            false => Interval {
                dt: 0.0,
                ..interval
            },
        };
        report.touches = (self.touches).enter(problem, bodies, solved, interval, &mut contacts);
        report.returns =
            (self.contacts).enter_returns(problem.model, bodies, solved, interval, &mut contacts);
        let (works, dt) = (&ledger.works, interval.dt);
        (self.contacts).enter(problem, bodies, solved, works, dt, &mut contacts);
        let mut nodal = nodal_results(problem, solved);
        let (theta1, Interval { start, end, .. }) = (problem.integration.theta1, interval);
        nodal.concentrated = problem.loads.concentrated(theta1, start, end, u.len());
        let (forces, most) = (&solved.contact.forces, &mut self.largest_normal);
        nodal.pressure = contact_pressure(&self.faces, problem, u, forces, most);
        nodal.slip.clone_from(&self.contacts.slip);
        (self.surface_work).enter(problem, &self.faces, solved, &ledger.works);
        report.surface_work_difference = self.surface_work.difference(&self.contacts);
        nodal.friction = FrictionResults {
            coefficient: nodal.friction.coefficient,
            ..self.surface_work.results()
        };
        report.rigid = rigid_reactions(problem, &solved.end, &nodal.reaction);
        (self.bodies).add_contact(problem, u, &nodal.contact_force, &mut report.bodies);
        IncrementReport {
            nodal,
            contacts,
            ..report
        }
    }

    /// Adds the momentum that mass-proportional damping removes in an increment: alpha M d, which acts at
    /// mid-increment, eq. (9.10).
    fn enter_damping(&mut self, problem: &StepProblem, solved: &Solved) {
        if !problem.has_damping() {
            return;
        }
        let (d, u_theta) = (&solved.d, &solved.equilibrium.u_theta);
        // U0 + d/2 is U_theta if nodes without mass may have moved on from U0 + d to their rest
        let halfway: Vec<f64> = match problem.integration.energy_momentum {
            true => u_theta.clone(),
            false => solved
                .end
                .u
                .iter()
                .zip(d)
                .map(|(u1, d)| u1 - d / 2.0)
                .collect(),
        };
        let impulse = problem.elements.mass_damping_impulse(d);
        let taken = momentum(problem, &halfway, &impulse);
        for (sum, p) in self.damped.linear.iter_mut().zip(taken.linear) {
            *sum += p;
        }
        self.damped.angular += taken.angular;
    }

    /// Momentum and motion of the bodies.
    fn moving(&self, problem: &StepProblem, state: &State, ledger: &Ledger) -> IncrementReport {
        let (p, elements) = (&ledger.momentum[..], &ledger.elements[..]);
        let State { u, v, .. } = state;
        let moving = Moving { u, v, p, elements };
        IncrementReport {
            momentum: Momentum {
                consistent_angular: (self.consistent.as_ref())
                    .map(|mass| momentum(problem, u, &mass.times(v)).angular),
                damped_linear: self.damped.linear,
                damped_angular: self.damped.angular,
                ..momentum(problem, u, p)
            },
            bodies: self.bodies.results(problem, &moving),
            connectors: problem.elements.connector_states(u, v),
            ..IncrementReport::default()
        }
    }
}
