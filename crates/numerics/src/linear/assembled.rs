//! Assembly of element matrices into compressed sparse columns, K = sum T_e^T K_e T_e, through positions that are
//! computed once. Symmetric blocks may be added outside the pattern of the elements, for unknowns that no element
//! connects. See docs/theory/time.md.

use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;
use smallvec::SmallVec;

use super::Transformation;
use super::symmetric::{Pattern, SymmetricMatrix, index};
use crate::archive::{Archive, ArchiveError};

/// Marks an entry of an element matrix that equations distribute over several entries.
const DISTRIBUTED: u32 = u32::MAX;

/// Estimated number of rows of a column for each element of its unknown, in a mesh of quadrilaterals or triangles.
const ROWS: usize = 5;

/// Number of dofs of an element up to which a list of its dofs needs no allocated memory.
const DOFS: usize = 16;

/// A symmetric sparse matrix over unknowns, assembled from element matrices over dofs. Both
/// triangles are stored by columns; the pattern is built once, shared by copies, and refilled in place.
#[derive(Debug, Clone)]
pub struct Assembled {
    matrix: SymmetricMatrix,
    positions: Arc<EntryPositions>,
    /// Coefficients of the terms of T, which the couplings use.
    coefficients: Vec<f64>,
}

/// Positions at which the entries of the element matrices are added.
#[derive(Debug)]
struct EntryPositions {
    /// Position among the values for every entry of the element matrices, column by column. If pairs of entries always
    /// go to consecutive values, only the position for the first entry of each pair.
    positions: Vec<u32>,
    /// Start of each element in `positions`, and the end of the last one.
    starts: Vec<usize>,
    /// Position of every entry of the diagonal.
    diagonal: Vec<u32>,
    /// Terms of the entries of element matrices at dofs that follow other dofs, element by element.
    couplings: Vec<Coupling>,
    /// Connected group of every unknown.
    groups: OnceLock<Vec<usize>>,
}

/// A term of T_e^T K_e T_e for a dof that follows other dofs.
#[derive(Debug, Clone, Copy)]
struct Coupling {
    element: usize,
    /// Entry of the element matrix.
    entry: usize,
    /// Position of the term among the values.
    position: u32,
    /// Terms of T for the row and for the column of the entry; the product of their coefficients multiplies the entry.
    terms: [u32; 2],
}

/// The pattern of elements with the given dofs and of the diagonal, over the unknowns of `map`.
fn pattern(map: &Transformation, elements: &[Vec<usize>]) -> Pattern {
    let unknowns = |element: usize| {
        let terms = elements[element].iter().flat_map(|&dof| map.row(dof));
        terms.map(|term| term.0)
    };
    let (starts, of_unknowns) = elements_of(map.unknowns(), || {
        let all = 0..elements.len();
        all.flat_map(|element| unknowns(element).map(move |unknown| (unknown, element)))
    });
    let mut column_starts = Vec::with_capacity(map.unknowns() + 1);
    let mut rows = Vec::with_capacity(of_unknowns.len() * ROWS);
    column_starts.push(0);
    let mut column = Vec::new();
    let mut last: &[u32] = &[];
    // the last column that has an unknown
    let mut in_column = vec![usize::MAX; map.unknowns()];
    for unknown in 0..map.unknowns() {
        let elements = &of_unknowns[starts[unknown]..starts[unknown + 1]];
        // both dofs of a node have the same elements, and columns
        if elements.is_empty() || elements != last {
            column.clear();
            column.push(unknown as u32);
            in_column[unknown] = unknown;
            for &element in elements {
                for row in unknowns(element as usize) {
                    if in_column[row] != unknown {
                        in_column[row] = unknown;
                        column.push(row as u32);
                    }
                }
            }
            column.sort_unstable();
        }
        last = elements;
        rows.extend_from_slice(&column);
        column_starts.push(index(rows.len()));
    }
    Pattern::new(column_starts, rows)
}

