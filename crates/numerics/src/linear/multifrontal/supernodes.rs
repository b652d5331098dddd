//! The supernodes of L: groups of unknowns that are eliminated together. Forward and backward substitution treat their
//! columns in panels, with vector instructions (docs/numerics.md, Solves of a pass). The elimination forest is cut into
//! branches, which do not depend on each other, and the trunks on which they stand (docs/numerics.md, Branches).

use std::array::from_fn;
use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use pulp::{Arch, Simd, WithSimd};

/// Supernodes: columns of L with the same rows below them; children come before their parents.
#[derive(Debug, Default)]
pub struct Supernodes {
    /// First column of every supernode, and the number of columns at the end.
    starts: Vec<usize>,
    /// Rows below the columns of each supernode, in increasing order, supernode after supernode.
    rows: Vec<usize>,
    /// Start of the rows of every supernode, and the end of the last ones.
    row_starts: Vec<usize>,
}

impl Supernodes {
    /// Supernodes of unknowns, made from supernodes of groups of unknowns; `offsets` holds the first pivot of every
    /// group in the order of elimination, and the number of pivots at the end.
    pub fn of_groups(groups: &SymbolicSupernodalCholesky<usize>, offsets: &[usize]) -> Self {
        let mut supernodes = Supernodes {
            starts: vec![0],
            rows: Vec::new(),
            row_starts: vec![0],
        };
        for s in 0..groups.n_supernodes() {
            supernodes.starts.push(offsets[groups.supernode_end()[s]]);
            for &row in groups.supernode(s).pattern() {
                supernodes.rows.extend(offsets[row]..offsets[row + 1]);
            }
            supernodes.row_starts.push(supernodes.rows.len());
        }
        supernodes
    }

    /// Number of supernodes.
    pub fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Columns of a supernode.
    pub fn columns(&self, s: usize) -> Range<usize> {
        self.starts[s]..self.starts[s + 1]
    }

    /// Rows below the columns of a supernode, in increasing order.
    pub fn rows(&self, s: usize) -> &[usize] {
        &self.rows[self.row_starts[s]..self.row_starts[s + 1]]
    }

    /// Number of entries of the columns of a supernode, including those above the diagonal.
    pub fn entries(&self, s: usize) -> usize {
        let size = self.columns(s).len();
        size * (size + self.rows(s).len())
    }

    /// The parent of every supernode: the supernode of the first row below it.
    pub fn parents(&self) -> Vec<Option<usize>> {
        let of_row = |row: &usize| self.starts.partition_point(|start| start <= row) - 1;
        let parent = |s: usize| self.rows(s).first().map(of_row);
        (0..self.count()).map(parent).collect()
    }
}

/// Number of columns of the widest panel.
const WIDEST: usize = 8;

/// Panels of a supernode of `size` columns: first column and number of columns of each; each panel is the widest one
/// that fits.
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
    /// Rows below those of its own columns; if rows come in pairs of neighbours, the first row of each pair.
    pub rows: &'a [u32],
    /// Whether rows come in pairs of neighbours.
    pub is_of_twos: bool,
    /// Beginning and end of its entries in L of all limbs.
    pub entries: [usize; 2],
}

/// Arrangement of the entries of a supernode. Each panel has the entries between its own columns first, column by
/// column; then the rows below them, in tiles with as many rows as a vector register holds numbers. A tile is stored
/// column by column. Triangles and tiles are filled up with zeros to whole registers.
#[derive(Clone, Copy)]
pub struct Layout {
    /// Number of values that a vector register holds.
    pub lanes: usize,
}

impl Layout {
    /// The layout for the vector instructions of the processor.
    pub fn of_processor() -> Self {
        Arch::new().dispatch(OfProcessor)
    }

    /// Number of entries between the columns of a panel.
    #[inline(always)]
    pub fn triangle(self, width: usize) -> usize {
        (width * (width - 1) / 2).next_multiple_of(self.lanes)
    }

