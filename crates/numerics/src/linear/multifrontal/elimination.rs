//! Numerical factorisation, front by front from the leaves of the elimination forest to its roots (Duff & Reid 1983),
//! branches side by side; what is added up in the fronts: entries of the matrix, and what eliminating the supernodes
//! below has left. docs/numerics.md, Factorisation.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use sprs::CsMatView;

use super::factor::{Entries, Factor, LimbFactor, PivotPlace};
use super::front::Front;
use super::supernodes::Layout;

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
    /// column, at the places of [`UpdateStack`].
    stack: Entries,
}

impl Elimination {
    /// For a factor of matrices with the pattern of `a`.
    pub fn new(factor: &Factor, a: CsMatView<'_, f64>) -> Self {
        let limbs = 0..factor.limbs.len();
        let stacks: Vec<UpdateStack> = factor.limbs.iter().map(UpdateStack::new).collect();
        let assembly = |limb| Assembly::new(factor, limb, a, &stacks);
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
            fronts.stack.make_room(assembly.stack_height());
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
                let stack = below.get(child.limb).map_or(&fronts.stack, |f| &f.stack);
                fronts.front.add(&stack[child.update..], runs);
            }
            let [values, pivots] = limb.columns_mut(s, l);
            fronts.front.eliminate(simd, size, values, pivots);
            fronts
                .front
                .store_update(size, &mut fronts.stack[assembly.update(s)..]);
        }
    }
}

impl Front {
    /// Adds what eliminating a child has left.
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

    /// Writes the rows and columns from `size` on.
    fn store_update(&self, size: usize, mut update: &mut [f64]) {
        for column in size..self.length {
            let own = &self.values[column * self.stride..][column..self.length];
            update[..own.len()].copy_from_slice(own);
            update = &mut update[own.len()..];
        }
    }
}

/// What goes into the fronts of the supernodes of a limb.
#[derive(Debug, Default, Clone)]
pub struct Assembly {
    /// Of every entry of the matrix its place there and that in the front; supernode by supernode.
    entries: Vec<[u32; 2]>,
    /// End of the entries of every supernode.
    entry_ends: Vec<usize>,
    children: Vec<Child>,
    /// End of the children of every supernode.
    child_ends: Vec<usize>,
    runs: Vec<ConsecutiveRows>,
    stack: UpdateStack,
}

/// Places of the update matrices (contribution blocks) that eliminating the supernodes of a limb in postorder leaves: a
/// stack, from which a supernode takes those of its children before it leaves its own.
#[derive(Debug, Default, Clone)]
pub struct UpdateStack {
    /// First entry of the update matrix of every supernode.
    starts: Vec<usize>,
    /// Entries of the highest stack.
    height: usize,
}

/// A supernode whose update matrix is added to a front.
#[derive(Debug, Clone, Copy)]
pub struct Child {
    pub limb: usize,
    /// First entry of its update matrix in the stack of the limb.
    pub update: usize,
    /// End of its runs, which begin where those of the child before end.
    end: usize,
}

/// Rows below a supernode that are next to each other in the front of its parent, too.
#[derive(Debug, Clone, Copy)]
pub struct ConsecutiveRows {
    /// First row in the front.
    pub row: usize,
    /// Number of rows.
    pub length: usize,
}

impl Assembly {
    /// For a limb of a factor of matrices with the pattern of `a`; `stacks` are those of all limbs.
    pub fn new(
        factor: &Factor,
        number: usize,
        a: CsMatView<'_, f64>,
        stacks: &[UpdateStack],
    ) -> Self {
        let limb = &factor.limbs[number];
        let layout = Layout::of_processor();
        let mut assembly = Assembly {
            stack: stacks[number].clone(),
            ..Assembly::default()
        };
        let mut at = vec![None; limb.length];
        let columns = limb
            .unknowns
            .iter()
            .map(|&unknown| a.indptr().nnz_in_outer_sz(unknown));
        assembly.entries.reserve(columns.sum());
        for (s, children) in children(factor, number).into_iter().enumerate() {
            let node = limb.supernode(s);
            let rows: Vec<usize> = node.columns().chain(node.rows_below()).collect();
            rows.iter()
                .zip(0..)
                .for_each(|(&row, place)| at[row] = Some(place));
            let stride = layout.stride(rows.len());
            for (column, &unknown) in limb.unknowns[node.columns()].iter().enumerate() {
                for entry in a.indptr().outer_inds_sz(unknown) {
                    let place = factor.places[a.indices()[entry]];
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
        assembly
    }

    /// Adds a child, with its update matrix, of a supernode of limb `own` whose rows are `at` these places of the front.
    fn push(
        &mut self,
        factor: &Factor,
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

    /// Entries of the matrix for a supernode: place there and in the front.
    pub fn entries(&self, s: usize) -> &[[u32; 2]] {
        &self.entries[start(&self.entry_ends, s)..self.entry_ends[s]]
    }

    /// First entry of the update matrix of a supernode.
    pub fn update(&self, s: usize) -> usize {
        self.stack.starts[s]
    }

    /// Entries of the highest stack of update matrices.
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
    /// Stack of the updates of a limb.
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

/// Start of a list, given the ends of all.
fn start(ends: &[usize], k: usize) -> usize {
    k.checked_sub(1).map_or(0, |k| ends[k])
}

/// Children of every supernode of a limb, by limb and number.
fn children(factor: &Factor, number: usize) -> Vec<Vec<(usize, usize)>> {
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
    /// Row of the limb, whose number is given, at a place; none if it is not in it or its trunk.
    fn row(&self, number: usize, place: PivotPlace) -> Option<usize> {
        match self.trunk {
            _ if place.limb == number => Some(place.row),
            Some(trunk) if place.limb == trunk => Some(self.unknowns.len() + place.row),
            _ => None,
        }
    }
}
