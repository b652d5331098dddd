//! The configurations between which contact constraints are linearised, and the form of their
//! rows. Sections 3 and 7 of docs/theory.md.

use crate::contact::geometry::position;

/// How the rows Bn and Bt of a pair are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowForm {
    /// Normal and tangent of the end configuration (SS22).
    End,
    /// Discrete gradients of gap and projection between start and end: Bn d = g1 - g0 and
    /// Bt d = L (xi1 - xi0) exactly, and both momenta are kept (energy-momentum form).
    DiscreteGradient,
}

/// Start of the increment and iterate between which constraints are linearised.
#[derive(Debug, Clone, Copy)]
pub struct Configurations<'a> {
    /// How rows are made.
    pub form: RowForm,
    /// Reference coordinates of the nodes (length).
    pub x: &'a [[f64; 2]],
    /// Displacement U0 of the start, over all dofs (length).
    pub u0: &'a [f64],
    /// Displacement U of the iterate, over all dofs (length).
    pub u: &'a [f64],
}

impl Configurations<'_> {
    /// Positions of nodes at the start.
    pub(super) fn start<const N: usize>(&self, nodes: [usize; N]) -> [[f64; 2]; N] {
        nodes.map(|node| position(self.x, self.u0, node))
    }

    /// Positions of nodes in the iterate.
    pub(super) fn iterate<const N: usize>(&self, nodes: [usize; N]) -> [[f64; 2]; N] {
        nodes.map(|node| position(self.x, self.u, node))
    }
}
