//! Results of an increment, as the output receives them through [`Observer`].

use std::io;
use std::sync::Arc;

use super::contact_results::{ContactResultant, ContactViolation, Landing, ReturnedImpulse, Touch};
use super::failure::Failure;
use super::pass_report::PassReport;
use crate::elements::{ElementResult, Strained};

/// Motion at one time, `2 N` entries each, and what the materials remember.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Displacement (length).
    pub u: Vec<f64>,
    /// Velocity (length/time).
    pub v: Vec<f64>,
    /// Acceleration (length/time^2).
    pub a: Vec<f64>,
    /// Internal variables of the materials at all integration points, element by element: accepted or
    /// dropped with the rest of the state.
    pub internal: Vec<f64>,
}

/// Contact status of a node as slave; a node that is slave of several pairs shows the highest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
#[repr(u8)]
pub enum NodeStatus {
    /// No candidate segment.
    #[default]
    None = 0,
    /// A candidate, no contact.
    Open = 1,
    /// In contact without slip.
    Stick = 2,
    /// In contact, sliding.
    Slip = 3,
}

/// Mass of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u8)]
pub enum NodeMass {
    /// Its own; no node of a contact surface.
    #[default]
    Own = 0,
    /// Its own although it is a node of a contact surface of a body.
    Kept = 1,
    /// None: its donors carry it.
    None = 2,
}

/// Results at nodes, apart from the motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NodalResults {
    /// Support reaction, with the force that the support exerts through equations, eq. (9.12), `2 N` entries
    /// (force); 0 at all other dofs. That of a rigid surface is at its reference node.
    pub reaction: Vec<f64>,
    /// Concentrated loads on the node, `2 N` entries (force).
    pub concentrated: Vec<f64>,
    /// Contact force on the node, `2 N` entries (force).
    pub contact_force: Vec<f64>,
    /// Gap of the node to its segment, `N` entries (length); NaN without candidate.
    pub gap: Vec<f64>,
    /// Contact status, `N` entries.
    pub status: Vec<NodeStatus>,
    /// Contact pressure, `N` entries (force/length^2); NaN at all nodes but slave
    /// nodes.
    pub pressure: Vec<f64>,
    /// Accumulated slip since the start of the analysis, `N` entries (length); NaN at all nodes but
    /// slave nodes.
    pub slip: Vec<f64>,
    /// Masses, `N` entries where they are redistributed, else none.
    pub mass: Vec<NodeMass>,
}

/// Energies; all but the first two are cumulative from the start of the analysis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energy {
    /// Kinetic energy T.
    pub kinetic: f64,
    /// Strain energy W.
    pub strain: f64,
    /// Work of the loads and of the supports' prescribed motion.
    pub external_work: f64,
    /// Work of the normal contact forces.
    pub normal_contact_work: f64,
    /// Energy dissipated by friction.
    pub friction_dissipation: f64,
    /// Kinetic energy taken by the impact impulses.
    pub impact_loss: f64,
    /// Kinetic energy given back after landings.
    pub landing_return: f64,
    /// Strain energy that nodes without mass lose as they come to rest after a release.
    pub release_loss: f64,
    /// Energy dissipated by the damping of the materials.
    pub damping: f64,
    /// Energy dissipated by the materials.
    pub material_dissipation: f64,
    /// Energy dissipated by the integration scheme.
    pub numerical_dissipation: f64,
    /// Energy balance; for exact solutions zero, so that it measures the residual of the passes.
    pub balance: f64,
}

/// Momentum of all bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Momentum {
    /// Linear momentum (mass length/time).
    pub linear: [f64; 2],
    /// Angular momentum about the origin (mass length^2/time).
    pub angular: f64,
    /// That of the consistent mass, where the mass is redistributed.
    pub consistent_angular: Option<f64>,
    /// Linear momentum that mass-proportional damping has taken since the start of the analysis (mass
    /// length/time).
    pub damped_linear: [f64; 2],
    /// Angular momentum that it has taken (mass length^2/time).
    pub damped_angular: f64,
}

