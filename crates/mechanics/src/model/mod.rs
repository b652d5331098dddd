//! The problem as plain data, with all names resolved to indices: mesh, materials and sections, sets, surfaces,
//! contacts, constraints, and steps with loads and settings. See docs/theory/README.md.
//!
//! Everything in the model is indexed from 0 in the order of the deck. Vectors over degrees of freedom have `2 N`
//! entries; dof `2 n + i` is direction i (0 = x, 1 = y) of node n. A rigid body that turns has two more nodes, which
//! exist only in vectors over the dofs: the centre of mass, and a node whose direction 0 is the angle of the body.

mod amplitude;
mod connector;
mod contact;
mod element_type;
mod friction;
mod mesh;
mod sets;
mod side;
mod step;
mod thickness;
mod tie;

pub use crate::lcp::LcpMethod;
pub use crate::linear::SolverChoice;
pub use crate::materials::Plane;
use crate::materials::{Expansion, Law, SmallStrainModuli};
pub use amplitude::{Amplitude, Curve, Signal, TimeBase};
pub use connector::{Connector, ConnectorDirection, ConnectorLaw, ForceCurve};
pub use contact::{
    ALL_EXTERIOR, Adjust, Circle, CircleArc, Contact, ContactFormulation, Disc, Equation, Heat,
    Hinge, Interaction, Reach, RigidBody, RigidPart, RigidProfile, Smoothing, Surface, SurfaceKind,
    Wear,
};
pub use element_type::{ElementType, Formulation, Shape, Topology};
pub use friction::{Friction, FrictionCurve, FrictionLaw};
pub use mesh::sides;
pub use mesh::{Bodies, Element, ElementsAtNodes, Face, Mesh, NO_SECTION, Nodes, Set};
pub use sets::{
    HistorySet, Instance, NamedSets, NodalVariable, RequestedFields, element_name, node_name,
};
pub use side::{Segment, Side, SideNodes};
use std::collections::{BTreeMap, BTreeSet};
pub use step::{
    BodyForce, CentrifugalForce, ContactChanges, ContactMass, Factorization, FormerFriction,
    Frames, FrictionChange, Impact, ImpactTime, Incrementation, Increments, Interference,
    LandingRule, Load, NodeTemperature, PointLoad, Pressure, Procedure, Rate, RestartOutput,
    Scheme, Settings, Step, Support, SupportMotion, Traction, Variation,
};
pub use thickness::Thickness;
pub use tie::{Follows, Tie, TieReach, TiedLine, TiedNode, TiedSide};
pub use tie::{NEAR, beside, nearest_of};

/// A whole problem: the content of a deck, checked, with all names resolved to indices.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// Text of `*HEADING`, lines joined by a blank.
    pub title: String,
    /// Nodes and elements.
    pub mesh: Mesh,
    /// Named sets of nodes and elements, the sets of the history output, and instances of parts.
    pub sets: NamedSets,
    /// Named surfaces.
    pub surfaces: Vec<Surface>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Sections: material and thickness of elements.
    pub sections: Vec<Section>,
    /// Springs and dashpots of the model.
    pub connectors: Vec<Connector>,
    /// Contacts: one for each data line of `*CONTACT PAIR`, then general contact.
    pub contacts: Vec<Contact>,
    /// Amplitude curves.
    pub amplitudes: Vec<Amplitude>,
    /// Ties; their equations are among `equations`.
    pub ties: Vec<Tie>,
    /// Equations between displacements, sorted by the dof that they eliminate, each at most once.
    pub equations: Vec<Equation>,
    /// Hinges between bodies.
    pub hinges: Vec<Hinge>,
    /// Initial velocity, `2 N` entries (length/time), followed by the velocities of the bodies that turn, with their
    /// angular velocity (1/time).
    pub initial_velocity: Vec<f64>,
    /// Temperature of every node at the start of the analysis (temperature); empty if the deck gives no temperatures,
    /// which means zero.
    pub initial_temperature: Vec<f64>,
    /// Steps in order.
    pub steps: Vec<Step>,
    /// Rigid surfaces with their reference nodes, and bodies that turn.
    pub rigid_bodies: Vec<RigidBody>,
    /// Masses at nodes that do not belong to a rigid body (index, mass).
    pub point_masses: Vec<(usize, f64)>,
    /// Requests of checkpoints, in the order of their steps.
    pub restarts: Vec<RestartOutput>,
}

