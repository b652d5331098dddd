//! Constraints between displacements: linear equations (section 3 of docs/theory.md, Unknowns), and
//! rigid surfaces that move with a reference node (section 9, Rigid surfaces).

/// A dof that follows others at all times: u_dof = sum c_k u_k, eq. (3.8).
///
/// The u_k are free or prescribed: none follows others itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// The dof that is eliminated, `2 node + direction`.
    pub dof: usize,
    /// Dofs that it follows, each once, and their coefficients c_k (dimensionless).
    pub terms: Vec<(usize, f64)>,
}

impl Equation {
    /// The eliminated dof and the dofs that it follows.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        std::iter::once(self.dof).chain(self.terms.iter().map(|&(dof, _)| dof))
    }
}

/// A rigid surface and the node that it moves with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RigidBody {
    /// Index of the rigid surface.
    pub surface: usize,
    /// Reference node (index).
    pub reference: usize,
}
