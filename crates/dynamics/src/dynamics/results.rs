//! Results of an increment, as the output receives them through [`Observer`].
//!
//! Resultants, impulses, impacts and errors of the contacts.
//!
//! One pass of an increment: errors, contact states, work of the complementarity problem.
//!
//! The end of a run: outcome, counts and times of its phases.
//!
//! Failed increments: cause, worst node and data of the attempt, for the report of a cutback or a
//! stop.
//!
//! How the passes of an attempt went that did not converge, as the report of its failure tells it.

use std::sync::Arc;
use std::time::Duration;
use std::{fmt, io};

use crate::contact::{ClosedPairs, Constraint};
use crate::elements::{ConnectorState, ElementResult, Inverted, Strained};
use crate::lcp::{FrictionalLcp, LcpError};
use crate::linear::LinearError;

/// Motion at one time, `2 N` entries each, what the materials remember, and the pairs in contact.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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
    /// The pairs that carry a force.
    pub contact: ClosedPairs,
}

/// Contact status of a node as slave; a node that is slave of several pairs shows the highest.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Default,
    serde::Serialize,
    serde::Deserialize,
)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct NodalResults {
    /// Support reaction, with the force that the support exerts through equations, eq. (9.12), `2 N` entries
    /// (force); 0 at all other dofs. That of a rigid body is at its reference node.
    pub reaction: Vec<f64>,
    /// Concentrated loads on the node, `2 N` entries (force).
    pub concentrated: Vec<f64>,
    /// Contact force on the node, `2 N` entries (force).
    pub contact_force: Vec<f64>,
    /// Force of its tie on a tied node, `2 N` entries (force); none where there are no ties.
    pub tie_force: Vec<f64>,
    /// Force of every hinge on its first node (force); that on its second is its opposite.
    pub hinge_force: Vec<[f64; 2]>,
    /// Gap of the node to its segment, `N` entries (length); NaN without candidate.
    pub gap: Vec<f64>,
    /// Contact status, `N` entries.
    pub status: Vec<NodeStatus>,
    /// Contact pressure, `N` entries (force/length^2); NaN at all nodes but slave
    /// nodes.
    pub pressure: Vec<f64>,
    /// What friction does at slave nodes.
    pub friction: FrictionResults,
    /// Accumulated slip since the start of the analysis, `N` entries (length); NaN at all nodes but
    /// slave nodes.
    pub slip: Vec<f64>,
    /// Masses, `N` entries where they are redistributed, else none.
    pub mass: Vec<NodeMass>,
}

/// What friction does at the nodes as slaves: `N` entries each where a contact of the deck has it, else none; NaN at
/// all nodes but slave nodes.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct FrictionResults {
    /// Coefficient of friction of the closed pairs, their mean by Pn, where it varies; NaN without closed pairs.
    pub coefficient: Vec<f64>,
    /// Its work since the start of the analysis over the area of the node (energy/length^2).
    pub work: Vec<f64>,
    /// Depth of wear since the start (length).
    pub wear: Vec<f64>,
    /// Heat into the slave surface since the start (energy).
    pub heat: Vec<f64>,
}

/// Energies; all but the first two are cumulative from the start of the analysis.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Energy {
    /// Kinetic energy T.
    pub kinetic: f64,
    /// Strain energy W.
    pub strain: f64,
    /// The part of it in hourglass modes.
    pub hourglass: f64,
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
    /// Largest kinetic or strain energy or external work so far, in static steps also the work of the loads or of the
    /// supports alone.
    pub scale: f64,
    /// Work that the round-off of the forces may have done in static steps.
    pub round_off: f64,
}

impl BodyResult {
    /// Leaves out what is zero in a body of revolution: all but what is along its axis.
    pub(super) fn keep_to_axis(&mut self) {
        self.center[0] = 0.0;
        self.velocity[0] = 0.0;
        self.angular_velocity = 0.0;
        self.contact_force[0] = 0.0;
        self.contact_moment = 0.0;
    }
}

/// Momentum of all bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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

/// Reaction that holds a rigid body, and the motion of one that turns.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct RigidReaction {
    /// Force.
    pub force: [f64; 2],
    /// Its moment about the reference node (force length).
    pub moment: f64,
    /// Angle since the start (rad).
    pub angle: f64,
    /// Angular velocity (1/time).
    pub angular_velocity: f64,
    /// Position of the centre of mass.
    pub center: [f64; 2],
    /// Kinetic energy.
    pub kinetic: f64,
}

