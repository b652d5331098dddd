//! Assembly of element matrices into compressed sparse columns, K = sum T_e^T K_e T_e, through
//! positions computed once. Section 4 of docs/theory.md.

use sprs::{CsMat, CsMatView};

use super::Transformation;

/// Marks an entry of an element matrix that equations distribute over several entries.
const DISTRIBUTED: usize = usize::MAX;

/// A symmetric sparse matrix over unknowns, assembled from element matrices over dofs. Both
/// triangles are stored by columns; the pattern is built once and refilled in place.
#[derive(Debug, Clone)]
pub struct Assembled {
    matrix: CsMat<f64>,
    /// Position in the values of every entry of every element matrix, column by column.
    positions: Vec<usize>,
    /// Start of each element in `positions`.
    starts: Vec<usize>,
    /// Terms of the entries whose dofs follow others, element by element.
    couplings: Vec<Coupling>,
    /// Start of each element in `couplings`, and their end.
    coupling_starts: Vec<usize>,
}

/// A term of T_e^T K_e T_e where a row of T is not one of the identity.
#[derive(Debug, Clone, Copy)]
struct Coupling {
    /// Entry of the element matrix.
    entry: usize,
    /// Its position in the values.
    position: usize,
    /// Product of the two coefficients.
    coefficient: f64,
}

