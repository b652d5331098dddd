//! Results at nodes. See docs/theory/impacts.md, Pressure and Reactions.

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