/// Work of the solver in an increment or in a whole run, and the errors of its answer.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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
    /// Largest force that holds a motion which only facets resist, as a part of the normal forces at its body.
    pub held: f64,
    /// Whether the increment converged.
    pub converged: bool,
}

/// Everything about one finished increment; number 0 is the start. A checkpoint keeps the numbers of the last one
/// ([`IncrementReport::numbers`]).
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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
    /// Truncation error beside the displacements, in a step whose increments it decides.
    pub truncation_error: Option<f64>,
    /// Motion at the end.
    #[serde(skip)]
    pub state: State,
    /// Results at nodes.
    #[serde(skip)]
    pub nodal: NodalResults,
    /// Strain energy, mean stress and mean strain of every element.
    #[serde(skip)]
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
    /// Springs and dashpots, in the order of the model.
    pub connectors: Vec<ConnectorState>,
    /// Largest principal strain.
    pub strain: Strained,
    /// Resultants, one per contact of the model.
    pub contacts: Vec<ContactResultant>,
    /// Difference of the work of friction, wear and heat of the nodes from those of the contacts, as a part of all that
    /// was added since the start.
    pub surface_work_difference: f64,
    /// Landings of this increment.
    #[serde(skip)]
    pub landings: Vec<Landing>,
    /// Total impulses of the pairs that were given energy back.
    #[serde(skip)]
    pub returns: Vec<ReturnedImpulse>,
    /// Touches that have ended.
    #[serde(skip)]
    pub touches: Vec<Touch>,
    /// The body with the largest force that holds a motion which only facets resist.
    #[serde(skip)]
    pub held: Option<Box<Unbalanced>>,
    /// Counters of this increment.
    pub solver: SolverCounts,
    /// Its passes.
    #[serde(skip)]
    pub passes: Vec<PassReport>,
}

impl IncrementReport {
    /// Its numbers, without fields and without what happened in it.
    pub fn numbers(&self) -> IncrementReport {
        IncrementReport {
            increment: self.increment,
            step: self.step,
            time: self.time,
            step_time: self.step_time,
            dt: self.dt,
            ends_step: self.ends_step,
            truncation_error: self.truncation_error,
            energy: self.energy,
            contact_energy: self.contact_energy,
            momentum: self.momentum,
            bodies: self.bodies.clone(),
            rigid: self.rigid.clone(),
            connectors: self.connectors.clone(),
            strain: self.strain,
            contacts: self.contacts.clone(),
            solver: self.solver,
            ..IncrementReport::default()
        }
    }

    /// Leaves out what vectors over the dofs hold beyond those of so many nodes.
    pub fn keep_nodes(&mut self, nodes: usize) {
        let (state, nodal) = (&mut self.state, &mut self.nodal);
        for vector in [
            &mut state.u,
            &mut state.v,
            &mut state.a,
            &mut nodal.reaction,
            &mut nodal.concentrated,
            &mut nodal.contact_force,
            &mut nodal.tie_force,
        ] {
            vector.truncate(2 * nodes);
        }
        nodal.gap.truncate(nodes);
        nodal.status.truncate(nodes);
    }
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

    /// Whether a checkpoint is due; asked after every increment.
    fn wants_checkpoint(&self) -> bool {
        false
    }

    /// All that the rest of the run depends on, for [`super::resume`]: when it is wanted, and before the run ends
    /// because it shall.
    fn checkpoint(&mut self, _checkpoint: Vec<u8>) -> io::Result<()> {
        Ok(())
    }
}

/// Impulses of a contact: those of its forces, of its impacts and of landing returns.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactImpulse {
    /// Impulse on the slave surface (force time).
    pub vector: [f64; 2],
    /// Sum of dt Pn + Phi and of what landing returns give (force time).
    pub normal: f64,
    /// Sum of dt Pt + Psi (force time).
    pub tangential: f64,
    /// Sum of Phi, the impact impulses (force time).
    pub impact_normal: f64,
    /// Sum of Psi (force time).
    pub impact_tangential: f64,
    /// Sum of the normal impulses of landing returns; negative ones take back what the next increment
    /// gives (force time).
    pub landing_return: f64,
}

