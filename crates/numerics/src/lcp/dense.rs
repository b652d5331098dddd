//! Dense arithmetic of the solvers on one core, with the same operations in the same order on all processors: vector
//! kernels, factorisations, and lists in an arena. The next solve uses the arena again, so the solves of the passes
//! allocate no memory.

use std::array::from_fn;

use bumpalo::Bump;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor as llt;
use faer::linalg::lu::partial_pivoting::factor as lu;
use faer::{MatMut, Par};
use pulp::{Arch, Simd, WithSimd};
use smallvec::SmallVec;

/// Sum of a_i b_i over the shorter length, in eight interleaved partial sums (which the compiler
/// turns into vector instructions).
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    Arch::new().dispatch(
        #[inline(always)]
        || interleaved_dot(a, b),
    )
}

#[inline(always)]
fn interleaved_dot(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let (a, b) = (&a[..length], &b[..length]);
    let mut sums = [0.0; 8];
    let (mut chunks_a, mut chunks_b) = (a.chunks_exact(8), b.chunks_exact(8));
    for (x, y) in (&mut chunks_a).zip(&mut chunks_b) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest = chunks_a.remainder().iter().zip(chunks_b.remainder());
    sums.iter().sum::<f64>() + rest.map(|(x, y)| x * y).sum::<f64>()
}

/// y += a x.
pub(crate) fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    if a != 0.0 {
        Arch::new().dispatch(
            #[inline(always)]
            || y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x),
        );
    }
}

/// y += M p, where M is stored by columns; columns with p = 0 are left out.
pub(crate) fn add_product(columns: &[f64], p: &[f64], y: &mut [f64]) {
    Arch::new().dispatch(MatrixProduct {
        columns,
        p,
        y,
        sizes: None,
    });
}

/// y += M p and sizes += |M| |p|, where M is stored by columns.
pub(crate) fn add_product_and_sizes(columns: &[f64], p: &[f64], y: &mut [f64], sizes: &mut [f64]) {
    let sizes = Some(sizes);
    Arch::new().dispatch(MatrixProduct {
        columns,
        p,
        y,
        sizes,
    });
}

/// The operation of [`add_product`] and [`add_product_and_sizes`].
struct MatrixProduct<'a> {
    columns: &'a [f64],
    p: &'a [f64],
    y: &'a mut [f64],
    sizes: Option<&'a mut [f64]>,
}

impl WithSimd for MatrixProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let length = self.y.len();
        let mut terms = (self.p.iter().enumerate()).filter(|(_, a)| **a != 0.0);
        while let Some((k, a)) = terms.next() {
            // four columns at a time, at the end with the factor zero
            let column = |k: usize| &self.columns[k * length..(k + 1) * length];
            let (mut x, mut factors) = ([column(k); 4], [*a, 0.0, 0.0, 0.0]);
            for ((x, factor), (k, a)) in x.iter_mut().zip(&mut factors).skip(1).zip(&mut terms) {
                (*x, *factor) = (column(k), *a);
            }
            combine(simd, x, factors, self.y);
            if let Some(sizes) = &mut self.sizes {
                combine_terms::<S, true>(simd, x, factors, sizes);
            }
        }
    }
}

/// y += a_0 x_0 + ... + a_3 x_3, term by term.
#[inline(always)]
pub(crate) fn combine<S: Simd>(simd: S, x: [&[f64]; 4], a: [f64; 4], y: &mut [f64]) {
    combine_terms::<S, false>(simd, x, a, y);
}

/// Adds the terms a_k x_k, or their absolute values, to y.
#[inline(always)]
fn combine_terms<S: Simd, const SIZES: bool>(simd: S, x: [&[f64]; 4], a: [f64; 4], y: &mut [f64]) {
    let length = y.len();
    let [x0, x1, x2, x3] = x;
    let (heads, rest) = S::as_mut_simd_f64s(y);
    let (x0, rest0) = S::as_simd_f64s(&x0[..length]);
    let (x1, rest1) = S::as_simd_f64s(&x1[..length]);
    let (x2, rest2) = S::as_simd_f64s(&x2[..length]);
    let (x3, rest3) = S::as_simd_f64s(&x3[..length]);
    let mut factors = [simd.splat_f64s(0.0); 4];
    for (factor, a) in factors.iter_mut().zip(a) {
        *factor = simd.splat_f64s(a);
    }
    for (y, ((x0, x1), (x2, x3))) in heads
        .iter_mut()
        .zip(x0.iter().zip(x1).zip(x2.iter().zip(x3)))
    {
        *y = add_terms::<S, SIZES>(simd, factors, [*x0, *x1, *x2, *x3], *y);
    }
    if !rest.is_empty() {
        let mut x = [simd.splat_f64s(0.0); 4];
        for (x, rest) in x.iter_mut().zip([rest0, rest1, rest2, rest3]) {
            *x = simd.partial_load_f64s(rest);
        }
        let sum = simd.partial_load_f64s(rest);
        simd.partial_store_f64s(rest, add_terms::<S, SIZES>(simd, factors, x, sum));
    }
}

