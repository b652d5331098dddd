//! LDL^T factors by limbs (branches and trunks of the elimination forest), packed in the order in which substitutions
//! read them. The memory has large pages if the system has them, because substitutions read the entries from one end to
//! the other, and a processor reads ahead only within a page. See docs/numerics.md, Order in memory.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use bytemuck::{cast_slice, cast_slice_mut};
use memmap2::MmapMut;
use rayon::prelude::*;

use crate::system::in_large_pages;

use super::supernodes::{Layout, Limb, Supernode, Supernodes, cut};

/// Smallest number of entries of L for which a factorisation uses several threads; that for a substitution follows.
const FACTORISATION: usize = 200_000;
const SUBSTITUTION: usize = 800_000;

/// Place of the unknown of a pivot.
#[derive(Debug, Clone, Copy, Default)]
pub struct PivotPlace {
    /// Limb (branch or trunk) of the pivot.
    pub limb: usize,
    /// Row of the pivot in the limb.
    pub row: usize,
}

/// Place and shape of a supernode of a limb.
#[derive(Debug, Clone, Copy)]
struct Spot {
    start: u32,
    size: u32,
    is_of_twos: bool,
    /// First entry of the supernode in the rows of the limb.
    rows: usize,
    /// First entry of the supernode among those of the limb.
    entries: usize,
}

/// Places of the columns of L and D of a branch or a trunk. The rows of a branch are its own rows, followed by those of
/// the trunk that it stands on.
#[derive(Debug, Default)]
pub struct LimbFactor {
    /// Unknowns of the own rows.
    pub unknowns: Vec<usize>,
    /// The trunk of a branch, by its number among the limbs.
    pub trunk: Option<usize>,
    /// Number of rows: own rows and those of the trunk.
    pub length: usize,
    /// Number of rows of the longest supernode.
    pub longest: usize,
    spots: Vec<Spot>,
    rows: Vec<u32>,
    /// Number of entries of L, which the entries of D follow; `first` is the beginning of L among the entries of all
    /// limbs, which begins a line of the cache.
    entries: usize,
    first: usize,
}

/// What the factors of all matrices of one pattern have in common.
#[derive(Debug, Default)]
pub struct FactorLayout {
    /// Branches, then trunks.
    pub limbs: Vec<LimbFactor>,
    /// Number of branches.
    pub branches: usize,
    /// Place of every unknown.
    pub places: Vec<PivotPlace>,
    /// Number of entries of L.
    entries: usize,
}

/// Factors of a matrix.
#[derive(Debug, Default)]
pub struct Factor {
    layout: Arc<FactorLayout>,
    /// L and D, limb by limb.
    values: Entries,
}

impl Deref for Factor {
    type Target = FactorLayout;

    fn deref(&self) -> &FactorLayout {
        &self.layout
    }
}

/// Places in the limbs of all pivots, in the order of elimination.
struct PivotPlaces {
    of_pivots: Vec<PivotPlace>,
    /// Number of own rows of every limb.
    sizes: Vec<usize>,
}

impl FactorLayout {
    /// The layout of the factors of analysed matrices; `unknowns` holds the unknown of every pivot.
    pub fn new(supernodes: &Supernodes, unknowns: &[usize]) -> Self {
        let all = 0..supernodes.count();
        let work: Vec<usize> = all.map(|s| supernodes.entries(s)).collect();
        let (limbs, branches) = cut(&supernodes.parents(), &work);
        let in_limbs = PivotPlaces::new(supernodes, &limbs, unknowns.len());
        let mut places = vec![PivotPlace::default(); unknowns.len()];
        for (&unknown, place) in unknowns.iter().zip(&in_limbs.of_pivots) {
            places[unknown] = *place;
        }
        let mut layout = FactorLayout {
            limbs: Vec::new(),
            branches,
            places,
            entries: work.iter().sum(),
        };
        let of_limb = |number| in_limbs.factor(supernodes, unknowns, (number, &limbs));
        let all = 0..limbs.len();
        layout.limbs = match layout.is_factorised_on_threads() {
            true => all.into_par_iter().map(of_limb).collect(),
            false => all.map(of_limb).collect(),
        };
        let mut entries = 0;
        for limb in &mut layout.limbs {
            limb.first = entries;
            entries += limb.room();
        }
        layout
    }

