//! Symmetric blocks that are added to an assembled matrix beyond its pattern: what couples unknowns
//! that no element connects. Section 4 of docs/theory.md.

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

    /// Places (column, row) of these blocks and of earlier ones, increasing: the pattern of the sum stays the same as
    /// long as it can, and with it its symbolic analysis. Many more places than entries are forgotten.
    pub(super) fn places(&self, earlier: &[(usize, usize)]) -> Vec<(usize, usize)> {
        let forgets = earlier.len() > MOST_PLACES * self.entries.len();
        let mut places = if forgets {
            Vec::new()
        } else {
            earlier.to_vec()
        };
        places.extend(self.entries.iter().map(|entry| (entry.0, entry.1)));
        places.sort_unstable();
        places.dedup();
        places
    }
}

/// The sum of a matrix and added blocks, with the union of their patterns; by columns. It takes new values as long as
/// the pattern of the matrix and the places of the blocks stay.
#[derive(Debug)]
pub(super) struct BlockSum {
    sum: CsMat<f64>,
    /// Places (column, row) of the blocks, increasing.
    places: Vec<(usize, usize)>,
    /// Their positions among the values.
    positions: Vec<usize>,
    /// Values of the matrix that are next to each other in the sum, too.
    runs: Vec<Run>,
}

/// Consecutive values of a matrix in a sum.
#[derive(Debug)]
struct Run {
    /// The first of them in the matrix, and in the sum.
    from: usize,
    to: usize,
    length: usize,
}

impl BlockSum {
    /// Room for the sum of a matrix and blocks with entries at some places (column, row), increasing.
    pub fn new(matrix: CsMatView<'_, f64>, places: Vec<(usize, usize)>) -> Self {
        let (n, ends, all_rows) = (matrix.cols(), matrix.indptr(), matrix.indices());
        let ends = ends.raw_storage();
        let mut starts = Vec::with_capacity(n + 1);
        let mut rows = Vec::with_capacity(matrix.nnz() + places.len());
        let (mut positions, mut runs) = (Vec::with_capacity(places.len()), Vec::<Run>::new());
        let mut taken = 0;
        let mut take_until = |end: usize, rows: &mut Vec<usize>| {
            match runs.last_mut() {
                Some(run) if run.to + run.length == rows.len() => run.length += end - taken,
                _ => runs.push(Run {
                    from: taken,
                    to: rows.len(),
                    length: end - taken,
                }),
            }
            rows.extend_from_slice(&all_rows[taken..end]);
            taken = end;
            rows.len() - end
        };
        let mut added = 0;
        for of_column in places.chunk_by(|one, other| one.0 == other.0) {
            let column = of_column[0].0;
            starts.extend(ends[starts.len()..=column].iter().map(|end| end + added));
            let entries = ends[column]..ends[column + 1];
            for &(_, row) in of_column {
                let own = &all_rows[entries.clone()];
                let at = entries.start + own.partition_point(|r| *r < row);
                take_until(at, &mut rows);
                positions.push(rows.len());
                if !all_rows[at..entries.end].starts_with(&[row]) {
                    rows.push(row);
                }
            }
            added = take_until(entries.end, &mut rows);
        }
        take_until(all_rows.len(), &mut rows);
        starts.extend(ends[starts.len()..].iter().map(|end| end + added));
        let values = vec![0.0; rows.len()];
        BlockSum {
            sum: CsMat::new_csc((n, n), starts, rows, values),
            places,
            positions,
            runs,
        }
    }

    /// Places (column, row) of the blocks, increasing.
    pub fn places(&self) -> &[(usize, usize)] {
        &self.places
    }

    /// Sets the values to the sum of the matrix and blocks with entries at the places.
    pub fn fill(&mut self, matrix: CsMatView<'_, f64>, blocks: &AddedBlocks) {
        let (values, own) = (self.sum.data_mut(), matrix.data());
        self.positions.iter().for_each(|&at| values[at] = 0.0);
        for Run { from, to, length } in &self.runs {
            values[*to..to + length].copy_from_slice(&own[*from..from + length]);
        }
        for &(column, row, value) in &blocks.entries {
            if let Ok(at) = self.places.binary_search(&(column, row)) {
                values[self.positions[at]] += value;
            }
        }
    }

    /// The sum.
    pub fn view(&self) -> CsMatView<'_, f64> {
        self.sum.view()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Assembled;

    impl BlockSum {
        fn of(matrix: &Assembled, blocks: &AddedBlocks) -> Self {
            let mut sum = BlockSum::new(matrix.matrix(), blocks.places(&[]));
            sum.fill(matrix.matrix(), blocks);
            sum
        }
    }

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
        let sum = BlockSum::of(&matrix, &blocks);
        let sum = sum.view();
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
    fn other_blocks_at_some_of_the_places_take_their_turn() {
        let mut matrix = Assembled::new(&Transformation::identity(5), &[vec![0, 2], vec![2, 4]]);
        matrix.add(0, &[2.0, 1.0, 1.0, 3.0], 1.0);
        matrix.add(1, &[4.0, 1.0, 1.0, 5.0], 1.0);
        let blocks = |dofs: [usize; 2]| {
            let mut blocks = AddedBlocks::default();
            let k = DMatrix::from_element(2, 2, 7.0);
            blocks.add(&Transformation::identity(5), &dofs, &k);
            blocks
        };
        let places = blocks([2, 1]).places(&blocks([0, 4]).places(&[]));
        assert_eq!(places.len(), 8);
        let mut both = BlockSum::new(matrix.matrix(), places);
        for dofs in [[0, 4], [2, 1]] {
            both.fill(matrix.matrix(), &blocks(dofs));
            let alone = BlockSum::of(&matrix, &blocks(dofs));
            for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
                let at = |sum: &BlockSum| sum.view().get(i, j).copied().unwrap_or(0.0);
                assert_eq!(at(&both), at(&alone), "({i}, {j})");
            }
        }
        // many more places than entries are forgotten
        assert_eq!(
            AddedBlocks {
                entries: vec![(3, 3, 1.0)]
            }
            .places(both.places()),
            [(3, 3)]
        );
    }

    #[test]
    fn without_entries_the_matrix_is_the_same() {
        let mut matrix = Assembled::new(&Transformation::identity(3), &[vec![0, 2]]);
        matrix.add(0, &[2.0, 1.0, 1.0, 3.0], 1.0);
        let blocks = AddedBlocks::default();
        assert!(blocks.is_empty());
        assert_eq!(BlockSum::of(&matrix, &blocks).view(), matrix.matrix());
    }
}
