//! Lemke's method with free unknowns, which are pivoted in first: the principal transform of the frictional problem in which
//! they are basic and do not appear any more. Section 8 of docs/theory.md, Free unknowns.

use nalgebra::{DMatrix, DVector};

use super::basis::PivotMatrix;
use super::lemke::{FrictionalMatrix, LemkeSettings, follow_path};
use super::problems::{ContactState, LcpError};
use super::scaled::Scaled;

/// Part of the largest entry up to which no row sees what is left of the free unknowns.
const UNSEEN: f64 = 1e-7;

/// The problem w = M z + q with z = (Pn, T+, Dt-) of eq. (8.3) in which the free unknowns x and the forces of the rows J that
/// see them are basic:
///
/// ```text
/// w_J = M_JJ z_J + D_J x + M_JR z_R + q_J
/// 0   = -L^T z + (S + E) x - h              eq. (8.10)
/// ```
///
/// solved for z_J and x. In it w_J and z_J have changed places.
pub(crate) struct Pivoted<'a> {
    matrix: FrictionalMatrix<'a>,
    m: DMatrix<f64>,
    q: Vec<f64>,
    /// Whether w and z of an index have changed places.
    is_changed: Vec<bool>,
}

impl<'a> Pivoted<'a> {
    /// That of a scaled problem, unless what the rows J and S + E hold is singular.
    pub fn new(scaled: &'a Scaled<'a>) -> Option<Self> {
        let matrix = FrictionalMatrix::of(scaled);
        let (size, free) = (matrix.size(), scaled.free);
        let places = scaled.free_places();
        let contact = places.start;
        // M, D, -L^T and S + E over z and x
        let mut whole = DMatrix::zeros(size + free, size + free);
        for j in 0..size {
            for i in 0..size {
                whole[(i, j)] = matrix.entry(i, j);
            }
            let forces = matrix.forces(std::iter::once((j, 1.0)));
            for (k, force) in forces.iter().enumerate().take(contact) {
                for (row, place) in places.clone().enumerate() {
                    whole[(size + row, j)] += scaled.column(k)[place] * force;
                }
            }
        }
        for (x, place) in places.clone().enumerate() {
            let column = scaled.column(place);
            for i in 0..contact {
                whole[(i, size + x)] = matrix.sign(i) * column[i];
            }
            for (row, at) in places.clone().enumerate() {
                whole[(size + row, size + x)] = column[at];
            }
        }
        let mut q = matrix.q();
        q.extend(places.map(|place| scaled.b[place]));
        let seen = whole.view((0, size), (contact, free)).into_owned();
        let rows = rows_that_see(seen);
        let mut is_changed = vec![false; size];
        rows.iter().for_each(|&row| is_changed[row] = true);
        let (m, q) = transformed(&whole, &q, &rows, size)?;
        Some(Pivoted {
            matrix,
            m,
            q,
            is_changed,
        })
    }

    /// States at the end of the path with a covering vector, and the pivots that it took.
    pub fn states(&self, covering: &[f64]) -> Result<(Vec<ContactState>, usize), LcpError> {
        let vertex = follow_path(&self.m, &self.q, covering, &LemkeSettings::default())?;
        let basic = vertex.basic.iter().zip(&self.is_changed);
        let basic: Vec<bool> = basic.map(|(basic, changed)| basic ^ changed).collect();
        let states = self.matrix.states(&basic);
        Ok((states, vertex.pivots))
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.q.len()
    }
}

/// Rows of D that see its columns, at most one for each: those of the pivots of an elimination with full pivoting.
fn rows_that_see(mut d: DMatrix<f64>) -> Vec<usize> {
    let largest = d.amax();
    let mut rows = Vec::new();
    for _ in 0..d.ncols().min(d.nrows()) {
        let (row, column) = d.iamax_full();
        let pivot = d[(row, column)];
        if pivot.abs() <= UNSEEN * largest {
            break;
        }
        rows.push(row);
        let of_row = d.row(row) / pivot;
        let of_column = d.column(column).into_owned();
        d -= of_column * of_row;
        // the row and the column are spent, without round-off
        d.row_mut(row).fill(0.0);
        d.column_mut(column).fill(0.0);
    }
    rows.sort_unstable();
    rows
}

/// M and q of eq. (8.10) with w_J and z_J in each other's place, J being `rows`, and the unknowns from `size` on solved for.
fn transformed(
    whole: &DMatrix<f64>,
    q: &[f64],
    rows: &[usize],
    size: usize,
) -> Option<(DMatrix<f64>, Vec<f64>)> {
    let basic: Vec<usize> = rows.iter().copied().chain(size..whole.nrows()).collect();
    let others: Vec<usize> = (0..size).filter(|i| !rows.contains(i)).collect();
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, k| {
            whole[(rows[i], columns[k])]
        })
    };
    let (count, changed) = (basic.len(), rows.len());
    // (z_J, x) = K^-1 ((w_J, 0) - (M_R z_R + q))
    let factors = part(&basic, &basic).full_piv_lu();
    let of_changed = factors.solve(&DMatrix::identity(count, changed))?;
    let of_others = -factors.solve(&part(&basic, &others))?;
    let alone = DVector::from_fn(count, |i, _| -q[basic[i]]);
    let alone = factors.solve(&alone)?;
    let to_basic = part(&others, &basic);
    let mut m = DMatrix::zeros(size, size);
    let mut moved = vec![0.0; size];
    for (i, &row) in rows.iter().enumerate() {
        moved[row] = alone[i];
        for (k, &column) in rows.iter().enumerate() {
            m[(row, column)] = of_changed[(i, k)];
        }
        for (k, &column) in others.iter().enumerate() {
            m[(row, column)] = of_others[(i, k)];
        }
    }
    let own = part(&others, &others) + &to_basic * of_others;
    let by_changed = &to_basic * of_changed;
    let by_alone = &to_basic * alone;
    for (i, &row) in others.iter().enumerate() {
        moved[row] = q[row] + by_alone[i];
        for (k, &column) in rows.iter().enumerate() {
            m[(row, column)] = by_changed[(i, k)];
        }
        for (k, &column) in others.iter().enumerate() {
            m[(row, column)] = own[(i, k)];
        }
    }
    let is_finite = m.iter().chain(&moved).all(|value| value.is_finite());
    is_finite.then_some((m, moved))
}
