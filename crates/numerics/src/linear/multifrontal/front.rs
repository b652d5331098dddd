//! Dense elimination of the columns of a supernode from its front, in panels of columns with vector
//! instructions. docs/numerics.md, Factorisation.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::factor::Entries;
use super::supernodes::{Layout, panels};

/// Number of panels of full width that are eliminated before the columns to their right change.
const BLOCK: usize = 6;

/// Number of columns that change together.
const SIDE: usize = 4;

/// Number of columns whose change is one task for a thread.
const PIECE: usize = 8 * SIDE;
const OPERATIONS: usize = 500_000;

/// Dense matrix over the rows of a supernode: its own and those below it. Only the lower triangle is stored, column by
/// column. Behind the rows and columns there is room for whole vector registers.
#[derive(Debug, Default)]
pub struct Front {
    pub values: Entries,
    /// Whether several threads may change its columns.
    pub on_threads: bool,
    /// Number of rows, and of columns.
    pub length: usize,
    /// Distance from the start of a column to that of the next.
    pub stride: usize,
    /// -L D of the panels of a block, in tiles like L.
    scaled: Vec<f64>,
}

/// A panel that has been eliminated, with its factors for the columns that change.
#[derive(Default, Clone, Copy)]
struct Panel<'a> {
    /// L below the columns of the panel, in tiles.
    l: &'a [f64],
    /// First row below the columns of the panel.
    below: usize,
    /// Entries of -L D for each of the changing columns, from the first factor of this column on.
    scaled: [&'a [f64]; SIDE],
}

/// Columns of a panel of a block, and the places of their parts.
#[derive(Debug, Default, Clone, Copy)]
struct PanelSpot {
    first: usize,
    width: usize,
    /// Start of the tiles of the panel in the values of the supernode.
    tiles: usize,
    /// Start of the tiles of the panel in -L D.
    scaled: usize,
}

impl PanelSpot {
    /// The panel, which has N columns, with its factors for the columns from `column` on.
    #[inline(always)]
    fn panel<'a, const N: usize>(
        self,
        lanes: usize,
        column: usize,
        [l, scaled]: [&'a [f64]; 2],
    ) -> Panel<'a> {
        let below = self.first + N;
        let mut of_columns = [&[][..]; SIDE];
        for (row, of_column) in (column - below..).zip(&mut of_columns) {
            let start = self.scaled + row / lanes * (lanes * N) + row % lanes;
            *of_column = &scaled[start..start + lanes * (N - 1) + 1];
        }
        Panel {
            l: &l[self.tiles..],
            below,
            scaled: of_columns,
        }
    }
}

impl Front {
    /// Makes room for fronts of up to `length` rows.
    pub fn make_room(&mut self, length: usize) {
        let stride = Layout::of_processor().stride(length);
        self.values.make_room(stride * (length + SIDE));
    }

    /// Makes this a front of `length` rows with zeros in the lower triangle; there must be room for it.
    pub fn clear(&mut self, layout: Layout, length: usize) {
        self.length = length;
        self.stride = layout.stride(length);
        let columns = self.values.chunks_exact_mut(self.stride).take(length);
        for (k, column) in columns.enumerate() {
            column[k..].fill(0.0);
        }
    }

    /// Eliminates the first `size` columns: writes their L to `values` (see [`Layout`]) and their D to `pivots`, and
    /// leaves the update matrix in the other columns.
    #[inline(always)]
    pub fn eliminate<S: Simd>(
        &mut self,
        simd: S,
        size: usize,
        values: &mut [f64],
        pivots: &mut [f64],
    ) {
        let layout = Layout {
            lanes: S::F64_LANES,
        };
        let mut spots = [PanelSpot::default(); BLOCK];
        let (mut count, mut start, mut scaled) = (0, 0, 0);
        for (first, width) in panels(size) {
            let spot = PanelSpot {
                first,
                width,
                tiles: start + layout.triangle(width),
                scaled,
            };
            let entries = layout.tiles(self.length - first - width) * layout.lanes * width;
            spots[count] = spot;
            let room = scaled + entries + SIDE * layout.lanes * width;
            self.scaled.resize(self.scaled.len().max(room), 0.0);
            self.change(simd, &spots[..count], values, first..first + width);
            let panel = &mut values[start..spot.tiles + entries];
            let pivots = &mut pivots[first..first + width];
            match width {
                8 => self.eliminate_panel::<S, 8>(simd, spot, panel, pivots),
                4 => self.eliminate_panel::<S, 4>(simd, spot, panel, pivots),
                2 => self.eliminate_panel::<S, 2>(simd, spot, panel, pivots),
                _ => self.eliminate_panel::<S, 1>(simd, spot, panel, pivots),
            }
            (start, scaled, count) = (spot.tiles + entries, scaled + entries, count + 1);
            let is_followed = first + 2 * width <= size && width == 8;
            if count == BLOCK || !is_followed {
                self.change(simd, &spots[..count], values, first + width..self.length);
                (count, scaled) = (0, 0);
            }
        }
    }

