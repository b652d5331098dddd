//! The mesh with the node and element numbers of the deck, and the sets named on `*NODE` and
//! `*ELEMENT`.

use crate::deck::{Name, Row};
use crate::diagnostics::Span;
use crate::model::{Element, ElementType, Face, Instance, Mesh, element_name, node_name};
use crate::reader::names::{Labelled, Labels};
use smallvec::SmallVec;

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
    /// Places of the elements.
    pub element_spans: Vec<Span>,
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
    pub labels: Vec<u64>,
}

/// A node as the deck gives it.
pub(in crate::reader) struct RawNode<'a> {
    pub label: u64,
    pub at: [f64; 3],
    pub row: &'a Row,
}

/// An element as the deck gives it, with the numbers of its nodes.
pub(in crate::reader) struct RawElement {
    pub label: u64,
    pub nodes: SmallVec<[u64; 4]>,
    pub element_type: ElementType,
    pub span: Span,
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

    /// Adds a node.
    pub fn add_node(&mut self, node: &RawNode) {
        let [x, y, _] = node.at;
        self.nodes
            .insert(node.label, Labelled::Index(self.mesh.node_count()));
        self.mesh.node_labels.push(node.label);
        self.mesh.coordinates.push([x, y]);
    }

    /// Adds an element whose nodes have been added.
    pub fn add_element(&mut self, element: &RawElement) {
        let index = |label: &u64| match self.nodes.get(*label) {
            Some(Labelled::Index(index)) => Some(index),
            _ => None,
        };
        let nodes: Option<Vec<usize>> = element.nodes.iter().map(index).collect();
        let Some(nodes) = nodes else { return };
        let next = self.mesh.elements.len();
        self.elements.insert(element.label, Labelled::Index(next));
        self.element_spans.push(element.span);
        self.mesh.elements.push(Element {
            label: element.label,
            element_type: element.element_type,
            nodes,
            section: 0,
        });
    }
}
