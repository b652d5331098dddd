//! Selected entries of the inverse from packed LDL^T factors: multifrontal forward
//! substitution along the paths of the elimination tree. Section 5 of docs/theory.md.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatRef, Par};

use super::factor::{Factor, Place};

/// A column of L^-1 E whose entries above are all smaller than this ends there: what it would add to the
/// inverse is below round-off, see section 5 of docs/theory.md. The unit vectors have no dimension.
const NEGLIGIBLE: f64 = 1e-25;

/// Contributions of the supernodes below to one above: unfinished rows of L^-1 E.
struct Rows {
    /// Columns (places in the list of unknowns) that are not zero, increasing.
    columns: Vec<usize>,
    /// Rows of the limb, increasing.
    rows: Vec<usize>,
    /// Values, rows x columns.
    values: Mat<f64>,
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
    let mut inverse = Mat::<f64>::zeros(m, m);
    let mut waiting: BTreeMap<(usize, usize), Vec<Rows>> = BTreeMap::new();
    for (column, &unknown) in unknowns.iter().enumerate() {
        let Place { limb, row } = factor.places[unknown];
        let unit = Rows {
            columns: vec![column],
            rows: vec![row],
            values: Mat::from_fn(1, 1, |_, _| 1.0),
        };
        let s = factor.limbs[limb].supernode_of(row);
        waiting.entry((limb, s)).or_default().push(unit);
    }
    let (mut l, mut scaled, mut product) = (Mat::new(), Mat::new(), Mat::new());
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
        let (mut top, mut below) = values.as_mut().split_at_row_mut(node.size);
        solve_unit_lower_triangular_in_place(l_top, top.rb_mut(), Par::Seq);
        matmul(
            below.rb_mut(),
            Accum::Add,
            l_below,
            top.rb(),
            -1.0,
            Par::Seq,
        );
        let pivots = &limb.pivots[node.columns()];
        scaled.resize_with(0, 0, |_, _| 0.0);
        scaled.resize_with(node.size, columns.len(), |i, j| top[(i, j)] / pivots[i]);
        product.resize_with(columns.len(), columns.len(), |_, _| 0.0);
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

        let mut rows: Vec<usize> = node.rows_below().collect();
        if let Some(&first) = rows.first() {
            let (own, mut place) = (
                limb.unknowns.len(),
                Place {
                    limb: number,
                    row: first,
                },
            );
            if let Some(trunk) = limb.trunk.filter(|_| first >= own) {
                rows.iter_mut().for_each(|row| *row -= own);
                place = Place {
                    limb: trunk,
                    row: rows[0],
                };
            }
            let rows = without_negligible(columns, rows, below.rb());
            if !rows.columns.is_empty() {
                let s = factor.limbs[place.limb].supernode_of(place.row);
                waiting.entry((place.limb, s)).or_default().push(rows);
            }
        }
    }
    (0..m)
        .flat_map(|j| (0..m).map(move |i| (i, j)))
        .map(|(i, j)| inverse[(i, j)])
        .collect()
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