    /// Whether a factorisation uses threads: there are several, and L has enough entries.
    pub fn is_factorised_on_threads(&self) -> bool {
        self.is_worth_threads(FACTORISATION)
    }

    /// Whether a substitution uses threads: there are several, and L has enough entries.
    pub fn is_substituted_on_threads(&self) -> bool {
        self.is_worth_threads(SUBSTITUTION)
    }

    fn is_worth_threads(&self, least: usize) -> bool {
        self.entries >= least && self.branches > 1 && rayon::current_num_threads() > 1
    }
}

impl Factor {
    /// Room for factors, in the memory of former ones as far as it is enough.
    pub fn new(layout: Arc<FactorLayout>, mut memory: Entries) -> Self {
        memory.make_room(layout.limbs.iter().map(LimbFactor::room).sum());
        Factor {
            layout,
            values: memory,
        }
    }

    /// The memory of factors that are given up.
    pub fn into_memory(self) -> Entries {
        self.values
    }

    /// L and D of all limbs, for their supernodes.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The limbs, each with its part of L and D.
    pub fn limbs_mut(&mut self) -> Vec<(&LimbFactor, &mut [f64])> {
        let (mut of_limbs, mut rest) = (Vec::new(), &mut *self.values);
        for limb in &self.layout.limbs {
            let own;
            (own, rest) = rest.split_at_mut(limb.room());
            of_limbs.push((limb, own));
        }
        of_limbs
    }

    /// Entries of D, each with its unknown.
    pub fn pivots(&self) -> impl Iterator<Item = (usize, f64)> {
        self.limbs.iter().flat_map(|limb| {
            let pivots = limb.unknowns.iter().zip(limb.pivots(&self.values));
            pivots.map(|(&unknown, &pivot)| (unknown, pivot))
        })
    }
}

impl PivotPlaces {
    fn new(supernodes: &Supernodes, limbs: &[Limb], unknowns: usize) -> Self {
        let mut of_pivots = vec![PivotPlace::default(); unknowns];
        let mut sizes = Vec::new();
        for (number, limb) in limbs.iter().enumerate() {
            let mut rows = 0..;
            for &s in &limb.supernodes {
                for (place, row) in of_pivots[supernodes.columns(s)].iter_mut().zip(&mut rows) {
                    *place = PivotPlace { limb: number, row };
                }
            }
            sizes.push(rows.start);
        }
        PivotPlaces { of_pivots, sizes }
    }

    /// The places of the factors of a limb.
    fn factor(
        &self,
        supernodes: &Supernodes,
        unknowns: &[usize],
        (number, limbs): (usize, &[Limb]),
    ) -> LimbFactor {
        let (limb, own) = (&limbs[number], self.sizes[number]);
        let mut factor = LimbFactor {
            trunk: limb.trunk,
            length: own + limb.trunk.map_or(0, |trunk| self.sizes[trunk]),
            ..LimbFactor::default()
        };
        let row = |&pivot: &usize| match self.of_pivots[pivot] {
            PivotPlace { limb, row } if limb == number => row,
            PivotPlace { row, .. } => own + row,
        };
        for &s in &limb.supernodes {
            let columns = supernodes.columns(s);
            let rows: Vec<usize> = supernodes.rows(s).iter().map(row).collect();
            factor.push(columns.len(), &rows);
            factor.unknowns.extend_from_slice(&unknowns[columns]);
        }
        factor
    }
}

impl LimbFactor {
    /// Adds a supernode, given by its number of columns and the rows below.
    fn push(&mut self, size: usize, rows: &[usize]) {
        let (twos, rest) = rows.as_chunks::<2>();
        let is_of_twos = rest.is_empty() && twos.iter().all(|[p, q]| p + 1 == *q);
        self.spots.push(Spot {
            start: self.unknowns.len() as u32,
            size: size as u32,
            is_of_twos,
            rows: self.rows.len(),
            entries: self.entries,
        });
        match is_of_twos {
            true => self.rows.extend(twos.iter().map(|[p, _]| *p as u32)),
            false => self.rows.extend(rows.iter().map(|&row| row as u32)),
        }
        let length = size + rows.len();
        self.longest = self.longest.max(length);
        self.entries += Layout::of_processor().supernode(size, length);
    }

