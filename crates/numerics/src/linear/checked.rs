//! Direct solves with a check of each result: a solution by its residual relative to the terms of b and A x, a part of
//! the inverse by its row sums.

use rayon::prelude::*;

use super::assembled::{BlockSum, united};
use super::symmetric::SymmetricMatrix;
use super::{AddedBlocks, Assembled, LinearError, LinearSolver, SMALLEST, larger, largest};
use crate::archive::{Archive, ArchiveError};

/// Largest residual of a solve, relative to the terms of the residual. The residual of a backward stable solve is near
/// the unit round-off.
const RESIDUAL: f64 = 1e-9;

/// A matrix with its solver and blocks that are added to it; every solve is checked for finiteness and residual.
pub struct CheckedSolver {
    solver: Box<dyn LinearSolver>,
    matrix: Assembled,
    /// Sum of the matrix and the last blocks that were added to it.
    sum: Option<BlockSum>,
    /// Whether the blocks of `sum` are part of the matrix at present.
    has_blocks: bool,
    factorized: bool,
    /// Right-hand side with which the last solve began.
    b: Vec<f64>,
    /// Additions to this right-hand side (unknown, value).
    added: Vec<(usize, f64)>,
    /// Solution of the last solve.
    x: Vec<f64>,
    is_under_way: bool,
}

impl CheckedSolver {
    /// A matrix without factors yet; `solver` must be new or have factorised the same pattern.
    pub fn new(solver: Box<dyn LinearSolver>, matrix: Assembled) -> Self {
        CheckedSolver {
            solver,
            matrix,
            sum: None,
            has_blocks: false,
            factorized: false,
            b: Vec::new(),
            added: Vec::new(),
            x: Vec::new(),
            is_under_way: false,
        }
    }

    /// The matrix, for setting new values, which solves use after [`Self::factorize`].
    pub fn matrix_mut(&mut self) -> &mut Assembled {
        (self.factorized, self.has_blocks) = (false, false);
        &mut self.matrix
    }

    /// Adds blocks to the matrix in place of earlier blocks; the blocks stay until the matrix gets new values.
    pub fn add_blocks(&mut self, blocks: AddedBlocks) {
        (self.factorized, self.has_blocks) = (false, !blocks.is_empty());
        let sum = self.sum.take().filter(|_| self.has_blocks);
        if self.has_blocks {
            let earlier = sum.as_ref().map_or(&[][..], BlockSum::places);
            let (matrix, places) = (self.matrix.matrix(), blocks.places(earlier));
            let sum = sum.filter(|sum| sum.places() == places);
            let mut sum = sum.unwrap_or_else(|| BlockSum::new(matrix, places));
            sum.fill(matrix, &blocks);
            self.sum = Some(sum);
        }
    }

