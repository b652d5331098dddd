use crate::linear::{CheckedSolver, LinearError};

use super::Pair;

/// Columns solved for at once.
const BATCH: usize = 32;

/// The inverse of a factorised matrix at the unknowns of the contact surfaces.
///
/// Columns are solved for when a pair first needs them and kept until the matrix changes, so that a
/// Delassus matrix for any normals costs no further solves.
#[derive(Debug, Default)]
pub struct Compliance {
    /// Unknowns of the contact surfaces.
    unknowns: Vec<usize>,
    /// For every dof its position among them; `None` off the surfaces and at supports.
    place: Vec<Option<usize>>,
    /// Column of the inverse at each of them, restricted to them.
    columns: Vec<Option<Vec<f64>>>,
}

impl Compliance {
    /// Compliance at the `nodes` of the contact surfaces, `unknown` being the number of each dof's
    /// unknown (`None` at supports).
    pub fn new(nodes: impl Iterator<Item = usize>, unknown: &[Option<usize>]) -> Self {
        let mut place = vec![None; unknown.len()];
        let mut unknowns = Vec::new();
        for dof in nodes.flat_map(|node| [2 * node, 2 * node + 1]) {
            if let (Some(unknown), None) = (unknown[dof], place[dof]) {
                place[dof] = Some(unknowns.len());
                unknowns.push(unknown);
            }
        }
        let columns = vec![None; unknowns.len()];
        Compliance {
            unknowns,
            place,
            columns,
        }
    }

    /// Forgets all columns: the matrix has changed.
    pub fn clear(&mut self) {
        self.columns.fill(None);
    }

    /// Solves for the columns that `pairs` need and that are missing.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        pairs: &[Pair],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        let n = solver.matrix().size();
        let mut missing: Vec<usize> = pairs
            .iter()
            .flat_map(Pair::dofs)
            .filter_map(|dof| self.place[dof])
            .filter(|&place| self.columns[place].is_none())
            .collect();
        missing.sort_unstable();
        missing.dedup();
        for batch in missing.chunks(BATCH) {
            let mut b = vec![0.0; n * batch.len()];
            for (k, &place) in batch.iter().enumerate() {
                b[k * n + self.unknowns[place]] = 1.0;
            }
            let x = solver.solve(&b)?;
            for (k, &place) in batch.iter().enumerate() {
                let column = self.unknowns.iter().map(|&row| x[k * n + row]).collect();
                self.columns[place] = Some(column);
            }
        }
        Ok(())
    }

    /// The inverse times one row of a pair, at the unknowns of the surfaces.
    pub(super) fn times_row(&self, pair: &Pair, row: &[f64; 6]) -> Vec<f64> {
        let mut result = vec![0.0; self.unknowns.len()];
        for (dof, factor) in pair.dofs().into_iter().zip(row) {
            let column = self.place[dof].and_then(|place| self.columns[place].as_ref());
            for (sum, value) in result.iter_mut().zip(column.into_iter().flatten()) {
                *sum += factor * value;
            }
        }
        result
    }

    /// One row of a pair times a vector over the unknowns of the surfaces.
    pub(super) fn row_times(&self, pair: &Pair, row: &[f64; 6], v: &[f64]) -> f64 {
        let at = |(dof, factor): (usize, &f64)| self.place[dof].map_or(0.0, |i| factor * v[i]);
        pair.dofs().into_iter().zip(row).map(at).sum()
    }
}
