//! Contact surfaces, contacts and their interactions, hard contact with Coulomb friction; equations between
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
    /// Its name as compared, empty without one.
    pub name: String,
    /// Coulomb friction.
    pub friction: Friction,
    /// Wear of the slave surface.
    pub wear: Option<Wear>,
    /// Heat of friction.
    pub heat: Option<Heat>,
}

/// What of the work of friction becomes heat, and where it goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heat {
    /// Part of the work that becomes heat.
    pub part: f64,
    /// Part of the heat that goes into the slave surface.
    pub to_slave: f64,
}

/// Archard's law of wear; the geometry stays as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wear {
    /// Depth over the product of pressure and way, k/H (length^2/force).
    pub rate: f64,
    /// Whether it is that over the work of friction, mu times the product.
    pub by_friction: bool,
}

/// What of the slave surface is kept out of the master.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactFormulation {
    /// Every slave node.
    #[default]
    NodeToSegment,
    /// Means over points of the slave faces, one for each slave node.
    SurfaceToSurface,
}

impl ContactFormulation {
    /// Its name in decks and logs.
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
    /// What is kept out.
    pub formulation: ContactFormulation,
    /// Faces that lie on other bodies at the start, by whose number general contact has chosen what is kept out; none
    /// where the deck says it.
    pub lying_faces: Option<usize>,
    /// The shape of its faces.
    pub smoothing: Smoothing,
    /// Slave nodes that are moved onto the master surface before the start.
    pub adjust: Option<Adjust>,
    /// Slave nodes that take no part (indices, increasing).
    pub left_out: Vec<usize>,
    /// Whether it is general contact that presses the overlap of bodies out in the first step.
    pub is_interference_fit: bool,
    /// Place in the deck, for messages.
    pub span: Span,
}

/// The shape of the faces of a contact between their nodes.
#[derive(Debug, Clone, PartialEq)]
pub enum Smoothing {
    /// Straight, as meshed.
    Straight,
    /// Curved as the reference configuration turns, parts of it as circles about given centres.
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
    /// Index of their surface.
    pub surface: usize,
    /// Centre of the circle (length).
    pub centre: [f64; 2],
}

/// Which slave nodes are moved onto the master surface before the start, free of strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Adjust {
    /// Those inside the master body or above it that are near its surface.
    Within(Reach),
    /// Those of the node set with this index.
    Nodes(usize),
    /// Those that are near the surface, to this clearance above it (length).
    Clearance(f64),
}

/// Which nodes are near a surface, and where they are moved to.
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
    /// A contact of two surfaces in which all slave nodes take part, where they are.
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
    /// Its faces, nodes or rigid segments.
    pub kind: SurfaceKind,
}

/// Element faces, nodes or rigid segments.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceKind {
    /// Faces of elements: can be slave or master.
    Faces(Vec<Face>),
    /// Nodes: can be slave only.
    Nodes(Vec<usize>),
    /// A rigid profile: can be master, and slave where it is a circle.
    Rigid(RigidProfile),
}

/// Segments of a rigid surface between nodes without element.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigidProfile {
    /// Segments [a, b], the rigid body on the left of the direction from a to b.
    pub segments: Vec<Segment>,
    /// The arcs that some of them are chords of, in the order of the segments.
    pub arcs: Vec<CircleArc>,
    /// Node at the centre, of the outline of a round body: all segments are chords of arcs about it, end to end all the
    /// way round, the body inside.
    pub centre: Option<usize>,
}

/// An arc of a rigid profile, as the deck gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct CircleArc {
    /// Its chords among the segments.
    pub segments: Range<usize>,
    /// Centre in the reference configuration (length).
    pub centre: [f64; 2],
    /// Radius (length).
    pub radius: f64,
}

/// Largest difference of the centres and radii of the arcs of one circle, relative to the radius.
const CIRCLE_ROUND_OFF: f64 = 1e-6;

impl CircleArc {
    /// Whether another arc is of the same circle.
    pub fn is_of_circle(&self, other: &CircleArc) -> bool {
        let apart = distance(self.centre, other.centre);
        apart.max((self.radius - other.radius).abs()) <= CIRCLE_ROUND_OFF * other.radius
    }
}

/// A rigid disc that is slave: its centre is a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Node at its centre.
    pub centre: usize,
    /// A node of its circle, which turns with it.
    pub arm: usize,
    /// Radius (length).
    pub radius: f64,
}

impl Surface {
    /// Segments [a, b] in order, the body on the left; empty for a node surface.
    pub fn segments(&self, mesh: &Mesh) -> Vec<Segment> {
        match &self.kind {
            SurfaceKind::Faces(faces) => {
                faces.iter().flat_map(|face| face.segments(mesh)).collect()
            }
            SurfaceKind::Nodes(_) => Vec::new(),
            SurfaceKind::Rigid(profile) => profile.segments.clone(),
        }
    }

    /// Nodes between the corners of the sides that it is made of, each with these corners.
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

    /// Nodes of the surface in order of first appearance, without duplicates.
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

/// Two nodes at one place that move together and let their bodies turn (`*MPC`, PIN), where at least one of them belongs to
/// a rigid body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hinge {
    /// The nodes.
    pub nodes: [usize; 2],
}

/// A dof that follows others at all times: u_dof = sum c_k u_k, eq. (3.8).
///
/// The u_k are free or prescribed: none follows others itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// The dof that is eliminated, `2 node + direction`.
    pub dof: usize,
    /// Dofs that it follows, each once, and their coefficients c_k (dimensionless).
    pub terms: Vec<(usize, f64)>,
}

impl Equation {
    /// Sum of terms of an equation, relative to their sizes, that counts as zero.
    pub const ROUND_OFF: f64 = 1e-12;

    /// The eliminated dof and the dofs that it follows.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        std::iter::once(self.dof).chain(self.terms.iter().map(|&(dof, _)| dof))
    }
}

/// A rigid body and the node that it moves with. It has a centre of mass and an angle of its own in all steps, whether one
/// frees them or not, so that a run does not depend on steps behind it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigidBody {
    /// Number among the rigid bodies.
    pub number: usize,
    /// Name of its first surface or set in the deck, or of the coupling.
    pub name: String,
    /// The surfaces and sets that it is made of, in the order of the deck.
    pub parts: Vec<RigidPart>,
    /// Reference node (index).
    pub reference: usize,
    /// Nodes that move with it, increasing, without the reference node.
    pub nodes: Vec<usize>,
    /// Its elements (indices, increasing), which have mass and no strain.
    pub elements: Vec<usize>,
    /// Whether it is made of coupled nodes (`*COUPLING`, `*KINEMATIC COUPLING`, `*MPC`), whose mass it has.
    pub is_coupling: bool,
    /// Nodes with the masses that they carry beside the elements (mass).
    pub masses: Vec<(usize, f64)>,
    /// Moment of inertia beside that of elements and masses (mass length^2).
    pub rotary_inertia: f64,
    /// Whether some step leaves it free in some direction, or turns it.
    pub turns: bool,
}

impl RigidBody {
    /// Whether a surface (index) is a part of it.
    pub fn has_surface(&self, surface: usize) -> bool {
        self.parts.contains(&RigidPart::Surface(surface))
    }
}

/// What a rigid body is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RigidPart {
    /// A rigid surface (index).
    Surface(usize),
    /// The elements of the set with this name.
    Elements(String),
    /// The nodes of the set with this name.
    Nodes(String),
}