/// How far the pairs at the end of an increment are from the contact law, in lengths of their segments.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactViolation {
    /// Largest overlap of an open pair.
    pub overlap: f64,
    /// Largest gap of a closed pair, in absolute value.
    pub gap: f64,
    /// Largest slip of a sticking pair in the increment, in absolute value.
    pub slip: f64,
    /// Largest penetration: of an open pair, of edges that cross, or of nodes whose means are kept out, in lengths of the
    /// edge.
    pub penetration: f64,
}

/// Force of one contact on a body.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactOnBody {
    /// Force.
    pub force: [f64; 2],
    /// Its moment about the origin (force length).
    pub moment: f64,
}

/// Resultants of one contact of the model.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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
    /// Coefficient of friction of the closed pairs, their mean by Pn; NaN without any.
    pub friction_coefficient: f64,
    /// max(|Pt| - mu Pn, 0) / max(Pn), of a pair that slips ||Pt| - mu Pn| / max(Pn); 0 without contact; mu is that of the
    /// law.
    pub cone_violation: f64,
    /// Distance from the cone of the total impulses of the pairs in the increment, with impacts and what is given back; of a
    /// pair whose total pulls, the pull.
    pub impulse_cone_violation: f64,
    /// Moment of the force about the reference node of a rigid master (force length); 0 for other
    /// masters.
    pub reference_moment: f64,
    /// Work of the normal contact forces since the start of the analysis.
    pub normal_work: f64,
    /// The part of it of nodes that landed where others of the same two bodies had opened, while the bodies stayed in
    /// contact.
    pub handover_work: f64,
    /// Energy dissipated by friction since the start of the analysis.
    pub friction_dissipation: f64,
    /// Kinetic energy given back after its landings and releases since the start of the analysis.
    pub landing_return: f64,
    /// Energy that nodes without mass lost after its releases since the start of the analysis.
    pub release_loss: f64,
    /// Impulses of the increment.
    pub impulse: ContactImpulse,
    /// Impulses since the start of the analysis.
    pub impulse_sum: ContactImpulse,
    /// Force on each body in self-contact; empty for two surfaces.
    pub bodies: Vec<ContactOnBody>,
}

/// The contact of two bodies, or of a body and a rigid surface, from the landing of a first node until no pair is
/// closed.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Touch {
    /// The bodies, in the order of [`crate::model::Bodies`]; none for a rigid surface.
    pub bodies: [Option<usize>; 2],
    /// A slave node that landed first (index).
    pub node: usize,
    /// Time at the start of the first increment.
    pub start: f64,
    /// Time at the end of the last increment.
    pub end: f64,
    /// Number of the first increment.
    pub first: usize,
    /// Number of the last increment.
    pub last: usize,
    /// Most nodes of one side in contact at a time.
    pub nodes: usize,
    /// Whether the contact reached a corner of an outline.
    pub is_at_corner: bool,
    /// Impulse J on one of the bodies (force time).
    pub impulse: f64,
    /// J²/(8 m), m being the reduced mass of the bodies: the kinetic energy of their approach where they rebound
    /// with their speed; 0 where both are held.
    pub energy: f64,
}

/// Total impulses on a pair of an increment after which it was given energy back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReturnedImpulse {
    /// Time at the end of the increment.
    pub time: f64,
    /// Slave node (index).
    pub slave: usize,
    /// Nodes a and b of the segment (indices).
    pub segment: [usize; 2],
    /// Total normal impulse: dt Pn + Phi and what is given back (force time).
    pub normal: f64,
    /// Total tangential impulse (force time).
    pub tangential: f64,
    /// Normal impulse that gives back (force time).
    pub returned_normal: f64,
    /// Tangential impulse with it (force time).
    pub returned_tangential: f64,
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
    /// Local coordinate on the segment, 0 at a, 1 at b.
    pub xi: f64,
    /// Approach speed -dg/dt just before (length/time).
    pub approach_speed: f64,
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
    /// Pairing of candidates, constraint rows and Delassus matrices, penetration check.
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
    /// The observer requested the end; the results up to there are valid.
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
    /// Number of increments that were repeated because of their truncation error.
    pub rejections: usize,
    /// Number of increments that an impact ended (`IMPACT TIME=EVENT`).
    pub events: usize,
    /// Counters summed over the increments (`lcp_size`, `residual` and `violation`: the largest).
    pub solver: SolverCounts,
    /// Time per phase.
    pub timings: Timings,
}