/// The starts of the lists of elements of every unknown, and these lists one after the other; `pairs` gives unknowns
/// with their elements.
fn elements_of<I: Iterator<Item = (usize, usize)>>(
    unknowns: usize,
    pairs: impl Fn() -> I,
) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0; unknowns + 1];
    pairs().for_each(|(unknown, _)| starts[unknown + 1] += 1);
    for unknown in 0..unknowns {
        starts[unknown + 1] += starts[unknown];
    }
    let (mut next, mut elements) = (starts.clone(), vec![0; starts[unknowns]]);
    for (unknown, element) in pairs() {
        elements[next[unknown]] = element as u32;
        next[unknown] += 1;
    }
    (starts, elements)
}

impl EntryPositions {
    /// Finds the positions of the entries of the next element matrix, over the given dofs.
    fn place(&mut self, pattern: &Pattern, map: &Transformation, dofs: &[usize]) {
        let mut unknowns: SmallVec<[usize; DOFS]> = SmallVec::new();
        for &dof in dofs {
            match map.row(dof) {
                &[(unknown, 1.0)] => unknowns.push(unknown),
                _ => break,
            }
        }
        match unknowns.len() == dofs.len() {
            true => self.place_unknowns(pattern, &unknowns),
            false => self.place_dofs(pattern, map, dofs),
        }
        self.starts.push(self.positions.len());
    }

    /// Finds the positions of the entries of an element whose dofs are all unknowns.
    fn place_unknowns(&mut self, pattern: &Pattern, unknowns: &[usize]) {
        let twos = unknowns.as_chunks::<2>();
        let are_twos = twos.1.is_empty() && twos.0.iter().all(|[p, q]| p + 1 == *q);
        let step = if are_twos { 2 } else { 1 };
        let rows = || unknowns.iter().step_by(step);
        let mut last: &[u32] = &[];
        let mut places: SmallVec<[u32; DOFS]> = SmallVec::new();
        for &column in unknowns {
            let of_column = pattern.rows(column);
            // both dofs of a node have the same rows
            if last != of_column {
                places.clear();
                for &row in rows() {
                    places.push(of_column.partition_point(|&r| (r as usize) < row) as u32);
                }
                last = of_column;
            }
            let start = pattern.starts()[column];
            self.positions
                .extend(places.iter().map(|place| start + place));
        }
    }

    /// Finds the positions of the entries of an element with dofs that are prescribed or follow other dofs.
    fn place_dofs(&mut self, pattern: &Pattern, map: &Transformation, dofs: &[usize]) {
        let element = self.starts.len() - 1;
        let pairs = dofs
            .iter()
            .flat_map(|column| dofs.iter().map(move |row| (row, column)));
        for (entry, (&row, &column)) in pairs.enumerate() {
            let position = match (map.row(row), map.row(column)) {
                (&[(row, 1.0)], &[(column, 1.0)]) => index(pattern.position(row, column)),
                (rows, columns) => {
                    let first = [row, column].map(|dof| map.first_term(dof) as u32);
                    for (&(column, _), c) in columns.iter().zip(first[1]..) {
                        let rows = rows.iter().zip(first[0]..);
                        self.couplings.extend(rows.map(|(&(row, _), r)| Coupling {
                            element,
                            entry,
                            position: index(pattern.position(row, column)),
                            terms: [r, c],
                        }));
                    }
                    DISTRIBUTED
                }
            };
            self.positions.push(position);
        }
    }

    /// Terms of those entries of an element matrix that equations distribute over several unknowns.
    fn couplings(&self, element: usize) -> &[Coupling] {
        let first = self.couplings.partition_point(|c| c.element < element);
        let last = self.couplings.partition_point(|c| c.element <= element);
        &self.couplings[first..last]
    }
}

