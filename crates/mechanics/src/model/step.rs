//! Steps: time increments, prescribed displacements and loads with their variation in time, times of field output, and
//! the settings of the solver. See docs/theory/time.md, docs/theory/impacts.md and docs/theory/complementarity.md.

use super::{Amplitude, Face, Friction, TimeBase};
use crate::lcp::LcpMethod;
use crate::linear::SolverChoice;

/// One step with everything that acts in the step, whether given in this step or in an earlier step.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Name of the step, if the deck gives a name.
    pub name: Option<String>,
    /// Its procedure.
    pub procedure: Procedure,
    /// Its increments.
    pub increments: Increments,
    /// Settings of the solver.
    pub settings: Settings,
    /// Prescribed dofs, sorted by dof, each at most once.
    pub supports: Vec<Support>,
    /// Concentrated forces.
    pub point_loads: Vec<Load<PointLoad>>,
    /// Body forces.
    pub body_forces: Vec<Load<BodyForce>>,
    /// Centrifugal forces.
    pub centrifugal_forces: Vec<Load<CentrifugalForce>>,
    /// Follower pressures.
    pub pressures: Vec<Load<Pressure>>,
    /// Dead tractions.
    pub tractions: Vec<Load<Traction>>,
    /// Overlaps that contacts allow, by contact.
    pub interferences: Vec<Load<Interference>>,
    /// Temperatures of nodes, with increasing nodes, each at most once; nodes that are not listed keep the temperature
    /// at the start of the analysis.
    pub temperatures: Vec<Load<NodeTemperature>>,
    /// Contacts that do not act in the step, and contacts with another friction.
    pub contacts: ContactChanges,
    /// Times at which field frames are written.
    pub frames: Frames,
}

impl Step {
    /// A dynamic step in which nothing acts, with the default settings of a deck.
    pub fn new(increments: Increments) -> Self {
        Step {
            name: None,
            procedure: Procedure::Dynamic,
            increments,
            settings: Settings::default(),
            supports: Vec::new(),
            point_loads: Vec::new(),
            body_forces: Vec::new(),
            centrifugal_forces: Vec::new(),
            pressures: Vec::new(),
            tractions: Vec::new(),
            interferences: Vec::new(),
            temperatures: Vec::new(),
            contacts: ContactChanges::default(),
            frames: Frames::default(),
        }
    }

    /// The prescribed motion of a dof; `None` if the dof is free.
    pub fn motion_of(&self, dof: usize) -> Option<SupportMotion> {
        let place = (self.supports).binary_search_by_key(&dof, |support| support.dof);
        place.ok().map(|index| self.supports[index].motion)
    }
}

/// Changes of the contacts in a step, made by the step itself or by an earlier step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactChanges {
    /// Contacts that do not act (indices, increasing).
    pub removed: Vec<usize>,
    /// Contacts whose friction differs from the friction of their interaction, by increasing contacts.
    pub friction: Vec<FrictionChange>,
}

/// Friction of a contact in a step.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionChange {
    /// Index of the contact.
    pub contact: usize,
    /// Friction of the contact; if a former friction is replaced gradually, this is the final friction.
    pub friction: Friction,
    /// Former friction, which is replaced gradually.
    pub from: Option<FormerFriction>,
}

/// A friction that another friction replaces gradually.
#[derive(Debug, Clone, PartialEq)]
pub struct FormerFriction {
    /// The friction.
    pub friction: Friction,
    /// Index of the amplitude whose value, from 0 to 1, is the replaced part; without an amplitude the replaced part
    /// grows linearly over the step from 0 to 1.
    pub amplitude: Option<usize>,
}

impl ContactChanges {
    /// Whether a coefficient of friction ramps over the step.
    pub fn ramp(&self) -> bool {
        let mut former = self
            .friction
            .iter()
            .filter_map(|change| change.from.as_ref());
        former.any(|former| former.amplitude.is_none())
    }
}

/// Request of checkpoints, valid from a step on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RestartOutput {
    /// Number, from 1, of the first step with the requested checkpoints.
    pub from_step: usize,
    /// Number of increments between two checkpoints of a step; the last increment of a step always has a checkpoint. 0:
    /// none.
    pub every: usize,
    /// Whether earlier checkpoints of the step are kept.
    pub keeps_all: bool,
}

/// Procedure of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Procedure {
    /// The equation of motion, integrated implicitly in time (`*DYNAMIC`).
    Dynamic,
    /// The equation of motion by the backward Euler rule, which removes the energy of vibrations (`*DYNAMIC,
    /// APPLICATION=QUASI-STATIC`).
    QuasiStatic,
    /// Equilibrium without inertia, damping and impacts (`*STATIC`).
    Static,
}

/// Time increments of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increments {
    /// Increment dt (time).
    pub dt: f64,
    /// Duration T of the step (time).
    pub period: f64,
    /// Smallest increment that a cutback may reach (time). By default the smallest increment is 0; in a static step
    /// without DIRECT it is 1e-5 of the duration, or the increment dt if dt is smaller.
    pub dt_min: f64,
    /// Largest increment (time).
    pub dt_max: f64,
    /// Criterion for the length of the increments.
    pub incrementation: Incrementation,
}

