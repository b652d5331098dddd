//! The supernodes of L, from the analysis of groups of unknowns that are eliminated together. Section 5 of
//! docs/theory.md, Branches.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// Supernodes: columns of L with the same rows below them, children before their parents.
#[derive(Debug, Default)]
pub struct Supernodes {
    /// First column of every supernode, and the number of columns.
    starts: Vec<usize>,
    /// Rows below the columns of one supernode after the other, increasing.
    rows: Vec<usize>,
    /// Start of the rows of every supernode, and their end.
    row_starts: Vec<usize>,
}

impl Supernodes {
    /// Those of the unknowns of groups, given those of the groups; `offsets` are the first pivot of every group in
    /// the order of their elimination, and the number of pivots.
    pub fn of_groups(groups: &SymbolicSupernodalCholesky<usize>, offsets: &[usize]) -> Self {
        let mut supernodes = Supernodes {
            starts: vec![0],
            rows: Vec::new(),
            row_starts: vec![0],
        };
        for s in 0..groups.n_supernodes() {
            supernodes.starts.push(offsets[groups.supernode_end()[s]]);
            for &row in groups.supernode(s).pattern() {
                supernodes.rows.extend(offsets[row]..offsets[row + 1]);
            }
            supernodes.row_starts.push(supernodes.rows.len());
        }
        supernodes
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Columns of a supernode.
    pub fn columns(&self, s: usize) -> Range<usize> {
        self.starts[s]..self.starts[s + 1]
    }

    /// Rows below the columns of a supernode, increasing.
    pub fn rows(&self, s: usize) -> &[usize] {
        &self.rows[self.row_starts[s]..self.row_starts[s + 1]]
    }

    /// Entries of the columns of a supernode, with those above their diagonal.
    pub fn entries(&self, s: usize) -> usize {
        let size = self.columns(s).len();
        size * (size + self.rows(s).len())
    }

    /// The supernode of the first row below each.
    pub fn parents(&self) -> Vec<Option<usize>> {
        let of_row = |row: &usize| self.starts.partition_point(|start| start <= row) - 1;
        let parent = |s: usize| self.rows(s).first().map(of_row);
        (0..self.count()).map(parent).collect()
    }
}
