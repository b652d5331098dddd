//! Numbering of the unknowns of a step, and the maps between them and all degrees of freedom.

use crate::elements::Elements;
use crate::model::Step;

/// Which dofs are unknowns: those of nodes with elements that no support prescribes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DofMap {
    /// Number of the unknown of every dof.
    pub unknown: Vec<Option<usize>>,
    /// Dof of every unknown.
    pub dof: Vec<usize>,
}

impl DofMap {
    /// Unknowns of a step.
    pub fn new(elements: &Elements, step: &Step, dofs: usize) -> Self {
        let mut free = vec![false; dofs];
        for element in 0..elements.len() {
            for &node in elements.nodes(element) {
                free[2 * node] = true;
                free[2 * node + 1] = true;
            }
        }
        for support in &step.supports {
            free[support.dof] = false;
        }
        let dof: Vec<usize> = (0..dofs).filter(|&dof| free[dof]).collect();
        let mut unknown = vec![None; dofs];
        for (number, &dof) in dof.iter().enumerate() {
            unknown[dof] = Some(number);
        }
        DofMap { unknown, dof }
    }

    /// Whether one of the nodes has an unknown.
    pub fn moves(&self, nodes: &[usize]) -> bool {
        nodes
            .iter()
            .any(|node| self.unknown[2 * node].is_some() || self.unknown[2 * node + 1].is_some())
    }

    /// Unknowns of every element, in the order of its dofs.
    pub fn element_unknowns(&self, elements: &Elements) -> Vec<Vec<Option<usize>>> {
        let of_node = |&node: &usize| [self.unknown[2 * node], self.unknown[2 * node + 1]];
        (0..elements.len())
            .map(|e| elements.nodes(e).iter().flat_map(of_node).collect())
            .collect()
    }

    /// Entries of a vector over all dofs at the unknowns.
    pub fn restrict(&self, v: &[f64]) -> Vec<f64> {
        self.dof.iter().map(|&dof| v[dof]).collect()
    }

    /// Adds a vector over the unknowns to one over all dofs.
    pub fn add(&self, unknowns: &[f64], v: &mut [f64]) {
        for (&dof, value) in self.dof.iter().zip(unknowns) {
            v[dof] += value;
        }
    }
}
