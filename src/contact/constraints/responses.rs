//! What gaps and slips of constraints take from forces at the unknowns of one block of the compliance, and
//! that of contact forces: the two products of the Delassus operator, eq. (5.1). Section 5 of docs/theory.md.

use std::array::from_fn;

use pulp::Simd;

/// The rows of a constraint at one unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    /// Row of the inverse, in its block.
    pub place: usize,
    /// Its block, that of the group of the unknown.
    pub block: usize,
    /// Entries of Bn T and Bt T.
    pub force: [f64; 2],
    /// Entries of Gn T and Gt T.
    pub derivative: [f64; 2],
}

/// The rows of some constraints at the unknowns of one block.
#[derive(Debug, Default)]
pub(super) struct GroupRows {
    /// The constraints, increasing, each with the end of its entries.
    pub members: Vec<(usize, usize)>,
    entries: Vec<UnknownEntry>,
}

impl GroupRows {
    /// Removes all constraints.
    pub fn clear(&mut self) {
        self.members.clear();
        self.entries.clear();
    }

    /// Adds an entry of a constraint, which is the last one or comes after it.
    pub fn push(&mut self, constraint: usize, entry: UnknownEntry) {
        self.entries.push(entry);
        let end = self.entries.len();
        match self.members.last_mut() {
            Some((last, at)) if *last == constraint => *at = end,
            _ => self.members.push((constraint, end)),
        }
    }

    /// Entries of the constraints with their numbers, one constraint after the other.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[UnknownEntry])> {
        let mut start = 0;
        self.members.iter().map(move |&(constraint, end)| {
            let entries = &self.entries[start..end];
            start = end;
            (constraint, entries)
        })
    }
}

/// What forces at the unknowns of a block do to gaps and slips of some constraints.
#[derive(Debug, Default)]
pub(super) struct Responses {
    /// A row for every unknown: all gaps, then all slips.
    rows: Vec<f64>,
    /// Entries of a row.
    width: usize,
    /// Gap and slip of some constraints, over the unknowns.
    columns: [[Vec<f64>; 2]; TOGETHER],
}

/// Constraints whose responses are written to the rows together.
const TOGETHER: usize = 4;

impl Responses {
    /// W^T (G_k T)^T of eq. (5.1) of some constraints k, in the rows of a block, with W = W^T. The `inverse`
    /// has `size` rows and columns.
    #[inline(always)]
    pub fn set<S: Simd>(
        &mut self,
        simd: S,
        (inverse, size): (&[f64], usize),
        constraints: &[(usize, &[UnknownEntry])],
    ) {
        let count = constraints.len();
        self.width = 2 * count;
        self.rows.resize(size * self.width, 0.0);
        let terms = Terms {
            vectors: inverse,
            length: size,
            factors: |entry| entry.derivative,
        };
        for (number, together) in constraints.chunks(TOGETHER).enumerate() {
            for ((_, entries), sums) in together.iter().zip(&mut self.columns) {
                terms.combine(simd, entries, resized(sums, size), false);
            }
            let first = number * TOGETHER;
            self.write_rows(first, [together.len(), count]);
        }
    }

    /// Writes the columns of so many constraints to the places from `first` on, of so many in all.
    #[inline(always)]
    fn write_rows(&mut self, first: usize, [together, count]: [usize; 2]) {
        let size = self.rows.len() / self.width;
        for i in 0..2 {
            let columns: [&[f64]; TOGETHER] = from_fn(|l| self.columns[l][i].as_slice());
            let at = i * count + first;
            if together < TOGETHER {
                for (unknown, row) in self.rows.chunks_exact_mut(self.width).enumerate() {
                    let row = &mut row[at..at + together];
                    (row.iter_mut().zip(&columns)).for_each(|(row, column)| *row = column[unknown]);
                }
                continue;
            }
            let tiles = columns.map(|column| column[..size].as_chunks::<TOGETHER>());
            let mut rows = self.rows.chunks_exact_mut(self.width);
            for tile in 0..size / TOGETHER {
                let tile: [[f64; TOGETHER]; TOGETHER] = from_fn(|l| tiles[l].0[tile]);
                for unknown in 0..TOGETHER {
                    if let Some(row) = rows.next() {
                        let row = &mut row[at..at + TOGETHER];
                        row.copy_from_slice(&tile.map(|column| column[unknown]));
                    }
                }
            }
            for (unknown, row) in rows.enumerate() {
                let row = &mut row[at..at + TOGETHER];
                row.copy_from_slice(&tiles.map(|tile| tile.1[unknown]));
            }
        }
    }

