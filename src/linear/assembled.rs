//! Assembly of element matrices into compressed sparse columns, through positions computed once.

use sprs::{CsMat, CsMatView};

/// Marks an element dof that is not an unknown.
const NOT_AN_UNKNOWN: usize = usize::MAX;

/// A symmetric sparse matrix assembled from element matrices. Both triangles are stored by columns;
/// the pattern is built once and refilled in place.
#[derive(Debug, Clone)]
pub struct Assembled {
    matrix: CsMat<f64>,
    /// Position in the values of every entry of every element matrix, column by column.
    slots: Vec<usize>,
    /// Start of each element in `slots`.
    starts: Vec<usize>,
}

impl Assembled {
    /// Zero matrix of size `n` with the pattern of elements whose unknowns are given: `None` for an
    /// element dof that is not an unknown.
    pub fn new(n: usize, elements: &[Vec<Option<usize>>]) -> Self {
        let mut entries: Vec<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
        for unknowns in elements {
            for &column in unknowns.iter().flatten() {
                entries.extend(unknowns.iter().flatten().map(|&row| (column, row)));
            }
        }
        entries.sort_unstable();
        entries.dedup();
        let mut starts_of_columns = vec![0; n + 1];
        for &(column, _) in &entries {
            starts_of_columns[column + 1] += 1;
        }
        for column in 0..n {
            starts_of_columns[column + 1] += starts_of_columns[column];
        }
        let rows: Vec<usize> = entries.iter().map(|&(_, row)| row).collect();
        let (slots, starts) = element_slots(elements, &starts_of_columns, &rows);
        let values = vec![0.0; rows.len()];
        let matrix = CsMat::new_csc((n, n), starts_of_columns, rows, values);
        Assembled {
            matrix,
            slots,
            starts,
        }
    }

    /// Sets all values to zero.
    pub fn clear(&mut self) {
        self.matrix.data_mut().fill(0.0);
    }

    /// Adds `factor` times the matrix `k` (column by column) of an element.
    pub fn add(&mut self, element: usize, k: &[f64], factor: f64) {
        let slots = &self.slots[self.starts[element]..self.starts[element + 1]];
        debug_assert_eq!(slots.len(), k.len(), "element matrix fits its unknowns");
        let values = self.matrix.data_mut();
        for (&slot, &value) in slots.iter().zip(k) {
            if slot != NOT_AN_UNKNOWN {
                values[slot] += factor * value;
            }
        }
    }

    /// Adds `factor` times a matrix of the same pattern.
    pub fn add_matrix(&mut self, other: &Assembled, factor: f64) {
        for (value, term) in self.matrix.data_mut().iter_mut().zip(other.matrix.data()) {
            *value += factor * term;
        }
    }

    /// The matrix.
    pub fn matrix(&self) -> CsMatView<'_, f64> {
        self.matrix.view()
    }

    /// The pattern with all values zero.
    pub fn zeros(&self) -> Assembled {
        let mut zeros = self.clone();
        zeros.clear();
        zeros
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.matrix.cols()
    }

    /// The entries of the diagonal.
    pub fn diagonal(&self) -> impl Iterator<Item = f64> {
        (0..self.size()).map(|i| self.matrix.get(i, i).copied().unwrap_or(0.0))
    }
}

/// Positions of the entries of all element matrices in the values of the sparse matrix.
fn element_slots(
    elements: &[Vec<Option<usize>>],
    starts_of_columns: &[usize],
    rows: &[usize],
) -> (Vec<usize>, Vec<usize>) {
    let mut slots = Vec::new();
    let mut starts = vec![0];
    for unknowns in elements {
        for column in unknowns {
            slots.extend(unknowns.iter().map(|row| match (row, column) {
                (Some(row), Some(column)) => {
                    let range = starts_of_columns[*column]..starts_of_columns[*column + 1];
                    range.start + rows[range].partition_point(|r| r < row)
                }
                _ => NOT_AN_UNKNOWN,
            }));
        }
        starts.push(slots.len());
    }
    (slots, starts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_add_up_and_refill() {
        let elements = vec![vec![Some(0), None, Some(1)], vec![Some(1), Some(2), None]];
        let mut a = Assembled::new(3, &elements);
        let k: Vec<f64> = (0..9).map(f64::from).collect();
        for _ in 0..2 {
            a.clear();
            a.add(0, &k, 1.0);
            a.add(1, &k, 10.0);
        }
        let dense = a.matrix().to_dense();
        let expected = [[0.0, 6.0, 0.0], [2.0, 8.0, 30.0], [0.0, 10.0, 40.0]];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(dense[[i, j]], *value, "({i}, {j})");
            }
        }
        assert_eq!(a.diagonal().collect::<Vec<_>>(), [0.0, 8.0, 40.0]);
    }
}
