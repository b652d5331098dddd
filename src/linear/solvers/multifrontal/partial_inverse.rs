//! Selected entries of the inverse from packed LDL^T factors: multifrontal forward
//! substitution along the paths of the elimination tree. Section 5 of docs/theory.md.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::factor::{Factor, LimbFactor, Place};

/// A column of L^-1 E whose entries above are all smaller than this ends there: what it would add to the
/// inverse is below round-off, see section 5 of docs/theory.md. The unit vectors have no dimension.
const NEGLIGIBLE: f64 = 1e-25;

/// Columns that are handled together, on one thread.
const CHUNK: usize = 96;

/// Contributions of the supernodes below to one above: unfinished rows of L^-1 E.
struct Rows {
    /// Columns (places in the list of unknowns) that are not zero, increasing.
    columns: Vec<usize>,
    /// Rows of the limb, increasing.
    rows: Vec<usize>,
    /// Values, rows x columns.
    values: Mat<f64>,
}

/// Finished rows of Y = L^-1 P E that have the same columns: supernodes one above the other, near the root.
#[derive(Default)]
struct Finished {
    /// Columns that are not zero, increasing.
    columns: Vec<usize>,
    /// Y^T, row by row.
    y: Vec<f64>,
    /// D of the rows.
    pivots: Vec<f64>,
}

