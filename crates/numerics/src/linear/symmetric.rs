//! Symmetric sparse matrices, stored by columns with both triangles; copies share their pattern. The matrices are own
//! code, because `sprs` stores indices of 8 bytes and does not share the storage of its pattern, so each solver would
//! need a copy.

use std::ops::Range;
use std::sync::Arc;

/// Pattern of a symmetric matrix: the places of its entries. Copies of a pattern share its memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern {
    /// First entry of every column, and the number of entries at the end.
    starts: Arc<[u32]>,
    /// Rows of the entries, column after column, in increasing order.
    rows: Arc<[u32]>,
}

impl Default for Pattern {
    fn default() -> Self {
        Pattern::new(vec![0], Vec::new())
    }
}

impl Pattern {
    /// A pattern, made from the first entry of every column (with the number of entries at the end) and the rows of the
    /// entries.
    pub fn new(starts: Vec<u32>, rows: Vec<u32>) -> Self {
        Pattern {
            starts: starts.into(),
            rows: rows.into(),
        }
    }

    /// The pattern whose column k has entries in the rows `neighbours[k]`, in increasing order.
    pub fn of_graph(neighbours: &[Vec<usize>]) -> Self {
        let mut starts = vec![0];
        let mut rows = Vec::new();
        for column in neighbours {
            rows.extend(column.iter().map(|&row| row as u32));
            starts.push(index(rows.len()));
        }
        Pattern::new(starts, rows)
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// Range of the entries of a column.
    pub fn column(&self, k: usize) -> Range<usize> {
        self.starts[k] as usize..self.starts[k + 1] as usize
    }

    /// Rows of the entries of a column.
    pub fn rows(&self, column: usize) -> &[u32] {
        &self.rows[self.column(column)]
    }

    /// First entry of every column, and the number of entries at the end.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Rows of all entries.
    pub fn all_rows(&self) -> &[u32] {
        &self.rows
    }

    /// Number of the entry at a row of a column.
    pub fn position(&self, row: usize, column: usize) -> usize {
        self.column(column).start + self.rows(column).partition_point(|&r| (r as usize) < row)
    }
}

/// The number of an entry as an index of four bytes.
///
/// # Panics
/// The number does not fit into `u32`.
pub fn index(entry: usize) -> u32 {
    assert!(entry < u32::MAX as usize, "matrices fit into memory");
    entry as u32
}

/// A symmetric matrix; copies share its pattern.
#[derive(Debug, Clone)]
pub struct SymmetricMatrix {
    /// Pattern of the matrix.
    pub pattern: Pattern,
    /// Values of the entries, column after column.
    pub values: Vec<f64>,
}

impl SymmetricMatrix {
    /// Zeros.
    pub fn zeros(pattern: Pattern) -> Self {
        SymmetricMatrix {
            values: vec![0.0; pattern.entries()],
            pattern,
        }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.pattern.size()
    }

    /// Entries of a column, each as row and value.
    pub fn column(&self, k: usize) -> impl Iterator<Item = (usize, f64)> {
        let values = &self.values[self.pattern.column(k)];
        let rows = self.pattern.rows(k).iter().map(|&row| row as usize);
        rows.zip(values.iter().copied())
    }

    /// All entries, zeros included.
    #[cfg(test)]
    pub fn to_dense(&self) -> nalgebra::DMatrix<f64> {
        let mut dense = nalgebra::DMatrix::zeros(self.size(), self.size());
        for k in 0..self.size() {
            self.column(k)
                .for_each(|(row, value)| dense[(row, k)] = value);
        }
        dense
    }
}