impl Model {
    /// Adds a section of the given thickness with a new material without damping.
    pub fn add_section(&mut self, law: Law, density: f64, thickness: f64) {
        let material = self.materials.len();
        self.materials.push(Material {
            name: format!("M{material}"),
            law,
            density,
            damping: Damping::default(),
            expansion: None,
        });
        self.sections.push(Section {
            material,
            thickness,
        });
    }

    /// Name of a node in the deck: its number, or `Instance.number`. A node that exists only for a rigid body has the
    /// name of the reference node.
    pub fn node_name(&self, node: usize) -> String {
        node_name(self.node_of(node), &self.mesh, &self.sets.instances)
    }

    /// The mesh node to which a pair of dofs belongs; for dofs beyond the dofs of the nodes, the reference node of the
    /// rigid body.
    pub fn node_of(&self, node: usize) -> usize {
        let beyond = node.checked_sub(self.mesh.node_count());
        let body = beyond.and_then(|k| self.rigid_bodies.get(k / 2));
        body.map_or(node, |body| body.reference)
    }

    /// Name of an element in the deck: its number, or `Instance.number`.
    pub fn element_name(&self, element: usize) -> String {
        element_name(element, &self.mesh, &self.sets.instances)
    }

    /// Whether the deck gives temperatures.
    pub fn has_temperatures(&self) -> bool {
        let in_steps = self.steps.iter().any(|step| !step.temperatures.is_empty());
        in_steps || !self.initial_temperature.is_empty()
    }

    /// Temperature of a node at the start of the analysis.
    pub fn initial_temperature_of(&self, node: usize) -> f64 {
        self.initial_temperature
            .get(node)
            .copied()
            .unwrap_or_default()
    }

    /// Number of degrees of freedom: 2 for every node, and 4 for every rigid body.
    pub fn dof_count(&self) -> usize {
        self.mesh.dof_count() + 4 * self.rigid_bodies.len()
    }

    /// The node that is the centre of mass of a rigid body.
    pub fn centre_of(&self, body: &RigidBody) -> usize {
        self.mesh.node_count() + 2 * body.number
    }

    /// The dof that is the angle of a rigid body.
    pub fn angle_of(&self, body: &RigidBody) -> usize {
        2 * (self.centre_of(body) + 1)
    }

    /// Whether supports of a step prescribe the same motion along an axis for two nodes, on bodies that neither this
    /// step nor an earlier step turns. If the result is true, a hinge between the two nodes has no effect along the
    /// axis.
    pub fn are_held_alike(&self, step: &Step, nodes: [usize; 2], axis: usize) -> bool {
        let has_not_turned = |body: &&RigidBody| {
            let angle = self.angle_of(body);
            let is_still = |step: &Step| step.motion_of(angle).is_some_and(SupportMotion::is_still);
            let mut before = (self.steps.iter()).take_while(|other| !std::ptr::eq(*other, step));
            before.all(is_still) && is_still(step)
        };
        let motion_of = |node: usize| {
            let rides = |body: &&RigidBody| {
                body.reference == node || body.nodes.binary_search(&node).is_ok()
            };
            match self.rigid_bodies.iter().find(rides) {
                None => step.motion_of(2 * node + axis),
                Some(body) => (Some(body).filter(has_not_turned))
                    .and_then(|body| step.motion_of(2 * body.reference + axis)),
            }
        };
        let [a, b] = nodes.map(motion_of);
        a.is_some() && a == b
    }

    /// Pairs of nodes at one place that equations between them join in both directions, with the smaller index first.
    /// An equation that joins a pair has at most one more node, for example the node of a pre-tension section.
    pub fn joined_nodes(&self) -> BTreeSet<[usize; 2]> {
        let mesh = &self.mesh;
        let mut counts: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for equation in &self.equations {
            let nodes: BTreeSet<usize> = equation.dofs().map(|dof| dof / 2).collect();
            let of_mesh = nodes.iter().filter(|&&node| node < mesh.node_count());
            let nodes: Vec<usize> = of_mesh.copied().collect();
            for (i, &a) in nodes.iter().enumerate().filter(|_| nodes.len() <= 3) {
                let same = |b: &&usize| mesh.coordinates[**b] == mesh.coordinates[a];
                for &b in nodes[i + 1..].iter().filter(same) {
                    *counts.entry([a, b]).or_default() += 1;
                }
            }
        }
        let both = counts.into_iter().filter(|(_, count)| *count >= 2);
        both.map(|(pair, _)| pair).collect()
    }

