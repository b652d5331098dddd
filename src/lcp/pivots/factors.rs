//! Dense factorisations on one core (the order of the operations, and so the result, never varies).

use std::array::from_fn;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor as llt;
use faer::linalg::lu::partial_pivoting::{factor as lu, solve as lu_solve};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::perm::PermRef;
use faer::reborrow::ReborrowMut;
use faer::{MatMut, MatRef, Par};
use pulp::{Arch, Simd, WithSimd};
use smallvec::SmallVec;

use crate::lcp::problems::{combine, dot};

/// A diagonal entry of a factor below this part of the largest one: the matrix counts as singular.
const SINGULAR: f64 = 1e-12;

/// Columns that a substitution takes at a time.
const TOGETHER: usize = 4;

/// Factors of a square matrix held by columns.
pub(crate) struct Factors {
    values: Vec<f64>,
    size: usize,
    kind: Kind,
}

enum Kind {
    /// L L^T, the lower triangle holds L.
    Cholesky,
    /// P A = L U with the permutation and its inverse.
    Lu(Vec<usize>, Vec<usize>),
}

impl Factors {
    /// Factorises a symmetric matrix of which the lower triangle is read. None unless it is
    /// positive definite beyond round-off.
    pub fn cholesky(mut values: Vec<f64>, size: usize) -> Option<Self> {
        let mut buffer = MemBuffer::new(llt::cholesky_in_place_scratch::<f64>(
            size,
            Par::Seq,
            Default::default(),
        ));
        llt::cholesky_in_place(
            MatMut::from_column_major_slice_mut(&mut values, size, size),
            Default::default(),
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        )
        .ok()?;
        // The pivots of the elimination are the squares of the diagonal of L.
        regular((0..size).map(|i| values[i + i * size].powi(2))).then_some(Self {
            values,
            size,
            kind: Kind::Cholesky,
        })
    }

    /// Factorises any square matrix. None when it is singular to round-off.
    pub fn lu(mut values: Vec<f64>, size: usize) -> Option<Self> {
        let mut buffer = MemBuffer::new(lu::lu_in_place_scratch::<usize, f64>(
            size,
            size,
            Par::Seq,
            Default::default(),
        ));
        let (mut forward, mut backward) = (vec![0; size], vec![0; size]);
        lu::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut values, size, size),
            &mut forward,
            &mut backward,
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        );
        regular((0..size).map(|i| values[i + i * size].abs())).then_some(Self {
            values,
            size,
            kind: Kind::Lu(forward, backward),
        })
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Size of the smallest pivot.
    pub fn smallest_pivot(&self) -> f64 {
        let pivots = (0..self.size).map(|i| self.values[i + i * self.size].abs());
        pivots.fold(f64::INFINITY, f64::min)
    }

    /// Overwrites b with the solution of A x = b.
    pub fn solve(&self, b: &mut [f64]) {
        if let Kind::Lu(forward, _) = &self.kind {
            let permuted: SmallVec<[f64; 256]> = forward.iter().map(|&row| b[row]).collect();
            b.copy_from_slice(&permuted);
        }
        Arch::new().dispatch(Substitution { factors: self, b });
    }

    /// Overwrites the columns of b with the solutions of A X = B.
    pub fn solve_columns(&self, b: &mut [f64]) {
        let factor = MatRef::from_column_major_slice(&self.values, self.size, self.size);
        let columns = b.len() / self.size;
        let mut x = MatMut::from_column_major_slice_mut(b, self.size, columns);
        match &self.kind {
            Kind::Cholesky => {
                solve_lower_triangular_in_place(factor, x.rb_mut(), Par::Seq);
                solve_upper_triangular_in_place(factor.transpose(), x, Par::Seq);
            }
            Kind::Lu(forward, backward) => {
                let scratch =
                    lu_solve::solve_in_place_scratch::<usize, f64>(self.size, columns, Par::Seq);
                let mut buffer = MemBuffer::new(scratch);
                let rows = PermRef::new_checked(forward, backward, self.size);
                let stack = MemStack::new(&mut buffer);
                lu_solve::solve_in_place(factor, factor, rows, x, Par::Seq, stack);
            }
        }
    }

    /// Part of column k from row `from` on.
    #[inline(always)]
    fn column(&self, k: usize, from: usize) -> &[f64] {
        &self.values[k * self.size + from..(k + 1) * self.size]
    }
}

/// A forward and a backward substitution.
struct Substitution<'a> {
    factors: &'a Factors,
    b: &'a mut [f64],
}

impl WithSimd for Substitution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factors, b } = self;
        match factors.kind {
            Kind::Cholesky => {
                factors.forward(simd, b, false);
                factors.backward_transposed(b);
            }
            Kind::Lu(..) => {
                factors.forward(simd, b, true);
                factors.backward(simd, b);
            }
        }
    }
}