/// sum + a_0 x_0 + ... + a_3 x_3, or the same sum with the absolute values of these terms.
#[inline(always)]
fn add_terms<S: Simd, const SIZES: bool>(
    simd: S,
    a: [S::f64s; 4],
    x: [S::f64s; 4],
    mut sum: S::f64s,
) -> S::f64s {
    for (a, x) in a.into_iter().zip(x) {
        sum = match SIZES {
            true => simd.add_f64s(sum, simd.abs_f64s(simd.mul_f64s(a, x))),
            false => simd.mul_add_e_f64s(a, x, sum),
        };
    }
    sum
}

/// y += |a x|, entry by entry.
pub(crate) fn add_sizes(a: f64, x: &[f64], y: &mut [f64]) {
    if a != 0.0 {
        Arch::new().dispatch(
            #[inline(always)]
            || y.iter_mut().zip(x).for_each(|(y, x)| *y += (a * x).abs()),
        );
    }
}

/// Appends v_i (w_i c) to `out`.
pub(crate) fn extend_scaled(out: &mut List<f64>, v: &[f64], w: &[f64], c: f64) {
    let start = out.len();
    out.extend_from_slice_copy(v);
    let scaled = &mut out[start..];
    Arch::new().dispatch(
        #[inline(always)]
        || scaled.iter_mut().zip(w).for_each(|(v, w)| *v *= w * c),
    );
}

/// Largest absolute value, 0 for an empty slice.
pub(crate) fn max_abs(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest: f64, v| largest.max(v.abs()))
}

/// Smallest ratio of a pivot to the largest one; with a smaller ratio, the matrix counts as singular.
const SINGULAR: f64 = 1e-12;

/// Number of columns that a substitution treats together.
const TOGETHER: usize = 4;

/// Factors of a square matrix, stored by columns.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Factors {
    values: Vec<f64>,
    size: usize,
    kind: FactorKind,
}

#[derive(serde::Serialize, serde::Deserialize)]
enum FactorKind {
    /// L L^T; the lower triangle holds L.
    Cholesky,
    /// P A = L U with this permutation P.
    Lu(Vec<usize>),
}

impl Factors {
    /// Factorises a symmetric matrix, given by its lower triangle; `None` unless the matrix is positive definite beyond
    /// round-off.
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
            kind: FactorKind::Cholesky,
        })
    }

    /// Factorises any square matrix. `None` if the matrix is singular to round-off.
    pub fn lu(mut values: Vec<f64>, size: usize) -> Option<Self> {
        let mut buffer = MemBuffer::new(lu::lu_in_place_scratch::<usize, f64>(
            size,
            size,
            Par::Seq,
            Default::default(),
        ));
        let [mut forward, mut backward] = [(); 2].map(|()| vec![0; size]);
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
            kind: FactorKind::Lu(forward),
        })
    }

    /// Overwrites b with the solution of A x = b.
    pub fn solve(&self, b: &mut [f64]) {
        if let FactorKind::Lu(forward) = &self.kind {
            let permuted: SmallVec<[f64; 256]> = forward.iter().map(|&row| b[row]).collect();
            b.copy_from_slice(&permuted);
        }
        Arch::new().dispatch(DenseSubstitution { factors: self, b });
    }

    /// The part of column k from row `from` on.
    #[inline(always)]
    fn column(&self, k: usize, from: usize) -> &[f64] {
        &self.values[k * self.size + from..(k + 1) * self.size]
    }
}

/// A forward and a backward substitution.
struct DenseSubstitution<'a> {
    factors: &'a Factors,
    b: &'a mut [f64],
}

