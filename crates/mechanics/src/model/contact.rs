//! Contact surfaces, contacts and their interactions, with hard contact and Coulomb friction; also equations between
//! displacements, and rigid surfaces that move with a reference node. See docs/theory/contact.md, and
//! docs/theory/impacts.md, Rigid bodies.
//!
//! Segments run from a to b with the body on the left.

use std::ops::Range;

use super::Segment;
use super::friction::Friction;
use super::mesh::{Face, Mesh};
use crate::diagnostics::Span;
use crate::vectors::distance;

/// Contact law between two surfaces: hard normal contact and Coulomb friction.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interaction {
    /// Name in the form in which names are compared; empty without a name.
    pub name: String,
    /// Coulomb friction.
    pub friction: Friction,
    /// Wear of the slave surface.
    pub wear: Option<Wear>,
    /// Heat of friction.
    pub heat: Option<Heat>,
}

/// Part of the work of friction that becomes heat, and the surfaces that this heat warms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heat {
    /// Part of the work that becomes heat.
    pub part: f64,
    /// Part of the heat that goes into the slave surface.
    pub to_slave: f64,
}

/// Archard's law of wear; the geometry does not change by wear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wear {
    /// Depth divided by the product of pressure and sliding path, k/H (length^2/force).
    pub rate: f64,
    /// Whether the depth is divided by the work of friction per area instead of the product of pressure and sliding
    /// path; this work is mu times the product.
    pub by_friction: bool,
}

/// Part of the slave surface that is kept out of the master.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactFormulation {
    /// Every slave node is kept out.
    #[default]
    NodeToSegment,
    /// For each slave node a mean gap over points of the slave faces is kept at zero or above.
    SurfaceToSurface,
}

impl ContactFormulation {
    /// Name of the formulation in decks and logs.
    pub fn name(self) -> &'static str {
        match self {
            ContactFormulation::NodeToSegment => "NODE TO SURFACE",
            ContactFormulation::SurfaceToSurface => "SURFACE TO SURFACE",
        }
    }
}

/// A slave surface whose nodes may not enter the body behind the master surface; self-contact if
/// both are the same surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Index of the slave surface.
    pub slave: usize,
    /// Index of the master surface (made of faces or rigid).
    pub master: usize,
    /// The contact law.
    pub interaction: Interaction,
    /// Part of the slave surface that is kept out of the master.
    pub formulation: ContactFormulation,
    /// Number of faces that lie on other bodies at the start, by which general contact has chosen the formulation;
    /// `None` if the deck gives the formulation.
    pub lying_faces: Option<usize>,
    /// Shape of the faces of the contact.
    pub smoothing: Smoothing,
    /// Slave nodes that are moved onto the master surface before the start.
    pub adjust: Option<Adjust>,
    /// Slave nodes that do not take part in the contact (indices, increasing).
    pub left_out: Vec<usize>,
    /// Whether the contact is general contact that removes the overlap of bodies in the first step.
    pub is_interference_fit: bool,
    /// Place in the deck, for messages.
    pub span: Span,
}

/// The shape of the faces of a contact between their nodes.
#[derive(Debug, Clone, PartialEq)]
pub enum Smoothing {
    /// Straight faces, as meshed.
    Straight,
    /// Curved faces, whose shape follows from the turns of the reference configuration; some faces lie on circles about
    /// given centres.
    Curved(Vec<Circle>),
}

impl Default for Smoothing {
    fn default() -> Self {
        Smoothing::Curved(Vec::new())
    }
}

/// Faces that lie on a circle in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// Index of the surface of these faces.
    pub surface: usize,
    /// Centre of the circle (length).
    pub centre: [f64; 2],
}

/// Choice of the slave nodes that are moved onto the master surface before the start, without
/// strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Adjust {
    /// Nodes near the surface of the master body, inside or above this surface.
    Within(Reach),
    /// Nodes of the node set with the given index.
    Nodes(usize),
    /// Nodes near the surface, which are moved to a clearance above the surface (length).
    Clearance(f64),
}

