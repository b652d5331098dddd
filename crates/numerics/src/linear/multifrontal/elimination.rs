//! Numerical factorisation, front by front from the leaves of the elimination forest to its roots (Duff & Reid 1983);
//! branches are independent of each other. A front is the sum of entries of the matrix and of the update matrices of
//! the supernodes below. docs/numerics.md, Factorisation.

use std::sync::{Mutex, PoisonError};

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::factor::{Entries, Factor, FactorLayout, LimbFactor, PivotPlace};
use super::front::Front;
use super::supernodes::Layout;
use crate::linear::symmetric::Pattern;

/// A limb (branch or trunk) with its part of L and D.
type OwnFactor<'a> = (&'a LimbFactor, &'a mut [f64]);

/// The steps by which all matrices of one pattern are factorised.
#[derive(Debug, Default)]
pub struct Elimination {
    assemblies: Vec<Assembly>,
}

/// Memory that successive factorisations share.
#[derive(Debug, Default)]
pub struct FrontSpace {
    /// Fronts that no thread uses at present.
    fronts: Mutex<Vec<Front>>,
    /// For every limb the update matrices of its supernodes, for their parents: lower triangles, column by column, at
    /// the places of [`UpdateStack`].
    stacks: Vec<Entries>,
}

impl FrontSpace {
    /// Calls `action` with a front, which is free again afterwards.
    fn with_front(fronts: &Mutex<Vec<Front>>, action: impl FnOnce(&mut Front)) {
        let all = || fronts.lock().unwrap_or_else(PoisonError::into_inner);
        let own = all().pop();
        let mut front = own.unwrap_or_default();
        action(&mut front);
        all().push(front);
    }
}

impl Elimination {
    /// The steps for the factors of matrices with a pattern.
    pub fn new(factor: &FactorLayout, pattern: &Pattern) -> Self {
        let limbs = 0..factor.limbs.len();
        let stacks: Vec<UpdateStack> = factor.limbs.iter().map(UpdateStack::new).collect();
        let assembly = |limb| Assembly::new(factor, limb, pattern, &stacks);
        Elimination {
            assemblies: match factor.is_factorised_on_threads() {
                true => limbs.into_par_iter().map(assembly).collect(),
                false => limbs.map(assembly).collect(),
            },
        }
    }

    /// Writes the factors of a matrix of the pattern with the given entries.
    pub fn eliminate(&self, a: &[f64], factor: &mut Factor, space: &mut FrontSpace) {
        let FrontSpace { fronts, stacks } = space;
        stacks.resize_with(factor.limbs.len(), Entries::default);
        for (stack, assembly) in stacks.iter_mut().zip(&self.assemblies) {
            stack.make_room(assembly.stack_height());
        }
        let (threads, branches) = (factor.is_factorised_on_threads(), factor.branches);
        let (of_branches, of_trunks) = stacks.split_at_mut(branches);
        let mut limbs = factor.limbs_mut();
        let (branch, trunk) = limbs.split_at_mut(branches);
        let (for_branches, for_trunks) = self.assemblies.split_at(branches);
        let mut with = Common {
            fronts,
            on_threads: false,
            below: &[],
            a,
        };
        eliminate(threads, (branch, for_branches, of_branches), &with);
        (with.on_threads, with.below) = (threads, of_branches);
        eliminate(threads, (trunk, for_trunks, of_trunks), &with);
    }
}

/// Data that the factorisations of all limbs share.
struct Common<'a> {
    fronts: &'a Mutex<Vec<Front>>,
    /// Whether several threads may change columns of one front.
    on_threads: bool,
    /// Stacks of the branches, for trunks.
    below: &'a [Entries],
    /// Entries of the matrix.
    a: &'a [f64],
}

/// Factorises some limbs, on several threads if `threads` is true.
fn eliminate(
    threads: bool,
    (limbs, assemblies, stacks): (&mut [OwnFactor], &[Assembly], &mut [Entries]),
    with: &Common,
) {
    let of_limb = |((own, assembly), stack): ((&mut OwnFactor, &Assembly), &mut Entries)| {
        let (limb, values) = own;
        FrontSpace::with_front(with.fronts, |front| {
            front.make_room(limb.longest);
            front.on_threads = with.on_threads;
            Arch::new().dispatch(OfLimb {
                limb,
                values,
                assembly,
                front,
                stack,
                below: with.below,
                a: with.a,
            });
        });
    };
    if threads {
        let all = limbs.par_iter_mut().zip(assemblies).zip(stacks);
        all.with_max_len(1).for_each(of_limb);
        return;
    }
    limbs
        .iter_mut()
        .zip(assemblies)
        .zip(stacks)
        .for_each(of_limb);
}