impl Assembled {
    /// A zero matrix over the unknowns of `map`, with the pattern of elements with the given dofs.
    pub fn new(map: &Transformation, elements: &[Vec<usize>]) -> Self {
        let (n, pattern) = (map.unknowns(), pattern(map, elements));
        let entries: usize = elements.iter().map(|dofs| dofs.len().pow(2)).sum();
        let mut positions = EntryPositions {
            positions: Vec::with_capacity(entries),
            starts: Vec::with_capacity(elements.len() + 1),
            diagonal: (0..n).map(|i| index(pattern.position(i, i))).collect(),
            couplings: Vec::new(),
            groups: OnceLock::new(),
        };
        positions.starts.push(0);
        for dofs in elements {
            positions.place(&pattern, map, dofs);
        }
        positions.positions.shrink_to_fit();
        let coefficients = match positions.couplings.is_empty() {
            true => Vec::new(),
            false => map.coefficients().collect(),
        };
        Assembled {
            matrix: SymmetricMatrix::zeros(pattern),
            positions: Arc::new(positions),
            coefficients,
        }
    }

    /// Copies the coefficients of the terms of T from `map`, which must have the pattern of the map at construction.
    pub fn set_coefficients(&mut self, map: &Transformation) {
        if !self.coefficients.is_empty() {
            self.coefficients.clear();
            self.coefficients.extend(map.coefficients());
        }
    }

    /// Transfers the values and coefficients.
    pub(super) fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        archive.transfer_values(&mut self.matrix.values)?;
        archive.transfer_values(&mut self.coefficients)
    }

    /// Sets all values to zero.
    pub fn clear(&mut self) {
        self.matrix.values.fill(0.0);
    }

    /// Adds `factor` times the matrix `k` (column by column) of an element.
    pub fn add(&mut self, element: usize, k: &[f64], factor: f64) {
        let EntryPositions {
            positions, starts, ..
        } = &*self.positions;
        let positions = &positions[starts[element]..starts[element + 1]];
        let values = &mut self.matrix.values;
        if 2 * positions.len() == k.len() {
            for (&position, [p, q]) in positions.iter().zip(k.as_chunks::<2>().0) {
                if let Some([first, second]) = values[position as usize..].first_chunk_mut::<2>() {
                    *first += factor * p;
                    *second += factor * q;
                }
            }
            return;
        }
        assert_eq!(positions.len(), k.len(), "element matrix fits its dofs");
        for (&position, &value) in positions.iter().zip(k) {
            if position != DISTRIBUTED {
                values[position as usize] += factor * value;
            }
        }
        for coupling in self.positions.couplings(element) {
            let position = coupling.position as usize;
            let [row, column] = coupling.terms.map(|term| self.coefficients[term as usize]);
            values[position] += row * column * factor * k[coupling.entry];
        }
    }

    /// Whether an element adds to any value.
    pub fn depends_on(&self, element: usize) -> bool {
        let EntryPositions {
            positions, starts, ..
        } = &*self.positions;
        let positions = &positions[starts[element]..starts[element + 1]];
        positions.iter().any(|&p| p != DISTRIBUTED) || !self.positions.couplings(element).is_empty()
    }

    /// Adds `factor` times a matrix of the same pattern.
    pub fn add_matrix(&mut self, other: &Assembled, factor: f64) {
        for (value, term) in self.matrix.values.iter_mut().zip(&other.matrix.values) {
            *value += factor * term;
        }
    }

    /// The matrix.
    pub fn matrix(&self) -> &SymmetricMatrix {
        &self.matrix
    }

    /// A matrix of the same pattern with all values zero.
    pub fn zeros(&self) -> Assembled {
        Assembled {
            matrix: SymmetricMatrix::zeros(self.matrix.pattern.clone()),
            positions: Arc::clone(&self.positions),
            coefficients: self.coefficients.clone(),
        }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.matrix.size()
    }

    /// Connected group of every unknown, numbered from 0: the inverse has no entries between different groups.
    pub fn groups(&self) -> &[usize] {
        let groups = || groups(&self.matrix.pattern);
        self.positions.groups.get_or_init(groups)
    }

    /// Values of the diagonal.
    pub fn diagonal(&self) -> impl Iterator<Item = f64> {
        let (diagonal, values) = (&self.positions.diagonal, &self.matrix.values);
        diagonal.iter().map(|&position| values[position as usize])
    }
}

