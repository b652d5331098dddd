//! Momenta, results of bodies and reactions of rigid ones. See docs/theory/impacts.md, Bodies and Rigid bodies.

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

impl BodyResult {
    /// Leaves out what is zero in a body of revolution: all but what is along its axis.
    pub(crate) fn keep_to_axis(&mut self) {
        self.center[0] = 0.0;
        self.velocity[0] = 0.0;
        self.angular_velocity = 0.0;
        self.contact_force[0] = 0.0;
        self.contact_moment = 0.0;
    }
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