impl Factors {
    /// b <- L^-1 b, with the diagonal 1 or that of the values.
    #[inline(always)]
    fn forward<S: Simd>(&self, simd: S, b: &mut [f64], has_unit_diagonal: bool) {
        for first in (0..self.size).step_by(TOGETHER) {
            let end = (first + TOGETHER).min(self.size);
            for k in first..end {
                if !has_unit_diagonal {
                    b[k] /= self.values[k + k * self.size];
                }
                for i in k + 1..end {
                    b[i] -= self.values[i + k * self.size] * b[k];
                }
            }
            let (above, below) = b.split_at_mut(end);
            self.subtract(simd, [first, end], (end, &above[first..]), below);
        }
    }

    /// b <- U^-1 b.
    #[inline(always)]
    fn backward<S: Simd>(&self, simd: S, b: &mut [f64]) {
        for first in (0..self.size).step_by(TOGETHER).rev() {
            let end = (first + TOGETHER).min(self.size);
            for k in (first..end).rev() {
                b[k] /= self.values[k + k * self.size];
                for i in first..k {
                    b[i] -= self.values[i + k * self.size] * b[k];
                }
            }
            let (above, own) = b.split_at_mut(first);
            self.subtract(simd, [first, end], (0, own), above);
        }
    }

    /// b <- L^-T b.
    #[inline(always)]
    fn backward_transposed(&self, b: &mut [f64]) {
        for k in (0..self.size).rev() {
            let (b, below) = b.split_at_mut(k + 1);
            b[k] = (b[k] - dot(self.column(k, k + 1), below)) / self.values[k + k * self.size];
        }
    }

    /// Subtracts the columns from `first` to `end`, from row `from` on, times their entries of b.
    #[inline(always)]
    fn subtract<S: Simd>(
        &self,
        simd: S,
        [first, end]: [usize; 2],
        (from, b): (usize, &[f64]),
        others: &mut [f64],
    ) {
        let columns = from_fn(|k| self.column((first + k).min(end - 1), from));
        let is_own = |k: &usize| first + k < end;
        let factors = from_fn(|k| Some(k).filter(is_own).map_or(0.0, |k| -b[k]));
        combine(simd, columns, factors, others);
    }
}

/// Whether all pivots are finite and none is negligible against the largest.
fn regular(pivots: impl Iterator<Item = f64>) -> bool {
    let (mut smallest, mut largest, mut finite) = (f64::INFINITY, 0.0_f64, true);
    for pivot in pivots {
        finite &= pivot.is_finite();
        smallest = smallest.min(pivot);
        largest = largest.max(pivot);
    }
    finite && smallest > SINGULAR * largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_factorisations_solve() {
        // A = [4 1; 1 3], x = (1, 2), b = (6, 7)
        let a = vec![4.0, 1.0, 1.0, 3.0];
        for factors in [Factors::cholesky(a.clone(), 2), Factors::lu(a.clone(), 2)] {
            let mut b = [6.0, 7.0];
            factors.unwrap().solve(&mut b);
            assert!((b[0] - 1.0).abs() < 1e-15 && (b[1] - 2.0).abs() < 1e-15);
        }
    }

    #[test]
    fn substitutions_of_all_sizes_solve_what_columns_together_solve() {
        for size in 1..23 {
            // diagonally dominant and symmetric
            let entry = |i: usize, j: usize| 1.0 / (1.0 + (i + j) as f64);
            let a = |k: usize| entry(k % size, k / size) + f64::from(k % size == k / size) * 3.0;
            let a: Vec<f64> = (0..size * size).map(a).collect();
            let b: Vec<f64> = (0..size).map(|i| 1.0 - i as f64).collect();
            let unsymmetric: Vec<f64> = (0..)
                .zip(&a)
                .map(|(k, a)| a * f64::from(1 + k % 3))
                .collect();
            for factors in [Factors::cholesky(a, size), Factors::lu(unsymmetric, size)] {
                let factors = factors.expect("regular");
                let (mut one, mut two) = (b.clone(), [b.clone(), b.clone()].concat());
                factors.solve(&mut one);
                factors.solve_columns(&mut two);
                for (i, x) in two.iter().enumerate() {
                    assert!((x - one[i % size]).abs() < 1e-13, "{size} {i}");
                }
            }
        }
    }

    #[test]
    fn singular_matrices_are_refused() {
        let a = vec![1.0, 1.0, 1.0, 1.0];
        assert!(Factors::cholesky(a.clone(), 2).is_none());
        assert!(Factors::lu(a, 2).is_none());
        assert!(Factors::cholesky(vec![1.0, 0.0, 0.0, -1.0], 2).is_none());
        assert!(Factors::lu(vec![f64::NAN; 4], 2).is_none());
        assert!(Factors::lu(vec![0.0], 1).is_none());
    }
}
