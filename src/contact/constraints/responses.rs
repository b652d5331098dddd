//! What the forces of constraints do to the unknowns of one block of the compliance, and that to gaps and
//! slips: the two products of the Delassus operator, eq. (5.1). Section 5 of docs/theory.md.

use std::array::from_fn;

use pulp::Simd;
use smallvec::SmallVec;

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

/// What the forces of some constraints do to the unknowns of a block.
#[derive(Debug, Default)]
pub(super) struct Responses {
    /// A row for every unknown: all normal forces, then all tangential ones.
    rows: Vec<f64>,
    /// Entries of a row.
    width: usize,
    /// What normal and tangential force of some constraints do.
    columns: [[Vec<f64>; 2]; TOGETHER],
}

/// Constraints whose responses are written to the rows together.
const TOGETHER: usize = 4;

impl Responses {
    /// W (B_l T)^T of eq. (5.1) of some constraints l, in the rows of a block: what their normal and
    /// tangential forces do to its unknowns. The `inverse` has `size` rows and columns.
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
        let column = |place: usize| &inverse[place * size..(place + 1) * size];
        for (number, together) in constraints.chunks(TOGETHER).enumerate() {
            for ((_, entries), sums) in together.iter().zip(&mut self.columns) {
                let terms = entries.iter().map(|e| (column(e.place), e.force));
                let terms: Terms = terms.collect();
                combine(simd, &terms, resized(sums, size), false);
            }
            let first = number * TOGETHER;
            self.write_rows(first, [together.len(), count]);
        }
    }

    /// Writes the columns of so many constraints to the places from `first` on, of so many in all.
    #[inline(always)]
    fn write_rows(&mut self, first: usize, [together, count]: [usize; 2]) {
        let columns: [[&[f64]; 2]; TOGETHER] =
            (self.columns.each_ref()).map(|column| column.each_ref().map(Vec::as_slice));
        for (unknown, row) in self.rows.chunks_exact_mut(self.width).enumerate() {
            let (normal, tangential) = row.split_at_mut(count);
            for (i, row) in [normal, tangential].into_iter().enumerate() {
                match row[first..first + together].first_chunk_mut() {
                    Some(all) => *all = from_fn::<f64, TOGETHER, _>(|l| columns[l][i][unknown]),
                    None => (row[first..].iter_mut().zip(&columns))
                        .for_each(|(row, column)| *row = column[i][unknown]),
                }
            }
        }
    }

    /// (G_k T) Y of eq. (5.1), Y being the rows: what the forces add to gap and slip of k; added to what there
    /// is, or written.
    #[inline(always)]
    pub fn product<S: Simd>(&self, simd: S, k: &[UnknownEntry], sums: [&mut [f64]; 2], adds: bool) {
        let row = |place: usize| &self.rows[place * self.width..(place + 1) * self.width];
        let terms = k.iter().map(|e| (row(e.place), e.derivative));
        combine(simd, &terms.collect::<Terms>(), sums, adds);
    }
}

/// Two vectors of the given length.
#[inline(always)]
pub(super) fn resized(vectors: &mut [Vec<f64>; 2], length: usize) -> [&mut [f64]; 2] {
    vectors.each_mut().map(|vector| {
        vector.resize(length, 0.0);
        vector.as_mut_slice()
    })
}

/// A vector with two factors.
type Term<'a> = (&'a [f64], [f64; 2]);

/// Vectors of one length.
type Terms<'a> = SmallVec<[Term<'a>; 8]>;

/// The two sums of vectors times their factors, added to what there is, or written.
#[inline(always)]
fn combine<S: Simd>(simd: S, terms: &[Term], [first, second]: [&mut [f64]; 2], mut adds: bool) {
    let (fours, rest) = terms.as_chunks::<4>();
    for four in fours {
        combine_some(simd, four, [first, second], adds);
        adds = true;
    }
    match rest {
        [a] => combine_some(simd, &[*a], [first, second], adds),
        [a, b] => combine_some(simd, &[*a, *b], [first, second], adds),
        [a, b, c] => combine_some(simd, &[*a, *b, *c], [first, second], adds),
        _ if adds => {}
        _ => [first, second].into_iter().for_each(|sum| sum.fill(0.0)),
    }
}

/// [`combine`] for N vectors.
#[inline(always)]
fn combine_some<S: Simd, const N: usize>(
    simd: S,
    terms: &[Term; N],
    [first, second]: [&mut [f64]; 2],
    adds: bool,
) {
    let length = first.len();
    let factors = |i: usize| -> [_; N] { from_fn(|k| simd.splat_f64s(terms[k].1[i])) };
    let (a, b) = (factors(0), factors(1));
    let vectors = terms.map(|term| S::as_simd_f64s(&term.0[..length]));
    let zero = simd.splat_f64s(0.0);
    let (first, first_rest) = S::as_mut_simd_f64s(first);
    let (second, second_rest) = S::as_mut_simd_f64s(&mut second[..length]);
    let heads = vectors.map(|vector| &vector.0[..first.len()]);
    for (i, (first, second)) in first.iter_mut().zip(second).enumerate() {
        let mut sums = if adds { [*first, *second] } else { [zero; 2] };
        for k in 0..N {
            sums[0] = simd.mul_add_e_f64s(a[k], heads[k][i], sums[0]);
            sums[1] = simd.mul_add_e_f64s(b[k], heads[k][i], sums[1]);
        }
        [*first, *second] = sums;
    }
    if !first_rest.is_empty() {
        let mut sums = match adds {
            true => [&*first_rest, &*second_rest].map(|rest| simd.partial_load_f64s(rest)),
            false => [zero; 2],
        };
        for (k, vector) in vectors.iter().enumerate() {
            let rest = simd.partial_load_f64s(vector.1);
            sums[0] = simd.mul_add_e_f64s(a[k], rest, sums[0]);
            sums[1] = simd.mul_add_e_f64s(b[k], rest, sums[1]);
        }
        simd.partial_store_f64s(first_rest, sums[0]);
        simd.partial_store_f64s(second_rest, sums[1]);
    }
}