    /// Mass of an element: density times volume.
    pub fn element_mass(&self, element: &Element) -> f64 {
        let section = &self.sections[element.section];
        let density = self.materials[section.material].density;
        density * self.mesh.volume(element, section.thickness)
    }

    /// Thickness of an element.
    pub fn thickness(&self, element: &Element) -> Thickness {
        Thickness::new(
            element.element_type,
            self.sections[element.section].thickness,
        )
    }

    /// Speed of longitudinal waves in an element (length/time).
    pub fn wave_speed(&self, element: &Element) -> f64 {
        let material = &self.materials[self.sections[element.section].material];
        material.wave_speed(element.element_type.plane)
    }

    /// Whether accumulated plastic strains are written: if a material may flow, or the deck asks for these strains.
    pub fn writes_plastic_strain(&self) -> bool {
        self.sets.fields.plastic_strain || self.has_plasticity()
    }

    /// Whether any elements have hourglass modes.
    pub fn has_hourglass_modes(&self) -> bool {
        let mut elements = self.mesh.elements.iter();
        elements.any(|element| element.element_type.has_hourglass_modes())
    }

    /// Whether any material may flow.
    fn has_plasticity(&self) -> bool {
        let mut materials = self.materials.iter();
        materials.any(|material| matches!(material.law, Law::Plastic(_)))
    }

    /// Whether the law of an element (index) is meant only for small strains.
    pub fn is_for_small_strains(&self, element: usize) -> bool {
        let section = &self.sections[self.mesh.elements[element].section];
        self.materials[section.material].law.is_for_small_strains()
    }

    /// Whether the mass of contact surfaces is redistributed in any step.
    pub fn redistributes_mass(&self) -> bool {
        let redistributes = |step: &Step| step.settings.contact_mass == ContactMass::Redistributed;
        self.steps.iter().any(redistributes)
    }

    /// Whether the coefficient of friction of any contact varies.
    pub fn has_varying_friction(&self) -> bool {
        let mut all = (0..self.contacts.len()).map(|contact| self.friction_range(contact));
        let is_varying = |contact: &Contact| !contact.interaction.friction.is_constant();
        self.contacts.iter().any(is_varying) || all.any(|[first, other]| first != other)
    }

    /// Two coefficients of friction of a contact, equal if the coefficient is constant in all steps. The two
    /// coefficients are the coefficients of [`Friction::range`]; if steps change the friction, they are the largest and
    /// the smallest coefficient.
    pub fn friction_range(&self, contact: usize) -> [f64; 2] {
        let own = self.contacts[contact].interaction.friction.range();
        let changes = self.steps.iter().flat_map(|step| &step.contacts.friction);
        let all = changes
            .filter(|change| change.contact == contact)
            .flat_map(|change| change.friction.range())
            .collect::<Vec<f64>>();
        match all.is_empty() {
            true => own,
            false => {
                let all = || all.iter().chain(&own).copied();
                [
                    all().fold(0.0, f64::max),
                    all().fold(f64::INFINITY, f64::min),
                ]
            }
        }
    }

    /// Whether the deck is only to be read and checked (`*NO ANALYSIS`).
    pub fn is_check_only(&self) -> bool {
        self.steps.iter().any(|step| step.settings.is_check_only)
    }

    /// Overlaps that contacts allow in the first step.
    fn first_interferences(&self) -> impl Iterator<Item = &Load<Interference>> {
        let first = self.steps.first();
        first.into_iter().flat_map(|step| &step.interferences)
    }

    /// Whether a contact (index) removes the initial overlap in the first step.
    pub fn shrinks(&self, contact: usize) -> bool {
        let mut all = self.first_interferences();
        all.any(|load| load.at.contact == contact && load.at.is_shrink)
    }

    /// Whether a contact (index) allows an overlap in the first step.
    pub fn is_fitted(&self, contact: usize) -> bool {
        let mut all = self.first_interferences();
        all.any(|load| load.at.contact == contact)
    }

    /// Overlap that a contact (index) allows all its slave nodes at the start of the analysis (length).
    pub fn allowed_at_start(&self, contact: usize) -> f64 {
        let at_start = |load: &Load<Interference>| match load.variation {
            Variation::Constant => load.magnitude,
            Variation::Ramp { from } => from,
            Variation::Amplitude(index) => load.magnitude * self.amplitudes[index].at(0.0),
        };
        let all = self.first_interferences();
        let own = all.filter(|load| load.at.contact == contact && !load.at.is_shrink);
        own.map(at_start).sum()
    }

