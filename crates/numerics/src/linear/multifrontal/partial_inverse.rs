//! Selected entries of the inverse from packed LDL^T factors: multifrontal forward
//! substitution along the paths of the elimination tree. docs/numerics.md, Compliance of the pairs.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::factor::{Factor, LimbFactor, PivotPlace};

/// Size of entries of L^-1 E that are negligible: a column ends where all further entries are smaller, because they
/// would change the inverse by less than its round-off. See docs/numerics.md, Compliance of the pairs. The entries of
/// the unit vectors E are dimensionless.
const NEGLIGIBLE: f64 = 1e-25;

/// Number of columns that one thread handles together.
const CHUNK: usize = 96;

/// Number of columns of a supernode up to which they are eliminated one by one, which is then less work than in blocks.
const SMALL: usize = 16;

/// Contributions of lower supernodes to a higher one: unfinished rows of L^-1 E.
struct Contributions {
    /// Nonzero columns (places in the list of unknowns), in increasing order, with their places in the values.
    columns: Vec<[usize; 2]>,
    /// Rows of the limb, in increasing order.
    rows: Vec<usize>,
    /// Values, column by column.
    values: Vec<f64>,
    /// Distance from the start of a column to that of the next; the rows stand at the end of each column.
    stride: usize,
}

/// Finished rows of Y = L^-1 P E that have the same columns: they belong to supernodes one above the other, near the
/// root.
#[derive(Default)]
struct Finished {
    /// Nonzero columns, in increasing order.
    columns: Vec<usize>,
    /// Y^T, row by row.
    y: Vec<f64>,
    /// Entries of D in these rows.
    pivots: Vec<f64>,
}

/// Adds up fronts on the given rows; returns the columns, and the values column by column. `places` is work space for
/// the place of every column in a front.
fn assemble(
    all: &[usize],
    fronts: Vec<Contributions>,
    places: &mut [usize],
) -> (Vec<usize>, Vec<f64>) {
    let of_fronts = fronts.iter().flat_map(|front| &front.columns);
    let mut columns: Vec<usize> = of_fronts.map(|column| column[0]).collect();
    if fronts.len() > 1 {
        columns.sort_unstable();
        columns.dedup();
    }
    let mut values = vec![0.0; all.len() * columns.len()];
    for (place, &column) in columns.iter().enumerate() {
        places[column] = place;
    }
    for front in fronts {
        // the rows of the supernode hold those of the front; both increase
        let mut next = 0;
        let place = |row: &usize| {
            next += all[next..].partition_point(|r| r < row);
            next
        };
        let at: Vec<usize> = front.rows.iter().map(place).collect();
        for &[column, of_front] in &front.columns {
            let to = &mut values[places[column] * all.len()..][..all.len()];
            let end = (of_front + 1) * front.stride;
            let from = &front.values[end - at.len()..end];
            at.iter().zip(from).for_each(|(&i, value)| to[i] += value);
        }
    }
    (columns, values)
}

/// The inverse of P^T L D L^T P at m `unknowns`, as an m x m matrix by columns:
///
/// ```text
/// Y = L^-1 P E,   E the unit vectors of the unknowns
/// inverse = Y^T D^-1 Y
/// ```
///
/// Column j of Y is nonzero only on the path from its unknown to the root of the elimination tree, so supernodes off
/// these paths are not visited, nor supernodes at which the column has become negligible.
pub fn inverse_at(factor: &Factor, unknowns: &[usize]) -> Vec<f64> {
    let m = unknowns.len();
    let (mut inverse, mut places) = (vec![0.0; m * m], vec![0; m]);
    let (mut finished, mut l) = (Finished::default(), Vec::new());
    let mut waiting = units(factor, unknowns);
    // Children come before their parents in their limb, and branches before the trunks.
    while let Some(((number, s), fronts)) = waiting.pop_first() {
        let limb = &factor.limbs[number];
        let node = limb.supernode(s);
        let all: Vec<usize> = node.columns().chain(node.rows_below()).collect();
        let (columns, mut values) = assemble(&all, fronts, &mut places);

        node.write_to(factor.values(), &mut l);
        let l = &l[..all.len() * node.size];
        let mut chunks: Vec<&mut [f64]> = values.chunks_mut(CHUNK * all.len()).collect();
        for_chunks(&mut chunks, |chunk| {
            eliminate(l, [node.size, all.len()], chunk)
        });
        if finished.columns != columns {
            finished.add_to(&mut inverse, m);
            finished.begin(&columns);
        }
        let pivots = &limb.pivots(factor.values())[node.columns()];
        finished.push(&values, all.len(), pivots);

        let kept = without_negligible(&columns, &values, [node.size, all.len()]);
        if let Some((place, rows)) = above(limb, number, node.rows_below().collect())
            && !kept.is_empty()
        {
            let s = factor.limbs[place.limb].supernode_of(place.row);
            let fronts = waiting.entry((place.limb, s)).or_default();
            fronts.push(Contributions {
                columns: kept,
                rows,
                values,
                stride: all.len(),
            });
        }
    }
    finished.add_to(&mut inverse, m);
    for j in 0..m {
        for i in j + 1..m {
            inverse[i * m + j] = inverse[j * m + i];
        }
    }
    inverse
}

