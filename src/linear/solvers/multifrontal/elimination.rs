//! Numerical factorisation, front by front from the leaves of the elimination forest to its roots (Duff & Reid
//! 1983), branches side by side. Section 5 of docs/theory.md, Branches.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use sprs::CsMatView;

use super::assembly::{Assembly, Run};
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
struct Fronts {
    front: Front,
    /// What eliminating each supernode has left in the rows below, for its parent: the lower triangle, column by column.
    rests: Vec<Vec<f64>>,
    /// Space of former ones.
    spare: Vec<Vec<f64>>,
}

impl Elimination {
    /// For a factor of matrices with the pattern of `a`.
    pub fn new(factor: &Factor, a: CsMatView<'_, f64>) -> Self {
        let limbs = 0..factor.limbs.len();
        let assembly = |limb| Assembly::new(factor, limb, a);
        Elimination {
            fronts: limbs.clone().map(|_| Fronts::default()).collect(),
            assemblies: match factor.is_factorised_on_threads() {
                true => limbs.into_par_iter().map(assembly).collect(),
                false => limbs.map(assembly).collect(),
            },
        }
    }

    /// The same with memory of its own.
    pub fn again(&self) -> Self {
        Elimination {
            assemblies: self.assemblies.clone(),
            fronts: self.fronts.iter().map(|_| Fronts::default()).collect(),
        }
    }

    /// Writes the factors of a matrix of the pattern with the given entries.
    pub fn eliminate(&mut self, a: &[f64], factor: &mut Factor) {
        let (threads, branches) = (factor.is_factorised_on_threads(), factor.branches);
        let (of_branches, of_trunks) = self.fronts.split_at_mut(branches);
        let mut limbs = factor.limbs_mut();
        let (branch, trunk) = limbs.split_at_mut(branches);
        let (for_branches, for_trunks) = self.assemblies.split_at(branches);
        eliminate(threads, (branch, for_branches, of_branches), (&[], a));
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
        fronts.rests.resize_with(limb.supernodes(), Vec::new);
        for s in 0..limb.supernodes() {
            let (size, length) = (limb.supernode(s).size, limb.supernode(s).length());
            fronts.front.clear(layout, length);
            for &[entry, place] in assembly.entries(s) {
                fronts.front.values[place as usize] = a[entry as usize];
            }
            for (child, runs) in assembly.children(s) {
                match below.get(child.limb) {
                    Some(branch) => fronts.front.add(&branch.rests[child.supernode], runs),
                    None => {
                        let rest = std::mem::take(&mut fronts.rests[child.supernode]);
                        fronts.front.add(&rest, runs);
                        fronts.spare.push(rest);
                    }
                }
            }
            let [values, pivots] = limb.columns_mut(s, l);
            fronts.front.eliminate(simd, size, values, pivots);
            if size < length {
                let mut rest = fronts.spare.pop().unwrap_or_default();
                fronts.front.rest(size, &mut rest);
                let before = std::mem::replace(&mut fronts.rests[s], rest);
                fronts
                    .spare
                    .extend((before.capacity() > 0).then_some(before));
            }
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

    /// Takes the rows and columns from `size` on.
    fn rest(&self, size: usize, rest: &mut Vec<f64>) {
        rest.clear();
        for column in size..self.length {
            let start = column * self.stride;
            rest.extend_from_slice(&self.values[start + column..start + self.length]);
        }
    }
}
