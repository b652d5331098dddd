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
}

/// A supernode whose rest goes to a front.
#[derive(Debug, Clone, Copy)]
pub struct Child {
    pub limb: usize,
    /// Its number in the limb.
    pub supernode: usize,
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
    /// For a limb of a factor of matrices with the pattern of `a`.
    pub fn new(factor: &Factor, number: usize, a: CsMatView<'_, f64>) -> Self {
        let limb = &factor.limbs[number];
        let layout = Layout::of_processor();
        let (mut assembly, mut at) = (Assembly::default(), vec![None; limb.length]);
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
                assembly.push(factor, [number, limb, supernode], &at);
            }
            assembly.child_ends.push(assembly.children.len());
            rows.iter().for_each(|&row| at[row] = None);
        }
        assembly
    }

    /// Adds a child of a supernode of limb `own` whose rows are `at` these places of the front.
    fn push(&mut self, factor: &Factor, [own, limb, supernode]: [usize; 3], at: &[Option<usize>]) {
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
        self.children.push(Child {
            limb,
            supernode,
            end,
        });
    }

    /// Entries of the matrix for a supernode: place there and in the front.
    pub fn entries(&self, s: usize) -> &[[u32; 2]] {
        &self.entries[start(&self.entry_ends, s)..self.entry_ends[s]]
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
