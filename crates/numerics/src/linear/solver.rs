//! Interface of the direct solvers, and their errors.

use super::symmetric::SymmetricMatrix;

/// Reason why a factorisation or a solve failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// A pivot of the factorisation is not positive.
    #[error("pivot {pivot:.3e} of unknown {unknown} is not positive")]
    NotPositiveDefinite {
        /// Unknown.
        unknown: usize,
        /// Pivot.
        pivot: f64,
    },
    /// The matrix or a solution holds a value that is not finite.
    #[error("{0} is not finite")]
    NotFinite(&'static str),
    /// The residual of a solve exceeds its bound.
    #[error("relative residual {residual:.1e} of a solve")]
    Residual {
        /// Residual relative to the terms of the residual.
        residual: f64,
    },
    /// A bilateral constraint follows from others.
    #[error("the hinges ask for more than the bodies between them can do")]
    Dependent {
        /// Number of the constraint.
        number: usize,
    },
    /// A solve was asked for without factors.
    #[error("the matrix is not factorised")]
    NotFactorized,
    /// The solver library failed.
    #[error("{0}")]
    Library(String),
}

/// A direct solver for symmetric positive definite matrices.
///
/// A solve can be done in parts: the solution at some unknowns is known before the solve ends, and the right-hand side
/// at these unknowns may still change.
///
/// A matrix with the pattern of the last matrix needs no symbolic analysis.
pub trait LinearSolver: Send {
    /// Factorises `a`.
    ///
    /// # Errors
    /// A pivot is not positive, or the library fails.
    fn factorize(&mut self, a: &SymmetricMatrix) -> Result<(), LinearError>;

    /// Frees the factors and their memory.
    fn give_up_factors(&mut self);

    /// Begins a solve with the right-hand side `b`. A successful `factorize` must come before a solve.
    fn begin(&mut self, b: &[f64]);

    /// Sets the watched unknowns, which `watched` and `add` use until the next factorisation.
    fn watch(&mut self, unknowns: &[usize]);

    /// Writes the solution for the right-hand side so far, at the watched unknowns, to `values`, in
    /// their order.
    fn watched(&mut self, values: &mut Vec<f64>);

    /// Adds to the right-hand side, at watched unknowns only (unknown, value).
    fn add(&mut self, b: &[(usize, f64)]);

    /// Ends the solve: writes the solution to `x`.
    fn end(&mut self, x: &mut [f64]);

    /// Replaces `b` by the solution.
    fn solve(&mut self, b: &mut [f64]) {
        self.begin(b);
        self.end(b);
    }

    /// The inverse at the rows and columns of each list of `unknowns` (distinct), as m x m matrices by columns.
    /// `factorize` must have succeeded before, for a matrix of size `n`.
    fn inverse_at(&mut self, unknowns: &[&[usize]], n: usize) -> Vec<Vec<f64>> {
        let mut column = |&column: &usize| {
            let mut x = vec![0.0; n];
            x[column] = 1.0;
            self.solve(&mut x);
            x
        };
        let mut of_list = |list: &&[usize]| {
            let columns = list.iter().map(&mut column);
            let of_rows = |x: Vec<f64>| list.iter().map(move |&row| x[row]);
            columns.flat_map(of_rows).collect()
        };
        unknowns.iter().map(&mut of_list).collect()
    }
}

/// Returns an error with the position and value of the first pivot that is not positive (NaN included).
pub(super) fn check_pivots(pivots: impl Iterator<Item = (usize, f64)>) -> Result<(), LinearError> {
    for (unknown, pivot) in pivots {
        if pivot.is_nan() || pivot <= 0.0 {
            return Err(LinearError::NotPositiveDefinite { unknown, pivot });
        }
    }
    Ok(())
}
