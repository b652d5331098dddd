//! Results of an increment and totals of a run, as the output receives them through `Observer`.

use std::io;
use std::time::Duration;

use super::failure::Failure;
use crate::elements::Strained;

/// Motion at one time; `2 N` entries each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Displacement (length).
    pub u: Vec<f64>,
    /// Velocity (length/time).
    pub v: Vec<f64>,
    /// Acceleration (length/time^2).
    pub a: Vec<f64>,
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

/// Results at nodes, apart from the motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NodalResults {
    /// Support reaction, `2 N` entries (force); 0 at free dofs. That of a rigid surface stands at its
    /// reference node.
    pub reaction: Vec<f64>,
    /// Concentrated loads on the node, `2 N` entries (force).
    pub concentrated: Vec<f64>,
    /// Contact force on the node, `2 N` entries (force).
    pub contact_force: Vec<f64>,
    /// Gap of the node to its segment, `N` entries (length); NaN without candidate.
    pub gap: Vec<f64>,
    /// Contact status, `N` entries.
    pub status: Vec<NodeStatus>,
    /// Contact pressure, `N` entries (force/length^2); NaN at nodes that are no slave nodes.
    pub pressure: Vec<f64>,
    /// Way slid in contact since the start of the analysis, `N` entries (length); NaN at nodes that
    /// are no slave nodes.
    pub slip: Vec<f64>,
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
    /// Energy dissipated by the integration scheme.
    pub numerical_dissipation: f64,
    /// What is left of the balance: only the unconverged residual.
    pub balance: f64,
}

/// Momentum of all bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Momentum {
    /// Linear momentum (mass length/time).
    pub linear: [f64; 2],
    /// Angular momentum about the origin (mass length^2/time).
    pub angular: f64,
}

/// Motion, energies and contact force of a body: what elements connect.
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

/// Impulses of a contact: those of its forces and of its impacts, or of its impacts alone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactImpulse {
    /// Impulse on the slave surface (force time).
    pub vector: [f64; 2],
    /// Sum of dt Pn + Phi (force time).
    pub normal: f64,
    /// Sum of dt Pt + Psi (force time).
    pub tangential: f64,
    /// Sum of Phi, the impact impulses (force time).
    pub impact_normal: f64,
    /// Sum of Psi (force time).
    pub impact_tangential: f64,
}

/// Force of one contact on a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactOnBody {
    /// Force.
    pub force: [f64; 2],
    /// Its moment about the origin (force length).
    pub moment: f64,
}

/// Resultants of one contact of the model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactResultant {
    /// Force on the slave surface (force).
    pub force: [f64; 2],
    /// Moment of that force about the origin (force length).
    pub moment: f64,
    /// Sum of Pn (force).
    pub normal: f64,
    /// Sum of Pt (force).
    pub tangential: f64,
    /// Pairs with Pn > 0.
    pub closed: usize,
    /// Closed pairs that do not slip.
    pub sticking: usize,
    /// Smallest gap over the candidate pairs (length); NaN without candidates.
    pub min_gap: f64,
    /// max(|Pt| - mu Pn, 0) / max(Pn); 0 without contact.
    pub cone_violation: f64,
    /// Moment of the force about the reference node of a rigid master (force length); 0 of others.
    pub reference_moment: f64,
    /// Work of the normal contact forces since the start of the analysis.
    pub normal_work: f64,
    /// Energy dissipated by friction since the start of the analysis.
    pub friction_dissipation: f64,
    /// Impulses of the increment.
    pub impulse: ContactImpulse,
    /// Impulses since the start of the analysis.
    pub impulse_sum: ContactImpulse,
    /// Force on each body of a surface that touches itself; empty for two surfaces.
    pub bodies: Vec<ContactOnBody>,
}

/// A slave node that came into contact within the increment; time and place from its second-order
/// motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// Time of the landing.
    pub time: f64,
    /// Slave node (index).
    pub slave: usize,
    /// Nodes a and b of the segment (indices).
    pub segment: [usize; 2],
    /// Place on the segment, 0 at a, 1 at b.
    pub xi: f64,
    /// Approach speed -dg/dt just before (length/time).
    pub approach_speed: f64,
}

/// What the solver did in an increment, or in a whole run.
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
    /// Whether the increment converged.
    pub converged: bool,
}

/// One pass of an increment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PassReport {
    /// Relative force residual with the contact forces of this pass.
    pub residual: f64,
    /// Relative displacement correction.
    pub correction: f64,
    /// Pairs with Pn > 0.
    pub active: usize,
    /// Active pairs that stick.
    pub stick: usize,
    /// Pairs in the complementarity problem.
    pub lcp_size: usize,
    /// Pivots of Lemke's method.
    pub pivots: usize,
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

/// Wall-clock time per phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Timings {
    /// Internal force, tangent and loads.
    pub assembly: Duration,
    /// Factorisations.
    pub factorization: Duration,
    /// Solves with the factors, those for the Delassus matrices included.
    pub solve: Duration,
    /// Contact search: territories and their candidates.
    pub search: Duration,
    /// Pairs among the candidates, their rows and complementarity problems, check of the ways.
    pub contact: Duration,
    /// Complementarity problems.
    pub lcp: Duration,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// All steps are done.
    Finished,
    /// An increment failed for good; the results up to it are valid.
    Stopped(Box<Failure>),
    /// The observer wanted no more; the results up to there are valid.
    Interrupted,
}

/// Totals of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSummary {
    /// How it ended.
    pub outcome: Outcome,
    /// Number of increments done.
    pub increments: usize,
    /// Number of cutbacks.
    pub cutbacks: usize,
    /// Number of increments that an impact ended (`IMPACT TIME=EVENT`).
    pub events: usize,
    /// Counters summed over the increments (`lcp_size` and `residual`: the largest).
    pub solver: SolverCounts,
    /// Time per phase.
    pub timings: Timings,
}

/// Receives the results of a run as it goes. The numerics neither print nor open files.
pub trait Observer {
    /// An increment is done (number 0: the start).
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()>;

    /// An increment is repeated with half its length.
    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()>;

    /// Whether the run is to end here; asked before every attempt at an increment.
    fn wants_stop(&self) -> bool {
        false
    }
}
