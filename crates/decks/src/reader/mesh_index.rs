//! The mesh with the node and element numbers of the deck, the sets named on `*NODE` and `*ELEMENT`, and the places of
//! the elements. Nodes and elements of instances get new numbers, because the numbers of a part appear in each of its
//! instances.

use super::collapsed::side_of_triangle;
use super::context::Context;
use super::label::{LabelList, instance_of, number_of};
use super::names::{Labelled, Labels};
use crate::deck::{Card, Name};
use crate::diagnostics::{Code, Span};
use crate::model::{ConnectorLaw, Face, Instance, Mesh, element_name, node_name};
use std::collections::{HashMap, HashSet};

/// The mesh, with the numbers and sets that the deck gives to its nodes and elements.
pub(crate) struct MeshIndex {
    /// The mesh: nodes that belong to elements, and elements. The elements of the mesh have no sections yet.
    pub mesh: Mesh,
    /// Instances of parts.
    pub instances: Vec<Instance>,
    /// Labels of the nodes.
    pub nodes: Labels,
    /// Labels of the elements; their indices number plane elements first, then line elements, point elements, springs
    /// and dashpots, and rigid lines.
    pub elements: Labels,
    /// Faces of the plane elements that the line elements name.
    pub lines: Vec<Face>,
    /// Point elements, whose indices follow the indices of the line elements.
    pub points: Vec<PointElement>,
    /// Springs and dashpots.
    pub connectors: Vec<ConnectorElement>,
    /// Rigid lines, whose indices follow the indices of springs and dashpots.
    pub rigid_lines: Vec<RigidLine>,
    /// Places of the plane elements.
    pub places: Vec<Span>,
    /// For quadrilaterals that are triangles (indices of elements), the number of the side of no length.
    pub collapsed: HashMap<usize, usize>,
    /// Node sets named on `*NODE`.
    pub node_groups: Vec<Group>,
    /// Element sets named on `*ELEMENT`.
    pub element_groups: Vec<Group>,
    /// Faces on both sides of the cuts of pre-tension sections; only surfaces that name these faces contain them.
    pub cut_faces: HashSet<Face>,
}

/// An element at one node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PointElement {
    /// Property of the element.
    pub kind: PointKind,
    /// Node of the element.
    pub node: usize,
    /// Place of the row that defines the element.
    pub span: Span,
}

/// Property of a point element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PointKind {
    /// Mass (`MASS`).
    Mass,
    /// Rotary inertia (`ROTARYI`).
    RotaryInertia,
}

/// An element of the deck that is a spring or a dashpot.
pub(crate) struct ConnectorElement {
    /// Label of the element.
    pub label: u64,
    /// Type of the element.
    pub kind: ConnectorKind,
    /// Nodes of the element (indices).
    pub nodes: Vec<usize>,
    /// Place of the element.
    pub span: Span,
}

/// A rigid line: an element of the type R2D2 or RAX2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidLine {
    /// Label of the element.
    pub label: u64,
    /// Nodes of the line (indices).
    pub nodes: [usize; 2],
    /// Place of the line.
    pub span: Span,
}

/// A type of springs or dashpots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ConnectorKind {
    /// Whether the force follows the elongation (spring) or its rate (dashpot).
    pub law: ConnectorLaw,
    /// End of the name of the type: `1`, `2` or `A`.
    pub form: char,
}

impl ConnectorKind {
    /// The type with a given name, in capitals without blanks.
    pub fn from_name(name: &str) -> Option<Self> {
        let families = [
            ("SPRING", ConnectorLaw::Spring),
            ("DASHPOT", ConnectorLaw::Dashpot),
        ];
        families.into_iter().find_map(|(family, law)| {
            match name.strip_prefix(family)? {
                "1" => Some('1'),
                "2" => Some('2'),
                "A" => Some('A'),
                _ => None,
            }
            .map(|form| ConnectorKind { law, form })
        })
    }

    /// Number of nodes of an element of the type.
    pub fn nodes(self) -> usize {
        if self.form == '1' { 1 } else { 2 }
    }
}

/// A set that is named on the card that defines its members.
pub(crate) struct Group {
    /// Name of the set.
    pub name: Name,
    /// Place of the name.
    pub span: Span,
    /// Labels of the members of the set.
    pub labels: LabelList,
}

impl Group {
    /// The set that a parameter of a card names.
    pub fn named_by(
        card: &Card,
        parameter: &str,
        labels: LabelList,
        cx: &mut Context,
    ) -> Option<Group> {
        let text = card.value(parameter)?;
        Some(Group {
            name: text
                .name(cx.d)
                .map(|name| cx.of_instance(name, text.span))?,
            span: text.span,
            labels,
        })
    }
}

impl Default for MeshIndex {
    fn default() -> MeshIndex {
        MeshIndex {
            mesh: Mesh::default(),
            instances: Vec::new(),
            nodes: Labels::new("node", Code::UndefinedNode),
            elements: Labels::new("element", Code::UndefinedElement),
            lines: Vec::new(),
            points: Vec::new(),
            connectors: Vec::new(),
            rigid_lines: Vec::new(),
            places: Vec::new(),
            collapsed: HashMap::new(),
            node_groups: Vec::new(),
            element_groups: Vec::new(),
            cut_faces: HashSet::new(),
        }
    }
}

