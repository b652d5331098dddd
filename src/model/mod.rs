//! The problem as plain data, all names resolved to indices: mesh, materials, sets, surfaces,
//! contacts, constraints, steps with loads and settings.
//!
//! Everything is indexed from 0 in the order of the deck. Vectors over degrees of freedom hold
//! `2 N` entries, dof `2 n + i` being direction i (0 = x, 1 = y) of node n.

mod amplitude;
mod bodies;
mod constraint;
mod contact;
mod element_type;
mod load;
mod material;
mod mesh;
mod sets;
mod settings;
mod step;
mod surface;

pub use crate::materials::Plane;
pub use amplitude::{Amplitude, Curve, Signal, TimeBase};
pub use bodies::Bodies;
pub use constraint::{Equation, RigidBody};
pub use contact::{Adjust, Contact, Friction, Interaction, Reach};
pub use element_type::{ElementType, Formulation, Shape, Topology};
pub use load::{
    BodyForce, Load, PointLoad, Pressure, Rate, Support, SupportMotion, Traction, Variation,
};
pub use material::{Damping, Material, Section};
pub(crate) use mesh::sides;
pub use mesh::{Element, ElementsAtNodes, Face, Mesh, Nodes, Set};
pub use sets::{HistorySet, Instance, NamedSets, RequestedFields, element_name, node_name};
pub use settings::{
    ContactMass, Factorization, Impact, ImpactTime, LandingRule, LcpChoice, Scheme, Settings,
    SolverChoice,
};
pub use step::{Frames, Increments, Procedure, Step};
pub use surface::{ALL_EXTERIOR, Surface, SurfaceKind};

/// A whole problem: the content of a deck, checked, with all names resolved to indices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// Text of `*HEADING`, lines joined by a blank.
    pub title: String,
    /// Nodes and elements.
    pub mesh: Mesh,
    /// Named sets of nodes and elements, those of the history, and instances of parts.
    pub sets: NamedSets,
    /// Named surfaces.
    pub surfaces: Vec<Surface>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Sections: material and thickness of elements.
    pub sections: Vec<Section>,
    /// Contacts: one per data line of `*CONTACT PAIR`, then general contact.
    pub contacts: Vec<Contact>,
    /// Amplitude curves.
    pub amplitudes: Vec<Amplitude>,
    /// Equations between displacements, sorted by the dof that they eliminate, each at most once.
    pub equations: Vec<Equation>,
    /// Initial velocity, `2 N` entries (length/time).
    pub initial_velocity: Vec<f64>,
    /// Steps in order.
    pub steps: Vec<Step>,
    /// Rigid surfaces with their reference nodes.
    pub rigid_bodies: Vec<RigidBody>,
}

impl Model {
    /// What the deck calls a node: its number, or `Instance.number`.
    pub fn node_name(&self, node: usize) -> String {
        node_name(node, &self.mesh, &self.sets.instances)
    }

    /// What the deck calls an element: its number, or `Instance.number`.
    pub fn element_name(&self, element: usize) -> String {
        element_name(element, &self.mesh, &self.sets.instances)
    }

    /// Whether the deck shall be read and checked only (`*NO ANALYSIS`).
    pub fn is_check_only(&self) -> bool {
        self.steps.iter().any(|step| step.settings.is_check_only)
    }

    /// Segments [a, b] of all rigid surfaces.
    pub fn rigid_segments(&self) -> Vec<[usize; 2]> {
        let segments = self.surfaces.iter().map(|surface| match &surface.kind {
            SurfaceKind::Rigid(segments) => segments.as_slice(),
            SurfaceKind::Faces(_) | SurfaceKind::Nodes(_) => &[],
        });
        segments.flatten().copied().collect()
    }
}