impl Assembled {
    /// Zero matrix over the unknowns of `map`, with the pattern of elements with the given dofs.
    pub fn new(map: &Transformation, elements: &[Vec<usize>]) -> Self {
        let n = map.unknowns();
        let mut entries: Vec<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
        for dofs in elements {
            let unknowns = || dofs.iter().flat_map(|&dof| map.row(dof)).map(|term| term.0);
            for column in unknowns() {
                entries.extend(unknowns().map(|row| (column, row)));
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
        let values = vec![0.0; rows.len()];
        let mut assembled = Assembled {
            matrix: CsMat::new_csc((n, n), starts_of_columns, rows, values),
            positions: Vec::new(),
            starts: vec![0],
            couplings: Vec::new(),
            coupling_starts: vec![0],
        };
        for dofs in elements {
            assembled.place(map, dofs);
        }
        assembled
    }

    /// Finds the positions of the entries of an element matrix over the given dofs.
    fn place(&mut self, map: &Transformation, dofs: &[usize]) {
        let pairs = dofs
            .iter()
            .flat_map(|column| dofs.iter().map(move |row| (row, column)));
        for (entry, (&row, &column)) in pairs.enumerate() {
            let position = match (map.row(row), map.row(column)) {
                (&[(row, 1.0)], &[(column, 1.0)]) => self.position(row, column),
                (rows, columns) => {
                    for &(column, c) in columns {
                        for &(row, r) in rows {
                            let (position, coefficient) = (self.position(row, column), r * c);
                            self.couplings.push(Coupling {
                                entry,
                                position,
                                coefficient,
                            });
                        }
                    }
                    DISTRIBUTED
                }
            };
            self.positions.push(position);
        }
        self.starts.push(self.positions.len());
        self.coupling_starts.push(self.couplings.len());
    }

    /// Position in the values of an entry of the pattern.
    fn position(&self, row: usize, column: usize) -> usize {
        let range = self.matrix.indptr().outer_inds_sz(column);
        range.start + self.matrix.indices()[range].partition_point(|r| *r < row)
    }

    /// Sets all values to zero.
    pub fn clear(&mut self) {
        self.matrix.data_mut().fill(0.0);
    }

    /// Adds `factor` times the matrix `k` (column by column) of an element.
    pub fn add(&mut self, element: usize, k: &[f64], factor: f64) {
        let positions = &self.positions[self.starts[element]..self.starts[element + 1]];
        debug_assert_eq!(positions.len(), k.len(), "element matrix fits its dofs");
        let values = self.matrix.data_mut();
        for (&position, &value) in positions.iter().zip(k) {
            if position != DISTRIBUTED {
                values[position] += factor * value;
            }
        }
        let couplings = self.coupling_starts[element]..self.coupling_starts[element + 1];
        for coupling in &self.couplings[couplings] {
            values[coupling.position] += coupling.coefficient * factor * k[coupling.entry];
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

/// Connected group of every unknown of a matrix, numbered from 0: the inverse has no entries between
/// different groups.
pub(super) fn groups(matrix: CsMatView<'_, f64>) -> Vec<usize> {
    let n = matrix.cols();
    let (mut group, mut count) = (vec![usize::MAX; n], 0);
    for first in 0..n {
        if group[first] != usize::MAX {
            continue;
        }
        let mut reached = vec![first];
        group[first] = count;
        while let Some(unknown) = reached.pop() {
            for &next in &matrix.indices()[matrix.indptr().outer_inds_sz(unknown)] {
                if group[next] == usize::MAX {
                    group[next] = count;
                    reached.push(next);
                }
            }
        }
        count += 1;
    }
    group
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Elements of three dofs each, the second dof of the first and the third of the second prescribed.
    fn two_elements(map: &Transformation) -> Assembled {
        let mut a = Assembled::new(map, &[vec![0, 1, 2], vec![2, 3, 4]]);
        let k: Vec<f64> = (0..9).map(f64::from).collect();
        for _ in 0..2 {
            a.clear();
            a.add(0, &k, 1.0);
            a.add(1, &k, 10.0);
        }
        a
    }

    fn assert_entries<const N: usize>(a: &Assembled, expected: [[f64; N]; N]) {
        let dense = a.matrix().to_dense();
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(dense[[i, j]], *value, "({i}, {j})");
            }
        }
    }

    #[test]
    fn elements_add_up_and_refill() {
        let free = |unknown| vec![(unknown, 1.0)];
        let rows = [free(0), vec![], free(1), free(2), vec![]];
        let a = two_elements(&Transformation::new(3, rows));
        assert_entries(&a, [[0.0, 6.0, 0.0], [2.0, 8.0, 30.0], [0.0, 10.0, 40.0]]);
        assert_eq!(a.diagonal().collect::<Vec<_>>(), [0.0, 8.0, 40.0]);
        assert_eq!(groups(a.matrix()), [0, 0, 0]);
    }

    #[test]
    fn a_dof_that_follows_others_adds_to_their_rows_and_columns() {
        // u = T q: u1 = 2 q0, u4 = q2 - 3 q0
        let free = |unknown| vec![(unknown, 1.0)];
        let rows = [
            free(0),
            vec![(0, 2.0)],
            free(1),
            free(2),
            vec![(2, 1.0), (0, -3.0)],
        ];
        let dense = [
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [-3.0, 0.0, 1.0],
        ];
        let k = |element: usize, i: usize, j: usize| {
            let at = 2 * element;
            match i >= at && j >= at && i < at + 3 && j < at + 3 {
                true => [1.0, 10.0][element] * (3 * (j - at) + i - at) as f64,
                false => 0.0,
            }
        };
        let mut expected = [[0.0; 3]; 3];
        for (p, row) in expected.iter_mut().enumerate() {
            for (q, sum) in row.iter_mut().enumerate() {
                for (i, ti) in dense.iter().enumerate() {
                    for (j, tj) in dense.iter().enumerate() {
                        *sum += ti[p] * (k(0, i, j) + k(1, i, j)) * tj[q];
                    }
                }
            }
        }
        assert_entries(&two_elements(&Transformation::new(3, rows)), expected);
    }

    #[test]
    fn groups_are_what_elements_and_equations_connect() {
        let elements = [vec![0, 1], vec![2, 3]];
        let apart = Assembled::new(&Transformation::identity(4), &elements);
        assert_eq!(groups(apart.matrix()), [0, 0, 1, 1]);
        let rows = [0, 1, 0, 2].map(|unknown| vec![(unknown, 1.0)]);
        let tied = Assembled::new(&Transformation::new(3, rows), &elements);
        assert_eq!(groups(tied.matrix()), [0, 0, 0]);
    }
}