/// The factorisation of a limb.
struct OfLimb<'a> {
    limb: &'a LimbFactor,
    /// L and D of the limb.
    values: &'a mut [f64],
    assembly: &'a Assembly,
    front: &'a mut Front,
    stack: &'a mut [f64],
    /// Stacks of the branches, which a trunk needs.
    below: &'a [Entries],
    /// Entries of the matrix.
    a: &'a [f64],
}

impl WithSimd for OfLimb<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            limb,
            values: own,
            assembly,
            front,
            stack,
            below,
            a,
        } = self;
        let layout = Layout {
            lanes: S::F64_LANES,
        };
        for s in 0..limb.supernodes() {
            let (size, length) = (limb.supernode(s).size, limb.supernode(s).length());
            front.clear(layout, length);
            for &[entry, place] in assembly.entries(s) {
                front.values[place as usize] = a[entry as usize];
            }
            for (child, runs) in assembly.children(s) {
                let stack = below.get(child.limb).map_or(&*stack, |stack| stack);
                front.add(&stack[child.update..], runs);
            }
            let [values, pivots] = limb.columns_mut(s, own);
            front.eliminate(simd, size, values, pivots);
            front.store_update(size, &mut stack[assembly.update(s)..]);
        }
    }
}

impl Front {
    /// Adds the update matrix of a child.
    #[inline(always)]
    fn add(&mut self, update: &[f64], runs: &[ConsecutiveRows]) {
        let mut rest = update;
        for (k, run) in runs.iter().enumerate() {
            for column in run.row..run.row + run.length {
                let to = &mut self.values[column * self.stride..(column + 1) * self.stride];
                let own = ConsecutiveRows {
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

    /// Writes the rows and columns from `size` on as the update matrix.
    fn store_update(&self, size: usize, mut update: &mut [f64]) {
        for column in size..self.length {
            let own = &self.values[column * self.stride..][column..self.length];
            update[..own.len()].copy_from_slice(own);
            update = &mut update[own.len()..];
        }
    }
}

/// The entries and update matrices that are added to the fronts of the supernodes of a limb.
#[derive(Debug, Default)]
pub struct Assembly {
    /// For every entry of the matrix, its place in the matrix and its place in the front, supernode by supernode.
    entries: Vec<[u32; 2]>,
    /// End of the list of entries of every supernode.
    entry_ends: Vec<usize>,
    children: Vec<Child>,
    /// End of the list of children of every supernode.
    child_ends: Vec<usize>,
    runs: Vec<ConsecutiveRows>,
    stack: UpdateStack,
}

/// Places of the update matrices (contribution blocks) of the supernodes of a limb in postorder. The update matrices
/// form a stack: a supernode removes those of its children before it adds its own.
#[derive(Debug, Default, Clone)]
pub struct UpdateStack {
    /// First entry of the update matrix of every supernode.
    starts: Vec<usize>,
    /// Number of entries of the stack at its highest.
    height: usize,
}

/// A supernode whose update matrix is added to a front.
#[derive(Debug, Clone, Copy)]
pub struct Child {
    pub limb: usize,
    /// First entry of the update matrix of the child in the stack of its limb.
    pub update: usize,
    /// End of the runs of the child, which begin where those of the child before end.
    end: usize,
}

/// Consecutive rows below a supernode that are also consecutive in the front of its parent.
#[derive(Debug, Clone, Copy)]
pub struct ConsecutiveRows {
    /// First row in the front.
    pub row: usize,
    /// Number of rows.
    pub length: usize,
}

impl Assembly {
    /// The assembly of a limb of the factors, for matrices with a pattern; `stacks` holds the stacks of all limbs.
    pub fn new(
        factor: &FactorLayout,
        number: usize,
        pattern: &Pattern,
        stacks: &[UpdateStack],
    ) -> Self {
        let limb = &factor.limbs[number];
        let layout = Layout::of_processor();
        let mut assembly = Assembly {
            stack: stacks[number].clone(),
            ..Assembly::default()
        };
        let mut at = vec![None; limb.length];
        for (s, children) in children(factor, number).into_iter().enumerate() {
            let node = limb.supernode(s);
            let rows: Vec<usize> = node.columns().chain(node.rows_below()).collect();
            rows.iter()
                .zip(0..)
                .for_each(|(&row, place)| at[row] = Some(place));
            let stride = layout.stride(rows.len());
            for (column, &unknown) in limb.unknowns[node.columns()].iter().enumerate() {
                for (entry, &row) in pattern.column(unknown).zip(pattern.rows(unknown)) {
                    let place = factor.places[row as usize];
                    if let Some(row) = limb.row(number, place)
                        && let Some(row) = at[row].filter(|&row| row >= column)
                    {
                        let in_front = column * stride + row;
                        assembly.entries.push([entry as u32, in_front as u32]);
                    }
                }
            }
            assembly.entry_ends.push(assembly.entries.len());
            for (limb, supernode) in children {
                let update = stacks[limb].starts[supernode];
                assembly.push(factor, [number, limb, supernode], update, &at);
            }
            assembly.child_ends.push(assembly.children.len());
            rows.iter().for_each(|&row| at[row] = None);
        }
        assembly.entries.shrink_to_fit();
        assembly.runs.shrink_to_fit();
        assembly
    }

    /// Adds a child to a supernode of limb `own`; `at` gives the places of rows in the front of this supernode.
    fn push(
        &mut self,
        factor: &FactorLayout,
        [own, limb, supernode]: [usize; 3],
        update: usize,
        at: &[Option<usize>],
    ) {
        let of_child = &factor.limbs[limb];
        let skipped = if own == limb {
            0
        } else {
            of_child.unknowns.len()
        };
        let first_run = self.runs.len();
        for row in of_child.supernode(supernode).rows_below() {
            let Some(row) = at[row - skipped] else {
                continue;
            };
            match self.runs[first_run..].last_mut() {
                Some(run) if run.row + run.length == row => run.length += 1,
                _ => self.runs.push(ConsecutiveRows { row, length: 1 }),
            }
        }
        let end = self.runs.len();
        self.children.push(Child { limb, update, end });
    }

    /// Entries of the matrix for a supernode, each with its place in the matrix and its place in the front.
    pub fn entries(&self, s: usize) -> &[[u32; 2]] {
        &self.entries[start(&self.entry_ends, s)..self.entry_ends[s]]
    }

    /// First entry of the update matrix of a supernode.
    pub fn update(&self, s: usize) -> usize {
        self.stack.starts[s]
    }

    /// Number of entries of the stack of update matrices at its highest.
    pub fn stack_height(&self) -> usize {
        self.stack.height
    }

    /// Children of a supernode with their runs.
    pub fn children(&self, s: usize) -> impl Iterator<Item = (Child, &[ConsecutiveRows])> {
        let range = start(&self.child_ends, s)..self.child_ends[s];
        range.map(|k| {
            let start = k.checked_sub(1).map_or(0, |k| self.children[k].end);
            let child = self.children[k];
            (child, &self.runs[start..child.end])
        })
    }
}

impl UpdateStack {
    /// The stack of the update matrices of a limb.
    pub fn new(limb: &LimbFactor) -> Self {
        let (mut updates, mut stack) =
            (UpdateStack::default(), Vec::<(Option<usize>, usize)>::new());
        for s in 0..limb.supernodes() {
            while stack.last().is_some_and(|(parent, _)| *parent == Some(s)) {
                stack.pop();
            }
            let node = limb.supernode(s);
            let start = stack.last().map_or(0, |(_, end)| *end);
            let (first, length) = (node.rows_below().next(), node.length() - node.size);
            let own = first.filter(|&row| row < limb.unknowns.len());
            let end = start + length * (length + 1) / 2;
            updates.starts.push(start);
            updates.height = updates.height.max(end);
            stack.push((own.map(|row| limb.supernode_of(row)), end));
        }
        updates
    }
}

/// Start of list `k`, given the ends of all lists.
fn start(ends: &[usize], k: usize) -> usize {
    k.checked_sub(1).map_or(0, |k| ends[k])
}

/// Children of every supernode of a limb, given by their limb and number.
fn children(factor: &FactorLayout, number: usize) -> Vec<Vec<(usize, usize)>> {
    let limb = &factor.limbs[number];
    let mut children = vec![Vec::new(); limb.supernodes()];
    for (below, of_child) in factor.limbs.iter().enumerate() {
        if below != number && of_child.trunk != Some(number) {
            continue;
        }
        for s in 0..of_child.supernodes() {
            if let Some(row) = of_child.supernode(s).rows_below().next() {
                let place = match of_child.trunk {
                    Some(limb) if row >= of_child.unknowns.len() => PivotPlace {
                        limb,
                        row: row - of_child.unknowns.len(),
                    },
                    _ => PivotPlace { limb: below, row },
                };
                if place.limb == number {
                    children[limb.supernode_of(place.row)].push((below, s));
                }
            }
        }
    }
    children
}

impl LimbFactor {
    /// Row of this limb, which has the given number, at a place; `None` if the place is neither in this limb nor in its
    /// trunk.
    fn row(&self, number: usize, place: PivotPlace) -> Option<usize> {
        match self.trunk {
            _ if place.limb == number => Some(place.row),
            Some(trunk) if place.limb == trunk => Some(self.unknowns.len() + place.row),
            _ => None,
        }
    }
}
