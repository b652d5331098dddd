//! Symmetric blocks that are added to an assembled matrix beyond its pattern: what couples unknowns
//! that no element connects. Section 4 of docs/theory.md.

use std::ops::Range;

use nalgebra::DMatrix;
use sprs::{CsMat, CsMatView};

use super::Transformation;

/// Places of earlier blocks for each entry at hand.
const MOST_PLACES: usize = 3;

/// Sum of blocks T_e^T K_e T_e over the unknowns.
#[derive(Debug, Clone, Default)]
pub struct AddedBlocks {
    /// Column, row and value of every entry, in any order; entries of one place add up.
    entries: Vec<(usize, usize, f64)>,
}

/// Columns of a matrix as they grow.
struct Columns {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl AddedBlocks {
    /// Adds T_e^T K_e T_e of a symmetric matrix `k` over some dofs; its zeros enlarge no pattern.
    pub fn add(&mut self, map: &Transformation, dofs: &[usize], k: &DMatrix<f64>) {
        for (j, &column_dof) in dofs.iter().enumerate() {
            for (i, &row_dof) in dofs.iter().enumerate().filter(|&(i, _)| k[(i, j)] != 0.0) {
                for &(column, c) in map.row(column_dof) {
                    let terms = map.row(row_dof).iter();
                    self.entries
                        .extend(terms.map(|&(row, r)| (column, row, r * c * k[(i, j)])));
                }
            }
        }
    }

    /// Whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds zeros at the `places` (column, row) of earlier blocks, and these blocks' to the places: the pattern
    /// of the sum stays the same as long as it can, and with it its symbolic analysis. Many more places than
    /// entries are forgotten.
    pub fn keep_places(&mut self, places: &mut Vec<(usize, usize)>) {
        if places.len() > MOST_PLACES * self.entries.len() {
            places.clear();
        }
        let own = self.entries.iter().map(|entry| (entry.0, entry.1));
        let known = places.len();
        places.extend(own);
        let zeros = places[..known]
            .iter()
            .map(|&(column, row)| (column, row, 0.0));
        self.entries.extend(zeros);
        places.sort_unstable();
        places.dedup();
    }

    /// The sum of a matrix and the blocks, with the union of their patterns; by columns.
    pub fn added_to(mut self, matrix: CsMatView<'_, f64>) -> CsMat<f64> {
        self.entries.sort_by_key(|&(column, row, _)| (column, row));
        let n = matrix.cols();
        let mut sum = Columns {
            starts: vec![0],
            rows: Vec::with_capacity(matrix.nnz() + self.entries.len()),
            values: Vec::with_capacity(matrix.nnz() + self.entries.len()),
        };
        let mut next = 0;
        for added in self.entries.chunk_by(|one, other| one.0 == other.0) {
            let column = added[0].0;
            sum.take(matrix, next..column);
            sum.merge(matrix, column, added);
            next = column + 1;
        }
        sum.take(matrix, next..n);
        CsMat::new_csc((n, n), sum.starts, sum.rows, sum.values)
    }
}

impl Columns {
    /// Takes over columns of a matrix as they are.
    fn take(&mut self, matrix: CsMatView<'_, f64>, columns: Range<usize>) {
        let starts = matrix.indptr();
        let ends = &starts.raw_storage()[columns.start..=columns.end];
        let entries = ends[0]..ends[columns.len()];
        let first = self.rows.len();
        self.starts
            .extend(ends[1..].iter().map(|end| end - ends[0] + first));
        self.rows
            .extend_from_slice(&matrix.indices()[entries.clone()]);
        self.values.extend_from_slice(&matrix.data()[entries]);
    }

    /// Adds the next column: that of a matrix and entries of it, in the order of their rows.
    fn merge(&mut self, matrix: CsMatView<'_, f64>, column: usize, added: &[(usize, usize, f64)]) {
        let entries = matrix.indptr().outer_inds_sz(column);
        let own = (matrix.indices()[entries.clone()].iter()).zip(&matrix.data()[entries]);
        let mut added = added.iter().peekable();
        for (&row, &value) in own {
            while let Some(entry) = added.next_if(|entry| entry.1 < row) {
                self.push(entry.1, entry.2);
            }
            self.push(row, value);
        }
        added.for_each(|entry| self.push(entry.1, entry.2));
        self.starts.push(self.rows.len());
    }

    /// Adds an entry to the last column, whose rows come in increasing order.
    fn push(&mut self, row: usize, value: f64) {
        let first = self.starts[self.starts.len() - 1];
        match self.values.last_mut() {
            Some(last) if self.rows[first..].last() == Some(&row) => *last += value,
            _ => {
                self.rows.push(row);
                self.values.push(value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Assembled;

    #[test]
    fn blocks_add_to_entries_and_enlarge_the_pattern() {
        // dof 1 follows dof 0, u1 = 2 q0; dof 4 is prescribed
        let free = |unknown| vec![(unknown, 1.0)];
        let rows = [free(0), vec![(0, 2.0)], free(1), free(2), vec![]];
        let map = Transformation::new(3, rows);
        let mut matrix = Assembled::new(&map, &[vec![0], vec![2, 3]]);
        matrix.add(0, &[5.0], 1.0);
        matrix.add(1, &[7.0, -1.0, -1.0, 8.0], 1.0);
        let mut blocks = AddedBlocks::default();
        let k = DMatrix::from_row_slice(3, 3, &[1.0, 3.0, 9.0, 3.0, 0.0, 9.0, 9.0, 9.0, 9.0]);
        blocks.add(&map, &[1, 3, 4], &k);
        blocks.add(&map, &[2], &DMatrix::from_element(1, 1, 0.5));
        let sum = blocks.added_to(matrix.matrix());
        let expected = [[9.0, 0.0, 6.0], [0.0, 7.5, -1.0], [6.0, -1.0, 8.0]];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(sum.get(i, j).copied().unwrap_or(0.0), *value, "({i}, {j})");
            }
        }
        // the zero of the block and the pair of the dofs 0 and 2 stay out of the pattern
        assert_eq!(sum.nnz(), 7);
        assert_eq!(matrix.matrix().nnz(), 5);
    }

    #[test]
    fn without_entries_the_matrix_is_the_same() {
        let mut matrix = Assembled::new(&Transformation::identity(3), &[vec![0, 2]]);
        matrix.add(0, &[2.0, 1.0, 1.0, 3.0], 1.0);
        let blocks = AddedBlocks::default();
        assert!(blocks.is_empty());
        assert_eq!(blocks.added_to(matrix.matrix()).view(), matrix.matrix());
    }
}