    /// Transfers the matrix with its blocks. After reading, the matrix is factorised again, which gives the same bits.
    ///
    /// # Errors
    /// The archive holds another matrix.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        self.matrix.transfer(archive)?;
        let mut places = self.sum.as_ref().map(|sum| sum.places().to_vec());
        archive.transfer(&mut places)?;
        if archive.is_reading() {
            let n = self.matrix.size();
            let are_inside = |places: &Vec<(usize, usize)>| {
                places.iter().all(|&(column, row)| column < n && row < n)
                    && places.is_sorted_by(|one, other| one < other)
            };
            if places.as_ref().is_some_and(|places| !are_inside(places)) {
                return Err(ArchiveError::Size);
            }
            self.sum = places.map(|places| BlockSum::new(self.matrix.matrix(), places));
        }
        if let Some(sum) = &mut self.sum {
            archive.transfer_values(sum.values_mut())?;
        }
        archive.transfer(&mut self.has_blocks)?;
        archive.transfer(&mut self.factorized)?;
        if archive.is_reading() && self.factorized {
            self.factorize().map_err(|_| ArchiveError::Factors)?;
        }
        Ok(())
    }

    /// Factorises the matrix with the added blocks.
    ///
    /// # Errors
    /// [`LinearSolver::factorize`] fails, or a value is not finite.
    pub fn factorize(&mut self) -> Result<(), LinearError> {
        let Self {
            solver,
            matrix,
            sum,
            has_blocks,
            ..
        } = self;
        let sum = sum.as_ref().filter(|_| *has_blocks);
        let whole = sum.map_or(matrix.matrix(), BlockSum::matrix);
        if whole.values.iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite("the matrix"));
        }
        solver.factorize(whole)?;
        self.factorized = true;
        Ok(())
    }

    /// Frees the factors.
    pub fn give_up_factors(&mut self) {
        self.factorized = false;
        self.solver.give_up_factors();
    }

    /// Whether the factors belong to the present matrix.
    pub fn is_factorized(&self) -> bool {
        self.factorized
    }

    /// The matrix, without added blocks.
    pub fn matrix(&self) -> &Assembled {
        &self.matrix
    }

    /// Connected group of every unknown of the matrix with the added blocks, numbered from 0: the
    /// inverse has no entries between different groups.
    pub fn groups(&self) -> Vec<usize> {
        let own = self.matrix.groups();
        self.sum()
            .map_or_else(|| own.to_vec(), |sum| united(own, sum.places()))
    }

    /// The sum with the added blocks, if there are any.
    fn sum(&self) -> Option<&BlockSum> {
        self.sum.as_ref().filter(|_| self.has_blocks)
    }

    /// The matrix with the added blocks.
    fn whole(&self) -> &SymmetricMatrix {
        self.sum().map_or(self.matrix.matrix(), BlockSum::matrix)
    }

    /// The solution for the right-hand side `b`.
    ///
    /// # Errors
    /// The solution is not finite or fails the residual check, or the matrix has no factors.
    pub fn solve(&mut self, b: &[f64]) -> Result<Vec<f64>, LinearError> {
        self.begin(|own| b.clone_into(own))?;
        let x = self.end()?.to_vec();
        self.check()?;
        Ok(x)
    }

    /// Begins a solve in parts (see [`LinearSolver`]) with the right-hand side that `write` writes.
    ///
    /// # Errors
    /// The matrix has no factors.
    pub fn begin(&mut self, write: impl FnOnce(&mut Vec<f64>)) -> Result<(), LinearError> {
        if !self.factorized {
            return Err(LinearError::NotFactorized);
        }
        write(&mut self.b);
        self.added.clear();
        self.solver.begin(&self.b);
        self.is_under_way = true;
        Ok(())
    }

    /// Writes the solution for the right-hand side so far at some `unknowns` to `values`, in their order.
    pub fn partial(&mut self, unknowns: &[usize], values: &mut Vec<f64>) {
        self.solver.watch(unknowns);
        self.solver.watched(values);
    }

    /// Adds to the right-hand side at the unknowns of the last partial solution (unknown, value).
    pub fn add(&mut self, b: &[(usize, f64)]) {
        self.added.extend_from_slice(b);
        self.solver.add(b);
    }

    /// The right-hand side with its additions.
    fn right_hand_side(&self) -> Vec<f64> {
        let mut b = self.b.clone();
        self.added
            .iter()
            .for_each(|&(unknown, value)| b[unknown] += value);
        b
    }

    /// Ends a solve and returns the solution, whose residual [`Self::check`] checks.
    ///
    /// # Errors
    /// The solution is not finite.
    pub fn end(&mut self) -> Result<&[f64], LinearError> {
        self.x.resize(self.b.len(), 0.0);
        self.solver.end(&mut self.x);
        self.is_under_way = false;
        match largest(&self.x).is_finite() {
            true => Ok(&self.x),
            false => Err(LinearError::NotFinite("a solution")),
        }
    }

    /// Checks the residual of the last solution, relative to the terms of the residual.
    ///
    /// # Errors
    /// The residual is too large.
    pub fn check(&self) -> Result<(), LinearError> {
        let b = self.right_hand_side();
        let residual = relative_residual(self.whole(), &self.x, [&b, &self.b]);
        match residual <= RESIDUAL {
            true => Ok(()),
            false => Err(LinearError::Residual { residual }),
        }
    }

    /// The inverse at the rows and columns of each list of `unknowns` (distinct; different lists have different
    /// connected groups), as m x m matrices by columns. A solve in parts may continue afterwards.
    ///
    /// # Errors
    /// A value is not finite, row sums disagree with a solve, or the matrix has no factors.
    pub fn inverse_at(&mut self, unknowns: &[&[usize]]) -> Result<Vec<Vec<f64>>, LinearError> {
        let mut b = vec![0.0; self.matrix.size()];
        unknowns
            .iter()
            .flat_map(|list| *list)
            .for_each(|&unknown| b[unknown] = 1.0);
        let is_under_way = self.is_under_way;
        let interrupted = (std::mem::take(&mut self.b), std::mem::take(&mut self.added));
        let x = self.solve(&b)?;
        (self.b, self.added) = interrupted;
        self.is_under_way = is_under_way;
        let inverses = self.unchecked_inverse_at(unknowns);
        for (inverse, list) in inverses.iter().zip(unknowns) {
            check_row_sums(inverse, list, &x)?;
        }
        Ok(inverses)
    }

    /// The inverse at the rows and columns of each list of `unknowns` (distinct) of a factorised matrix, as m x m
    /// matrices by columns. A solve in parts may continue afterwards.
    pub fn unchecked_inverse_at(&mut self, unknowns: &[&[usize]]) -> Vec<Vec<f64>> {
        let inverses = self.solver.inverse_at(unknowns, self.matrix.size());
        if self.is_under_way {
            self.solver.begin(&self.right_hand_side());
        }
        inverses
    }
}