    /// A supernode, by its number in the limb.
    #[inline(always)]
    pub fn supernode(&self, k: usize) -> Supernode<'_> {
        let spot = self.spots[k];
        let (rows, entries) = match self.spots.get(k + 1) {
            Some(next) => (next.rows, next.entries),
            None => (self.rows.len(), self.entries),
        };
        Supernode {
            start: spot.start as usize,
            size: spot.size as usize,
            rows: &self.rows[spot.rows..rows],
            is_of_twos: spot.is_of_twos,
            entries: [self.first + spot.entries, self.first + entries],
        }
    }

    /// Number of supernodes.
    pub fn supernodes(&self) -> usize {
        self.spots.len()
    }

    /// The supernode that has a row among its columns.
    pub fn supernode_of(&self, row: usize) -> usize {
        self.spots
            .partition_point(|spot| spot.start as usize <= row)
            - 1
    }

    /// Copies the entries of `b`, a vector over the unknowns, to the own rows of the limb.
    pub fn take(&self, b: &[f64], rows: &mut [f64]) {
        for (row, &unknown) in rows.iter_mut().zip(&self.unknowns) {
            *row = b[unknown];
        }
    }

    /// Entries of L and D, to the end of a line of the cache.
    fn room(&self) -> usize {
        (self.entries + self.unknowns.len()).next_multiple_of(LINE)
    }

    /// D of its own rows, among the values of all limbs.
    #[inline(always)]
    pub fn pivots<'a>(&self, values: &'a [f64]) -> &'a [f64] {
        &values[self.first + self.entries..][..self.unknowns.len()]
    }

    /// L and D of a supernode, given the part of the limb.
    #[inline(always)]
    pub fn columns_mut<'a>(&self, k: usize, own: &'a mut [f64]) -> [&'a mut [f64]; 2] {
        let (spot, next) = (self.spots[k], self.spots.get(k + 1));
        let start = spot.start as usize;
        let entries = spot.entries..next.map_or(self.entries, |next| next.entries);
        let columns = start..start + spot.size as usize;
        let (l, pivots) = own.split_at_mut(self.entries);
        [&mut l[entries], &mut pivots[columns]]
    }
}

/// Number of entries in a line of the cache.
pub const LINE: usize = 64 / size_of::<f64>();

/// Memory for entries, which begins with a line of the cache and is zero at first.
#[derive(Debug, Default)]
pub struct Entries {
    memory: Option<MmapMut>,
    /// The entries, if the system gives no memory of whole pages; else empty.
    plain: Vec<f64>,
}

impl Entries {
    /// Memory for `count` zeros.
    pub fn zeros(count: usize) -> Self {
        match MmapMut::map_anon(count * size_of::<f64>()) {
            Ok(memory) if count > 0 => Entries {
                memory: Some(in_large_pages(memory)),
                plain: Vec::new(),
            },
            _ => Entries {
                memory: None,
                plain: vec![0.0; count],
            },
        }
    }
}

/// Inverse of the spare part of the memory, so that slightly larger factors still fit; the system provides memory only
/// for entries that are written.
const SPARE: usize = 8;

impl Entries {
    /// Makes room for at least `count` entries, in the present memory if it is large enough; their values are
    /// undefined.
    pub fn make_room(&mut self, count: usize) {
        if self.len() < count {
            *self = Entries::default();
            *self = Entries::zeros(count + count / SPARE);
        }
    }
}

impl Deref for Entries {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        match &self.memory {
            Some(memory) => cast_slice(memory),
            None => &self.plain,
        }
    }
}

impl DerefMut for Entries {
    fn deref_mut(&mut self) -> &mut [f64] {
        match &mut self.memory {
            Some(memory) => cast_slice_mut(memory),
            None => &mut self.plain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_entries_is_zero_and_can_be_written() {
        for count in [0, 1, 7, 1000, 600_000] {
            let mut entries = Entries::zeros(count);
            assert!(entries.len() == count && entries.iter().all(|&entry| entry == 0.0));
            entries
                .iter_mut()
                .zip(1..)
                .for_each(|(entry, k)| *entry = f64::from(k));
            assert_eq!(
                entries.iter().sum::<f64>(),
                (count * (count + 1) / 2) as f64
            );
        }
    }
}
