//! Resultants, impulses, impacts and errors of the contacts.

/// Impulses of a contact: of its forces, of its impacts and of landing returns.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactImpulse {
    /// Impulse on the slave surface (force time).
    pub vector: [f64; 2],
    /// Normal impulse: sum of dt Pn + Phi and of the normal impulses of landing returns (force
    /// time).
    pub normal: f64,
    /// Tangential impulse: sum of dt Pt + Psi (force time).
    pub tangential: f64,
    /// Sum of Phi, the normal impact impulses (force time).
    pub impact_normal: f64,
    /// Sum of Psi, the tangential impact impulses (force time).
    pub impact_tangential: f64,
    /// Sum of the normal impulses of landing returns; a negative impulse takes a part of the contact force back (force
    /// time).
    pub landing_return: f64,
}

/// Errors of the pairs against the contact law at the end of an increment, in lengths of their segments.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactViolation {
    /// Largest overlap of an open pair.
    pub overlap: f64,
    /// Largest absolute value of the gap of a closed pair.
    pub gap: f64,
    /// Largest absolute value of the slip of a sticking pair in the increment.
    pub slip: f64,
    /// Largest penetration: of an open pair, of edges that cross, or of nodes in contact from surface to surface, in
    /// lengths of the edge.
    pub penetration: f64,
}

/// Force of one contact on a body.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactOnBody {
    /// Force.
    pub force: [f64; 2],
    /// Moment of the force about the origin (force length).
    pub moment: f64,
}

/// Resultants of one contact of the model.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ContactResultant {
    /// Force on the slave surface (force).
    pub force: [f64; 2],
    /// Moment of the force on the slave surface about the origin (force length).
    pub moment: f64,
    /// Sum of the normal forces Pn (force).
    pub normal: f64,
    /// Sum of the tangential forces Pt (force).
    pub tangential: f64,
    /// Number of closed pairs (Pn > 0).
    pub closed: usize,
    /// Number of closed pairs that do not slip.
    pub sticking: usize,
    /// Smallest gap over the candidate pairs (length); NaN without candidates.
    pub min_gap: f64,
    /// Mean coefficient of friction of the closed pairs, weighted by Pn; NaN without closed pairs.
    pub friction_coefficient: f64,
    /// Largest error of the friction: max(|Pt| - mu Pn, 0), or ||Pt| - mu Pn| for a pair that slips, divided by the
    /// largest Pn. Without contact the error of friction is 0; mu is the coefficient of the law.
    pub cone_violation: f64,
    /// Distance of the pairs' total impulses from the cone in the increment, with impacts and returns; for a pair whose
    /// total normal impulse pulls, the distance is this pull.
    pub impulse_cone_violation: f64,
    /// Moment of the force about the reference node of a rigid master (force length); 0 for other
    /// masters.
    pub reference_moment: f64,
    /// Work of the normal contact forces since the start of the analysis.
    pub normal_work: f64,
    /// Part of the normal work at nodes that landed where other nodes of the same two bodies had opened, while the
    /// bodies stayed in contact.
    pub handover_work: f64,
    /// Energy dissipated by friction since the start of the analysis.
    pub friction_dissipation: f64,
    /// Kinetic energy given back after landings and releases of the contact since the start of the
    /// analysis.
    pub landing_return: f64,
    /// Energy that nodes without mass lost after releases of the contact since the start of the
    /// analysis.
    pub release_loss: f64,
    /// Impulses of the contact in the increment.
    pub impulse: ContactImpulse,
    /// Impulses of the contact since the start of the analysis.
    pub impulse_sum: ContactImpulse,
    /// Force on each body in self-contact; empty for two surfaces.
    pub bodies: Vec<ContactOnBody>,
}

/// The contact of two bodies, or of a body and a rigid surface, from the landing of a first node until no pair is
/// closed.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Touch {
    /// The two bodies, numbered as in [`crate::model::Bodies`]; `None` for a rigid surface.
    pub bodies: [Option<usize>; 2],
    /// Index of a slave node that landed first.
    pub node: usize,
    /// Time at the start of the first increment of the touch.
    pub start: f64,
    /// Time at the end of the last increment of the touch.
    pub end: f64,
    /// Number of the first increment of the touch.
    pub first: usize,
    /// Number of the last increment of the touch.
    pub last: usize,
    /// Largest number of nodes of one side that were in contact at the same time.
    pub nodes: usize,
    /// Whether the contact reached a corner of an outline.
    pub is_at_corner: bool,
    /// Impulse J on one of the bodies (force time).
    pub impulse: f64,
    /// Energy J²/(8 m) with the reduced mass m of the bodies: their kinetic energy of approach if they rebound with the
    /// same speed; 0 if both bodies are held.
    pub energy: f64,
}

/// Total impulses on a pair in an increment after which energy was given back to the pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReturnedImpulse {
    /// Time at the end of the increment.
    pub time: f64,
    /// Slave node (index).
    pub slave: usize,
    /// Nodes a and b of the segment (indices).
    pub segment: [usize; 2],
    /// Total normal impulse: dt Pn + Phi plus the return (force time).
    pub normal: f64,
    /// Total tangential impulse (force time).
    pub tangential: f64,
    /// Normal impulse of the return (force time).
    pub returned_normal: f64,
    /// Tangential impulse of the return (force time).
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
    /// Local coordinate on the segment, 0 at a and 1 at b.
    pub xi: f64,
    /// Approach speed -dg/dt just before the landing (length/time).
    pub approach_speed: f64,
}