    /// The disc that forms the slave surface of a contact, if that surface is rigid.
    pub fn disc(&self, contact: &Contact) -> Option<Disc> {
        let SurfaceKind::Rigid(profile) = &self.surfaces[contact.slave].kind else {
            return None;
        };
        let (circle, first) = (profile.arcs.first()?, profile.segments.first()?);
        Some(Disc {
            centre: profile.centre?,
            arm: first[0],
            radius: circle.radius,
        })
    }

    /// Slave nodes of a contact; for a disc its centre.
    pub fn slave_nodes(&self, contact: &Contact) -> Vec<usize> {
        if let Some(disc) = self.disc(contact) {
            return vec![disc.centre];
        }
        let mut nodes = self.surfaces[contact.slave].nodes(&self.mesh);
        nodes.retain(|node| contact.left_out.binary_search(node).is_err());
        nodes
    }

    /// Segments [a, b] of all rigid surfaces.
    pub fn rigid_segments(&self) -> Vec<[usize; 2]> {
        let segments = self.surfaces.iter().map(|surface| match &surface.kind {
            SurfaceKind::Rigid(profile) => profile.segments.as_slice(),
            SurfaceKind::Faces(_) | SurfaceKind::Nodes(_) => &[],
        });
        segments.flatten().copied().collect()
    }
}

/// A material: its law with the constants of the deck, and its density.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the deck.
    pub name: String,
    /// Law of the stress.
    pub law: Law,
    /// Density rho of the reference configuration (mass/length^3).
    pub density: f64,
    /// Damping.
    pub damping: Damping,
    /// Expansion with the temperature.
    pub expansion: Option<Expansion>,
}

/// Damping of a material; zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Damping {
    /// Factor of mass-proportional damping (1/time).
    pub alpha: f64,
    /// Factor of damping proportional to the elasticity at small strains (time).
    pub beta: f64,
}

impl Material {
    /// Speed of longitudinal waves (length/time): sqrt(E/((1 - nu^2) rho)) in plane stress,
    /// sqrt(E (1 - nu)/((1 + nu) (1 - 2 nu) rho)) in plane strain and in bodies of revolution.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        let SmallStrainModuli { young, poisson: nu } = self.law.small_strain();
        let factor = match plane {
            Plane::Stress => 1.0 / (1.0 - nu * nu),
            Plane::Strain | Plane::Revolution => (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        };
        (young * factor / self.density).sqrt()
    }
}

/// Edge lengths of the elements, and times of waves along these edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeScales {
    /// The shortest edge (length); infinite without elements.
    pub shortest: f64,
    /// Largest speed of longitudinal waves (length/time).
    pub wave_speed: f64,
    /// Shortest time of a wave along an edge; infinite without a material.
    pub time: f64,
}

impl EdgeScales {
    /// Measures the elements of a mesh; some elements may have no section.
    pub fn new(mesh: &Mesh, sections: &[Section], materials: &[Material]) -> Self {
        // elements of a section in each plane; at last those without section
        let planes = [Plane::Stress, Plane::Strain, Plane::Revolution];
        let group = |element: &Element| {
            let section = element.section.min(sections.len());
            let plane = element.element_type.plane as usize;
            (planes.len() * section + plane).min(planes.len() * sections.len())
        };
        let edges = mesh.shortest_sides(planes.len() * sections.len() + 1, group);
        let speeds = sections.iter().flat_map(|section| {
            let material = &materials[section.material];
            planes.map(|plane| material.wave_speed(plane))
        });
        let used = edges
            .iter()
            .zip(speeds)
            .filter(|(edge, _)| edge.is_finite());
        let nothing = EdgeScales {
            shortest: edges.iter().copied().fold(f64::INFINITY, f64::min),
            wave_speed: 0.0,
            time: f64::INFINITY,
        };
        used.fold(nothing, |scales, (edge, speed)| EdgeScales {
            wave_speed: scales.wave_speed.max(speed),
            time: scales.time.min(edge / speed),
            ..scales
        })
    }
}

/// Material and thickness of a group of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Index into `Model::materials`.
    pub material: usize,
    /// Thickness t (length); the thickness has no meaning for bodies of revolution.
    pub thickness: f64,
}