impl MeshIndex {
    /// Name of a node in the words of the deck.
    pub fn node_name(&self, node: usize) -> String {
        node_name(node, &self.mesh, &self.instances)
    }

    /// Name of an element in the words of the deck.
    pub fn element_name(&self, element: usize) -> String {
        element_name(element, &self.mesh, &self.instances)
    }

    /// The side of an element that has this number in the deck, counted from 0; `None` if the element has no such side.
    pub fn side(&self, element: usize, number: usize) -> Option<usize> {
        let count = self.mesh.elements.get(element)?.side_count();
        match self.collapsed.get(&element) {
            Some(&short) => side_of_triangle(number, short),
            None => (number < count).then_some(number),
        }
    }

    /// Adds nodes without element at given points; the numbers of these nodes follow the largest number of a node.
    pub fn add_points(&mut self, points: &[[f64; 2]]) {
        let largest = self.mesh.node_labels.iter().max().copied().unwrap_or(0);
        let labels = (1..).map(|i| largest.saturating_add(i));
        self.mesh.node_labels.extend(labels.take(points.len()));
        self.mesh.coordinates.extend(points);
    }

    /// Makes room for `count` more nodes.
    pub fn reserve_nodes(&mut self, count: usize) {
        self.nodes.reserve(count);
        self.mesh.node_labels.reserve(count);
        self.mesh.coordinates.reserve(count);
    }

    /// Makes room for `count` more elements.
    pub fn reserve_elements(&mut self, count: usize) {
        self.elements.reserve(count);
        self.mesh.elements.reserve(count);
        self.places.reserve(count);
    }

    /// Gives springs and dashpots indices after the point elements, and rigid lines indices after the springs and
    /// dashpots.
    pub fn number_connectors(&mut self) {
        let first = self.mesh.elements.len() + self.lines.len() + self.points.len();
        let connectors = self.connectors.iter().map(|connector| connector.label);
        let labels = connectors.chain(self.rigid_lines.iter().map(|line| line.label));
        for (index, label) in (first..).zip(labels) {
            self.elements.insert(label, Labelled::new(index));
        }
    }

    /// Removes nodes that are not used, and gives the other nodes new indices.
    pub fn keep_nodes(&mut self, used: &[bool]) {
        let mut count = 0;
        let numbers = used.iter().map(|&used| {
            count += usize::from(used);
            used.then(|| count - 1)
        });
        let numbers: Vec<Option<usize>> = numbers.collect();
        self.nodes.renumber(&numbers);
        let elements = self.mesh.elements.iter_mut().flat_map(|e| &mut e.nodes);
        let connectors = self.connectors.iter_mut().flat_map(|c| &mut c.nodes);
        let rigid = self.rigid_lines.iter_mut().flat_map(|line| &mut line.nodes);
        for node in elements.chain(connectors).chain(rigid) {
            *node = numbers[*node].unwrap_or(*node);
        }
        for point in &mut self.points {
            point.node = numbers[point.node].unwrap_or(point.node);
        }
        let mut kept = used.iter();
        self.mesh.node_labels.retain(|_| kept.next() == Some(&true));
        let mut kept = used.iter();
        self.mesh.coordinates.retain(|_| kept.next() == Some(&true));
    }
}

/// Replaces the labels of nodes and elements by numbers. Numbers in instances follow the largest number outside
/// instances, including springs and dashpots.
pub(super) fn number_instances(
    mesh: &mut Mesh,
    connectors: &[ConnectorElement],
    cx: &Context,
) -> Vec<Instance> {
    if cx.deck.instances.is_empty() {
        return Vec::new();
    }
    let mut instances: Vec<Instance> = Vec::new();
    for instance in &cx.deck.instances {
        instances.push(Instance {
            name: instance.name.typed.clone(),
            ..Instance::default()
        });
    }
    let first = first_number(mesh.node_labels.iter());
    let labels = mesh.node_labels.iter_mut();
    for (index, instance, number) in renumbered(labels, first) {
        if let Some(instance) = instances.get_mut(instance) {
            if instance.node_numbers.is_empty() {
                instance.first_node = index;
            }
            instance.node_numbers.push(number);
        }
    }
    let plane = mesh.elements.iter().map(|element| &element.label);
    let first = first_number(plane.chain(connectors.iter().map(|element| &element.label)));
    let labels = mesh.elements.iter_mut().map(|element| &mut element.label);
    for (index, instance, number) in renumbered(labels, first) {
        if let Some(instance) = instances.get_mut(instance) {
            if instance.element_numbers.is_empty() {
                instance.first_element = index;
            }
            instance.element_numbers.push(number);
        }
    }
    instances
}

/// The number after the largest number outside instances.
fn first_number<'l>(labels: impl Iterator<Item = &'l u64>) -> u64 {
    let others = labels.filter(|label| instance_of(**label) == 0);
    1 + others.max().copied().unwrap_or(0)
}

/// Gives labels of instances new numbers from `next` on; returns index, instance and number in the part of each
/// renumbered node or element.
fn renumbered<'l>(
    labels: impl Iterator<Item = &'l mut u64>,
    mut next: u64,
) -> impl Iterator<Item = (usize, usize, u64)> {
    labels.enumerate().filter_map(move |(index, label)| {
        let instance = instance_of(*label).checked_sub(1)?;
        let number = number_of(*label);
        *label = next;
        next += 1;
        Some((index, instance as usize, number))
    })
}