    /// Subtracts the products of eliminated panels from some columns:
    ///
    /// ```text
    /// F_ij <- F_ij - sum_k L_ik D_k L_jk,   i >= j
    /// ```
    #[inline(always)]
    fn change<S: Simd>(
        &mut self,
        simd: S,
        spots: &[PanelSpot],
        values: &[f64],
        columns: Range<usize>,
    ) {
        let Some(last) = spots.last() else {
            return;
        };
        let Self {
            values: front,
            on_threads,
            length,
            stride,
            scaled,
        } = self;
        let change = Change {
            spots,
            values,
            scaled,
            length: *length,
            stride: *stride,
        };
        let end = columns.start + columns.len().next_multiple_of(SIDE);
        let front = &mut front[columns.start * *stride..end * *stride];
        let depth = spots.len() * last.width;
        let operations = columns.len() * (*length - columns.start) / 2 * depth;
        if *on_threads && operations > OPERATIONS {
            let pieces = front.par_chunks_mut(PIECE * *stride).enumerate();
            pieces.with_max_len(1).for_each(|(k, front)| {
                let first = columns.start + k * PIECE;
                Arch::new().dispatch(Piece {
                    change: &change,
                    first,
                    front,
                });
            });
            return;
        }
        change.take(simd, columns.start, front);
    }

    /// Eliminates the columns of a panel, after all earlier panels have changed them.
    #[inline(always)]
    fn eliminate_panel<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        spot: PanelSpot,
        panel: &mut [f64],
        pivots: &mut [f64],
    ) {
        let lanes = S::F64_LANES;
        let (triangle, tiles) = panel.split_at_mut(Layout { lanes }.triangle(N));
        let (first, stride) = (spot.first, self.stride);
        let mut columns = [&[][..]; N];
        for (k, column) in columns.iter_mut().enumerate() {
            let column_start = (first + k) * stride;
            *column = &self.values[column_start + first..column_start + stride];
        }
        // L D L^T of the columns' own rows
        let (mut l, mut d, mut inverse) = ([[0.0; N]; N], [0.0; N], [0.0; N]);
        for k in 0..N {
            let mut of_row = [0.0; N];
            for j in 0..k {
                of_row[j] = l[k][j] * d[j];
            }
            for i in k..N {
                let mut entry = columns[k][i];
                for j in 0..k {
                    entry -= l[i][j] * of_row[j];
                }
                if i == k {
                    (d[k], inverse[k]) = (entry, 1.0 / entry);
                }
                l[i][k] = entry * inverse[k];
            }
        }
        pivots.copy_from_slice(&d);
        let below = |k: usize| (k + 1..N).map(move |i| (i, k));
        for (value, (i, k)) in triangle.iter_mut().zip((0..N).flat_map(below)) {
            *value = l[i][k];
        }
        // rows below: L D = F L^-T, tile by tile
        let inverse = inverse.map(|inverse| simd.splat_f64s(-inverse));
        let of_scaled = &mut self.scaled[spot.scaled..spot.scaled + tiles.len()];
        let tiles = S::as_mut_simd_f64s(tiles).0.as_chunks_mut::<N>().0;
        let of_scaled = S::as_mut_simd_f64s(of_scaled).0.as_chunks_mut::<N>().0;
        for (t, (tile, scaled)) in tiles.iter_mut().zip(of_scaled).enumerate() {
            let row = N + t * lanes;
            for k in 0..N {
                let mut entry = simd.neg_f64s(S::as_simd_f64s(&columns[k][row..row + lanes]).0[0]);
                for j in 0..k {
                    entry = simd.mul_add_e_f64s(simd.splat_f64s(-l[k][j]), scaled[j], entry);
                }
                scaled[k] = entry;
                tile[k] = simd.mul_f64s(entry, inverse[k]);
            }
        }
    }
}