/// x_i <- x_i - L_ij x_j, i > j, for all columns j of a supernode with `size` columns and `length` rows, in vectors x
/// of this length.
fn eliminate(l: &[f64], [size, length]: [usize; 2], x: &mut [f64]) {
    if size <= SMALL {
        for x in x.chunks_exact_mut(length) {
            for (k, column) in l.chunks_exact(length).enumerate() {
                let (own, below) = x[..size].split_at_mut(k + 1);
                let of_column = below.iter_mut().zip(&column[k + 1..size]);
                of_column.for_each(|(x, l)| *x -= l * own[k]);
            }
        }
    }
    let count = x.len() / length;
    let (l_top, l_below) = MatRef::from_column_major_slice(l, length, size).split_at_row(size);
    let x = MatMut::from_column_major_slice_mut(x, length, count);
    let (mut top, below) = x.split_at_row_mut(size);
    if size > SMALL {
        solve_unit_lower_triangular_in_place(l_top, top.rb_mut(), Par::Seq);
    }
    matmul(below, Accum::Add, l_below, top.rb(), -1.0, Par::Seq);
}

/// The unit vectors of the unknowns, by limb and supernode.
fn units(factor: &Factor, unknowns: &[usize]) -> BTreeMap<(usize, usize), Vec<Contributions>> {
    let mut units: BTreeMap<(usize, usize), Vec<Contributions>> = BTreeMap::new();
    for (column, &unknown) in unknowns.iter().enumerate() {
        let PivotPlace { limb, row } = factor.places[unknown];
        let unit = Contributions {
            columns: vec![[column, 0]],
            rows: vec![row],
            values: vec![1.0],
            stride: 1,
        };
        let s = factor.limbs[limb].supernode_of(row);
        units.entry((limb, s)).or_default().push(unit);
    }
    units
}

/// The place of the first row below a supernode, and all rows below it as rows of the limb of that place; `None` below
/// a root.
fn above(
    limb: &LimbFactor,
    number: usize,
    mut rows: Vec<usize>,
) -> Option<(PivotPlace, Vec<usize>)> {
    let (&first, own) = (rows.first()?, limb.unknowns.len());
    let limb = match limb.trunk.filter(|_| first >= own) {
        Some(trunk) => {
            rows.iter_mut().for_each(|row| *row -= own);
            trunk
        }
        None => number,
    };
    let row = rows[0];
    Some((PivotPlace { limb, row }, rows))
}

/// Calls `action` for all chunks, on threads if there are several chunks.
fn for_chunks<T: Send>(chunks: &mut [T], action: impl Fn(&mut T) + Sync + Send) {
    if chunks.len() > 1 && rayon::current_num_threads() > 1 {
        chunks.par_iter_mut().with_max_len(1).for_each(action);
        return;
    }
    chunks.iter_mut().for_each(action);
}

/// Columns of the inverse that one thread handles together.
struct ColumnGroup<'a> {
    /// Place of the first of these columns among the nonzero ones; `columns` holds all nonzero columns.
    first: usize,
    columns: &'a [usize],
    /// The columns of the inverse behind those of the group before; `start` is the first of them.
    inverse: &'a mut [f64],
    start: usize,
}

impl Finished {
    /// Removes all rows and sets the nonzero columns of the next ones.
    fn begin(&mut self, columns: &[usize]) {
        self.columns.clear();
        self.columns.extend_from_slice(columns);
        self.y.clear();
        self.pivots.clear();
    }

    /// Adds the first rows of `values`, which has columns of the given length, with their entries of D.
    fn push(&mut self, values: &[f64], length: usize, pivots: &[f64]) {
        for row in 0..pivots.len() {
            self.y
                .extend(values.chunks_exact(length).map(|column| column[row]));
        }
        self.pivots.extend_from_slice(pivots);
    }

    /// Adds the lower triangle of Y^T D^-1 Y of these rows to the inverse at m unknowns.
    fn add_to(&self, inverse: &mut [f64], m: usize) {
        let Self { columns, y, pivots } = self;
        let n = columns.len();
        if n == 0 {
            return;
        }
        let (mut parts, mut rest, mut start) = (Vec::new(), inverse, 0);
        for (columns, first) in columns.chunks(CHUNK).zip((0..).step_by(CHUNK)) {
            let end = columns.last().map_or(start, |last| last + 1);
            let own;
            (own, rest) = rest.split_at_mut((end - start) * m);
            parts.push(ColumnGroup {
                first,
                columns,
                inverse: own,
                start,
            });
            start = end;
        }
        for_chunks(&mut parts, |part| {
            let (rows, count) = (n - part.first, part.columns.len());
            // D^-1 Y in these columns
            let mut scaled = Vec::with_capacity(count * pivots.len());
            for (row, pivot) in y.chunks_exact(n).zip(pivots) {
                scaled.extend(row[part.first..][..count].iter().map(|y| y / pivot));
            }
            let mut product = vec![0.0; rows * count];
            let to = MatMut::from_column_major_slice_mut(&mut product, rows, count);
            let left = MatRef::from_column_major_slice(y, n, pivots.len());
            let left = left.subrows(part.first, rows);
            let right = MatRef::from_column_major_slice(&scaled, count, pivots.len());
            matmul(to, Accum::Replace, left, right.transpose(), 1.0, Par::Seq);
            for (j, &column) in part.columns.iter().enumerate() {
                let to = &mut part.inverse[(column - part.start) * m..][..m];
                let from = &product[j * rows + j..(j + 1) * rows];
                for (&row, value) in columns[part.first + j..].iter().zip(from) {
                    to[row] += value;
                }
            }
        });
    }
}

/// The columns that are not negligible below their first `size` rows, with their places in `values`, whose columns have
/// the given length.
fn without_negligible(
    columns: &[usize],
    values: &[f64],
    [size, length]: [usize; 2],
) -> Vec<[usize; 2]> {
    let matters = |(place, _): &(usize, &usize)| {
        let below = &values[place * length + size..(place + 1) * length];
        !below.iter().all(|value| value.abs() <= NEGLIGIBLE)
    };
    let kept = columns.iter().enumerate().filter(matters);
    kept.map(|(place, &column)| [column, place]).collect()
}
