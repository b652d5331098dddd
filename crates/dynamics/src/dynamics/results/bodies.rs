//! Momenta, results of bodies and reactions of rigid bodies. See docs/theory/impacts.md, Bodies and Rigid bodies.

/// Momentum of all bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Momentum {
    /// Linear momentum (mass length/time).
    pub linear: [f64; 2],
    /// Angular momentum about the origin (mass length^2/time).
    pub angular: f64,
    /// Angular momentum with the consistent mass, if the mass is redistributed.
    pub consistent_angular: Option<f64>,
    /// Linear momentum that mass-proportional damping has removed since the start of the analysis (mass length/time).
    pub damped_linear: [f64; 2],
    /// Angular momentum that mass-proportional damping has removed since the start of the analysis (mass
    /// length^2/time).
    pub damped_angular: f64,
}

/// Motion, energies and contact force of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct BodyResult {
    /// Centre of mass (length).
    pub center: [f64; 2],
    /// Velocity of the centre of mass (length/time).
    pub velocity: [f64; 2],
    /// Angular momentum about the centre of mass divided by the moment of inertia (1/time).
    pub angular_velocity: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Force of all contacts on the body (force).
    pub contact_force: [f64; 2],
    /// Moment of all contact forces about the centre of mass (force length).
    pub contact_moment: f64,
}

impl BodyResult {
    /// Sets to zero the components that vanish in a body of revolution, that is, all components except along its axis.
    pub(crate) fn keep_to_axis(&mut self) {
        self.center[0] = 0.0;
        self.velocity[0] = 0.0;
        self.angular_velocity = 0.0;
        self.contact_force[0] = 0.0;
        self.contact_moment = 0.0;
    }
}

/// Reaction that holds a rigid body, and the motion of a rigid body that turns.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct RigidReaction {
    /// Force.
    pub force: [f64; 2],
    /// Moment of the reaction about the reference node (force length).
    pub moment: f64,
    /// Angle of rotation since the start (rad).
    pub angle: f64,
    /// Angular velocity (1/time).
    pub angular_velocity: f64,
    /// Position of the centre of mass.
    pub center: [f64; 2],
    /// Kinetic energy.
    pub kinetic: f64,
}
