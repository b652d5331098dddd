//! Solver settings of a step: time integration and convergence (docs/theory.md, section 4), impacts
//! (section 6), complementarity solver (section 8), sparse factorisation; whether to solve at all.

/// Settings of `*STICKSLIP` and `*NO ANALYSIS` for one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Time integration.
    pub scheme: Scheme,
    /// Impact impulses on or off.
    pub impact: Impact,
    /// When nodes land.
    pub impact_time: ImpactTime,
    /// What becomes of the energy that landings take.
    pub landing: LandingRule,
    /// Mass of the nodes of contact surfaces, the same in all steps.
    pub contact_mass: ContactMass,
    /// Solver of the complementarity problem.
    pub lcp: LcpChoice,
    /// When the effective matrix is factorised again.
    pub factorization: Factorization,
    /// Sparse factorisation.
    pub solver: SolverChoice,
    /// Relative tolerance of an increment's convergence.
    pub tolerance: f64,
    /// Largest number of passes of an increment.
    pub max_passes: usize,
    /// Whether the deck shall be read and checked only (`*NO ANALYSIS`).
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
            lcp: LcpChoice::Hybrid,
            factorization: Factorization::Keep,
            solver: SolverChoice::Faer,
            tolerance: 1e-11,
            max_passes: 25,
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

/// When nodes land.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImpactTime {
    /// Within the increment.
    Increment,
    /// At the time of the impact, which ends a subincrement.
    Event,
}

/// What becomes of the energy that the normal contact forces take at landings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandingRule {
    /// It is lost.
    Plastic,
    /// It is given back as kinetic energy.
    Return,
}

/// Mass of the nodes of contact surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactMass {
    /// That of the elements.
    Consistent,
    /// Carried by the nodes behind the surface.
    Redistributed,
}

/// Solver of the complementarity problem of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LcpChoice {
    /// Warm-started active set; Lemke's method where it fails.
    Hybrid,
    /// Lemke's method at every pass.
    Lemke,
}

/// When the effective matrix is factorised again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Factorization {
    /// Kept as long as the passes converge quickly.
    Keep,
    /// At every pass.
    EveryPass,
}

/// Sparse factorisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolverChoice {
    /// Multifrontal LDL^T in faer's order.
    Faer,
    /// sprs-ldl with an AMD permutation.
    Sprs,
}
