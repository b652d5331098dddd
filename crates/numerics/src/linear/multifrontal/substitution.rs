//! Forward and backward substitution with packed LDL^T factors, for all unknowns or for those on the paths from some
//! unknowns to the root of the elimination tree. docs/numerics.md, Solves of a pass.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::factor::{Factor, LimbFactor, PivotPlace};

/// State of the solution of P^T L D L^T P x = b for one right-hand side b, limb by limb.
#[derive(Default)]
pub struct Substitution {
    limbs: Vec<LimbVectors>,
    has_paths: bool,
}

/// The right-hand side on a limb, as vectors over the rows of the limb.
#[derive(Default)]
struct LimbVectors {
    /// z = L^-1 P b in the own rows; in the rows of the trunk, the sums that are added there.
    z: Vec<f64>,
    /// L^-T D^-1 z, as far as it has been computed.
    x: Vec<f64>,
    /// Work space for the rows of one supernode.
    work: Vec<f64>,
    /// The supernodes on the paths of some unknowns, in increasing order, so children come before their parents.
    path: Vec<usize>,
}

/// Calls `action` for all limbs, on several threads if `threads` is true.
fn for_each(
    threads: bool,
    limbs: &[LimbFactor],
    sides: &mut [LimbVectors],
    action: impl Fn(usize, &LimbFactor, &mut LimbVectors) + Sync,
) {
    if threads {
        let all = limbs.par_iter().zip(sides).enumerate().with_max_len(1);
        all.for_each(|(number, (limb, side))| action(number, limb, side));
        return;
    }
    for (number, (limb, side)) in limbs.iter().zip(sides).enumerate() {
        action(number, limb, side);
    }
}

impl Substitution {
    /// Whether paths have been set.
    pub fn has_paths(&self) -> bool {
        self.has_paths
    }

    /// Makes room for right-hand sides of a factor and removes the paths.
    pub fn adapt(&mut self, factor: &Factor) {
        self.has_paths = false;
        self.limbs
            .resize_with(factor.limbs.len(), LimbVectors::default);
        for (side, limb) in self.limbs.iter_mut().zip(&factor.limbs) {
            side.z.resize(limb.length, 0.0);
            side.x.resize(limb.length, 0.0);
            // a register more, of any processor
            side.work.resize(limb.longest + 8, 0.0);
        }
    }

    /// Sets the paths from the unknowns at the given places to the root of the elimination tree. The parent of a
    /// supernode is the supernode of the first row below it.
    pub fn set_paths(&mut self, factor: &Factor, places: impl Iterator<Item = PivotPlace>) {
        let limbs = &factor.limbs;
        let mut is_on_path: Vec<Vec<bool>> = limbs
            .iter()
            .map(|limb| vec![false; limb.supernodes()])
            .collect();
        for mut place in places {
            loop {
                let limb = &limbs[place.limb];
                let s = limb.supernode_of(place.row);
                if std::mem::replace(&mut is_on_path[place.limb][s], true) {
                    break;
                }
                let own = limb.unknowns.len();
                match (limb.supernode(s).rows.first(), limb.trunk) {
                    (Some(&row), _) if (row as usize) < own => place.row = row as usize,
                    (Some(&row), Some(trunk)) => {
                        place = PivotPlace {
                            limb: trunk,
                            row: row as usize - own,
                        };
                    }
                    _ => break,
                }
            }
        }
        for (side, is_on_path) in self.limbs.iter_mut().zip(is_on_path) {
            side.path.clear();
            side.path
                .extend((0..is_on_path.len()).filter(|&s| is_on_path[s]));
        }
        self.has_paths = true;
    }

    /// Computes z = L^-1 P b.
    pub fn begin(&mut self, factor: &Factor, b: &[f64]) {
        let (threads, branches) = (factor.is_substituted_on_threads(), factor.branches);
        let (of_branches, of_trunks) = self.limbs.split_at_mut(branches);
        let limbs = &factor.limbs[..branches];
        for_each(threads, limbs, of_branches, |_, limb, side| {
            side.z[limb.unknowns.len()..].fill(0.0);
            limb.take(b, &mut side.z);
            side.forward(limb, factor.values());
        });
        let trunks = &factor.limbs[branches..];
        for_each(threads, trunks, of_trunks, |number, trunk, side| {
            trunk.take(b, &mut side.z);
            for (limb, of_limb) in limbs.iter().zip(&*of_branches) {
                if limb.trunk == Some(branches + number) {
                    add(&mut side.z, &of_limb.z[limb.unknowns.len()..]);
                }
            }
            side.forward(trunk, factor.values());
        });
    }