impl Increments {
    /// Increments of one length over a step (DIRECT); cutbacks may shorten these increments without limit.
    pub fn fixed(dt: f64, period: f64) -> Self {
        Increments {
            dt,
            period,
            dt_min: 0.0,
            dt_max: dt,
            incrementation: Incrementation::Fixed,
        }
    }
}

/// Criterion for the length of the increments of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Incrementation {
    /// The deck fixes the length: all increments have one length except after cutbacks (DIRECT).
    Fixed,
    /// The number of passes determines the length of the increments.
    Passes,
    /// The truncation error determines the length of the increments.
    Error {
        /// Largest truncation error, relative to the displacements of the step so far.
        tolerance: f64,
    },
}

/// Times at which field frames are written. Frames at the start and at the end of a step are always written.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Frames {
    /// The program's default number of frames.
    #[default]
    Default,
    /// A given number of frames, evenly spaced over the step.
    Count(usize),
    /// Frames at multiples of a given time since the start of the step.
    Every(f64),
    /// Frames after each multiple of a given number of increments.
    Increments(usize),
    /// Frames at the given step times, which increase.
    Times(Vec<f64>),
}

/// Variation of a load's magnitude in time within its step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variation {
    /// The full magnitude from the start of the step.
    Constant,
    /// Linear over the step, from the magnitude at its start up to the full magnitude.
    Ramp {
        /// Magnitude at the start of the step.
        from: f64,
    },
    /// Magnitude times the amplitude with the given index.
    Amplitude(usize),
}

/// A load: its kind and place (`at`), its full magnitude and its variation in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load<T> {
    /// Loaded dof, element or face, and direction.
    pub at: T,
    /// Full magnitude.
    pub magnitude: f64,
    /// Variation of the magnitude in time.
    pub variation: Variation,
}

impl<T> Load<T> {
    /// Whether the magnitude changes linearly over the step.
    pub fn ramps(&self) -> bool {
        matches!(self.variation, Variation::Ramp { .. })
    }

    /// Magnitudes at the start and at the end of the step; `None` if an amplitude gives the magnitudes.
    pub fn ends(&self) -> Option<[f64; 2]> {
        match self.variation {
            Variation::Constant => Some([self.magnitude; 2]),
            Variation::Ramp { from } => Some([from, self.magnitude]),
            Variation::Amplitude(_) => None,
        }
    }

    /// The load with the given magnitudes at start and end of the step, linear in between.
    pub fn between(self, [from, magnitude]: [f64; 2]) -> Self {
        let variation = match from == magnitude {
            true => Variation::Constant,
            false => Variation::Ramp { from },
        };
        Load {
            magnitude,
            variation,
            ..self
        }
    }
}

/// Concentrated force (magnitude: force) on one dof, `2 node + direction`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLoad {
    /// Loaded dof.
    pub dof: usize,
}

/// Force per reference volume along a fixed direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyForce {
    /// Loaded element.
    pub element: usize,
    /// Direction; a unit vector.
    pub direction: [f64; 2],
    /// Whether the magnitude is an acceleration (GRAV: multiplied by the density) or a force per
    /// volume (BX, BY).
    pub per_mass: bool,
}

/// Centrifugal force (magnitude: square of the angular velocity, 1/time^2) of the mass of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CentrifugalForce {
    /// Loaded element.
    pub element: usize,
    /// Place of the axis, which is perpendicular to the plane (length); in bodies of revolution the axis is x = 0.
    pub axis: [f64; 2],
}

/// Pressure or shear (magnitude: force/length^2) on the current face. A pressure is positive into the body; a shear
/// acts along the face, from its first corner to its last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressure {
    /// Loaded face.
    pub face: Face,
    /// Whether the load is a shear, not a pressure.
    pub is_shear: bool,
}

impl Pressure {
    /// The force of a unit magnitude, if `thrust` is `int N^T n dl` with the outward normal n.
    pub fn force(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self.is_shear {
            true => [-y, x],
            false => [-x, -y],
        }
    }
}

/// Dead traction (magnitude: force per reference area) along a fixed direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Traction {
    /// Loaded face.
    pub face: Face,
    /// Direction; a unit vector.
    pub direction: [f64; 2],
}

/// Temperature of a node (magnitude: temperature).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeTemperature {
    /// Index of the node.
    pub node: usize,
}

/// Overlap that a contact allows. The magnitude is a length, the same for all slave nodes. For a shrink fit the
/// magnitude is a factor on the overlap of each node at the start of the analysis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interference {
    /// Index of the contact.
    pub contact: usize,
    /// Whether the allowed overlap of every node is proportional to its overlap at the start of the
    /// analysis.
    pub is_shrink: bool,
}

/// A dof whose displacement is prescribed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Prescribed dof, `2 node + direction`.
    pub dof: usize,
    /// Displacement of the dof as a function of time.
    pub motion: SupportMotion,
}

