//! Selected entries of the inverse from supernodal LDL^T factors: multifrontal forward
//! substitution along the paths of the elimination tree. Section 5 of docs/theory.md.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::{Accum, Mat, MatRef, Par};

/// A column of L^-1 E whose entries above are all smaller than this ends there: what it would add to the
/// inverse is below round-off, see section 5 of docs/theory.md. The unit vectors have no dimension.
const NEGLIGIBLE: f64 = 1e-25;

/// Contributions of the supernodes below to one above: unfinished rows of L^-1 E.
struct Front {
    /// Columns (positions in the list of unknowns) that are not zero, increasing.
    columns: Vec<usize>,
    /// Rows in the order of pivots, increasing.
    rows: Vec<usize>,
    /// Values, rows x columns.
    values: Mat<f64>,
}

/// The inverse of P^T L D L^T P at some unknowns, given by their `positions` in the order of
/// pivots, m x m column by column:
///
/// ```text
/// Y = L^-1 E,   E the unit vectors of the positions
/// inverse = Y^T D^-1 Y
/// ```
///
/// Column j of Y is nonzero only on the path from its position to the root of the elimination tree,
/// so that the supernodes off these paths are never visited, nor those where it has died away.
pub(super) fn inverse_at(
    factor: SupernodalLdltRef<'_, usize, f64>,
    positions: &[usize],
) -> Vec<f64> {
    let m = positions.len();
    let ends = factor.symbolic().supernode_end();
    let supernode_of = |row: usize| ends.partition_point(|&end| end <= row);
    let mut inverse = Mat::<f64>::zeros(m, m);
    let mut waiting: BTreeMap<usize, Vec<Front>> = BTreeMap::new();
    for (column, &position) in positions.iter().enumerate() {
        let unit = Front {
            columns: vec![column],
            rows: vec![position],
            values: Mat::from_fn(1, 1, |_, _| 1.0),
        };
        waiting
            .entry(supernode_of(position))
            .or_default()
            .push(unit);
    }
    // Children come before their parents in the order of pivots.
    while let Some((s, fronts)) = waiting.pop_first() {
        let node = factor.supernode(s);
        let size = node.val().ncols();
        let rows: Vec<usize> = (node.start()..node.start() + size)
            .chain(node.pattern().iter().copied())
            .collect();
        let Front {
            columns,
            mut values,
            ..
        } = assemble(rows, &fronts);

        let (l_top, l_below) = node.val().split_at_row(size);
        let (mut top, mut below) = values.as_mut().split_at_row_mut(size);
        solve_unit_lower_triangular_in_place(l_top, top.rb_mut(), Par::Seq);
        matmul(
            below.rb_mut(),
            Accum::Add,
            l_below,
            top.rb(),
            -1.0,
            Par::Seq,
        );
        let scaled = Mat::from_fn(size, columns.len(), |i, j| top[(i, j)] / l_top[(i, i)]);
        let mut product = Mat::<f64>::zeros(columns.len(), columns.len());
        matmul(
            product.as_mut(),
            Accum::Replace,
            top.rb().transpose(),
            &scaled,
            1.0,
            Par::Seq,
        );
        for (j, &column) in columns.iter().enumerate() {
            for (i, &row) in columns.iter().enumerate() {
                inverse[(row, column)] += product[(i, j)];
            }
        }

        if let Some(&first) = node.pattern().first() {
            let front = without_negligible(columns, node.pattern(), below.rb());
            if !front.columns.is_empty() {
                waiting.entry(supernode_of(first)).or_default().push(front);
            }
        }
    }
    (0..m)
        .flat_map(|j| (0..m).map(move |i| (i, j)))
        .map(|(i, j)| inverse[(i, j)])
        .collect()
}

/// The front of the columns that are not negligible.
fn without_negligible(columns: Vec<usize>, rows: &[usize], values: MatRef<f64>) -> Front {
    let is_negligible = |value: f64| value.abs() <= NEGLIGIBLE;
    let matters = |j: &usize| !(0..rows.len()).all(|i| is_negligible(values[(i, *j)]));
    let kept: Vec<usize> = (0..columns.len()).filter(matters).collect();
    let of_kept = |i: usize, j: usize| values[(i, kept[j])];
    Front {
        values: Mat::from_fn(rows.len(), kept.len(), of_kept),
        columns: kept.iter().map(|&j| columns[j]).collect(),
        rows: rows.to_vec(),
    }
}

/// Adds up fronts on the given rows.
fn assemble(rows: Vec<usize>, fronts: &[Front]) -> Front {
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
    Front {
        columns,
        rows,
        values,
    }
}