/// The inverse of P^T L D L^T P at m `unknowns`, m x m column by column:
///
/// ```text
/// Y = L^-1 P E,   E the unit vectors of the unknowns
/// inverse = Y^T D^-1 Y
/// ```
///
/// Column j of Y is nonzero only on the path from its unknown to the root of the elimination tree,
/// so that the supernodes off these paths are never visited, nor those where it has died away.
pub fn inverse_at(factor: &Factor, unknowns: &[usize]) -> Vec<f64> {
    let m = unknowns.len();
    let mut inverse = vec![0.0; m * m];
    let mut finished = Finished::default();
    let mut waiting = units(factor, unknowns);
    let mut l = Mat::new();
    // Children come before their parents in their limb, and branches before the trunks.
    while let Some(((number, s), rows)) = waiting.pop_first() {
        let limb = &factor.limbs[number];
        let node = limb.supernode(s);
        let all: Vec<usize> = node.columns().chain(node.rows_below()).collect();
        let Rows {
            columns,
            mut values,
            ..
        } = assemble(all, &rows);

        node.write_to(factor.values(), &mut l);
        let (l_top, l_below) = l.as_ref().split_at_row(node.size);
        for_chunks(chunks(values.as_mut()), |of_chunk| {
            let (mut top, below) = of_chunk.split_at_row_mut(node.size);
            solve_unit_lower_triangular_in_place(l_top, top.rb_mut(), Par::Seq);
            matmul(below, Accum::Add, l_below, top.rb(), -1.0, Par::Seq);
        });
        let (top, below) = values.as_ref().split_at_row(node.size);
        if finished.columns != columns {
            finished.add_to(&mut inverse, m);
            finished = Finished {
                columns: columns.clone(),
                ..Finished::default()
            };
        }
        finished.push(top, &limb.pivots[node.columns()]);

        if let Some((place, rows)) = above(limb, number, node.rows_below().collect()) {
            let rows = without_negligible(columns, rows, below);
            if !rows.columns.is_empty() {
                let s = factor.limbs[place.limb].supernode_of(place.row);
                waiting.entry((place.limb, s)).or_default().push(rows);
            }
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

/// The unit vectors of the unknowns, by limb and supernode.
fn units(factor: &Factor, unknowns: &[usize]) -> BTreeMap<(usize, usize), Vec<Rows>> {
    let mut units: BTreeMap<(usize, usize), Vec<Rows>> = BTreeMap::new();
    for (column, &unknown) in unknowns.iter().enumerate() {
        let Place { limb, row } = factor.places[unknown];
        let unit = Rows {
            columns: vec![column],
            rows: vec![row],
            values: Mat::from_fn(1, 1, |_, _| 1.0),
        };
        let s = factor.limbs[limb].supernode_of(row);
        units.entry((limb, s)).or_default().push(unit);
    }
    units
}

/// The rows below a supernode of a limb as those of the limb of the first one, and where that is; none below a root.
fn above(limb: &LimbFactor, number: usize, mut rows: Vec<usize>) -> Option<(Place, Vec<usize>)> {
    let (&first, own) = (rows.first()?, limb.unknowns.len());
    let limb = match limb.trunk.filter(|_| first >= own) {
        Some(trunk) => {
            rows.iter_mut().for_each(|row| *row -= own);
            trunk
        }
        None => number,
    };
    let row = rows[0];
    Some((Place { limb, row }, rows))
}

/// Chunks of the columns of a matrix.
fn chunks(mut matrix: MatMut<f64>) -> Vec<MatMut<f64>> {
    let mut chunks = Vec::new();
    while matrix.ncols() > CHUNK {
        let chunk;
        (chunk, matrix) = matrix.split_at_col_mut(CHUNK);
        chunks.push(chunk);
    }
    chunks.push(matrix);
    chunks
}

/// Does something with all chunks, on threads if there are several.
fn for_chunks<T: Send>(chunks: Vec<T>, action: impl Fn(T) + Sync + Send) {
    if chunks.len() > 1 && rayon::current_num_threads() > 1 {
        chunks.into_par_iter().with_max_len(1).for_each(action);
        return;
    }
    chunks.into_iter().for_each(action);
}

impl Finished {
    /// Adds rows with the same columns, and D of these.
    fn push(&mut self, rows: MatRef<f64>, pivots: &[f64]) {
        for row in rows.row_iter() {
            self.y.extend(row.iter());
        }
        self.pivots.extend_from_slice(pivots);
    }

    /// Adds the lower triangle of Y^T D^-1 Y of these rows to the inverse at m unknowns.
    fn add_to(&self, inverse: &mut [f64], m: usize) {
        let (columns, n) = (&self.columns, self.columns.len());
        if n == 0 {
            return;
        }
        let transposed = MatRef::from_column_major_slice(&self.y, n, self.pivots.len());
        let scaled: Vec<f64> = (self.y.chunks_exact(n).zip(&self.pivots))
            .flat_map(|(row, pivot)| row.iter().map(move |y| y / pivot))
            .collect();
        let scaled = MatRef::from_column_major_slice(&scaled, n, self.pivots.len());
        let (mut parts, mut rest, mut start) = (Vec::new(), inverse, 0);
        for (of_chunk, first) in columns.chunks(CHUNK).zip((0..).step_by(CHUNK)) {
            let end = of_chunk.last().map_or(start, |last| last + 1);
            let own;
            (own, rest) = rest.split_at_mut((end - start) * m);
            parts.push((first, of_chunk, start, own));
            start = end;
        }
        for_chunks(parts, |(first, of_chunk, start, own)| {
            let mut product = Mat::zeros(n - first, of_chunk.len());
            let left = transposed.subrows(first, n - first);
            let right = scaled.subrows(first, of_chunk.len()).transpose();
            matmul(product.as_mut(), Accum::Replace, left, right, 1.0, Par::Seq);
            for (j, &column) in of_chunk.iter().enumerate() {
                let to = &mut own[(column - start) * m..(column - start + 1) * m];
                let from = &product.col_as_slice(j)[j..];
                for (&row, value) in columns[first + j..].iter().zip(from) {
                    to[row] += value;
                }
            }
        });
    }
}

/// The front of the columns that are not negligible.
fn without_negligible(columns: Vec<usize>, rows: Vec<usize>, values: MatRef<f64>) -> Rows {
    let is_negligible = |value: f64| value.abs() <= NEGLIGIBLE;
    let matters = |j: &usize| !(0..rows.len()).all(|i| is_negligible(values[(i, *j)]));
    let kept: Vec<usize> = (0..columns.len()).filter(matters).collect();
    let of_kept = |i: usize, j: usize| values[(i, kept[j])];
    Rows {
        values: Mat::from_fn(rows.len(), kept.len(), of_kept),
        columns: kept.iter().map(|&j| columns[j]).collect(),
        rows,
    }
}

/// Adds up fronts on the given rows.
fn assemble(rows: Vec<usize>, fronts: &[Rows]) -> Rows {
    let mut columns: Vec<usize> = fronts
        .iter()
        .flat_map(|f| f.columns.iter().copied())
        .collect();
    columns.sort_unstable();
    columns.dedup();
    let mut values = Mat::<f64>::zeros(rows.len(), columns.len());
    for front in fronts {
        // `rows` holds the supernode's own rows, then its pattern, both increasing.
        let at: Vec<usize> = front
            .rows
            .iter()
            .map(|row| rows.partition_point(|r| r < row))
            .collect();
        for (j, column) in front.columns.iter().enumerate() {
            let to = columns.partition_point(|c| c < column);
            for (i, &row) in at.iter().enumerate() {
                values[(row, to)] += front.values[(i, j)];
            }
        }
    }
    Rows {
        columns,
        rows,
        values,
    }
}
