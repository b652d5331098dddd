//! Positions of nodes in a configuration. See docs/theory/elements.md.

use super::projection::{Projection, project};

/// Positions of all nodes in a configuration: reference coordinates plus displacements.
#[derive(Debug, Clone, Copy)]
pub struct Positions<'a> {
    x: &'a [[f64; 2]],
    u: &'a [[f64; 2]],
}

impl<'a> Positions<'a> {
    /// Positions from reference coordinates `x` of the nodes and displacements `u` over all dofs
    /// (length).
    pub fn new(x: &'a [[f64; 2]], u: &'a [f64]) -> Self {
        let u = u.as_chunks().0;
        Positions { x, u }
    }

    /// Position of a node.
    #[inline]
    pub fn of(&self, node: usize) -> [f64; 2] {
        let ([x, y], [u, v]) = (self.x[node], self.u[node]);
        [x + u, y + v]
    }

    /// Reference coordinates of the nodes (length).
    pub fn reference(&self) -> &'a [[f64; 2]] {
        self.x
    }

    /// Projection of a node on a segment; `nodes` are the slave node and the ends a and b.
    pub fn place(&self, nodes: [usize; 3]) -> Projection {
        let [s, a, b] = nodes.map(|node| self.of(node));
        project(s, a, b)
    }
}

/// Position of a node: reference coordinates plus displacement.
pub(crate) fn position(x: &[[f64; 2]], u: &[f64], node: usize) -> [f64; 2] {
    [x[node][0] + u[2 * node], x[node][1] + u[2 * node + 1]]
}