/// Why an increment failed.
#[derive(Debug, Clone, PartialEq)]
pub enum Cause {
    /// The passes did not converge.
    NotConverged,
    /// The determinant of an element's deformation gradient is not positive.
    Inverted {
        /// Element (index).
        element: usize,
        /// Determinant.
        determinant: f64,
    },
    /// A segment has shrunk to almost no length.
    Collapsed {
        /// Its ends (indices).
        segment: [usize; 2],
    },
    /// A body that contact alone holds is not in balance, whatever the forces of contact.
    Unbalanceable(Box<Unbalanced>),
    /// The equilibrium is not stable.
    Unstable {
        /// Node (index) whose pivot is not positive.
        node: usize,
    },
    /// A static increment leads much farther than the last one of the same load: to another equilibrium.
    Jump {
        /// Node (index) that moves most.
        node: usize,
    },
    /// The effective matrix is not positive definite.
    Indefinite {
        /// Node (index) whose pivot is not positive.
        node: usize,
    },
    /// The truncation error of a converged increment is too large.
    Inaccurate {
        /// It, beside the displacements.
        error: f64,
        /// The largest that counts as small.
        tolerance: f64,
    },
    /// The factorisation or a solve with it failed.
    LinearSolver(LinearError),
    /// The passes diverged until numbers were not finite.
    Diverged,
    /// A node has entered a body through a segment.
    Crossed {
        /// Slave node (index).
        slave: usize,
        /// Ends (indices) of the segment.
        segment: [usize; 2],
        /// Whether the motion of all three is prescribed.
        prescribed: bool,
    },
    /// A contact is added while a slave node is inside the master body.
    Overlaps {
        /// Slave node (index).
        slave: usize,
        /// Ends (indices) of the segment.
        segment: [usize; 2],
        /// How deep it is inside (length).
        depth: f64,
    },
    /// Positive work of the normal contact forces: contact would put energy in.
    GainedEnergy {
        /// The energy put in, relative to the largest energy.
        part: f64,
        /// Slave node and ends of the segment (indices) of the pair whose force puts the most in.
        pair: Option<[usize; 3]>,
    },
    /// The energy balance is off: the residual that the passes have left does work that counts.
    Unbalanced {
        /// The balance relative to the largest energy.
        part: f64,
        /// Whether the round-off of positions makes forces whose work in an increment counts by itself: in halves
        /// it is not less.
        is_round_off: bool,
    },
    /// A complementarity problem was not solved.
    Lcp(Box<FailedLcp>),
    /// A quantity is not finite.
    NotFinite {
        /// Which.
        what: &'static str,
        /// Node (index) of the value, or the node that moves most.
        node: usize,
    },
}

/// A body that is not in balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalanced {
    /// One of its nodes (index).
    pub node: usize,
    /// Force that is left over.
    pub force: [f64; 2],
    /// Its moment about the mean of the nodes (force length).
    pub moment: f64,
    /// Rigid motion that the body is about to make: displacement of that place and angle (length; rad).
    pub motion: [f64; 3],
    /// Distance of its farthest node from there (length).
    pub size: f64,
}

/// A complementarity problem without solution, of a pass or of the impulses.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedLcp {
    /// Why it was not solved.
    pub error: LcpError,
    /// The problem.
    pub problem: FrictionalLcp,
    /// Nodes (indices) of its pairs: slave, segment ends a and b.
    pub pairs: Vec<[usize; 3]>,
}

impl FailedLcp {
    /// Whether its pairs contradict each other.
    pub fn is_contradiction(&self) -> bool {
        matches!(self.error, LcpError::Ray { .. })
    }

    /// The problem of some constraints that was not solved.
    pub(crate) fn new(
        error: LcpError,
        problem: FrictionalLcp,
        constraints: &[&Constraint],
    ) -> Self {
        FailedLcp {
            error,
            problem,
            pairs: constraints.iter().map(|c| c.pair().nodes).collect(),
        }
    }
}

/// The node with the largest residual or correction of a failed increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Node (index).
    pub node: usize,
    /// Its current position (length).
    pub position: [f64; 2],
    /// Which quantity is worst there.
    pub quantity: &'static str,
    /// Its value relative to the tolerance's scale.
    pub value: f64,
}