/// Checks that the row sums of an inverse at some unknowns agree with the solution `x`.
fn check_row_sums(inverse: &[f64], unknowns: &[usize], x: &[f64]) -> Result<(), LinearError> {
    let sums = sum(inverse, unknowns.len());
    let difference = |(sum, &unknown): (&f64, &usize)| (sum - x[unknown]).abs();
    let worst = sums.iter().zip(unknowns).map(difference).fold(0.0, larger);
    let scale = largest(inverse);
    if sums.iter().any(|sum| !sum.is_finite()) {
        return Err(LinearError::NotFinite("an inverse"));
    }
    if worst.is_nan() || worst > RESIDUAL * scale * unknowns.len() as f64 {
        return Err(LinearError::Residual {
            residual: worst / scale,
        });
    }
    Ok(())
}

/// Sum of columns of length `n`.
fn sum(columns: &[f64], n: usize) -> Vec<f64> {
    let mut sum = vec![0.0; n];
    for column in columns.chunks_exact(n.max(1)) {
        for (sum, value) in sum.iter_mut().zip(column) {
            *sum += value;
        }
    }
    sum
}

/// Number of rows whose residual is one task for a thread.
const ROWS: usize = 16_384;

/// The ratio max_i |b - A x|_i / max_i (|b0| + |A| |x|)_i, where b0 is the right-hand side at the start of the solve; 0
/// if the numbers are so small that they have lost digits. The matrix A is symmetric, so its columns are used as rows.
fn relative_residual(a: &SymmetricMatrix, x: &[f64], [b, b0]: [&[f64]; 2]) -> f64 {
    let of_rows =
        |(k, (b, b0)): (usize, (&[f64], &[f64]))| residual_and_size(a, x, (k * ROWS, b, b0));
    let both =
        |one: [f64; 2], other: [f64; 2]| [larger(one[0], other[0]), larger(one[1], other[1])];
    let rows = b.par_chunks(ROWS).zip(b0.par_chunks(ROWS)).enumerate();
    let [error, scale] = match b.len() > ROWS && rayon::current_num_threads() > 1 {
        true => rows.map(of_rows).reduce(|| [0.0; 2], both),
        false => residual_and_size(a, x, (0, b, b0)),
    };
    if scale < SMALLEST { 0.0 } else { error / scale }
}

