//! Resultants, impulses, impacts and errors of the contacts.

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
    /// Tangential impulse that comes with `returned_normal` (force time).
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