/// Connected group of every unknown of a pattern, numbered from 0 in the order of their first unknowns.
fn groups(pattern: &Pattern) -> Vec<usize> {
    let n = pattern.size();
    let (mut group, mut count) = (vec![usize::MAX; n], 0);
    for first in 0..n {
        if group[first] != usize::MAX {
            continue;
        }
        let mut reached = vec![first];
        group[first] = count;
        while let Some(unknown) = reached.pop() {
            for next in pattern.rows(unknown).iter().map(|&row| row as usize) {
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

/// The connected groups after entries at some places (column, row) have been added.
pub(super) fn united(groups: &[usize], places: &[(usize, usize)]) -> Vec<usize> {
    let count = groups.iter().max().map_or(0, |last| last + 1);
    let mut first: Vec<usize> = (0..count).collect();
    let own = |first: &[usize], mut group: usize| {
        while first[group] != group {
            group = first[group];
        }
        group
    };
    for &(column, row) in places {
        let [a, b] = [column, row].map(|unknown| own(&first, groups[unknown]));
        first[a.max(b)] = a.min(b);
    }
    let mut number = vec![0; count];
    let mut numbers = 0..;
    for group in 0..count {
        number[group] = match own(&first, group) {
            root if root < group => number[root],
            _ => numbers.next().unwrap_or(group),
        };
    }
    groups.iter().map(|&group| number[group]).collect()
}

/// Ratio of places of earlier blocks to present entries above which the earlier places are forgotten.
const MOST_PLACES: usize = 3;

/// Sum of blocks T_e^T K_e T_e over the unknowns.
#[derive(Debug, Clone, Default)]
pub struct AddedBlocks {
    /// Column, row and value of every entry, in any order; entries at the same place are added.
    entries: Vec<(usize, usize, f64)>,
}

impl AddedBlocks {
    /// Adds the block T_e^T K_e T_e of a symmetric matrix `k` over some dofs; zeros of `k` do not enlarge the pattern.
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

    /// Places (column, row) of the entries of the present and of earlier blocks, in increasing order. With the earlier
    /// places kept, the pattern of the sum stays the same, and so does its symbolic analysis. Earlier places are
    /// forgotten if there are many more places than entries.
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

/// The sum of a matrix and added blocks, with the union of their patterns, stored by columns. The sum can be filled
/// with new values as long as the pattern of the matrix and the places of the blocks stay the same.
#[derive(Debug)]
pub(super) struct BlockSum {
    sum: SymmetricMatrix,
    /// Places (column, row) of the entries of the blocks, in increasing order.
    places: Vec<(usize, usize)>,
    /// Positions of the places of the blocks among the values.
    positions: Vec<usize>,
    /// Runs of values of the matrix that are also contiguous in the sum.
    runs: Vec<ConsecutiveValues>,
}

/// Consecutive values of a matrix that are also consecutive in a sum.
#[derive(Debug)]
struct ConsecutiveValues {
    /// Position of the first value in the matrix; `to` is its position in the sum.
    from: usize,
    to: usize,
    length: usize,
}

impl BlockSum {
    /// A zero sum of a matrix and blocks with entries at some places (column, row), in increasing order.
    pub fn new(matrix: &SymmetricMatrix, places: Vec<(usize, usize)>) -> Self {
        let (ends, all_rows) = (matrix.pattern.starts(), matrix.pattern.all_rows());
        let mut starts = Vec::with_capacity(ends.len());
        let mut rows = Vec::with_capacity(all_rows.len() + places.len());
        let (mut positions, mut runs) = (
            Vec::with_capacity(places.len()),
            Vec::<ConsecutiveValues>::new(),
        );
        let mut taken = 0;
        let mut take_until = |end: usize, rows: &mut Vec<u32>| {
            match runs.last_mut() {
                Some(run) if run.to + run.length == rows.len() => run.length += end - taken,
                _ => runs.push(ConsecutiveValues {
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
            let moved = ends[starts.len()..=column].iter();
            starts.extend(moved.map(|&end| index(end as usize + added)));
            let entries = matrix.pattern.column(column);
            for &(_, row) in of_column {
                let at = matrix.pattern.position(row, column);
                take_until(at, &mut rows);
                positions.push(rows.len());
                if !all_rows[at..entries.end].starts_with(&[row as u32]) {
                    rows.push(row as u32);
                }
            }
            added = take_until(entries.end, &mut rows);
        }
        take_until(all_rows.len(), &mut rows);
        let moved = ends[starts.len()..].iter();
        starts.extend(moved.map(|&end| index(end as usize + added)));
        BlockSum {
            sum: SymmetricMatrix::zeros(Pattern::new(starts, rows)),
            places,
            positions,
            runs,
        }
    }

    /// Places (column, row) of the entries of the blocks, in increasing order.
    pub fn places(&self) -> &[(usize, usize)] {
        &self.places
    }

    /// Sets the values to the sum of the matrix and blocks with entries at the places.
    pub fn fill(&mut self, matrix: &SymmetricMatrix, blocks: &AddedBlocks) {
        let (values, own) = (&mut self.sum.values, &matrix.values);
        self.positions.iter().for_each(|&at| values[at] = 0.0);
        for ConsecutiveValues { from, to, length } in &self.runs {
            values[*to..to + length].copy_from_slice(&own[*from..from + length]);
        }
        for &(column, row, value) in &blocks.entries {
            if let Ok(at) = self.places.binary_search(&(column, row)) {
                values[self.positions[at]] += value;
            }
        }
    }

    /// Values of the sum.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.sum.values
    }

    /// The sum.
    pub fn matrix(&self) -> &SymmetricMatrix {
        &self.sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two elements of three dofs each; the second dof of the first element and the third dof of the second are
    /// prescribed.
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
                assert_eq!(dense[(i, j)], *value, "({i}, {j})");
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
        assert_eq!(a.groups(), [0, 0, 0]);
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
        assert_eq!(apart.groups(), [0, 0, 1, 1]);
        assert_eq!(united(apart.groups(), &[(0, 1), (2, 2)]), [0, 0, 1, 1]);
        assert_eq!(united(apart.groups(), &[(3, 1)]), [0, 0, 0, 0]);
        assert_eq!(united(&[0, 1, 2, 3, 2], &[(3, 1), (4, 2)]), [0, 1, 2, 1, 2]);
        let rows = [0, 1, 0, 2].map(|unknown| vec![(unknown, 1.0)]);
        let tied = Assembled::new(&Transformation::new(3, rows), &elements);
        assert_eq!(tied.groups(), [0, 0, 0]);
    }
}

#[cfg(test)]
mod added_blocks_tests {
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
        let sum = sum.matrix();
        let dense = sum.to_dense();
        let expected = [[9.0, 0.0, 6.0], [0.0, 7.5, -1.0], [6.0, -1.0, 8.0]];
        for (i, row) in expected.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(dense[(i, j)], *value, "({i}, {j})");
            }
        }
        // the zero of the block and the pair of the dofs 0 and 2 stay out of the pattern
        assert_eq!(sum.values.len(), 7);
        assert_eq!(matrix.matrix().values.len(), 5);
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
            assert_eq!(both.matrix().to_dense(), alone.matrix().to_dense());
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
        let sum = BlockSum::of(&matrix, &blocks);
        assert_eq!(sum.matrix().pattern, matrix.matrix().pattern);
        assert_eq!(sum.matrix().values, matrix.matrix().values);
    }
}