/// The largest |b - A x| and |b0| + |A| |x| in the rows of `b` and `b0`, which begin with row `first`.
fn residual_and_size(
    a: &SymmetricMatrix,
    x: &[f64],
    (first, b, b0): (usize, &[f64], &[f64]),
) -> [f64; 2] {
    let (starts, rows) = (&a.pattern.starts()[first..], a.pattern.all_rows());
    let (mut error, mut scale) = (0.0, 0.0);
    for (ends, (b, b0)) in starts.windows(2).zip(b.iter().zip(b0)) {
        let entries = ends[0] as usize..ends[1] as usize;
        let (mut residual, mut size) = ([*b, 0.0], [b0.abs(), 0.0]);
        let mut take = |side: usize, value: f64, row: u32| {
            let term = value * x[row as usize];
            residual[side] -= term;
            size[side] += term.abs();
        };
        // the terms of x and y side by side
        let (twos, rest) = a.values[entries.clone()].as_chunks::<2>();
        let (rows_of_twos, rows_of_rest) = rows[entries].as_chunks::<2>();
        for ([p, q], [i, j]) in twos.iter().zip(rows_of_twos) {
            take(0, *p, *i);
            take(1, *q, *j);
        }
        (rest.iter().zip(rows_of_rest)).for_each(|(value, row)| take(0, *value, *row));
        let [residual, size] = [residual[0] + residual[1], size[0] + size[1]];
        (error, scale) = (larger(error, residual.abs()), larger(scale, size));
    }
    [error, scale]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::SolverChoice;
    use crate::linear::{Transformation, linear_solver};

    /// Matrix of the five-point stencil on an n x n grid, with shifted diagonal.
    fn grid(n: usize, shift: f64) -> Assembled {
        let index = |i: usize, j: usize| i * n + j;
        let mut edges = Vec::new();
        for i in 0..n {
            for j in 0..n {
                if i + 1 < n {
                    edges.push(vec![index(i, j), index(i + 1, j)]);
                }
                if j + 1 < n {
                    edges.push(vec![index(i, j), index(i, j + 1)]);
                }
            }
        }
        let mut a = Assembled::new(&Transformation::identity(n * n), &edges);
        for edge in 0..edges.len() {
            a.add(edge, &[1.0 + shift, -1.0, -1.0, 1.0 + shift], 1.0);
        }
        a
    }

    fn factorized(choice: SolverChoice, a: Assembled) -> Result<CheckedSolver, LinearError> {
        let mut solver = CheckedSolver::new(linear_solver(choice), a);
        solver.factorize().map(|()| solver)
    }

    #[test]
    fn both_solvers_agree() {
        let a = grid(17, 0.01);
        let b: Vec<f64> = (0..a.size())
            .map(|i| ((i * 31) % 17) as f64 - 8.0)
            .collect();
        let mut solutions = [SolverChoice::Faer, SolverChoice::Sprs].map(|choice| {
            let mut solver = factorized(choice, a.clone()).unwrap();
            solver.solve(&b).unwrap()
        });
        let second = std::mem::take(&mut solutions[1]);
        for (x, y) in solutions[0].iter().zip(&second) {
            assert!((x - y).abs() < 1e-11 * 8.0 / 0.01);
        }
    }

    #[test]
    fn a_solve_in_parts_is_that_of_the_whole_right_hand_side() {
        let a = grid(17, 0.01);
        let b: Vec<f64> = (0..a.size())
            .map(|i| ((i * 31) % 17) as f64 - 8.0)
            .collect();
        let unknowns = [280, 3, 77, 76];
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-10, "{x} {y}");
        for choice in [SolverChoice::Faer, SolverChoice::Sprs] {
            let mut solver = factorized(choice, a.clone()).unwrap();
            let (before, mut b_after) = (solver.solve(&b).unwrap(), b.clone());
            (b_after[77], b_after[280]) = (b[77] + 3.0, b[280] - 5.0);
            let after = solver.solve(&b_after).unwrap();
            let mut values = Vec::new();
            solver.begin(|own| own.clone_from(&b)).unwrap();
            solver.partial(&unknowns, &mut values);
            (values.iter().zip(unknowns)).for_each(|(value, u)| near(*value, before[u]));
            solver.add(&[(77, 3.0)]);
            solver.inverse_at(&[&[5, 9]]).unwrap();
            solver.add(&[(280, -5.0)]);
            solver.partial(&unknowns, &mut values);
            (values.iter().zip(unknowns)).for_each(|(value, u)| near(*value, after[u]));
            let x = solver.end().unwrap().to_vec();
            solver.check().unwrap();
            (x.iter().zip(&after)).for_each(|(x, after)| near(*x, *after));
        }
    }

    #[test]
    fn parts_of_the_inverse_agree_with_solves() {
        let a = grid(17, 0.01);
        let n = a.size();
        let unknowns: Vec<usize> = (0..n)
            .filter(|i| i % 17 == 0 || i % 23 == 5)
            .rev()
            .collect();
        for choice in [SolverChoice::Faer, SolverChoice::Sprs] {
            let mut solver = factorized(choice, a.clone()).unwrap();
            let inverse = solver.inverse_at(&[&unknowns]).unwrap().concat();
            for (j, &column) in unknowns.iter().enumerate() {
                let mut b = vec![0.0; n];
                b[column] = 1.0;
                let x = solver.solve(&b).unwrap();
                for (i, &row) in unknowns.iter().enumerate() {
                    let value = inverse[j * unknowns.len() + i];
                    assert!((value - x[row]).abs() < 1e-11, "{choice:?} {row} {column}");
                }
            }
        }
    }

    #[test]
    fn diagonal_matrices_are_inverted_and_checked() {
        let diagonal = |values: [f64; 3]| {
            let unknowns = [vec![0], vec![1], vec![2]];
            let mut a = Assembled::new(&Transformation::identity(3), &unknowns);
            for (i, value) in values.into_iter().enumerate() {
                a.add(i, &[value], 1.0);
            }
            a
        };
        for choice in [SolverChoice::Faer, SolverChoice::Sprs] {
            let mut solver = factorized(choice, diagonal([2.0, 4.0, 8.0])).unwrap();
            let inverse = solver.inverse_at(&[&[2, 0]]).unwrap().concat();
            assert_eq!(inverse, [0.125, 0.0, 0.0, 0.5], "{choice:?}");
            let error = factorized(choice, diagonal([2.0, -4.0, 8.0])).err();
            let pivot = LinearError::NotPositiveDefinite {
                unknown: 1,
                pivot: -4.0,
            };
            assert_eq!(error, Some(pivot), "{choice:?}");
        }
    }

    #[test]
    fn indefinite_and_non_finite_matrices_are_errors() {
        for choice in [SolverChoice::Faer, SolverChoice::Sprs] {
            let error = factorized(choice, grid(6, -0.5)).err();
            assert!(
                matches!(error, Some(LinearError::NotPositiveDefinite { .. })),
                "{error:?}"
            );
            let error = factorized(choice, grid(3, f64::NAN)).err();
            assert_eq!(error, Some(LinearError::NotFinite("the matrix")));
        }
    }

    #[test]
    fn empty_and_single_systems_are_solved() {
        for choice in [SolverChoice::Faer, SolverChoice::Sprs] {
            let empty = Assembled::new(&Transformation::new(0, [vec![], vec![]]), &[vec![0, 1]]);
            let mut solver = factorized(choice, empty).unwrap();
            assert!(solver.solve(&[]).unwrap().is_empty());
            let mut one = Assembled::new(&Transformation::identity(1), &[vec![0]]);
            one.add(0, &[4.0], 1.0);
            let mut solver = factorized(choice, one).unwrap();
            assert_eq!(solver.solve(&[8.0]).unwrap(), [2.0]);
        }
    }

    #[test]
    fn numbers_that_have_lost_digits_are_solved_with_those_they_have() {
        let mut solver = CheckedSolver::new(linear_solver(SolverChoice::Faer), grid(3, 0.1));
        solver.factorize().expect("definite");
        for b in [1e-318, 1e-305, 1e-290] {
            let x = solver.solve(&[b; 9]).expect("solved");
            assert!(x.iter().all(|x| (0.0..=6.0 * b).contains(x)), "{x:?}");
        }
    }
}
