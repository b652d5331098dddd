//! The mesh with the node and element numbers of the deck, and the sets named on `*NODE` and
//! `*ELEMENT`.

use super::places::Places;
use crate::deck::{Card, Name};
use crate::diagnostics::{Code, Span};
use crate::model::{Face, Instance, Mesh, element_name, node_name};
use crate::reader::context::Context;
use crate::reader::label::LabelList;
use crate::reader::names::Labels;

/// The mesh, with the numbers and sets that the deck gives to its nodes and elements.
pub(crate) struct MeshIndex {
    /// Nodes that belong to elements, and elements. Sections are not yet known.
    pub mesh: Mesh,
    /// Instances of parts.
    pub instances: Vec<Instance>,
    /// Labels of the nodes.
    pub nodes: Labels,
    /// Labels of the elements; the indices of line elements follow those of the plane ones.
    pub elements: Labels,
    /// Faces of the plane elements that the line elements name.
    pub lines: Vec<Face>,
    /// Places of the plane elements.
    pub places: Places,
    /// Node sets named on `*NODE`.
    pub node_groups: Vec<Group>,
    /// Element sets named on `*ELEMENT`.
    pub element_groups: Vec<Group>,
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
            places: Places::default(),
            node_groups: Vec::new(),
            element_groups: Vec::new(),
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

    /// Takes out the nodes that are not used and numbers the others anew.
    pub fn keep_nodes(&mut self, used: &[bool]) {
        let mut count = 0;
        let numbers = used.iter().map(|&used| {
            count += usize::from(used);
            used.then(|| count - 1)
        });
        let numbers: Vec<Option<usize>> = numbers.collect();
        self.nodes.renumber(&numbers);
        for element in &mut self.mesh.elements {
            for node in &mut element.nodes {
                *node = numbers[*node].unwrap_or(*node);
            }
        }
        let mut kept = used.iter();
        self.mesh.node_labels.retain(|_| kept.next() == Some(&true));
        let mut kept = used.iter();
        self.mesh.coordinates.retain(|_| kept.next() == Some(&true));
    }
}
