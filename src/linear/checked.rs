//! Direct solves with an a posteriori check: the residual relative to |b| + |A| |x|, by one
//! product with the matrix for all right-hand sides together; parts of the inverse by their row
//! sums.

use sprs::{CsMat, CsMatView};

use super::assembled::groups;
use super::{AddedBlocks, Assembled, LinearError, LinearSolver, larger, largest};

/// Largest residual of a solve, relative to the terms it is made of. A backward stable solve stays
/// near the round-off unit.
const RESIDUAL: f64 = 1e-9;

/// A matrix with its solver and blocks that are added to it; every solve is checked for finiteness and residual.
pub struct CheckedSolver {
    solver: Box<dyn LinearSolver>,
    matrix: Assembled,
    /// Sum of the matrix and the blocks added to it, if there are any.
    sum: Option<CsMat<f64>>,
    factorized: bool,
}

impl CheckedSolver {
    /// A matrix without factors yet; `solver` must be new or have factorised the same pattern.
    pub fn new(solver: Box<dyn LinearSolver>, matrix: Assembled) -> Self {
        CheckedSolver {
            solver,
            matrix,
            sum: None,
            factorized: false,
        }
    }

    /// The matrix, to set new values; solves use them after [`Self::factorize`].
    pub fn matrix_mut(&mut self) -> &mut Assembled {
        self.factorized = false;
        self.sum = None;
        &mut self.matrix
    }

    /// Adds blocks to the matrix in place of those added before, until it gets new values.
    pub fn add_blocks(&mut self, blocks: AddedBlocks) {
        self.factorized = false;
        self.sum = (!blocks.is_empty()).then(|| blocks.added_to(self.matrix.matrix()));
    }

    /// Factorises the matrix with the added blocks.
    ///
    /// # Errors
    /// Those of [`LinearSolver::factorize`], or values that are not finite.
    pub fn factorize(&mut self) -> Result<(), LinearError> {
        let Self {
            solver,
            matrix,
            sum,
            ..
        } = self;
        let whole = sum.as_ref().map_or(matrix.matrix(), |sum| sum.view());
        if whole.data().iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite("the matrix"));
        }
        solver.factorize(whole)?;
        self.factorized = true;
        Ok(())
    }

    /// Whether the factors are those of the matrix.
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
        groups(self.whole())
    }

    /// The matrix with the added blocks.
    fn whole(&self) -> CsMatView<'_, f64> {
        (self.sum.as_ref()).map_or(self.matrix.matrix(), |sum| sum.view())
    }

    /// Solutions for the columns of `b` (n x k, column by column).
    ///
    /// # Errors
    /// A solution that is not finite or fails the residual check; a matrix without factors.
    pub fn solve(&mut self, b: &[f64]) -> Result<Vec<f64>, LinearError> {
        if !self.factorized {
            return Err(LinearError::NotFactorized);
        }
        let n = self.matrix.size();
        let mut x = b.to_vec();
        if n == 0 {
            return Ok(x);
        }
        self.solver.solve(&mut x);
        if x.iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite("a solution"));
        }
        let residual = relative_residual(self.whole(), &sum(&x, n), &sum(b, n));
        if residual.is_nan() || residual > RESIDUAL {
            return Err(LinearError::Residual { residual });
        }
        Ok(x)
    }

    /// The inverse at the rows and columns `unknowns` (distinct), m x m column by column.
    ///
    /// # Errors
    /// Values that are not finite, or row sums that disagree with a solve; a matrix without
    /// factors.
    pub fn inverse_at(&mut self, unknowns: &[usize]) -> Result<Vec<f64>, LinearError> {
        let (n, m) = (self.matrix.size(), unknowns.len());
        let mut b = vec![0.0; n];
        unknowns.iter().for_each(|&unknown| b[unknown] = 1.0);
        let x = self.solve(&b)?;
        let inverse = self.solver.inverse_at(unknowns, n);
        let sums = sum(&inverse, m);
        let difference = |(sum, &unknown): (&f64, &usize)| (sum - x[unknown]).abs();
        let worst = sums.iter().zip(unknowns).map(difference).fold(0.0, larger);
        let scale = largest(&inverse);
        if sums.iter().any(|sum| !sum.is_finite()) {
            return Err(LinearError::NotFinite("an inverse"));
        }
        if worst.is_nan() || worst > RESIDUAL * scale * m as f64 {
            return Err(LinearError::Residual {
                residual: worst / scale,
            });
        }
        Ok(inverse)
    }
}

/// Sum of columns of length `n`: one product with the matrix checks all of them.
fn sum(columns: &[f64], n: usize) -> Vec<f64> {
    let mut sum = vec![0.0; n];
    for column in columns.chunks_exact(n.max(1)) {
        for (sum, value) in sum.iter_mut().zip(column) {
            *sum += value;
        }
    }
    sum
}

/// max_i |b - A x|_i / max_i (|b| + |A| |x|)_i
fn relative_residual(a: CsMatView<'_, f64>, x: &[f64], b: &[f64]) -> f64 {
    let mut residual = b.to_vec();
    let mut size: Vec<f64> = b.iter().map(|value| value.abs()).collect();
    for (column, entries) in a.outer_iterator().enumerate() {
        for (row, value) in entries.iter() {
            let term = value * x[column];
            residual[row] -= term;
            size[row] += term.abs();
        }
    }
    let scale = largest(&size);
    if scale == 0.0 {
        0.0
    } else {
        largest(&residual) / scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{Transformation, linear_solver};
    use crate::model::SolverChoice;

    /// Five-point stencil on an n x n grid with shifted diagonal.
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
    fn both_solvers_agree_on_several_right_hand_sides() {
        let a = grid(17, 0.01);
        let b: Vec<f64> = (0..3 * a.size())
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
    fn parts_of_the_inverse_agree_with_solves() {
        let a = grid(17, 0.01);
        let n = a.size();
        let unknowns: Vec<usize> = (0..n)
            .filter(|i| i % 17 == 0 || i % 23 == 5)
            .rev()
            .collect();
        for choice in [SolverChoice::Faer, SolverChoice::Sprs] {
            let mut solver = factorized(choice, a.clone()).unwrap();
            let inverse = solver.inverse_at(&unknowns).unwrap();
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
            let inverse = solver.inverse_at(&[2, 0]).unwrap();
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
}
