//! A supernode of LDL^T factors: its columns of L eliminated from a right-hand side, and the unknowns of
//! its columns from those above them, in blocks of columns with vector instructions. Section 5 of
//! docs/theory.md, One solve.

use std::array::from_fn;
use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use pulp::Simd;

pub(super) type Factor<'a> = SupernodalLdltRef<'a, usize, f64>;

/// A supernode: columns of L with the same rows below them, D on the diagonal.
#[derive(Clone, Copy)]
pub(super) struct Supernode<'a> {
    /// First column, in the order of pivots.
    start: usize,
    /// Number of columns.
    size: usize,
    /// Rows below those of its own columns.
    rows: &'a [usize],
    /// Own rows, then those below, column by column.
    values: &'a [f64],
}

impl<'a> Supernode<'a> {
    #[inline(always)]
    pub fn new(factor: Factor<'a>, s: usize) -> Self {
        let symbolic = factor.symbolic();
        let (starts, ends) = (symbolic.supernode_begin(), symbolic.supernode_end());
        let values = symbolic.col_ptr_for_val();
        Supernode {
            start: starts[s],
            size: ends[s] - starts[s],
            rows: symbolic.supernode(s).pattern(),
            values: &factor.values()[values[s]..values[s + 1]],
        }
    }

    /// Its columns.
    #[inline(always)]
    pub fn columns(self) -> Range<usize> {
        self.start..self.start + self.size
    }

    /// Number of its columns.
    #[inline(always)]
    pub fn size(self) -> usize {
        self.size
    }

    /// Rows below those of its own columns.
    #[inline(always)]
    pub fn rows(self) -> &'a [usize] {
        self.rows
    }

    /// Number of entries of a column.
    #[inline(always)]
    pub fn length(self) -> usize {
        self.size + self.rows.len()
    }

    /// D of its columns.
    #[inline(always)]
    pub fn pivots(self) -> impl Iterator<Item = &'a f64> {
        self.values
            .iter()
            .step_by(self.length() + 1)
            .take(self.size)
    }

    /// w_i <- w_i - L_ij w_j, i > j, for all its columns j; w in own rows, then in those below.
    #[inline(always)]
    pub fn eliminate<S: Simd>(self, simd: S, w: &mut [f64]) {
        let fours = self.size / 4 * 4;
        for j in (0..fours).step_by(4) {
            self.eliminate_block::<S, 4>(simd, j, w);
        }
        let rest = self.size - fours;
        if rest >= 2 {
            self.eliminate_block::<S, 2>(simd, fours, w);
        }
        if rest % 2 == 1 {
            self.eliminate_block::<S, 1>(simd, self.size - 1, w);
        }
    }

    /// w_j <- w_j - L_ij w_i, i > j, for all its columns j, the last one first.
    #[inline(always)]
    pub fn resolve<S: Simd>(self, simd: S, w: &mut [f64]) {
        let fours = self.size / 4 * 4;
        let rest = self.size - fours;
        if rest % 2 == 1 {
            self.resolve_block::<S, 1>(simd, self.size - 1, w);
        }
        if rest >= 2 {
            self.resolve_block::<S, 2>(simd, fours, w);
        }
        for j in (0..fours).step_by(4).rev() {
            self.resolve_block::<S, 4>(simd, j, w);
        }
    }

    /// N columns from j on, from row j on.
    #[inline(always)]
    fn block<const N: usize>(self, j: usize) -> [&'a [f64]; N] {
        let length = self.length();
        from_fn(|k| &self.values[(j + k) * length + j..(j + k + 1) * length])
    }

    /// [`Self::eliminate`] for N columns from j on.
    #[inline(always)]
    fn eliminate_block<S: Simd, const N: usize>(self, simd: S, j: usize, w: &mut [f64]) {
        let l = self.block::<N>(j);
        let (own, below) = w[j..].split_at_mut(N);
        for i in 1..N {
            for k in 0..i {
                own[i] -= l[k][i] * own[k];
            }
        }
        let own: [f64; N] = from_fn(|k| own[k]);
        subtract(simd, below, own, l.map(|l| &l[N..]));
    }

    /// [`Self::resolve`] for N columns from j on.
    #[inline(always)]
    fn resolve_block<S: Simd, const N: usize>(self, simd: S, j: usize, w: &mut [f64]) {
        let l = self.block::<N>(j);
        let (own, below) = w[j..].split_at_mut(N);
        let products = products(simd, below, l.map(|l| &l[N..]));
        for k in (0..N).rev() {
            own[k] -= products[k];
            for i in k + 1..N {
                own[k] -= l[k][i] * own[i];
            }
        }
    }
}

/// y <- y - sum_k l_k x_k
#[inline(always)]
fn subtract<S: Simd, const N: usize>(simd: S, y: &mut [f64], x: [f64; N], l: [&[f64]; N]) {
    let x = x.map(|x| simd.splat_f64s(-x));
    let l = l.map(|l| S::as_simd_f64s(&l[..y.len()]));
    let (y, y_rest) = S::as_mut_simd_f64s(y);
    let (l, l_rest) = (l.map(|l| &l.0[..y.len()]), l.map(|l| l.1));
    for (i, y) in y.iter_mut().enumerate() {
        let mut sum = *y;
        for k in 0..N {
            sum = simd.mul_add_e_f64s(x[k], l[k][i], sum);
        }
        *y = sum;
    }
    if !y_rest.is_empty() {
        let mut sum = simd.partial_load_f64s(y_rest);
        for k in 0..N {
            sum = simd.mul_add_e_f64s(x[k], simd.partial_load_f64s(l_rest[k]), sum);
        }
        simd.partial_store_f64s(y_rest, sum);
    }
}

/// l_k . x
#[inline(always)]
fn products<S: Simd, const N: usize>(simd: S, x: &[f64], l: [&[f64]; N]) -> [f64; N] {
    let l = l.map(|l| S::as_simd_f64s(&l[..x.len()]));
    let (x, x_rest) = S::as_simd_f64s(x);
    let (l, l_rest) = (l.map(|l| &l.0[..x.len()]), l.map(|l| l.1));
    let mut sums = [simd.splat_f64s(0.0); N];
    for (i, &x) in x.iter().enumerate() {
        for k in 0..N {
            sums[k] = simd.mul_add_e_f64s(l[k][i], x, sums[k]);
        }
    }
    if !x_rest.is_empty() {
        let x = simd.partial_load_f64s(x_rest);
        for k in 0..N {
            sums[k] = simd.mul_add_e_f64s(simd.partial_load_f64s(l_rest[k]), x, sums[k]);
        }
    }
    sums.map(|sum| simd.reduce_sum_f64s(sum))
}
