//! Forward and backward substitution with supernodal LDL^T factors, of all unknowns or of those on the
//! paths of some to the root of the elimination tree. Section 5 of docs/theory.md, One solve.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use pulp::Arch;

type Factor<'a> = SupernodalLdltRef<'a, usize, f64>;

/// One right-hand side b on its way through P^T L D L^T P x = b; vectors in the order of pivots.
#[derive(Default)]
pub(super) struct Substitution {
    /// z = L^-1 P b
    z: Vec<f64>,
    /// L^-T D^-1 z, where it has been asked for.
    x: Vec<f64>,
    /// Entries in the rows below one supernode.
    below: Vec<f64>,
    /// The supernodes on the paths of some unknowns, increasing: children come before their parents.
    paths: Vec<usize>,
}

impl Substitution {
    /// Whether there are paths.
    pub fn has_paths(&self) -> bool {
        !self.paths.is_empty()
    }

    /// Forgets the paths: the factors have others.
    pub fn forget_paths(&mut self) {
        self.paths.clear();
    }

    /// The paths of the unknowns at the given `positions` in the order of pivots to the root of the
    /// elimination tree: the parent of a supernode is that of its first row below.
    pub fn set_paths(&mut self, factor: Factor, positions: &[usize]) {
        let symbolic = factor.symbolic();
        let ends = symbolic.supernode_end();
        let supernode_of = |position: usize| ends.partition_point(|&end| end <= position);
        let mut is_on_path = vec![false; symbolic.n_supernodes()];
        for &position in positions {
            let mut next = Some(supernode_of(position));
            while let Some(s) = next.filter(|&s| !is_on_path[s]) {
                is_on_path[s] = true;
                next = symbolic
                    .supernode(s)
                    .pattern()
                    .first()
                    .map(|&row| supernode_of(row));
            }
        }
        self.paths.clear();
        self.paths
            .extend((0..is_on_path.len()).filter(|&s| is_on_path[s]));
    }

    /// z = L^-1 P b, `b` given in the order of pivots.
    pub fn begin(&mut self, factor: Factor, b: impl Iterator<Item = f64>) {
        self.z.clear();
        self.z.extend(b);
        let Self { z, below, .. } = self;
        forward(factor, 0..factor.symbolic().n_supernodes(), z, below);
    }

    /// z <- z + L^-1 f, f having entries at positions of the paths only.
    pub fn add(&mut self, factor: Factor, f: impl Iterator<Item = (usize, f64)>) {
        let Self {
            z, x, below, paths, ..
        } = self;
        x.resize(z.len(), 0.0);
        let columns = |&s: &usize| Supernode::new(factor, s).columns();
        paths.iter().for_each(|s| x[columns(s)].fill(0.0));
        f.for_each(|(position, value)| x[position] += value);
        forward(factor, paths.iter().copied(), x, below);
        for range in paths.iter().map(columns) {
            z[range.clone()]
                .iter_mut()
                .zip(&x[range])
                .for_each(|(z, x)| *z += x);
        }
    }

    /// x = L^-T D^-1 z on the paths.
    pub fn on_paths(&mut self, factor: Factor) -> &[f64] {
        let Self {
            z, x, below, paths, ..
        } = self;
        x.resize(z.len(), 0.0);
        backward(factor, paths.iter().copied(), z, (x, below));
        x
    }

    /// x = L^-T D^-1 z everywhere.
    pub fn end(&mut self, factor: Factor) -> &[f64] {
        let Self { z, x, below, .. } = self;
        x.resize(z.len(), 0.0);
        backward(factor, 0..factor.symbolic().n_supernodes(), z, (x, below));
        x
    }
}

/// A supernode: columns of L with the same rows below them, D on the diagonal.
#[derive(Clone, Copy)]
struct Supernode<'a> {
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
    fn new(factor: Factor<'a>, s: usize) -> Self {
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
    fn columns(self) -> Range<usize> {
        self.start..self.start + self.size
    }

    /// Column j: D_jj, entries of L in its own rows, and those in the rows below.
    #[inline(always)]
    fn column(self, j: usize) -> (f64, &'a [f64], &'a [f64]) {
        let length = self.size + self.rows.len();
        let (own, below) = self.values[j * length..(j + 1) * length].split_at(self.size);
        (own[j], &own[j + 1..], below)
    }

    /// Entries of L in the rows below, of column j and the three after it.
    #[inline(always)]
    fn four_below(self, j: usize) -> [&'a [f64]; 4] {
        let below = |k: usize| self.column(j + k).2;
        [below(0), below(1), below(2), below(3)]
    }
}

/// x <- L^-1 x for the given supernodes, children before their parents:
///
/// ```text
/// x_i <- x_i - L_ij x_j,   i > j
/// ```
fn forward(
    factor: Factor,
    supernodes: impl Iterator<Item = usize>,
    x: &mut [f64],
    below: &mut Vec<f64>,
) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for s in supernodes {
                forward_supernode(Supernode::new(factor, s), x, below);
            }
        },
    );
}