    /// z <- z + L^-1 f, where f has entries only at places on the paths.
    pub fn add(&mut self, factor: &Factor, f: impl Iterator<Item = (PivotPlace, f64)>) {
        let limbs = &factor.limbs;
        for (limb, side) in limbs.iter().zip(&mut self.limbs) {
            side.clear_path(limb);
        }
        f.for_each(|(place, value)| self.limbs[place.limb].x[place.row] += value);
        let (threads, branches) = (factor.is_substituted_on_threads(), factor.branches);
        let (of_branches, of_trunks) = self.limbs.split_at_mut(branches);
        let limbs = &factor.limbs[..branches];
        for_each(threads, limbs, of_branches, |_, limb, side| {
            side.forward_on_path(limb, factor.values());
            side.take_path(limb);
        });
        let trunks = &factor.limbs[branches..];
        for_each(threads, trunks, of_trunks, |number, trunk, side| {
            for (limb, of_limb) in limbs.iter().zip(&*of_branches) {
                if limb.trunk == Some(branches + number) && !of_limb.path.is_empty() {
                    add(&mut side.x, &of_limb.x[limb.unknowns.len()..]);
                }
            }
            side.forward_on_path(trunk, factor.values());
            side.take_path(trunk);
        });
    }

    /// Computes x = L^-T D^-1 z on the paths.
    pub fn on_paths(&mut self, factor: &Factor) {
        let (threads, branches) = (factor.is_substituted_on_threads(), factor.branches);
        let (of_branches, of_trunks) = self.limbs.split_at_mut(branches);
        let trunks = &factor.limbs[branches..];
        for_each(threads, trunks, of_trunks, |_, trunk, side| {
            side.backward_on_path(trunk, factor.values())
        });
        let limbs = &factor.limbs[..branches];
        for_each(threads, limbs, of_branches, |_, limb, side| {
            if !side.path.is_empty() {
                side.stand_on(limb, of_trunks, branches);
                side.backward_on_path(limb, factor.values());
            }
        });
    }

    /// Value of x at a place on the paths.
    pub fn x(&self, place: PivotPlace) -> f64 {
        self.limbs[place.limb].x[place.row]
    }

    /// Computes x = L^-T D^-1 z everywhere; `x` is a vector over the unknowns.
    pub fn end(&mut self, factor: &Factor, x: &mut [f64]) {
        let (threads, branches) = (factor.is_substituted_on_threads(), factor.branches);
        let (of_branches, of_trunks) = self.limbs.split_at_mut(branches);
        let trunks = &factor.limbs[branches..];
        for_each(threads, trunks, of_trunks, |_, trunk, side| {
            side.backward(trunk, factor.values())
        });
        let limbs = &factor.limbs[..branches];
        for_each(threads, limbs, of_branches, |_, limb, side| {
            side.stand_on(limb, of_trunks, branches);
            side.backward(limb, factor.values());
        });
        for (limb, side) in factor.limbs.iter().zip(&self.limbs) {
            for (&unknown, value) in limb.unknowns.iter().zip(&side.x) {
                x[unknown] = *value;
            }
        }
    }
}

/// x <- x + y
fn add(x: &mut [f64], y: &[f64]) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += y);
}

impl LimbVectors {
    /// z <- L^-1 z
    fn forward(&mut self, limb: &LimbFactor, values: &[f64]) {
        let Self { z: x, work, .. } = self;
        let supernodes = 0..limb.supernodes();
        Arch::new().dispatch(Forward {
            limb,
            values,
            supernodes,
            x,
            work,
        });
    }

    /// x <- L^-1 x on the path.
    fn forward_on_path(&mut self, limb: &LimbFactor, values: &[f64]) {
        let Self { x, work, path, .. } = self;
        let supernodes = path.iter().copied();
        Arch::new().dispatch(Forward {
            limb,
            values,
            supernodes,
            x,
            work,
        });
    }

    /// Computes x = L^-T D^-1 z.
    fn backward(&mut self, limb: &LimbFactor, values: &[f64]) {
        let Self { z, x, work, .. } = self;
        let supernodes = 0..limb.supernodes();
        Arch::new().dispatch(Backward {
            limb,
            values,
            supernodes,
            z,
            x,
            work,
        });
    }

    /// Computes x = L^-T D^-1 z for the supernodes on the path.
    fn backward_on_path(&mut self, limb: &LimbFactor, values: &[f64]) {
        let Self {
            z, x, work, path, ..
        } = self;
        let supernodes = path.iter().copied();
        Arch::new().dispatch(Backward {
            limb,
            values,
            supernodes,
            z,
            x,
            work,
        });
    }

    /// Sets x = 0 on the path and in the rows of the trunk.
    fn clear_path(&mut self, limb: &LimbFactor) {
        for &s in &self.path {
            self.x[limb.supernode(s).columns()].fill(0.0);
        }
        self.x[limb.unknowns.len()..].fill(0.0);
    }