/// Choice of the nodes near a surface, and the clearance to which they are moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Largest clearance of a node that is moved (length).
    pub above: f64,
    /// Largest depth of a node that is moved (length); infinite without a limit.
    pub below: f64,
    /// Clearance that the moved nodes get (length).
    pub clearance: f64,
}

impl Adjust {
    /// Clearance that the moved nodes get (length).
    pub fn clearance(&self) -> f64 {
        match self {
            Adjust::Within(reach) => reach.clearance,
            Adjust::Nodes(_) => 0.0,
            Adjust::Clearance(clearance) => *clearance,
        }
    }
}

impl Contact {
    /// A contact of two surfaces in which all slave nodes take part and no node is moved.
    pub fn new([slave, master]: [usize; 2], interaction: Interaction) -> Self {
        Contact {
            slave,
            master,
            interaction,
            formulation: ContactFormulation::default(),
            lying_faces: None,
            smoothing: Smoothing::default(),
            adjust: None,
            left_out: Vec::new(),
            is_interference_fit: false,
            span: Span::default(),
        }
    }

    /// Whether slave and master are the same surface.
    pub fn is_self_contact(&self) -> bool {
        self.slave == self.master
    }
}

/// Name of the surface of general contact: all faces that belong to one element only.
pub const ALL_EXTERIOR: &str = "ALL_EXTERIOR";

/// A named surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name as typed in the deck.
    pub name: String,
    /// Faces, nodes or rigid segments of the surface.
    pub kind: SurfaceKind,
}

/// Element faces, nodes or rigid segments.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceKind {
    /// Faces of elements; they can be slave or master.
    Faces(Vec<Face>),
    /// Nodes; they can only be slave.
    Nodes(Vec<usize>),
    /// A rigid profile; it can be master, and also slave if it is a circle.
    Rigid(RigidProfile),
}

/// Segments of a rigid surface, between nodes without elements.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigidProfile {
    /// Segments [a, b] with the rigid body on the left of the direction from a to b.
    pub segments: Vec<Segment>,
    /// The arcs of which some segments are chords, in the order of the segments.
    pub arcs: Vec<CircleArc>,
    /// Node at the centre of a round body's outline: all segments are chords of arcs about this node, which form a
    /// closed circle with the body inside.
    pub centre: Option<usize>,
}

/// An arc of a rigid profile, as the deck gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct CircleArc {
    /// Range of the chords of the arc among the segments.
    pub segments: Range<usize>,
    /// Centre in the reference configuration (length).
    pub centre: [f64; 2],
    /// Radius (length).
    pub radius: f64,
}

/// Largest difference of centres and of radii between arcs of the same circle, relative to the
/// radius.
const CIRCLE_ROUND_OFF: f64 = 1e-6;

impl CircleArc {
    /// Whether another arc lies on the same circle.
    pub fn is_of_circle(&self, other: &CircleArc) -> bool {
        let apart = distance(self.centre, other.centre);
        apart.max((self.radius - other.radius).abs()) <= CIRCLE_ROUND_OFF * other.radius
    }
}

/// A rigid disc as slave; its centre is a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Node at the centre of the disc.
    pub centre: usize,
    /// A node on the circle of the disc, which turns with the disc.
    pub arm: usize,
    /// Radius (length).
    pub radius: f64,
}

impl Surface {
    /// Segments [a, b] in order, with the body on the left; empty for a surface made of nodes.
    pub fn segments(&self, mesh: &Mesh) -> Vec<Segment> {
        match &self.kind {
            SurfaceKind::Faces(faces) => {
                faces.iter().flat_map(|face| face.segments(mesh)).collect()
            }
            SurfaceKind::Nodes(_) => Vec::new(),
            SurfaceKind::Rigid(profile) => profile.segments.clone(),
        }
    }

