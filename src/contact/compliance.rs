use nalgebra::DMatrix;

use super::Pair;
use crate::linear::{CheckedSolver, LinearError};

/// The inverse of a factorised matrix at the unknowns that pairs act on.
///
/// It is computed when pairs first need it and kept until the matrix changes, so that a Delassus
/// matrix for any normals costs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// Unknown of every dof; `None` at supports.
    unknown: Vec<Option<usize>>,
    /// Row of the inverse of every dof, where it has been computed.
    place: Vec<Option<usize>>,
    /// Dofs of the rows.
    dofs: Vec<usize>,
    inverse: DMatrix<f64>,
}

impl Compliance {
    /// Compliance for the given unknowns of all dofs (`None` at supports).
    pub fn new(unknown: Vec<Option<usize>>) -> Self {
        let place = vec![None; unknown.len()];
        Compliance {
            unknown,
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

    /// The inverse times one row of a pair, at the rows of the inverse.
    pub(super) fn times_row(&self, pair: &Pair, row: &[f64; 8]) -> Vec<f64> {
        let mut result = vec![0.0; self.dofs.len()];
        for (dof, factor) in pair.dofs().into_iter().zip(row) {
            let Some(place) = self.place[dof] else {
                continue;
            };
            for (sum, value) in result.iter_mut().zip(self.inverse.column(place).iter()) {
                *sum += factor * value;
            }
        }
        result
    }

    /// One row of a pair times a vector over the rows of the inverse.
    pub(super) fn row_times(&self, pair: &Pair, row: &[f64; 8], v: &[f64]) -> f64 {
        let at = |(dof, factor): (usize, &f64)| self.place[dof].map_or(0.0, |i| factor * v[i]);
        pair.dofs().into_iter().zip(row).map(at).sum()
    }
}