#[inline(always)]
fn forward_supernode(node: Supernode<'_>, x: &mut [f64], below: &mut Vec<f64>) {
    let (rows, own) = (node.rows, node.columns());
    for j in 0..own.len() {
        let (_, l_own, _) = node.column(j);
        let (done, rest) = x[own.clone()].split_at_mut(j + 1);
        let x_j = done[j];
        rest.iter_mut().zip(l_own).for_each(|(y, l)| *y -= x_j * l);
    }
    below.clear();
    below.resize(rows.len(), 0.0);
    let (fours, rest) = x[own].as_chunks::<4>();
    for (four, [x0, x1, x2, x3]) in fours.iter().enumerate() {
        let [l0, l1, l2, l3] = node.four_below(4 * four);
        let columns = l0.iter().zip(l1).zip(l2.iter().zip(l3));
        for (y, ((l0, l1), (l2, l3))) in below.iter_mut().zip(columns) {
            *y += (x0 * l0 + x1 * l1) + (x2 * l2 + x3 * l3);
        }
    }
    for (k, x_j) in rest.iter().enumerate() {
        let (_, _, l) = node.column(4 * fours.len() + k);
        below.iter_mut().zip(l).for_each(|(y, l)| *y += x_j * l);
    }
    for (&row, below) in rows.iter().zip(below) {
        x[row] -= *below;
    }
}

/// x <- L^-T D^-1 z for the given supernodes, which come after all their descendants:
///
/// ```text
/// x_j = z_j/D_jj - sum_i L_ij x_i,   i > j
/// ```
fn backward(
    factor: Factor,
    supernodes: impl DoubleEndedIterator<Item = usize>,
    z: &[f64],
    (x, below): (&mut [f64], &mut Vec<f64>),
) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for s in supernodes.rev() {
                backward_supernode(Supernode::new(factor, s), z, x, below);
            }
        },
    );
}

#[inline(always)]
fn backward_supernode(node: Supernode<'_>, z: &[f64], x: &mut [f64], below: &mut Vec<f64>) {
    below.clear();
    below.extend(node.rows.iter().map(|&row| x[row]));
    let own = node.columns();
    let fours = own.len() / 4;
    for four in 0..fours {
        let sums = four_products(node.four_below(4 * four), below);
        x[own.start + 4 * four..][..4].copy_from_slice(&sums);
    }
    for j in 4 * fours..own.len() {
        x[own.start + j] = product(node.column(j).2, below);
    }
    for j in (0..own.len()).rev() {
        let (d, l_own, _) = node.column(j);
        let at = own.start + j;
        x[at] = z[at] / d - (x[at] + product(l_own, &x[at + 1..own.end]));
    }
}

/// Sum of l_i x_i, in four interleaved parts, which the compiler turns into vector instructions.
#[inline(always)]
fn product(l: &[f64], x: &[f64]) -> f64 {
    let ((l, l_rest), (x, x_rest)) = (l.as_chunks::<4>(), x.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (l, x) in l.iter().zip(x) {
        add_products(&mut sums, l, x);
    }
    total(sums, l_rest, x_rest)
}

/// The same of four columns.
#[inline(always)]
fn four_products([l0, l1, l2, l3]: [&[f64]; 4], x: &[f64]) -> [f64; 4] {
    let (x, x_rest) = x.as_chunks::<4>();
    let ((l0, r0), (l1, r1)) = (l0.as_chunks::<4>(), l1.as_chunks::<4>());
    let ((l2, r2), (l3, r3)) = (l2.as_chunks::<4>(), l3.as_chunks::<4>());
    let [mut s0, mut s1, mut s2, mut s3] = [[0.0; 4]; 4];
    for ((x, (l0, l1)), (l2, l3)) in x.iter().zip(l0.iter().zip(l1)).zip(l2.iter().zip(l3)) {
        add_products(&mut s0, l0, x);
        add_products(&mut s1, l1, x);
        add_products(&mut s2, l2, x);
        add_products(&mut s3, l3, x);
    }
    [
        total(s0, r0, x_rest),
        total(s1, r1, x_rest),
        total(s2, r2, x_rest),
        total(s3, r3, x_rest),
    ]
}

#[inline(always)]
fn add_products(sums: &mut [f64; 4], l: &[f64; 4], x: &[f64; 4]) {
    for k in 0..4 {
        sums[k] += l[k] * x[k];
    }
}

/// Sum of the parts and of the products that are left.
#[inline(always)]
fn total([a, b, c, d]: [f64; 4], l: &[f64], x: &[f64]) -> f64 {
    let mut total = (a + b) + (c + d);
    for (l, x) in l.iter().zip(x) {
        total += l * x;
    }
    total
}