/// Motion, energies and contact force of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BodyResult {
    /// Centre of mass (length).
    pub center: [f64; 2],
    /// Its velocity (length/time).
    pub velocity: [f64; 2],
    /// Angular momentum about the centre of mass over the moment of inertia (1/time).
    pub angular_velocity: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Force of all contacts on the body (force).
    pub contact_force: [f64; 2],
    /// Its moment about the centre of mass (force length).
    pub contact_moment: f64,
}

/// Reaction that holds a rigid surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigidReaction {
    /// Force.
    pub force: [f64; 2],
    /// Its moment about the reference node (force length).
    pub moment: f64,
}

/// Work of the solver in an increment or in a whole run, and the errors of its answer.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolverCounts {
    /// Predictor and corrector passes.
    pub passes: usize,
    /// Complementarity problems solved (passes and impulses).
    pub lcps: usize,
    /// Largest number of pairs in one of them.
    pub lcp_size: usize,
    /// Pivots of Lemke's method.
    pub pivots: usize,
    /// Iterations of the active-set method.
    pub active_set_iterations: usize,
    /// Sweeps of the Gauss-Seidel method.
    pub gauss_seidel_sweeps: usize,
    /// Calls of Lemke's method.
    pub lemke_calls: usize,
    /// Factorisations of the effective matrix.
    pub factorizations: usize,
    /// Relative force residual of the last pass.
    pub residual: f64,
    /// How far the pairs are from the contact law at the end.
    pub violation: ContactViolation,
    /// Whether the increment converged.
    pub converged: bool,
}

/// Everything about one finished increment; number 0 is the start.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IncrementReport {
    /// Number of the increment over all steps.
    pub increment: usize,
    /// Number of the step, from 1.
    pub step: usize,
    /// Time since the start of the analysis, at the end of the increment.
    pub time: f64,
    /// Time since the start of the step, at the end of the increment.
    pub step_time: f64,
    /// Length of the increment; 0 at the start.
    pub dt: f64,
    /// Whether this is the last increment of its step.
    pub ends_step: bool,
    /// Motion at the end.
    pub state: State,
    /// Results at nodes.
    pub nodal: NodalResults,
    /// Strain energy, mean stress and mean strain of every element.
    pub elements: Arc<[ElementResult]>,
    /// Energy ledger.
    pub energy: Energy,
    /// Energy that contact put in, if its normal work was positive beyond round-off.
    pub contact_energy: Option<f64>,
    /// Momentum.
    pub momentum: Momentum,
    /// Results of every body, in the order of [`crate::model::Bodies`].
    pub bodies: Vec<BodyResult>,
    /// Reactions, one per rigid surface with a reference node.
    pub rigid: Vec<RigidReaction>,
    /// Largest principal strain.
    pub strain: Strained,
    /// Resultants, one per contact of the model.
    pub contacts: Vec<ContactResultant>,
    /// Landings of this increment.
    pub landings: Vec<Landing>,
    /// Total impulses of the pairs that were given energy back.
    pub returns: Vec<ReturnedImpulse>,
    /// Touches that have ended.
    pub touches: Vec<Touch>,
    /// Counters of this increment.
    pub solver: SolverCounts,
    /// Its passes.
    pub passes: Vec<PassReport>,
}

/// An attempt at an increment that failed and is repeated with half the length.
#[derive(Debug, Clone, PartialEq)]
pub struct Cutback {
    /// The failed attempt.
    pub failure: Failure,
    /// Length of the next attempt.
    pub next_dt: f64,
}

/// Receives the results of a run as it goes. The numerics neither print nor open files.
pub trait Observer {
    /// An increment is done (number 0: the start).
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()>;

    /// An increment is repeated with half its length.
    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()>;

    /// Whether the run shall end here; asked before every attempt at an increment.
    fn wants_stop(&self) -> bool {
        false
    }
}
