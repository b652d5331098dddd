//! What is added up in the fronts of a limb: entries of the matrix, and what eliminating the supernodes below has
//! left. Section 5 of docs/theory.md, Branches.

use sprs::CsMatView;

use super::factor::{Factor, LimbFactor, Place};
use super::supernode::Layout;

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
    runs: Vec<Run>,
    rests: Rests,
}

/// Places of what eliminating the supernodes of a limb leaves, in its memory: a stack, from which a supernode takes
/// its children before it leaves its own rest.
#[derive(Debug, Default, Clone)]
pub struct Rests {
    /// First entry of the rest of every supernode.
    starts: Vec<usize>,
    /// Entries of the highest stack.
    height: usize,
}

/// A supernode whose rest goes to a front.
#[derive(Debug, Clone, Copy)]
pub struct Child {
    pub limb: usize,
    /// First entry of its rest in the memory of the limb.
    pub rest: usize,
    /// End of its runs, which begin where those of the child before end.
    end: usize,
}

/// Rows below a supernode that are next to each other in the front of its parent, too.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    /// First row in the front.
    pub row: usize,
    /// Number of rows.
    pub length: usize,
}

impl Assembly {
    /// For a limb of a factor of matrices with the pattern of `a`; `rests` are those of all limbs.
    pub fn new(factor: &Factor, number: usize, a: CsMatView<'_, f64>, rests: &[Rests]) -> Self {
        let limb = &factor.limbs[number];
        let layout = Layout::of_processor();
        let mut assembly = Assembly {
            rests: rests[number].clone(),
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
                let rest = rests[limb].starts[supernode];
                assembly.push(factor, [number, limb, supernode], rest, &at);
            }
            assembly.child_ends.push(assembly.children.len());
            rows.iter().for_each(|&row| at[row] = None);
        }
        assembly
    }

    /// Adds a child, with its rest, of a supernode of limb `own` whose rows are `at` these places of the front.
    fn push(
        &mut self,
        factor: &Factor,
        [own, limb, supernode]: [usize; 3],
        rest: usize,
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
                _ => self.runs.push(Run { row, length: 1 }),
            }
        }
        let end = self.runs.len();
        self.children.push(Child { limb, rest, end });
    }

    /// Entries of the matrix for a supernode: place there and in the front.
    pub fn entries(&self, s: usize) -> &[[u32; 2]] {
        &self.entries[start(&self.entry_ends, s)..self.entry_ends[s]]
    }

    /// First entry of the rest of a supernode.
    pub fn rest(&self, s: usize) -> usize {
        self.rests.starts[s]
    }

    /// Entries of the memory for rests.
    pub fn height_of_rests(&self) -> usize {
        self.rests.height
    }

    /// Children of a supernode with their runs.
    pub fn children(&self, s: usize) -> impl Iterator<Item = (Child, &[Run])> {
        let range = start(&self.child_ends, s)..self.child_ends[s];
        range.map(|k| {
            let start = k.checked_sub(1).map_or(0, |k| self.children[k].end);
            let child = self.children[k];
            (child, &self.runs[start..child.end])
        })
    }
}

impl Rests {
    /// Those of a limb.
    pub fn new(limb: &LimbFactor) -> Self {
        let (mut rests, mut stack) = (Rests::default(), Vec::<(Option<usize>, usize)>::new());
        for s in 0..limb.supernodes() {
            while stack.last().is_some_and(|(parent, _)| *parent == Some(s)) {
                stack.pop();
            }
            let node = limb.supernode(s);
            let start = stack.last().map_or(0, |(_, end)| *end);
            let (first, length) = (node.rows_below().next(), node.length() - node.size);
            let own = first.filter(|&row| row < limb.unknowns.len());
            let end = start + length * (length + 1) / 2;
            rests.starts.push(start);
            rests.height = rests.height.max(end);
            stack.push((own.map(|row| limb.supernode_of(row)), end));
        }
        rests
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
                    Some(limb) if row >= of_child.unknowns.len() => Place {
                        limb,
                        row: row - of_child.unknowns.len(),
                    },
                    _ => Place { limb: below, row },
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
    fn row(&self, number: usize, place: Place) -> Option<usize> {
        match self.trunk {
            _ if place.limb == number => Some(place.row),
            Some(trunk) if place.limb == trunk => Some(self.unknowns.len() + place.row),
            _ => None,
        }
    }
}
