//! Named sets of nodes and elements, the sets of the history output (groups `/history/nodes` and `/history/elements` of
//! the result file), fields on request, and dofs in the status file. Also instances of parts, with their nodes and
//! elements and the numbers of these nodes and elements in the part. With instances, nodes and elements of the mesh get
//! numbers of the program's own, each used once.

use std::collections::BTreeSet;

use super::mesh::{Mesh, Set};

/// The sets of a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedSets {
    /// Node sets; their members are sorted, without duplicates.
    pub nodes: Vec<Set>,
    /// Element sets; their members are sorted, without duplicates.
    pub elements: Vec<Set>,
    /// Node sets whose motion and reactions go to the history, each at most once.
    pub history: Vec<HistorySet>,
    /// Element sets whose stresses, strains and energies go to the history, each at most once.
    pub element_history: Vec<HistorySet>,
    /// Fields of the frames that are written on request only.
    pub fields: RequestedFields,
    /// Dofs whose displacements are in the status file, each at most once.
    pub monitored: Vec<usize>,
    /// Instances of parts, in the order of their nodes; empty for a flat deck.
    pub instances: Vec<Instance>,
}

/// Fields of the frames that are written only if the deck asks for these fields.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RequestedFields {
    /// Concentrated loads (`CF`).
    pub concentrated_load: bool,
    /// Strain energy over volume (`ENER`).
    pub energy_density: bool,
    /// Logarithmic strain (`LE`).
    pub logarithmic_strain: bool,
    /// Principal stresses (`SP`).
    pub principal_stress: bool,
    /// Pressure (`PRESS`).
    pub pressure: bool,
    /// Accumulated plastic strain (`PEEQ`), which is always written for models with metals.
    pub plastic_strain: bool,
    /// Variables written at nodes in addition to the means over elements (`POSITION=NODES`).
    pub at_nodes: BTreeSet<NodalVariable>,
}

/// Element variables that frames can contain at nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum NodalVariable {
    /// Cauchy stress and its von Mises value.
    Stress,
    /// Green-Lagrange strain.
    Strain,
    /// Logarithmic strain.
    LogarithmicStrain,
    /// Principal stresses.
    PrincipalStress,
    /// Pressure.
    Pressure,
    /// Strain energy over volume.
    EnergyDensity,
    /// Accumulated plastic strain.
    PlasticStrain,
}

impl NodalVariable {
    /// All element variables that frames can contain at nodes, with their names in decks.
    pub const ALL: [(NodalVariable, &'static str); 7] = [
        (NodalVariable::Stress, "S"),
        (NodalVariable::Strain, "E"),
        (NodalVariable::LogarithmicStrain, "LE"),
        (NodalVariable::PrincipalStress, "SP"),
        (NodalVariable::Pressure, "PRESS"),
        (NodalVariable::EnergyDensity, "ENER"),
        (NodalVariable::PlasticStrain, "PEEQ"),
    ];

    /// The variable with a name in a deck; names of components such as `S11` are also allowed.
    pub fn named(name: &str) -> Option<Self> {
        let whole = match name.trim_end_matches(|c: char| c.is_ascii_digit()) {
            "MISES" => "S",
            whole => whole,
        };
        let mut all = Self::ALL.into_iter();
        all.find_map(|(variable, own)| (own == whole).then_some(variable))
    }
}

/// A set in the history output; sums over the set, and means over nodes, are always written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HistorySet {
    /// Index into `NamedSets::nodes` or `NamedSets::elements`.
    pub set: usize,
    /// Whether the history also contains the values of every member.
    pub each_member: bool,
    /// Whether the history also contains the values at the integration points of elements.
    pub at_points: bool,
    /// Whether the history also contains the values at the nodes of elements.
    pub at_nodes: bool,
}

/// An instance of a part. The nodes of an instance are consecutive in the mesh, and so are its
/// elements.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Instance {
    /// Its name.
    pub name: String,
    /// Index of the first node of the instance.
    pub first_node: usize,
    /// Numbers of the instance's nodes in the part.
    pub node_numbers: Vec<u64>,
    /// Index of the first element of the instance.
    pub first_element: usize,
    /// Numbers of the instance's elements in the part.
    pub element_numbers: Vec<u64>,
}

impl Instance {
    fn node_name(&self, node: usize) -> Option<String> {
        let number = self.node_numbers.get(node.checked_sub(self.first_node)?)?;
        Some(format!("{}.{number}", self.name))
    }

    fn element_name(&self, element: usize) -> Option<String> {
        let index = element.checked_sub(self.first_element)?;
        let number = self.element_numbers.get(index)?;
        Some(format!("{}.{number}", self.name))
    }
}

/// Name of a node in the deck: its number, or `Instance.number`.
pub fn node_name(node: usize, mesh: &Mesh, instances: &[Instance]) -> String {
    let mut names = instances.iter().filter_map(|i| i.node_name(node));
    let label = || mesh.node_labels.get(node).copied().unwrap_or(0);
    names.next().unwrap_or_else(|| label().to_string())
}

/// Name of an element in the deck: its number, or `Instance.number`.
pub fn element_name(element: usize, mesh: &Mesh, instances: &[Instance]) -> String {
    let mut names = instances.iter().filter_map(|i| i.element_name(element));
    let label = || mesh.elements.get(element).map_or(0, |e| e.label);
    names.next().unwrap_or_else(|| label().to_string())
}
