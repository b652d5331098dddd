//! Compliance at the contacts: the entries of an inverse W that the Delassus operator
//! Q = B T W T^T B^T needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of
//! docs/theory.md.

use nalgebra::DMatrix;

use super::pair::Pair;
use crate::linear::{CheckedSolver, LinearError, Transformation};

/// The inverse of a factorised matrix at the unknowns that pairs act on.
///
/// It is computed when pairs first need it and kept until the matrix changes, so that a Delassus
/// matrix for any normals costs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// T: what unknowns the dofs depend on.
    map: Transformation,
    /// Connected group of every unknown: the inverse is zero between groups.
    groups: Vec<usize>,
    /// Row of the inverse of every unknown, where it has been computed.
    place: Vec<Option<usize>>,
    /// Unknowns of the rows.
    unknowns: Vec<usize>,
    inverse: DMatrix<f64>,
}

/// The rows of a pair at one unknown: entries of Bn T and Bt T.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    place: usize,
    group: usize,
    normal: f64,
    tangent: f64,
}

impl Compliance {
    /// Compliance for the unknowns that all dofs depend on, and the connected groups of the
    /// unknowns.
    pub fn new(map: Transformation, groups: Vec<usize>) -> Self {
        let place = vec![None; map.unknowns()];
        Compliance {
            map,
            groups,
            place,
            unknowns: Vec::new(),
            inverse: DMatrix::zeros(0, 0),
        }
    }

    /// Forgets the inverse: the matrix has changed.
    pub fn clear(&mut self) {
        self.place.fill(None);
        self.unknowns.clear();
        self.inverse = DMatrix::zeros(0, 0);
    }

    /// Computes the inverse at the unknowns of `pairs` too, if some are missing.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        pairs: &[Pair],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        let terms = pairs
            .iter()
            .flat_map(Pair::dofs)
            .flat_map(|dof| self.map.row(dof));
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

    /// Entries of Bn T and Bt T of a pair that are not both zero; the pair must have been prepared.
    pub(super) fn entries(&self, pair: &Pair) -> Vec<UnknownEntry> {
        let mut entries = Vec::with_capacity(8);
        for (k, dof) in pair.dofs().into_iter().enumerate() {
            let [normal, tangent] = [pair.normal[k], pair.tangent[k]];
            if normal == 0.0 && tangent == 0.0 {
                continue;
            }
            for &(unknown, c) in self.map.row(dof) {
                if let Some(place) = self.place[unknown] {
                    entries.push(UnknownEntry {
                        place,
                        group: self.groups[unknown],
                        normal: c * normal,
                        tangent: c * tangent,
                    });
                }
            }
        }
        entries
    }

    /// Block (B_p T) W (B_q T)^T of Q = B T W T^T B^T, eq. (5.1), of two pairs: normal before
    /// tangential.
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
                sum[0] += of_p.normal * w;
                sum[1] += of_p.tangent * w;
            }
            for (product, sum) in product.iter_mut().zip(sum) {
                product[0] += sum * of_q.normal;
                product[1] += sum * of_q.tangent;
            }
        }
        product
    }
}
