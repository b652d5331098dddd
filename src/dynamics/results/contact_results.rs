//! Resultants, impulses, impacts and errors of the contacts.

/// Impulses of a contact: those of its forces, of its impacts and of landing returns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactViolation {
    /// Largest overlap of an open pair.
    pub overlap: f64,
    /// Largest gap of a closed pair, in absolute value.
    pub gap: f64,
    /// Largest slip of a sticking pair in the increment, in absolute value.
    pub slip: f64,
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
    /// Moment of the force about the reference node of a rigid master (force length); 0 for other
    /// masters.
    pub reference_moment: f64,
    /// Work of the normal contact forces since the start of the analysis.
    pub normal_work: f64,
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