    /// Mid-side nodes of the sides of the surface, each with the corners of its side.
    pub fn middles(&self, mesh: &Mesh) -> Vec<(usize, [usize; 2])> {
        let SurfaceKind::Faces(faces) = &self.kind else {
            return Vec::new();
        };
        let middle = |face: &Face| match face.of(mesh).nodes() {
            &[a, middle, b] => Some((middle, [a, b])),
            _ => None,
        };
        faces.iter().filter_map(middle).collect()
    }

    /// Nodes of the surface in the order of their first appearance, without duplicates.
    pub fn nodes(&self, mesh: &Mesh) -> Vec<usize> {
        let all: Vec<usize> = match &self.kind {
            SurfaceKind::Faces(faces) => faces.iter().flat_map(|f| f.nodes(mesh)).collect(),
            SurfaceKind::Nodes(nodes) => nodes.clone(),
            SurfaceKind::Rigid(profile) => {
                let of_segments = profile.segments.as_flattened().iter().copied();
                of_segments.chain(profile.centre).collect()
            }
        };
        let mut seen = vec![false; mesh.node_count()];
        all.into_iter()
            .filter(|&n| !std::mem::replace(&mut seen[n], true))
            .collect()
    }
}

/// Two nodes at one place that move together while their bodies may rotate (`*MPC`, PIN); at least one of the two nodes
/// belongs to a rigid body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hinge {
    /// The nodes.
    pub nodes: [usize; 2],
}

/// A dof that follows other dofs at all times: u_dof = sum c_k u_k, eq. (3.8).
///
/// The dofs u_k are free or prescribed; no u_k follows other dofs.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// The dof that is eliminated, `2 node + direction`.
    pub dof: usize,
    /// Dofs that the eliminated dof follows, each once, and their coefficients c_k (dimensionless).
    pub terms: Vec<(usize, f64)>,
}

impl Equation {
    /// Sum of terms of an equation, relative to the sizes of the terms, up to which the sum counts as zero.
    pub const ROUND_OFF: f64 = 1e-12;

    /// The eliminated dof and the dofs that it follows.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        std::iter::once(self.dof).chain(self.terms.iter().map(|&(dof, _)| dof))
    }
}

/// A rigid body and its reference node. In all steps a rigid body has its own centre of mass and angle, whether a step
/// frees these or not, so a run does not depend on later steps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigidBody {
    /// Number of the body among the rigid bodies.
    pub number: usize,
    /// Name of the first surface or set of the body in the deck, or of the coupling.
    pub name: String,
    /// The surfaces and sets of the body, in the order of the deck.
    pub parts: Vec<RigidPart>,
    /// Reference node (index).
    pub reference: usize,
    /// Nodes that move with the body, increasing, without the reference node.
    pub nodes: Vec<usize>,
    /// Elements of the body (indices, increasing), which have mass and no strain.
    pub elements: Vec<usize>,
    /// Whether the body consists of coupled nodes (`*COUPLING`, `*KINEMATIC COUPLING`, `*MPC`), whose mass it has.
    pub is_coupling: bool,
    /// Nodes with the masses that they carry in addition to the elements (mass).
    pub masses: Vec<(usize, f64)>,
    /// Moment of inertia in addition to the moment of inertia of elements and masses (mass length^2).
    pub rotary_inertia: f64,
    /// Whether any step leaves the body free in some direction, or turns the body.
    pub turns: bool,
}

impl RigidBody {
    /// Whether a surface (index) is a part of the body.
    pub fn has_surface(&self, surface: usize) -> bool {
        self.parts.contains(&RigidPart::Surface(surface))
    }
}

/// A part of a rigid body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RigidPart {
    /// A rigid surface (index).
    Surface(usize),
    /// The elements of the set with the given name.
    Elements(String),
    /// The nodes of the set with the given name.
    Nodes(String),
}
