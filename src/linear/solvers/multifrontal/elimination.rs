//! Numerical factorisation, front by front from the leaves of the elimination forest to its roots (Duff & Reid
//! 1983), branches side by side. Section 5 of docs/theory.md, Branches.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use sprs::CsMatView;

use super::assembly::{Assembly, Rests, Run};
use super::entries::Entries;
use super::factor::{Factor, LimbFactor};
use super::front::Front;
use super::supernode::Layout;

/// A limb with its part of L.
type OwnFactor<'a> = (&'a mut LimbFactor, &'a mut [f64]);

/// What the factorisation of matrices of one pattern goes through.
#[derive(Debug, Default)]
pub struct Elimination {
    assemblies: Vec<Assembly>,
    fronts: Vec<Fronts>,
}

/// Space for the fronts of a limb.
#[derive(Debug, Default)]
pub struct Fronts {
    front: Front,
    /// What eliminating supernodes has left in the rows below, for their parents: the lower triangles, column by
    /// column, at the places of [`Rests`].
    rests: Entries,
}

impl Elimination {
    /// For a factor of matrices with the pattern of `a`.
    pub fn new(factor: &Factor, a: CsMatView<'_, f64>) -> Self {
        let limbs = 0..factor.limbs.len();
        let rests: Vec<Rests> = factor.limbs.iter().map(Rests::new).collect();
        let assembly = |limb| Assembly::new(factor, limb, a, &rests);
        Elimination {
            fronts: Vec::new(),
            assemblies: match factor.is_factorised_on_threads() {
                true => limbs.into_par_iter().map(assembly).collect(),
                false => limbs.map(assembly).collect(),
            },
        }
    }

    /// The memory of its fronts.
    pub fn into_fronts(self) -> Vec<Fronts> {
        self.fronts
    }

    /// Uses the memory of former fronts, as far as it is enough.
    pub fn use_fronts(&mut self, fronts: Vec<Fronts>) {
        self.fronts = fronts;
    }

    /// Makes room for the fronts of all limbs.
    fn make_room(&mut self, factor: &Factor) {
        (self.fronts).resize_with(factor.limbs.len(), Fronts::default);
        let of_limbs = factor.limbs.iter().zip(&self.assemblies);
        for (fronts, (limb, assembly)) in self.fronts.iter_mut().zip(of_limbs) {
            fronts.front.make_room(limb.longest);
            fronts.rests.make_room(assembly.height_of_rests());
        }
    }

    /// The same with memory of its own.
    pub fn again(&self) -> Self {
        Elimination {
            assemblies: self.assemblies.clone(),
            fronts: Vec::new(),
        }
    }

    /// Writes the factors of a matrix of the pattern with the given entries.
    pub fn eliminate(&mut self, a: &[f64], factor: &mut Factor) {
        self.make_room(factor);
        let (threads, branches) = (factor.is_factorised_on_threads(), factor.branches);
        let (of_branches, of_trunks) = self.fronts.split_at_mut(branches);
        let mut limbs = factor.limbs_mut();
        let (branch, trunk) = limbs.split_at_mut(branches);
        let (for_branches, for_trunks) = self.assemblies.split_at(branches);
        eliminate(threads, (branch, for_branches, of_branches), (&[], a));
        for fronts in &mut *of_trunks {
            fronts.front.on_threads = threads;
        }
        eliminate(threads, (trunk, for_trunks, of_trunks), (of_branches, a));
    }
}

/// Factorises some limbs, on threads if it is worth them; `below` are the fronts of the branches.
fn eliminate(
    threads: bool,
    (limbs, assemblies, fronts): (&mut [OwnFactor], &[Assembly], &mut [Fronts]),
    (below, a): (&[Fronts], &[f64]),
) {
    let of_limb = |((own, assembly), fronts): ((&mut OwnFactor, &Assembly), &mut Fronts)| {
        let (limb, l) = own;
        Arch::new().dispatch(OfLimb {
            limb,
            l,
            assembly,
            fronts,
            below,
            a,
        });
    };
    if threads {
        let all = limbs.par_iter_mut().zip(assemblies).zip(fronts);
        all.with_max_len(1).for_each(of_limb);
        return;
    }
    limbs
        .iter_mut()
        .zip(assemblies)
        .zip(fronts)
        .for_each(of_limb);
}

/// The factorisation of a limb.
struct OfLimb<'a> {
    limb: &'a mut LimbFactor,
    /// L of the limb.
    l: &'a mut [f64],
    assembly: &'a Assembly,
    fronts: &'a mut Fronts,
    /// Those of the branches, for a trunk.
    below: &'a [Fronts],
    /// Entries of the matrix.
    a: &'a [f64],
}

impl WithSimd for OfLimb<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            limb,
            l,
            assembly,
            fronts,
            below,
            a,
        } = self;
        let layout = Layout {
            lanes: S::F64_LANES,
        };
        for s in 0..limb.supernodes() {
            let (size, length) = (limb.supernode(s).size, limb.supernode(s).length());
            fronts.front.clear(layout, length);
            for &[entry, place] in assembly.entries(s) {
                fronts.front.values[place as usize] = a[entry as usize];
            }
            for (child, runs) in assembly.children(s) {
                let rests = below.get(child.limb).map_or(&fronts.rests, |f| &f.rests);
                fronts.front.add(&rests[child.rest..], runs);
            }
            let [values, pivots] = limb.columns_mut(s, l);
            fronts.front.eliminate(simd, size, values, pivots);
            fronts
                .front
                .rest(size, &mut fronts.rests[assembly.rest(s)..]);
        }
    }
}

impl Front {
    /// Adds what eliminating a child has left.
    #[inline(always)]
    fn add(&mut self, rest: &[f64], runs: &[Run]) {
        let mut rest = rest;
        for (k, run) in runs.iter().enumerate() {
            for column in run.row..run.row + run.length {
                let to = &mut self.values[column * self.stride..(column + 1) * self.stride];
                let own = Run {
                    row: column,
                    length: run.row + run.length - column,
                };
                for run in std::iter::once(&own).chain(&runs[k + 1..]) {
                    let from;
                    (from, rest) = rest.split_at(run.length);
                    let to = &mut to[run.row..run.row + run.length];
                    to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
                }
            }
        }
    }

    /// Writes the rows and columns from `size` on.
    fn rest(&self, size: usize, mut rest: &mut [f64]) {
        for column in size..self.length {
            let own = &self.values[column * self.stride..][column..self.length];
            rest[..own.len()].copy_from_slice(own);
            rest = &mut rest[own.len()..];
        }
    }
}