    /// Number of tiles for `rows` rows.
    #[inline(always)]
    pub fn tiles(self, rows: usize) -> usize {
        rows.div_ceil(self.lanes)
    }

    /// Number of entries of a panel of `width` columns with `rows` rows below its own.
    #[inline(always)]
    pub fn panel(self, width: usize, rows: usize) -> usize {
        self.triangle(width) + self.tiles(rows) * self.lanes * width
    }

    /// Number of entries of a supernode with `size` columns of `length` rows.
    pub fn supernode(self, size: usize, length: usize) -> usize {
        let of_panel = |(first, width)| self.panel(width, length - first - width);
        panels(size).map(of_panel).sum()
    }

    /// Distance between columns of a front of `length` rows, which leaves room for one more register.
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
    /// Columns of the supernode.
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

    /// Rows below those of its own columns, in increasing order.
    pub fn rows_below(&self) -> impl Iterator<Item = usize> {
        let of_each = if self.is_of_twos { 2 } else { 1 };
        let rows = self.rows.iter().map(|&row| row as usize);
        rows.flat_map(move |row| row..row + of_each)
    }

    /// Adds w to x in the rows below the supernode: x_i <- x_i + w_i.
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

    /// Copies x in the rows below the supernode to w: w_i <- x_i.
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

    /// The part of L of this supernode, panel by panel (see [`Layout`]).
    #[inline(always)]
    fn own<'l>(&self, values: &'l [f64]) -> &'l [f64] {
        let [start, end] = self.entries;
        &values[start..end]
    }

    /// Writes the part of L of this supernode, with all its rows, to the lower triangle of `l`, column by column.
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

    /// w_i <- w_i - L_ij w_j, i > j, for all its columns j; w holds its own rows, then those below, and room for one
    /// more register.
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

/// [`Supernode::eliminate`] for a panel of N columns, whose entries between its columns come first, then the tiles.
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

/// Inverse of the part of all work above which a subtree does not fit into one branch, so its root belongs to a trunk:
/// this gives enough branches for a few threads, and short trunks.
const SHARE: usize = 8;

/// Smallest work of a branch, in entries of L; with less, a thread would cost more time than it saves.
const LEAST: usize = 50_000;

/// A branch or a trunk.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Limb {
    /// Supernodes of the limb, in increasing order of their numbers in the forest.
    pub supernodes: Vec<usize>,
    /// The trunk on which a branch stands, as its number among the limbs; `None` for a branch of whole trees.
    pub trunk: Option<usize>,
}

/// The elimination forest of the supernodes, in postorder: children before their parents.
struct Forest<'a> {
    parents: &'a [Option<usize>],
    /// Work in the subtree of every supernode.
    work: Vec<usize>,
    /// Root of the tree of every supernode.
    trees: Vec<usize>,
    /// Largest work of a branch.
    most: usize,
}

/// Cuts a forest, given by the parent and the work of every supernode, into limbs. Branches come first; their number is
/// the second value. Supernodes with much work below them form the trunk of their tree. The rest of a tree, or
/// neighbouring small trees, form branches.
pub fn cut(parents: &[Option<usize>], work: &[usize]) -> (Vec<Limb>, usize) {
    let forest = Forest::new(parents, work);
    let (mut limb_of, trees) = forest.branches();
    let branches = trees.len();
    let is_base = |&s: &usize| parents[s].is_none() && forest.is_trunk(s);
    let bases: Vec<usize> = (0..parents.len()).filter(is_base).collect();
    let trunk_of = |tree: usize| branches + bases.partition_point(|&base| base < tree);
    for s in (0..parents.len()).filter(|&s| forest.is_trunk(s)) {
        limb_of[s] = trunk_of(forest.trees[s]);
    }
    let mut limbs = vec![Limb::default(); branches + bases.len()];
    for (limb, tree) in limbs.iter_mut().zip(trees) {
        limb.trunk = tree.map(trunk_of);
    }
    for (s, limb) in limb_of.into_iter().enumerate() {
        limbs[limb].supernodes.push(s);
    }
    (limbs, branches)
}

