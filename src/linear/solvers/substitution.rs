//! Forward and backward substitution with supernodal LDL^T factors, of all unknowns or of those on the
//! paths of some to the root of the elimination tree. Section 5 of docs/theory.md, One solve.

use pulp::{Arch, Simd, WithSimd};

use super::supernode::{Factor, Supernode};

/// One right-hand side b on its way through P^T L D L^T P x = b; vectors in the order of pivots.
#[derive(Default)]
pub(super) struct Substitution {
    /// z = L^-1 P b
    z: Vec<f64>,
    /// L^-T D^-1 z, where it has been asked for.
    x: Vec<f64>,
    /// Entries in the rows of one supernode.
    work: Vec<f64>,
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
        let Self { z, work, .. } = self;
        let supernodes = 0..factor.symbolic().n_supernodes();
        Arch::new().dispatch(Forward {
            factor,
            supernodes,
            x: z,
            work,
        });
    }

    /// z <- z + L^-1 f, f having entries at positions of the paths only.
    pub fn add(&mut self, factor: Factor, f: impl Iterator<Item = (usize, f64)>) {
        let Self {
            z, x, work, paths, ..
        } = self;
        x.resize(z.len(), 0.0);
        let columns = |&s: &usize| Supernode::new(factor, s).columns();
        paths.iter().for_each(|s| x[columns(s)].fill(0.0));
        f.for_each(|(position, value)| x[position] += value);
        let supernodes = paths.iter().copied();
        Arch::new().dispatch(Forward {
            factor,
            supernodes,
            x,
            work,
        });
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
            z, x, work, paths, ..
        } = self;
        x.resize(z.len(), 0.0);
        let supernodes = paths.iter().copied();
        Arch::new().dispatch(Backward {
            factor,
            supernodes,
            z,
            x,
            work,
        });
        x
    }

    /// x = L^-T D^-1 z everywhere.
    pub fn end(&mut self, factor: Factor) -> &[f64] {
        let Self { z, x, work, .. } = self;
        x.resize(z.len(), 0.0);
        let supernodes = 0..factor.symbolic().n_supernodes();
        Arch::new().dispatch(Backward {
            factor,
            supernodes,
            z,
            x,
            work,
        });
        x
    }
}

/// x <- L^-1 x for the given supernodes, children before their parents:
///
/// ```text
/// x_i <- x_i - L_ij x_j,   i > j
/// ```
struct Forward<'a, I> {
    factor: Factor<'a>,
    supernodes: I,
    x: &'a mut [f64],
    work: &'a mut Vec<f64>,
}

impl<I: Iterator<Item = usize>> WithSimd for Forward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { x, work, .. } = self;
        for s in self.supernodes {
            let node = Supernode::new(self.factor, s);
            work.clear();
            work.extend_from_slice(&x[node.columns()]);
            work.resize(node.length(), 0.0);
            node.eliminate(simd, work);
            let (own, below) = work.split_at(node.size());
            x[node.columns()].copy_from_slice(own);
            for (&row, below) in node.rows().iter().zip(below) {
                x[row] += below;
            }
        }
    }
}

/// x <- L^-T D^-1 z for the given supernodes, which come after all their descendants:
///
/// ```text
/// x_j = z_j/D_jj - sum_i L_ij x_i,   i > j
/// ```
struct Backward<'a, I> {
    factor: Factor<'a>,
    supernodes: I,
    z: &'a [f64],
    x: &'a mut [f64],
    work: &'a mut Vec<f64>,
}

impl<I: DoubleEndedIterator<Item = usize>> WithSimd for Backward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { z, x, work, .. } = self;
        for s in self.supernodes.rev() {
            let node = Supernode::new(self.factor, s);
            work.clear();
            let own = z[node.columns()].iter().zip(node.pivots());
            work.extend(own.map(|(z, d)| z / d));
            work.extend(node.rows().iter().map(|&row| x[row]));
            node.resolve(simd, work);
            x[node.columns()].copy_from_slice(&work[..node.size()]);
        }
    }
}
