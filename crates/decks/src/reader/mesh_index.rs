//! The mesh with the node and element numbers of the deck, the sets named on `*NODE` and `*ELEMENT`,
//! and the places of the elements. Nodes and elements of instances get numbers of the program's own, as
//! their numbers in the part appear in every instance.

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
    /// Nodes that belong to elements, and elements. Sections are not yet known.
    pub mesh: Mesh,
    /// Instances of parts.
    pub instances: Vec<Instance>,
    /// Labels of the nodes.
    pub nodes: Labels,
    /// Labels of the elements; the indices of line elements follow those of the plane ones, and those of springs and
    /// dashpots follow these.
    pub elements: Labels,
    /// Faces of the plane elements that the line elements name.
    pub lines: Vec<Face>,
    /// Point elements, whose indices follow those of the line elements.
    pub points: Vec<PointElement>,
    /// Springs and dashpots.
    pub connectors: Vec<ConnectorElement>,
    /// Rigid lines, whose indices follow those of springs and dashpots.
    pub rigid_lines: Vec<RigidLine>,
    /// Places of the plane elements.
    pub places: Vec<Span>,
    /// Sides of no length of quadrilaterals that are triangles (indices).
    pub collapsed: HashMap<usize, usize>,
    /// Node sets named on `*NODE`.
    pub node_groups: Vec<Group>,
    /// Element sets named on `*ELEMENT`.
    pub element_groups: Vec<Group>,
    /// Faces on both sides of the cuts of pre-tension sections, which belong to no surface but those that name them.
    pub cut_faces: HashSet<Face>,
}

/// An element at one node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PointElement {
    /// What it has.
    pub kind: PointKind,
    /// Its node.
    pub node: usize,
    /// Where it is defined.
    pub span: Span,
}

/// What a point element has.
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
    /// Its type.
    pub kind: ConnectorKind,
    /// Its nodes (indices).
    pub nodes: Vec<usize>,
    /// Its place.
    pub span: Span,
}

/// An element that is a rigid line, of the type R2D2 or RAX2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidLine {
    /// Label of the element.
    pub label: u64,
    /// Its nodes (indices).
    pub nodes: [usize; 2],
    /// Its place.
    pub span: Span,
}

/// A type of springs or dashpots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ConnectorKind {
    /// What its force follows.
    pub law: ConnectorLaw,
    /// `1`, `2` or `A`.
    pub form: char,
}

impl ConnectorKind {
    /// The type with this folded name.
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

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        if self.form == '1' { 1 } else { 2 }
    }
}

/// A set named where its members are defined.
pub(crate) struct Group {
    /// Its name.
    pub name: Name,
    /// Where it is named.
    pub span: Span,
    /// Labels of its members.
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
    /// What the deck calls a node.
    pub fn node_name(&self, node: usize) -> String {
        node_name(node, &self.mesh, &self.instances)
    }

    /// What the deck calls an element.
    pub fn element_name(&self, element: usize) -> String {
        element_name(element, &self.mesh, &self.instances)
    }

    /// The side of an element that the deck gives a number from 0; none if the element has no such side.
    pub fn side(&self, element: usize, number: usize) -> Option<usize> {
        let count = self.mesh.elements.get(element)?.side_count();
        match self.collapsed.get(&element) {
            Some(&short) => side_of_triangle(number, short),
            None => (number < count).then_some(number),
        }
    }

    /// Adds nodes without element at these points; their numbers follow the largest one.
    pub fn add_points(&mut self, points: &[[f64; 2]]) {
        let largest = self.mesh.node_labels.iter().max().copied().unwrap_or(0);
        let labels = (1..).map(|i| largest.saturating_add(i));
        self.mesh.node_labels.extend(labels.take(points.len()));
        self.mesh.coordinates.extend(points);
    }

    /// Makes room for so many nodes more.
    pub fn reserve_nodes(&mut self, count: usize) {
        self.nodes.reserve(count);
        self.mesh.node_labels.reserve(count);
        self.mesh.coordinates.reserve(count);
    }

    /// Makes room for so many elements more.
    pub fn reserve_elements(&mut self, count: usize) {
        self.elements.reserve(count);
        self.mesh.elements.reserve(count);
        self.places.reserve(count);
    }

    /// Numbers springs and dashpots after the point elements, and rigid lines after them.
    pub fn number_connectors(&mut self) {
        let first = self.mesh.elements.len() + self.lines.len() + self.points.len();
        let connectors = self.connectors.iter().map(|connector| connector.label);
        let labels = connectors.chain(self.rigid_lines.iter().map(|line| line.label));
        for (index, label) in (first..).zip(labels) {
            self.elements.insert(label, Labelled::new(index));
        }
    }

    /// Takes out the nodes that are not used and numbers the others anew.
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

/// Replaces the labels of nodes and elements by numbers; those of instances follow the largest one
/// of the others, that of springs and dashpots among them.
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

/// The number after the largest one outside instances.
fn first_number<'l>(labels: impl Iterator<Item = &'l u64>) -> u64 {
    let others = labels.filter(|label| instance_of(**label) == 0);
    1 + others.max().copied().unwrap_or(0)
}

/// Gives those of instances numbers of their own from `next` on; returns index, instance and number
/// in the part of each.
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
