//! Bodies: groups of nodes connected by elements.

use super::Mesh;

/// The bodies of a mesh, in the order of their first nodes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bodies {
    /// Number of bodies B.
    pub count: usize,
    /// Body of every node, `N` entries; `None` for nodes without element.
    pub of_node: Vec<Option<usize>>,
    /// Body of every element.
    pub of_element: Vec<usize>,
}

impl Bodies {
    /// The bodies of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let first = mesh.bodies();
        let mut number = vec![None; mesh.node_count()];
        for element in &mesh.elements {
            number[first[element.nodes[0]]] = Some(0);
        }
        let mut count = 0;
        for number in number.iter_mut().flatten() {
            *number = count;
            count += 1;
        }
        let of_node: Vec<Option<usize>> = first.iter().map(|&node| number[node]).collect();
        let of_element = (mesh.elements.iter())
            .filter_map(|element| of_node[element.nodes[0]])
            .collect();
        Bodies {
            count,
            of_node,
            of_element,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Element, ElementType};

    #[test]
    fn bodies_are_numbered_by_their_first_nodes() {
        let element = |nodes: [usize; 3]| Element {
            label: 1,
            element_type: ElementType::CPS3,
            nodes: nodes[..].into(),
            section: 0,
        };
        let mesh = Mesh {
            node_labels: (1..=9).collect(),
            coordinates: vec![[0.0; 2]; 9],
            elements: vec![element([6, 7, 8]), element([5, 2, 1]), element([2, 5, 4])],
        };
        let bodies = Bodies::new(&mesh);
        let (a, b) = (Some(0), Some(1));
        assert_eq!(bodies.count, 2);
        assert_eq!(bodies.of_node, [None, a, a, None, a, a, b, b, b]);
        assert_eq!(bodies.of_element, [1, 0, 0]);
    }
}
