//! Compliance at the contacts: the entries of an inverse W that the Delassus operator
//! Q = G T W T^T B^T needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of
//! docs/theory.md.

use nalgebra::DMatrix;

use super::constraint::{Constraint, Rows};
use crate::linear::{CheckedSolver, LinearError, Rotation, Transformation};

/// The inverse of a factorised matrix at the unknowns that constraints act on.
///
/// It is computed when constraints first need it and kept until the matrix changes, so that a Delassus
/// matrix for any normals costs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// T: what unknowns the dofs depend on.
    map: Transformation,
    /// R of the bodies since the matrix was factorised.
    rotation: Rotation,
    /// Connected group of every unknown: the inverse is zero between groups.
    groups: Vec<usize>,
    /// Row of the inverse of every unknown, where it has been computed.
    place: Vec<Option<usize>>,
    /// Unknowns of the rows.
    unknowns: Vec<usize>,
    inverse: DMatrix<f64>,
}

/// The rows of a constraint at one unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    /// Row of the inverse.
    place: usize,
    group: usize,
    /// Entries of Bn T and Bt T.
    force: [f64; 2],
    /// Entries of Gn T and Gt T.
    derivative: [f64; 2],
}

impl Compliance {
    /// Compliance for the unknowns that all dofs depend on, and the connected groups of the
    /// unknowns.
    pub fn new(map: Transformation, groups: Vec<usize>) -> Self {
        let place = vec![None; map.unknowns()];
        Compliance {
            map,
            rotation: Rotation::default(),
            groups,
            place,
            unknowns: Vec::new(),
            inverse: DMatrix::zeros(0, 0),
        }
    }

    /// Forgets the inverse: the matrix has changed, and with it, perhaps, the connected groups.
    pub fn renew(&mut self, groups: Vec<usize>) {
        self.groups = groups;
        self.rotation = Rotation::default();
        self.place.fill(None);
        self.unknowns.clear();
        self.inverse = DMatrix::zeros(0, 0);
    }

    /// Turns W with the bodies, to R W R^T, since the matrix was factorised.
    pub fn turn(&mut self, rotation: Rotation) {
        self.rotation = rotation;
    }

    /// R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// Computes the inverse at the unknowns of `constraints` too, if some are missing.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        constraints: &[&Constraint],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        let dofs = constraints.iter().flat_map(|constraint| &constraint.dofs);
        let terms = dofs.flat_map(|&dof| self.map.row(dof));
        let missing = |unknown: &usize| self.place[*unknown].is_none();
        let missing: Vec<usize> = terms.map(|term| term.0).filter(missing).collect();
        if missing.is_empty() {
            return Ok(());
        }
        self.unknowns.extend(missing);
        self.unknowns.sort_unstable();
        self.unknowns.dedup();
        let inverse = solver.inverse_at(&self.unknowns)?;
        let size = self.unknowns.len();
        self.inverse = DMatrix::from_vec(size, size, inverse);
        for (place, &unknown) in self.unknowns.iter().enumerate() {
            self.place[unknown] = Some(place);
        }
        Ok(())
    }

    /// T: what unknowns the dofs depend on.
    pub fn map(&self) -> &Transformation {
        &self.map
    }

    /// Entries of the rows of a constraint, turned back with R^T, that are not all zero; it must have
    /// been prepared.
    pub(super) fn entries(&self, constraint: &Constraint) -> Vec<UnknownEntry> {
        let rows = [&constraint.force_rows, constraint.derivative_rows()];
        let rows = rows.map(|rows| self.turned_back(&constraint.dofs, rows));
        let mut entries = Vec::with_capacity(constraint.dofs.len());
        for (k, &dof) in constraint.dofs.iter().enumerate() {
            let [force, derivative] =
                (rows.each_ref()).map(|rows| [rows.normal[k], rows.tangential[k]]);
            if force == [0.0; 2] && derivative == [0.0; 2] {
                continue;
            }
            for &(unknown, c) in self.map.row(dof) {
                if let Some(place) = self.place[unknown] {
                    entries.push(UnknownEntry {
                        place,
                        group: self.groups[unknown],
                        force: force.map(|entry| c * entry),
                        derivative: derivative.map(|entry| c * entry),
                    });
                }
            }
        }
        entries
    }

    /// Rows times R, over the dofs of a constraint, eq. (4.20).
    fn turned_back(&self, dofs: &[usize], rows: &Rows) -> Rows {
        let mut turned = rows.clone();
        self.rotation.turn_row(dofs, &mut turned.normal);
        self.rotation.turn_row(dofs, &mut turned.tangential);
        turned
    }

    /// Block (G_p T) W (B_q T)^T of Q = G T W T^T B^T, eq. (5.1), of two constraints: what normal
    /// (first column) and tangential force of q add to gap (first row) and slip of p.
    pub(super) fn between(&self, p: &[UnknownEntry], q: &[UnknownEntry]) -> [[f64; 2]; 2] {
        let mut product = [[0.0; 2]; 2];
        for of_q in q {
            if !p.iter().any(|of_p| of_p.group == of_q.group) {
                continue;
            }
            let column = self.inverse.column(of_q.place);
            let mut sum = [0.0; 2];
            for of_p in p {
                let w = column[of_p.place];
                sum[0] += of_p.derivative[0] * w;
                sum[1] += of_p.derivative[1] * w;
            }
            for (product, sum) in product.iter_mut().zip(sum) {
                product[0] += sum * of_q.force[0];
                product[1] += sum * of_q.force[1];
            }
        }
        product
    }
}
