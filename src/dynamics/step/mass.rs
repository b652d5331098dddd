//! Global mass matrices over the nodes and over the unknowns, and kinetic energies. Section 2 of
//! docs/theory.md.

use super::parts::Parts;
use super::unknowns::Unknowns;
use crate::elements::Elements;
use crate::linear::{Assembled, Transformation};

/// Consistent mass matrix M, the same for both directions: stored over the nodes.
pub(crate) struct Mass {
    nodal: Assembled,
}

impl Mass {
    /// Mass of all elements of a model with `nodes` nodes.
    pub fn new(elements: &Elements, nodes: usize) -> Self {
        let nodes_of_elements: Vec<Vec<usize>> = (0..elements.len())
            .map(|e| elements.nodes(e).to_vec())
            .collect();
        let mut nodal = Assembled::new(&Transformation::identity(nodes), &nodes_of_elements);
        for element in 0..elements.len() {
            nodal.add(element, &elements.mass(element), 1.0);
        }
        Mass { nodal }
    }

    /// M v for a vector over all dofs.
    pub fn times(&self, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; v.len()];
        for (column, entries) in self.nodal.matrix().outer_iterator().enumerate() {
            for (row, m) in entries.iter() {
                product[2 * row] += m * v[2 * column];
                product[2 * row + 1] += m * v[2 * column + 1];
            }
        }
        product
    }

    /// Kinetic energy v.M v/2.
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        dot(v, &self.times(v)) / 2.0
    }

    /// Kinetic energy of every body.
    pub fn kinetic_energies(&self, v: &[f64], parts: &Parts) -> Vec<f64> {
        let (p, mut energies) = (self.times(v), vec![0.0; parts.bodies()]);
        for (node, &body) in parts.of_nodes().iter().enumerate() {
            for i in [2 * node, 2 * node + 1] {
                energies[body] += v[i] * p[i] / 2.0;
            }
        }
        energies
    }
}

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Mass matrix T^T M T over the unknowns of a step.
pub(crate) fn unknown_mass(elements: &Elements, unknowns: &Unknowns) -> Assembled {
    let of_node = |&node: &usize| [2 * node, 2 * node + 1];
    let dofs_of_elements: Vec<Vec<usize>> = (0..elements.len())
        .map(|e| elements.nodes(e).iter().flat_map(of_node).collect())
        .collect();
    let mut mass = Assembled::new(&unknowns.map, &dofs_of_elements);
    for element in 0..elements.len() {
        let (m, n) = (elements.mass(element), elements.nodes(element).len());
        let d = 2 * n;
        let mut both = vec![0.0; d * d];
        for a in 0..n {
            for b in 0..n {
                both[2 * b * d + 2 * a] = m[b * n + a];
                both[(2 * b + 1) * d + 2 * a + 1] = m[b * n + a];
            }
        }
        mass.add(element, &both, 1.0);
    }
    mass
}