impl<'a> Forest<'a> {
    fn new(parents: &'a [Option<usize>], work: &[usize]) -> Self {
        let most = LEAST.max(work.iter().sum::<usize>() / SHARE);
        let (mut work, mut trees) = (work.to_vec(), Vec::from_iter(0..parents.len()));
        for (s, parent) in parents.iter().enumerate() {
            parent.iter().for_each(|&parent| work[parent] += work[s]);
        }
        for (s, parent) in parents.iter().enumerate().rev() {
            parent.iter().for_each(|&parent| trees[s] = trees[parent]);
        }
        Forest {
            parents,
            work,
            trees,
            most,
        }
    }

    fn is_trunk(&self, s: usize) -> bool {
        self.work[s] > self.most
    }

    /// The tree of a supernode, if it has a trunk.
    fn tree_with_trunk(&self, s: usize) -> Option<usize> {
        Some(self.trees[s]).filter(|&tree| self.is_trunk(tree))
    }

    /// The branch of every supernode that is not in a trunk, and the tree of every branch that stands on a trunk.
    fn branches(&self) -> (Vec<usize>, Vec<Option<usize>>) {
        let n = self.parents.len();
        let (mut branch_of, mut trees, mut work) = (vec![0; n], Vec::new(), 0);
        let is_in_subtree = |s: usize| self.parents[s].is_some_and(|parent| !self.is_trunk(parent));
        for s in (0..n).filter(|&s| !self.is_trunk(s) && !is_in_subtree(s)) {
            let tree = self.tree_with_trunk(s);
            if work + self.work[s] > self.most || trees.last() != Some(&tree) {
                trees.push(tree);
                work = 0;
            }
            work += self.work[s];
            branch_of[s] = trees.len() - 1;
        }
        for s in (0..n).rev().filter(|&s| is_in_subtree(s)) {
            self.parents[s]
                .iter()
                .for_each(|&parent| branch_of[s] = branch_of[parent]);
        }
        (branch_of, trees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limb(supernodes: &[usize], trunk: Option<usize>) -> Limb {
        Limb {
            supernodes: supernodes.to_vec(),
            trunk,
        }
    }

    #[test]
    fn a_tree_is_cut_below_its_trunk() {
        // 6 stands on 2 and 5, 2 on 0 and 1, 5 on 3 and 4
        let parents = [2, 2, 6, 5, 5, 6].map(Some);
        let parents = [&parents[..], &[None]].concat();
        let work = [50, 45, 10, 10, 10, 5, 5].map(|share| share * LEAST / 50);
        let expected = [
            limb(&[0], Some(3)),
            limb(&[1], Some(3)),
            limb(&[3, 4, 5], Some(3)),
            limb(&[2, 6], None),
        ];
        let (limbs, branches) = cut(&parents, &work);
        assert_eq!((limbs.as_slice(), branches), (&expected[..], 3));
    }

    #[test]
    fn small_trees_are_put_together_and_large_ones_have_trunks_of_their_own() {
        let parents = [None, None, Some(4), Some(4), None, None];
        let work = [LEAST / 2, LEAST / 2, LEAST, LEAST, 1, LEAST];
        let (limbs, branches) = cut(&parents, &work);
        let expected = [
            limb(&[0, 1], None),
            limb(&[2], Some(4)),
            limb(&[3], Some(4)),
            limb(&[5], None),
            limb(&[4], None),
        ];
        assert_eq!((limbs.as_slice(), branches), (&expected[..], 4));
    }

    #[test]
    fn little_work_is_one_branch() {
        let (limbs, branches) = cut(&[Some(2), None, None], &[1, 2, 3]);
        assert_eq!((limbs, branches), (vec![limb(&[0, 1, 2], None)], 1));
        assert_eq!(cut(&[], &[]), (Vec::new(), 0));
    }
}