/// Motion of a support within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SupportMotion {
    /// Linear over the step from the displacement at the start of the step to `to` (length) at its end.
    Ramp {
        /// Displacement at the end of the step.
        to: f64,
    },
    /// `value` (length) times the amplitude with the index `amplitude`.
    Amplitude {
        /// Factor of the amplitude.
        value: f64,
        /// Index into `Model::amplitudes`.
        amplitude: usize,
    },
    /// A velocity or an acceleration, by which the motion continues from displacement and velocity at the start of the
    /// step.
    Rate {
        /// The prescribed derivative.
        rate: Rate,
        /// Value of the rate, or factor of the amplitude (length/time, length/time^2).
        value: f64,
        /// Index into `Model::amplitudes`; without an amplitude the rate is constant.
        amplitude: Option<usize>,
    },
}

impl SupportMotion {
    /// Whether the support stays at its place at the start of the analysis.
    pub fn is_still(self) -> bool {
        match self {
            SupportMotion::Ramp { to } => to == 0.0,
            SupportMotion::Amplitude { value, .. } | SupportMotion::Rate { value, .. } => {
                value == 0.0
            }
        }
    }

    /// Motion of a support after a step of the given duration, if no card changes the motion: a motion that follows an
    /// amplitude in step time keeps its last value.
    pub fn after_step(self, period: f64, amplitudes: &[Amplitude]) -> SupportMotion {
        let last = |index: usize| {
            let curve = amplitudes.get(index);
            let curve = curve.filter(|curve| curve.time == TimeBase::Step);
            curve.map(|curve| curve.at(period))
        };
        match self {
            SupportMotion::Amplitude { value, amplitude } => match last(amplitude) {
                Some(last) => SupportMotion::Ramp { to: value * last },
                None => self,
            },
            SupportMotion::Rate {
                rate,
                value,
                amplitude,
            } => match amplitude.and_then(last) {
                Some(last) => SupportMotion::Rate {
                    rate,
                    value: value * last,
                    amplitude: None,
                },
                None => self,
            },
            SupportMotion::Ramp { .. } => self,
        }
    }
}

/// The derivative of the displacement that a card prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rate {
    /// The first.
    Velocity,
    /// The second.
    Acceleration,
}

/// Settings of `*STICKSLIP` and `*NO ANALYSIS` for one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Time integration.
    pub scheme: Scheme,
    /// Whether there are impact impulses.
    pub impact: Impact,
    /// Time at which nodes land.
    pub impact_time: ImpactTime,
    /// Treatment of the energy that landings remove.
    pub landing: LandingRule,
    /// Mass of the nodes of contact surfaces, the same in all steps.
    pub contact_mass: ContactMass,
    /// Solver of the complementarity problem.
    pub lcp: LcpMethod,
    /// Rule for factorising the effective matrix again.
    pub factorization: Factorization,
    /// Sparse factorisation.
    pub solver: SolverChoice,
    /// Relative tolerance of an increment's convergence.
    pub tolerance: f64,
    /// Largest number of passes of an increment.
    pub max_passes: usize,
    /// Whether the deck is only to be read and checked (`*NO ANALYSIS`).
    pub is_check_only: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            scheme: Scheme::EnergyMomentum,
            impact: Impact::Impulse,
            impact_time: ImpactTime::Increment,
            landing: LandingRule::Plastic,
            contact_mass: ContactMass::Consistent,
            lcp: LcpMethod::Hybrid,
            factorization: Factorization::Keep,
            solver: SolverChoice::Faer,
            tolerance: 1e-11,
            max_passes: 50,
            is_check_only: false,
        }
    }
}

/// Time integration scheme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// Implicit mid-point rule with the averaged stress, and energy-momentum contact.
    EnergyMomentum,
    /// Single-step SS22 of Zienkiewicz, Wood & Hine (1984), stable for theta2 >= theta1 >= 1/2.
    Ss22 {
        /// Weight of velocity and load.
        theta1: f64,
        /// Weight of the acceleration.
        theta2: f64,
    },
}

/// Change of the velocity of landing nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Impact {
    /// Impulses at the start of the increment.
    Impulse,
    /// No impulses.
    None,
}

/// Time at which nodes land.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImpactTime {
    /// Nodes land within the increment.
    Increment,
    /// Nodes land at the time of the impact, which ends a subincrement.
    Event,
}

/// Treatment of the energy that the normal contact forces remove at landings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandingRule {
    /// The energy is lost.
    Plastic,
    /// The energy is given back as kinetic energy.
    Return,
}

/// Mass of the nodes of contact surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactMass {
    /// Consistent mass of the elements.
    Consistent,
    /// The nodes behind the surface carry the mass.
    Redistributed,
}

/// Rule for factorising the effective matrix again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factorization {
    /// Factors are kept as long as the passes converge quickly.
    Keep,
    /// The matrix is factorised in every pass.
    EveryPass,
}