/// Products of eliminated panels that are subtracted from columns of a front.
struct Change<'a> {
    spots: &'a [PanelSpot],
    /// L of the supernode.
    values: &'a [f64],
    scaled: &'a [f64],
    length: usize,
    stride: usize,
}

/// The columns of a front, from `first` on, that one thread changes.
struct Piece<'a> {
    change: &'a Change<'a>,
    first: usize,
    front: &'a mut [f64],
}

impl WithSimd for Piece<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.change.take(simd, self.first, self.front);
    }
}

impl Change<'_> {
    /// Subtracts the products from columns of a front, from `first` on.
    #[inline(always)]
    fn take<S: Simd>(&self, simd: S, first: usize, front: &mut [f64]) {
        match self.spots[0].width {
            8 => self.take_by::<S, 8>(simd, first, front),
            4 => self.take_by::<S, 4>(simd, first, front),
            2 => self.take_by::<S, 2>(simd, first, front),
            _ => self.take_by::<S, 1>(simd, first, front),
        }
    }

    #[inline(always)]
    fn take_by<S: Simd, const N: usize>(&self, simd: S, first: usize, front: &mut [f64]) {
        let (lanes, stride) = (S::F64_LANES, self.stride);
        let sides = front.chunks_exact_mut(SIDE * stride);
        for (side, column) in sides.zip((first..).step_by(SIDE)) {
            let mut panels = [Panel::default(); BLOCK];
            for (panel, spot) in panels.iter_mut().zip(self.spots) {
                *panel = spot.panel::<N>(lanes, column, [self.values, self.scaled]);
            }
            let panels = &panels[..self.spots.len()];
            // Rows of the tile that has the diagonal, and those below.
            let phase = (column - self.spots[0].first - N) % lanes;
            let rows = column - phase..self.length;
            for row in rows.step_by(2 * lanes) {
                let products = Products { simd, row, stride };
                match row + lanes < self.length {
                    true => products.take::<2, N>(side, panels),
                    false => products.take::<1, N>(side, panels),
                }
            }
        }
    }
}

/// Products that change columns side by side.
struct Products<S> {
    simd: S,
    row: usize,
    stride: usize,
}

impl<S: Simd> Products<S> {
    /// Subtracts the products of panels of N columns from T tiles of rows.
    #[inline(always)]
    fn take<const T: usize, const N: usize>(&self, side: &mut [f64], panels: &[Panel]) {
        let Self { simd, row, stride } = *self;
        let lanes = S::F64_LANES;
        let at = |c: usize, t: usize| c * stride + row + t * lanes;
        let mut sums = [[simd.splat_f64s(0.0); T]; SIDE];
        for c in 0..SIDE {
            for t in 0..T {
                sums[c][t] = S::as_simd_f64s(&side[at(c, t)..at(c, t) + lanes]).0[0];
            }
        }
        for panel in panels {
            let tile = (row - panel.below) / lanes * (lanes * N);
            let l = &S::as_simd_f64s(&panel.l[tile..tile + T * lanes * N]).0[..T * N];
            let scaled = panel.scaled.map(|scaled| &scaled[..lanes * (N - 1) + 1]);
            for k in 0..N {
                for c in 0..SIDE {
                    let factor = simd.splat_f64s(scaled[c][k * lanes]);
                    for t in 0..T {
                        sums[c][t] = simd.mul_add_e_f64s(l[t * N + k], factor, sums[c][t]);
                    }
                }
            }
        }
        for c in 0..SIDE {
            for t in 0..T {
                S::as_mut_simd_f64s(&mut side[at(c, t)..at(c, t) + lanes]).0[0] = sums[c][t];
            }
        }
    }
}
