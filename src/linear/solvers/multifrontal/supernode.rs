//! A supernode of LDL^T factors: its columns of L eliminated from a right-hand side, and the unknowns of
//! its columns from those above them, in panels of columns with vector instructions. Section 5 of
//! docs/theory.md, One solve.

use std::array::from_fn;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

/// Columns of the widest panel.
const WIDEST: usize = 8;

/// Panels of a supernode of `size` columns: first column and number of columns of each, the
/// widest that fit, one after the other.
#[inline(always)]
pub fn panels(size: usize) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    let whole = size / WIDEST;
    let rest = size % WIDEST;
    let of_rest = [4, 2, 1].into_iter().filter(move |width| rest & width != 0);
    let of_rest = of_rest.map(move |width| (size - rest % (2 * width), width));
    let of_whole = (0..whole).map(|k| (k * WIDEST, WIDEST));
    of_whole.chain(of_rest)
}

/// A supernode: columns of L with the same rows below them.
#[derive(Clone, Copy)]
pub struct Supernode<'a> {
    /// First column.
    pub start: usize,
    /// Number of columns.
    pub size: usize,
    /// Rows below those of its own columns; where they come in twos, one next to the other, the first of each.
    pub rows: &'a [u32],
    /// Whether rows come in twos.
    pub is_of_twos: bool,
    /// Where its entries begin and end in L of all limbs.
    pub entries: [usize; 2],
}

/// How the entries of a supernode lie: each panel has those between its own columns, column by
/// column, then the rows below these, in tiles of as many rows as a vector register holds numbers. A tile has one column
/// after the other. Both are filled up with zeros to whole registers.
#[derive(Clone, Copy)]
pub struct Layout {
    /// Numbers in a vector register.
    pub lanes: usize,
}

impl Layout {
    /// The layout for the vector instructions of the processor.
    pub fn of_processor() -> Self {
        Arch::new().dispatch(OfProcessor)
    }

    /// Entries between the columns of a panel.
    #[inline(always)]
    pub fn triangle(self, width: usize) -> usize {
        (width * (width - 1) / 2).next_multiple_of(self.lanes)
    }

    /// Tiles for rows.
    #[inline(always)]
    pub fn tiles(self, rows: usize) -> usize {
        rows.div_ceil(self.lanes)
    }

    /// Entries of a panel with so many rows below its own.
    #[inline(always)]
    pub fn panel(self, width: usize, rows: usize) -> usize {
        self.triangle(width) + self.tiles(rows) * self.lanes * width
    }

    /// Entries of a supernode with `size` columns of `length` rows.
    pub fn supernode(self, size: usize, length: usize) -> usize {
        let of_panel = |(first, width)| self.panel(width, length - first - width);
        panels(size).map(of_panel).sum()
    }

    /// From a column of a front of so many rows to the next: room for a register more.
    #[inline(always)]
    pub fn stride(self, length: usize) -> usize {
        length + self.lanes
    }
}

struct OfProcessor;

impl WithSimd for OfProcessor {
    type Output = Layout;

    fn with_simd<S: Simd>(self, _: S) -> Layout {
        let lanes = S::F64_LANES;
        Layout { lanes }
    }
}

