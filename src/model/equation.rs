//! Linear constraint equations between displacements. Section 3 of docs/theory.md.

/// A dof that follows others at all times: u_dof = sum c_k u_k, eq. (3.8).
///
/// A term is never a dof that follows others itself, nor one without a motion of its own unless it
/// is prescribed or belongs to the equation of a node with elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// The dof that is eliminated, `2 node + direction`.
    pub dof: usize,
    /// Dofs that it follows, each once, and their coefficients c_k (dimensionless).
    pub terms: Vec<(usize, f64)>,
}

impl Equation {
    /// The dof that is eliminated and those that it follows.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        std::iter::once(self.dof).chain(self.terms.iter().map(|&(dof, _)| dof))
    }
}