impl WithSimd for DenseSubstitution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factors, b } = self;
        match factors.kind {
            FactorKind::Cholesky => {
                factors.forward(simd, b, false);
                factors.backward_transposed(b);
            }
            FactorKind::Lu(_) => {
                factors.forward(simd, b, true);
                factors.backward(simd, b);
            }
        }
    }
}

impl Factors {
    /// b <- L^-1 b, where the diagonal of L is 1 or that of `values`.
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

    /// Subtracts the columns `first` to `end`, each times its entry of b, from `others`, which begins with row `from`.
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

/// Whether all pivots are finite and no pivot is negligible against the largest one.
fn regular(pivots: impl Iterator<Item = f64>) -> bool {
    let (mut smallest, mut largest, mut finite) = (f64::INFINITY, 0.0_f64, true);
    for pivot in pivots {
        finite &= pivot.is_finite();
        smallest = smallest.min(pivot);
        largest = largest.max(pivot);
    }
    finite && smallest > SINGULAR * largest
}

/// A list in an arena.
pub(crate) type List<'a, T> = bumpalo::collections::Vec<'a, T>;

/// A list of the values of an iterator.
pub(crate) fn list<T>(arena: &Bump, values: impl IntoIterator<Item = T>) -> List<'_, T> {
    List::from_iter_in(values, arena)
}

/// A list with a copy of these values.
pub(crate) fn copy<'a, T: Copy>(arena: &'a Bump, values: &[T]) -> List<'a, T> {
    let mut list = List::with_capacity_in(values.len(), arena);
    list.extend_from_slice_copy(values);
    list
}

/// A list that holds the same value `length` times.
pub(crate) fn filled<T: Copy>(arena: &Bump, value: T, length: usize) -> List<'_, T> {
    bumpalo::vec![in arena; value; length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_match_their_definitions() {
        let a: Vec<f64> = (0..19).map(f64::from).collect();
        let b: Vec<f64> = (0..19).map(|i| f64::from(i) - 9.0).collect();
        let sum: f64 = a.iter().zip(&b).map(|(x, y)| x * y).sum();
        assert_eq!(dot(&a, &b), sum);
        let mut y = b.clone();
        axpy(2.0, &a, &mut y);
        assert_eq!(y[18], 9.0 + 36.0);
        add_sizes(-2.0, &a, &mut y);
        assert_eq!(y[18], 9.0 + 72.0);
        // 6 columns of 19 rows, one of them with the factor zero
        let m: Vec<f64> = (0..6 * 19).map(|i| f64::from(i % 7) - 3.0).collect();
        let p = [1.0, -2.0, 0.0, 3.0, 4.0, -5.0];
        let (mut product, mut sizes, mut both) = (a.clone(), vec![1.0; 19], a.clone());
        add_product(&m, &p, &mut product);
        add_product_and_sizes(&m, &p, &mut both, &mut sizes);
        assert_eq!(product, both);
        for i in 0..19 {
            let terms = p.iter().enumerate().map(|(k, p)| p * m[19 * k + i]);
            assert_eq!(product[i], a[i] + terms.clone().sum::<f64>());
            assert_eq!(sizes[i], 1.0 + terms.map(f64::abs).sum::<f64>());
        }
        assert_eq!(max_abs(&b), 9.0);
        assert_eq!(max_abs(&[]), 0.0);
    }
}

#[cfg(test)]
mod factors_tests {
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
    fn substitutions_of_all_sizes_solve() {
        for size in 1..23 {
            // diagonally dominant and symmetric
            let entry = |i: usize, j: usize| 1.0 / (1.0 + (i + j) as f64);
            let a = |k: usize| entry(k % size, k / size) + f64::from(k % size == k / size) * 3.0;
            let a: Vec<f64> = (0..size * size).map(a).collect();
            let x: Vec<f64> = (0..size).map(|i| 1.0 - i as f64).collect();
            let unsymmetric: Vec<f64> = (0..)
                .zip(&a)
                .map(|(k, a)| a * f64::from(1 + k % 3))
                .collect();
            for (a, is_symmetric) in [(a, true), (unsymmetric, false)] {
                let mut b = vec![0.0; size];
                add_product(&a, &x, &mut b);
                let factors = match is_symmetric {
                    true => Factors::cholesky(a, size),
                    false => Factors::lu(a, size),
                };
                factors.expect("regular").solve(&mut b);
                for (i, (found, x)) in b.iter().zip(&x).enumerate() {
                    assert!((found - x).abs() < 1e-12, "{size} {i}");
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