    /// (B_l T) Y of eq. (5.1), Y being the rows: what normal and tangential force of l add to gaps and slips of
    /// the constraints; added to what there is, or written.
    #[inline(always)]
    pub fn product<S: Simd>(&self, simd: S, l: &[UnknownEntry], sums: [&mut [f64]; 2], adds: bool) {
        let terms = Terms {
            vectors: &self.rows,
            length: self.width,
            factors: |entry| entry.force,
        };
        terms.combine(simd, l, sums, adds);
    }
}

/// Two vectors of the given length.
#[inline(always)]
fn resized(vectors: &mut [Vec<f64>; 2], length: usize) -> [&mut [f64]; 2] {
    vectors.each_mut().map(|vector| {
        vector.resize(length, 0.0);
        vector.as_mut_slice()
    })
}

/// Vectors of one length, one after the other, and the two factors that an entry has for the vector of its place.
struct Terms<'a, F: Fn(&UnknownEntry) -> [f64; 2]> {
    vectors: &'a [f64],
    length: usize,
    factors: F,
}

impl<F: Fn(&UnknownEntry) -> [f64; 2]> Terms<'_, F> {
    /// The two sums of the vectors of some entries times their factors, added to what there is, or written.
    #[inline(always)]
    fn combine<S: Simd>(
        &self,
        simd: S,
        entries: &[UnknownEntry],
        [first, second]: [&mut [f64]; 2],
        mut adds: bool,
    ) {
        let (fours, rest) = entries.as_chunks::<4>();
        for four in fours {
            self.combine_some(simd, four, [first, second], adds);
            adds = true;
        }
        match rest {
            [a] => self.combine_some(simd, &[*a], [first, second], adds),
            [a, b] => self.combine_some(simd, &[*a, *b], [first, second], adds),
            [a, b, c] => self.combine_some(simd, &[*a, *b, *c], [first, second], adds),
            _ if adds => {}
            _ => [first, second].into_iter().for_each(|sum| sum.fill(0.0)),
        }
    }

    /// [`Self::combine`] for N entries.
    #[inline(always)]
    fn combine_some<S: Simd, const N: usize>(
        &self,
        simd: S,
        entries: &[UnknownEntry; N],
        [first, second]: [&mut [f64]; 2],
        adds: bool,
    ) {
        let length = self.length;
        let mut factors = [[simd.splat_f64s(0.0); 2]; N];
        let mut vectors = [S::as_simd_f64s(&[]); N];
        for ((entry, factors), vector) in entries.iter().zip(&mut factors).zip(&mut vectors) {
            let [a, b] = (self.factors)(entry);
            *factors = [simd.splat_f64s(a), simd.splat_f64s(b)];
            *vector = S::as_simd_f64s(&self.vectors[entry.place * length..][..length]);
        }
        let (first, first_rest) = S::as_mut_simd_f64s(&mut first[..length]);
        let (second, second_rest) = S::as_mut_simd_f64s(&mut second[..length]);
        let zero = simd.splat_f64s(0.0);
        for (i, (first, second)) in first.iter_mut().zip(second).enumerate() {
            let mut sums = if adds { [*first, *second] } else { [zero; 2] };
            for ([a, b], vector) in factors.iter().zip(&vectors) {
                sums[0] = simd.mul_add_e_f64s(*a, vector.0[i], sums[0]);
                sums[1] = simd.mul_add_e_f64s(*b, vector.0[i], sums[1]);
            }
            [*first, *second] = sums;
        }
        if !first_rest.is_empty() {
            let mut sums = match adds {
                true => [&*first_rest, &*second_rest].map(|rest| simd.partial_load_f64s(rest)),
                false => [zero; 2],
            };
            for ([a, b], vector) in factors.iter().zip(&vectors) {
                let rest = simd.partial_load_f64s(vector.1);
                sums[0] = simd.mul_add_e_f64s(*a, rest, sums[0]);
                sums[1] = simd.mul_add_e_f64s(*b, rest, sums[1]);
            }
            simd.partial_store_f64s(first_rest, sums[0]);
            simd.partial_store_f64s(second_rest, sums[1]);
        }
    }
}