    /// z <- z + x on the path.
    fn take_path(&mut self, limb: &LimbFactor) {
        for columns in self.path.iter().map(|&s| limb.supernode(s).columns()) {
            add(&mut self.z[columns.clone()], &self.x[columns]);
        }
    }

    /// Copies x in the rows of the trunk; `above` holds the limbs from `first` on.
    fn stand_on(&mut self, limb: &LimbFactor, above: &[LimbVectors], first: usize) {
        if let Some(trunk) = limb.trunk {
            self.x[limb.unknowns.len()..].copy_from_slice(&above[trunk - first].x);
        }
    }
}

/// x <- L^-1 x for the given supernodes, children before their parents:
///
/// ```text
/// x_i <- x_i - L_ij x_j,   i > j
/// ```
struct Forward<'a, I> {
    limb: &'a LimbFactor,
    /// L and D of all limbs.
    values: &'a [f64],
    supernodes: I,
    x: &'a mut [f64],
    work: &'a mut [f64],
}

impl<I: Iterator<Item = usize>> WithSimd for Forward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            values, x, work, ..
        } = self;
        for s in self.supernodes {
            let node = self.limb.supernode(s);
            let w = &mut work[..node.length() + S::F64_LANES];
            let (own, below) = w.split_at_mut(node.size);
            own.copy_from_slice(&x[node.columns()]);
            below.fill(0.0);
            node.eliminate(simd, values, w);
            let (own, below) = w.split_at(node.size);
            x[node.columns()].copy_from_slice(own);
            node.scatter(below, x);
        }
    }
}

/// x <- L^-T D^-1 z for the given supernodes, which come after all their descendants:
///
/// ```text
/// x_j = z_j/D_jj - sum_i L_ij x_i,   i > j
/// ```
struct Backward<'a, I> {
    limb: &'a LimbFactor,
    /// L and D of all limbs.
    values: &'a [f64],
    supernodes: I,
    z: &'a [f64],
    x: &'a mut [f64],
    work: &'a mut [f64],
}

impl<I: DoubleEndedIterator<Item = usize>> WithSimd for Backward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            values, z, x, work, ..
        } = self;
        for s in self.supernodes.rev() {
            let node = self.limb.supernode(s);
            let w = &mut work[..node.length() + S::F64_LANES];
            let (own, below) = w.split_at_mut(node.size);
            let pivots = &self.limb.pivots(values)[node.columns()];
            for ((w, z), d) in own.iter_mut().zip(&z[node.columns()]).zip(pivots) {
                *w = z / d;
            }
            let (rows, pad) = below.split_at_mut(below.len() - S::F64_LANES);
            pad.fill(0.0);
            node.gather(x, rows);
            node.resolve(simd, values, w);
            x[node.columns()].copy_from_slice(&w[..node.size]);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::linear::SolverChoice;
    use crate::linear::{Assembled, CheckedSolver, Transformation, linear_solver};

    /// A matrix of several grids of n x n nodes that are not connected to each other.
    fn grids(n: usize, count: usize) -> Assembled {
        let index = |grid: usize, i: usize, j: usize| (grid * n + i) * n + j;
        let mut edges = Vec::new();
        for (grid, i, j) in (0..count * n * n).map(|k| (k / (n * n), k / n % n, k % n)) {
            let right = (i + 1 < n).then(|| vec![index(grid, i, j), index(grid, i + 1, j)]);
            let up = (j + 1 < n).then(|| vec![index(grid, i, j), index(grid, i, j + 1)]);
            edges.extend([right, up].into_iter().flatten());
        }
        let mut a = Assembled::new(&Transformation::identity(count * n * n), &edges);
        for edge in 0..edges.len() {
            a.add(edge, &[1.01, -1.0, -1.0, 1.01], 1.0);
        }
        a
    }

    /// A solve in parts gives the same solution as a whole solve.
    fn solution(a: &Assembled, threads: usize) -> Vec<f64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let mut solver = CheckedSolver::new(linear_solver(SolverChoice::Faer), a.clone());
            solver.factorize().unwrap();
            let b: Vec<f64> = (0..a.size()).map(|i| (i * 31 % 17) as f64 - 8.0).collect();
            let (n, mut values) = (a.size(), Vec::new());
            solver.begin(|own| own.clone_from(&b)).unwrap();
            solver.partial(&[n - 1, 3, n / 2, n / 2 + 1], &mut values);
            solver.add(&[(3, values[0]), (n / 2, 5.0)]);
            let x = solver.end().unwrap().to_vec();
            solver.check().unwrap();
            [values, x].concat()
        })
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        for (n, count) in [(220, 1), (160, 2), (20, 90), (2, 900)] {
            let a = grids(n, count);
            let expected = solution(&a, 1);
            for threads in [2, 4] {
                assert!(
                    solution(&a, threads) == expected,
                    "{count} grids, {threads} threads"
                );
            }
        }
    }
}