impl Supernode<'_> {
    /// Its columns.
    #[inline(always)]
    pub fn columns(self) -> Range<usize> {
        self.start..self.start + self.size
    }

    /// Number of entries of a column.
    #[inline(always)]
    pub fn length(self) -> usize {
        let of_rows = if self.is_of_twos { 2 } else { 1 };
        self.size + of_rows * self.rows.len()
    }

    /// Rows below those of its own columns, increasing.
    pub fn rows_below(&self) -> impl Iterator<Item = usize> {
        let of_each = if self.is_of_twos { 2 } else { 1 };
        let rows = self.rows.iter().map(|&row| row as usize);
        rows.flat_map(move |row| row..row + of_each)
    }

    /// x_i <- x_i + w_i in the rows below.
    #[inline(always)]
    pub fn scatter(self, below: &[f64], x: &mut [f64]) {
        if self.is_of_twos {
            for (&row, below) in self.rows.iter().zip(below.as_chunks::<2>().0) {
                if let Some(x) = x[row as usize..].first_chunk_mut::<2>() {
                    *x = from_fn(|k| x[k] + below[k]);
                }
            }
            return;
        }
        for (&row, below) in self.rows.iter().zip(below) {
            x[row as usize] += below;
        }
    }

    /// w_i <- x_i in the rows below.
    #[inline(always)]
    pub fn gather(self, x: &[f64], below: &mut [f64]) {
        if self.is_of_twos {
            for (&row, below) in self.rows.iter().zip(below.as_chunks_mut::<2>().0) {
                if let Some(x) = x[row as usize..].first_chunk::<2>() {
                    *below = *x;
                }
            }
            return;
        }
        for (&row, below) in self.rows.iter().zip(below) {
            *below = x[row as usize];
        }
    }

    /// Its part of L, panel by panel: see [`Layout`].
    #[inline(always)]
    fn own<'l>(&self, values: &'l [f64]) -> &'l [f64] {
        let [start, end] = self.entries;
        &values[start..end]
    }

    /// Writes its part of L, of all its rows, to the lower triangle of `l`, column by column.
    pub fn write_to(self, values: &[f64], l: &mut Vec<f64>) {
        let layout = Layout::of_processor();
        let (lanes, length) = (layout.lanes, self.length());
        l.resize(l.len().max(length * self.size), 0.0);
        let mut rest = self.own(values);
        for (first, width) in panels(self.size) {
            let panel;
            (panel, rest) = rest.split_at(layout.panel(width, length - first - width));
            let (triangle, tiles) = panel.split_at(layout.triangle(width));
            let mut triangle = triangle.iter();
            for k in 0..width {
                let column = &mut l[(first + k) * length..][first + k..length];
                let (own, below) = column[1..].split_at_mut(width - k - 1);
                own.iter_mut()
                    .zip(&mut triangle)
                    .for_each(|(to, l)| *to = *l);
                let tiles = tiles.chunks_exact(lanes * width);
                for (to, tile) in below.chunks_mut(lanes).zip(tiles) {
                    to.copy_from_slice(&tile[k * lanes..][..to.len()]);
                }
            }
        }
    }

    /// w_i <- w_i - L_ij w_j, i > j, for all its columns j; w in own rows, then in those below, and a
    /// register more.
    #[inline(always)]
    pub fn eliminate<S: Simd>(self, simd: S, values: &[f64], w: &mut [f64]) {
        let layout = Layout {
            lanes: S::F64_LANES,
        };
        let (mut rest, length) = (self.own(values), self.length());
        for (first, width) in panels(self.size) {
            let panel;
            (panel, rest) = rest.split_at(layout.panel(width, length - first - width));
            let (panel, w) = (panel.split_at(layout.triangle(width)), &mut w[first..]);
            match width {
                8 => eliminate_panel::<S, 8>(simd, panel, w),
                4 => eliminate_panel::<S, 4>(simd, panel, w),
                2 => eliminate_panel::<S, 2>(simd, panel, w),
                _ => eliminate_panel::<S, 1>(simd, panel, w),
            }
        }
    }

    /// w_j <- w_j - L_ij w_i, i > j, for all its columns j, the last one first.
    #[inline(always)]
    pub fn resolve<S: Simd>(self, simd: S, values: &[f64], w: &mut [f64]) {
        let layout = Layout {
            lanes: S::F64_LANES,
        };
        let (mut rest, length) = (self.own(values), self.length());
        for (first, width) in panels(self.size).rev() {
            let entries = layout.panel(width, length - first - width);
            let panel;
            (rest, panel) = rest.split_at(rest.len() - entries);
            let (panel, w) = (panel.split_at(layout.triangle(width)), &mut w[first..]);
            match width {
                8 => resolve_panel::<S, 8>(simd, panel, w),
                4 => resolve_panel::<S, 4>(simd, panel, w),
                2 => resolve_panel::<S, 2>(simd, panel, w),
                _ => resolve_panel::<S, 1>(simd, panel, w),
            }
        }
    }
}

/// [`Supernode::eliminate`] for a panel of N columns: entries between its columns, then tiles.
#[inline(always)]
fn eliminate_panel<S: Simd, const N: usize>(
    simd: S,
    (triangle, tiles): (&[f64], &[f64]),
    w: &mut [f64],
) {
    let (own, below) = w.split_at_mut(N);
    let (mut x, mut start): ([f64; N], usize) = (from_fn(|k| own[k]), 0);
    for k in 0..N {
        let column = &triangle[start..start + N - 1 - k];
        start += N - 1 - k;
        for (i, l) in column.iter().enumerate() {
            x[k + 1 + i] -= l * x[k];
        }
    }
    own.copy_from_slice(&x);
    let x: [S::f64s; N] = x.map(|x| simd.splat_f64s(-x));
    let tiles = S::as_simd_f64s(tiles).0.as_chunks::<N>().0;
    for (y, l) in S::as_mut_simd_f64s(below).0.iter_mut().zip(tiles) {
        let mut sum = *y;
        for k in 0..N {
            sum = simd.mul_add_e_f64s(x[k], l[k], sum);
        }
        *y = sum;
    }
}

/// [`Supernode::resolve`] for a panel of N columns.
#[inline(always)]
fn resolve_panel<S: Simd, const N: usize>(
    simd: S,
    (triangle, tiles): (&[f64], &[f64]),
    w: &mut [f64],
) {
    let (own, below) = w.split_at_mut(N);
    let mut sums = [simd.splat_f64s(0.0); N];
    let tiles = S::as_simd_f64s(tiles).0.as_chunks::<N>().0;
    for (&x, l) in S::as_simd_f64s(below).0[..tiles.len()]
        .iter()
        .zip(tiles)
        .rev()
    {
        for k in 0..N {
            sums[k] = simd.mul_add_e_f64s(l[k], x, sums[k]);
        }
    }
    let mut end = N * (N - 1) / 2;
    for k in (0..N).rev() {
        let column = &triangle[end - (N - 1 - k)..end];
        end -= N - 1 - k;
        let mut x = own[k] - simd.reduce_sum_f64s(sums[k]);
        for (l, above) in column.iter().zip(&own[k + 1..]) {
            x -= l * above;
        }
        own[k] = x;
    }
}
