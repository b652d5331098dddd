//! Compliance at the contacts: the entries of an inverse W that the Delassus operator Q = B W B^T
//! needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of docs/theory.md.

use nalgebra::DMatrix;

use super::pair::Pair;
use crate::linear::{CheckedSolver, LinearError};

/// The inverse of a factorised matrix at the unknowns that pairs act on.
///
/// It is computed when pairs first need it and kept until the matrix changes, so that a Delassus
/// matrix for any normals costs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// Unknown of every dof; `None` at supports.
    unknown: Vec<Option<usize>>,
    /// Body of every node: the inverse is zero between bodies.
    bodies: Vec<usize>,
    /// Row of the inverse of every dof, where it has been computed.
    place: Vec<Option<usize>>,
    /// Dofs of the rows.
    dofs: Vec<usize>,
    inverse: DMatrix<f64>,
}

impl Compliance {
    /// Compliance for the given unknowns of all dofs (`None` at supports) and bodies of all nodes.
    pub fn new(unknown: Vec<Option<usize>>, bodies: Vec<usize>) -> Self {
        let place = vec![None; unknown.len()];
        Compliance {
            unknown,
            bodies,
            place,
            dofs: Vec::new(),
            inverse: DMatrix::zeros(0, 0),
        }
    }

    /// Forgets the inverse: the matrix has changed.
    pub fn clear(&mut self) {
        self.place.fill(None);
        self.dofs.clear();
        self.inverse = DMatrix::zeros(0, 0);
    }

    /// Computes the inverse at the dofs of `pairs` too, if some are missing.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        pairs: &[Pair],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        let missing = |dof: &usize| self.unknown[*dof].is_some() && self.place[*dof].is_none();
        let missing: Vec<usize> = pairs.iter().flat_map(Pair::dofs).filter(missing).collect();
        if missing.is_empty() {
            return Ok(());
        }
        self.dofs.extend(missing);
        self.dofs.sort_unstable();
        self.dofs.dedup();
        let unknowns: Vec<usize> = self
            .dofs
            .iter()
            .filter_map(|&dof| self.unknown[dof])
            .collect();
        let inverse = solver.inverse_at(&unknowns)?;
        self.inverse = DMatrix::from_vec(unknowns.len(), unknowns.len(), inverse);
        for (place, &dof) in self.dofs.iter().enumerate() {
            self.place[dof] = Some(place);
        }
        Ok(())
    }

    /// Block B_p W B_q^T of Q = B W B^T, eq. (5.1), of two pairs: normal before tangential.
    pub(crate) fn between(&self, p: &Pair, q: &Pair) -> [[f64; 2]; 2] {
        let mut product = [[0.0; 2]; 2];
        let bodies = |pair: &Pair| pair.target.nodes.map(|node| self.bodies[node]);
        let (of_p, of_q) = (bodies(p), bodies(q));
        if !of_p.iter().any(|body| of_q.contains(body)) {
            return product;
        }
        let places = |pair: &Pair| pair.dofs().map(|dof| self.place[dof]);
        let (rows, columns) = (places(p), places(q));
        for (k, &column) in columns.iter().enumerate() {
            let Some(column) = column else { continue };
            let is_zero = q.normal[k] == 0.0 && q.tangent[k] == 0.0;
            if is_zero || !of_p.contains(&of_q[k / 2]) {
                continue;
            }
            let column = self.inverse.column(column);
            let mut sum = [0.0; 2];
            for (l, &row) in rows.iter().enumerate() {
                if let Some(row) = row {
                    sum[0] += p.normal[l] * column[row];
                    sum[1] += p.tangent[l] * column[row];
                }
            }
            for (product, sum) in product.iter_mut().zip(sum) {
                product[0] += sum * q.normal[k];
                product[1] += sum * q.tangent[k];
            }
        }
        product
    }
}
