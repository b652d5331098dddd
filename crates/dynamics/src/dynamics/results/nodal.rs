//! Results at nodes. See docs/theory/impacts.md, Pressure and Reactions.

/// Contact status of a node as slave; a node with several pairs has the highest status of its pairs.
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
    /// The node has no candidate segment.
    #[default]
    None = 0,
    /// The node has a candidate segment but no contact.
    Open = 1,
    /// The node is in contact and does not slip.
    Stick = 2,
    /// The node is in contact and slides.
    Slip = 3,
}

/// Kind of the mass of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[repr(u8)]
pub enum NodeMass {
    /// The node has its own mass; it is not a node of a contact surface.
    #[default]
    Own = 0,
    /// The node keeps its own mass although it lies on a contact surface of a body.
    Kept = 1,
    /// The node has no mass: its donors carry its mass.
    None = 2,
}

/// Results at nodes, without the motion.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct NodalResults {
    /// Support reaction, including the force that the support exerts through equations, eq. (9.12), `2 N` entries
    /// (force); 0 at all other dofs. The reaction of a rigid body is at its reference node.
    pub reaction: Vec<f64>,
    /// Concentrated loads on the node, `2 N` entries (force).
    pub concentrated: Vec<f64>,
    /// Contact force on the node, `2 N` entries (force).
    pub contact_force: Vec<f64>,
    /// Force of the tie on every tied node, `2 N` entries (force); empty without ties.
    pub tie_force: Vec<f64>,
    /// Force of every hinge on its first node (force); the opposite force acts on the second node of the hinge.
    pub hinge_force: Vec<[f64; 2]>,
    /// Gap of the node to its segment, `N` entries (length); NaN without a candidate.
    pub gap: Vec<f64>,
    /// Contact status, `N` entries.
    pub status: Vec<NodeStatus>,
    /// Contact pressure, `N` entries (force/length^2); NaN at nodes that are not slave nodes.
    pub pressure: Vec<f64>,
    /// Results of friction at slave nodes.
    pub friction: FrictionResults,
    /// Accumulated slip since the start of the analysis, `N` entries (length); NaN at nodes that
    /// are not slave nodes.
    pub slip: Vec<f64>,
    /// Kinds of the masses, `N` entries if masses are redistributed, else empty.
    pub mass: Vec<NodeMass>,
}

/// Results of friction at slave nodes. A list has `N` entries if a contact of the deck has the result of this list,
/// else the list is empty. Entries are NaN at nodes that are not slave nodes.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct FrictionResults {
    /// Mean coefficient of friction of the closed pairs, weighted by Pn, if the coefficient varies; NaN without closed
    /// pairs.
    pub coefficient: Vec<f64>,
    /// Work of friction since the start of the analysis, divided by the area of the node
    /// (energy/length^2).
    pub work: Vec<f64>,
    /// Depth of wear since the start (length).
    pub wear: Vec<f64>,
    /// Heat into the slave surface since the start (energy).
    pub heat: Vec<f64>,
}