/// A failed attempt at an increment.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Number of the increment over all steps.
    pub increment: usize,
    /// Number of the step, from 1.
    pub step: usize,
    /// Time at the start of the increment.
    pub time: f64,
    /// Length of the attempt.
    pub dt: f64,
    /// Why.
    pub cause: Cause,
    /// How the passes went, where they did not converge.
    pub course: Option<Box<Course>>,
    /// The node with the largest error, where the passes have one.
    pub worst: Option<Worst>,
    /// Passes of the attempt.
    pub passes: Vec<PassReport>,
    /// How many times the increment had been halved.
    pub halvings: u32,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::NotConverged => write!(f, "the passes did not converge"),
            Cause::Inverted { determinant, .. } => {
                write!(
                    f,
                    "an element turned inside out (det F = {determinant:.3e})"
                )
            }
            Cause::Collapsed { .. } => write!(f, "a segment shrank to a point"),
            Cause::Unbalanceable(_) => write!(f, "a body is not in equilibrium"),
            Cause::Unstable { .. } => write!(f, "the equilibrium is not stable"),
            Cause::Jump { .. } => {
                write!(
                    f,
                    "a body jumps to another equilibrium: its load has reached a limit"
                )
            }
            Cause::Indefinite { .. } => write!(f, "the effective matrix is not positive definite"),
            Cause::Crossed { .. } => write!(f, "a node went through a segment"),
            Cause::Overlaps { depth, .. } => write!(
                f,
                "a contact is added while its bodies overlap by {depth:.3e}"
            ),
            Cause::GainedEnergy { part, .. } => {
                write!(f, "contact would put energy in ({part:.1e} of the largest)")
            }
            Cause::Unbalanced { part, .. } => {
                write!(
                    f,
                    "the energy balance would be off by {part:.1e} of the largest energy"
                )
            }
            Cause::Inaccurate { error, tolerance } => {
                write!(
                    f,
                    "its truncation error of {error:.1e} is above {tolerance:.1e} of the displacements"
                )
            }
            Cause::LinearSolver(error) => write!(f, "the linear solver failed: {error}"),
            Cause::Diverged => write!(f, "the passes diverged"),
            Cause::Lcp(failed) => match &failed.error {
                LcpError::Ray { .. } => {
                    write!(
                        f,
                        "no contact forces hold the bodies (an LCP ended on a ray)"
                    )
                }
                error => write!(f, "a complementarity problem was not solved: {error}"),
            },
            Cause::NotFinite { what, .. } => write!(f, "{what} is not finite"),
        }
    }
}

impl From<LinearError> for Cause {
    fn from(error: LinearError) -> Self {
        Cause::LinearSolver(error)
    }
}

impl Cause {
    /// Whether the increment would fail in halves as well.
    pub fn stays(&self) -> bool {
        matches!(
            self,
            Cause::Unbalanced {
                is_round_off: true,
                ..
            }
        )
    }

    /// Whether the only cause is a number that has become too large.
    pub(crate) fn is_overflow(&self) -> bool {
        match self {
            Cause::LinearSolver(LinearError::NotFinite(_)) | Cause::NotFinite { .. } => true,
            Cause::Inverted { determinant, .. } => !determinant.is_finite(),
            Cause::Lcp(failed) => failed.error == LcpError::NotFinite,
            _ => false,
        }
    }
}

impl From<Inverted> for Cause {
    fn from(
        Inverted {
            element,
            determinant,
        }: Inverted,
    ) -> Self {
        Cause::Inverted {
            element,
            determinant,
        }
    }
}

/// The passes of an attempt that did not converge, from where they last began with the predictor.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Corrections grew.
    Growing {
        /// Number of the first pass that they grew after.
        from: usize,
    },
    /// Pairs went to and fro between two states, one of every slave node that did.
    Alternating(Vec<Alternation>),
    /// Corrections became smaller, but slowly.
    Slow {
        /// Correction over the one before, mean of the last passes.
        rate: f64,
        /// Further passes that would have been needed at this rate.
        left: usize,
    },
    /// Corrections became no smaller.
    Stagnant {
        /// The smallest relative correction of the last passes.
        correction: f64,
    },
}

/// A slave node whose contact left a state and came back to it; all numbers are indices of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alternation {
    /// Its pair with a segment closed and opened: slave, segment ends a and b.
    Closing([usize; 3]),
    /// It was on one segment and on another.
    Changing {
        /// Slave node.
        slave: usize,
        /// Ends a and b of both.
        segments: [[usize; 2]; 2],
    },
    /// Its pair stuck and slid, or slid one way and the other: slave, segment ends a and b.
    Sliding([usize; 3]),
}
