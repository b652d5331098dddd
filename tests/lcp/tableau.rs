//! The reference for speed: Lemke's method on a dense N x (N + 1) tableau, as in textbooks, with the
//! same lexicographic rule and tolerances.

use stickslip::lcp::Lcp;

/// Rows are the basic variables, columns the non-basic ones. Variables: w_i is i, z_i is N + i,
/// z0 is 2N.
struct Tableau {
    size: usize,
    /// N rows of N + 1 entries: B^-1 applied to the columns of the non-basic variables.
    values: Vec<f64>,
    rhs: Vec<f64>,
    basic: Vec<usize>,
    free: Vec<usize>,
}

impl Tableau {
    fn new(lcp: &Lcp, d: &[f64]) -> Self {
        let size = d.len();
        let mut values = Vec::with_capacity(size * (size + 1));
        for (i, d) in d.iter().enumerate() {
            values.extend((0..size).map(|j| -lcp.m[(i, j)]));
            values.push(-d);
        }
        Self {
            size,
            values,
            rhs: lcp.q.iter().copied().collect(),
            basic: (0..size).collect(),
            free: (size..=2 * size).collect(),
        }
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * (self.size + 1) + column]
    }

    fn column_of(&self, variable: usize) -> Option<usize> {
        self.free.iter().position(|v| *v == variable)
    }

    /// Exchanges the variables of a row and a column.
    fn pivot(&mut self, row: usize, column: usize) {
        let width = self.size + 1;
        let pivot = self.at(row, column);
        let mut pivot_row = self.values[row * width..(row + 1) * width].to_vec();
        pivot_row.iter_mut().for_each(|v| *v /= pivot);
        pivot_row[column] = 1.0 / pivot;
        self.rhs[row] /= pivot;
        let rhs = self.rhs[row];
        for (i, values) in self.values.chunks_exact_mut(width).enumerate() {
            let factor = values[column];
            if i == row || factor == 0.0 {
                continue;
            }
            values[column] = 0.0;
            values
                .iter_mut()
                .zip(&pivot_row)
                .for_each(|(v, p)| *v -= factor * p);
            self.rhs[i] = (self.rhs[i] - factor * rhs).max(0.0);
        }
        self.values[row * width..(row + 1) * width].copy_from_slice(&pivot_row);
        std::mem::swap(&mut self.basic[row], &mut self.free[column]);
    }

    /// Entry of B^-1: the column of w_j, a unit vector while w_j is basic.
    fn inverse(&self, row: usize, j: usize, column: Option<usize>) -> f64 {
        match column {
            Some(column) => self.at(row, column),
            None => f64::from(u8::from(self.basic[row] == j)),
        }
    }

    /// The row that leaves when `column` enters.
    fn leaving(&self, column: usize) -> Option<usize> {
        let mut rows: Vec<usize> = (0..self.size)
            .filter(|i| self.at(*i, column) > 1e-11)
            .collect();
        let keep = |rows: &mut Vec<usize>, value: &dyn Fn(usize) -> f64| {
            let ratio = |i: &usize| value(*i) / self.at(*i, column);
            let smallest = rows.iter().map(ratio).fold(f64::INFINITY, f64::min);
            rows.retain(|i| ratio(i) <= smallest + 1e-10 * smallest.abs().max(1.0));
        };
        keep(&mut rows, &|i| self.rhs[i]);
        if let Some(row) = rows.iter().find(|i| self.basic[**i] == 2 * self.size) {
            return Some(*row);
        }
        for j in 0..self.size {
            if rows.len() < 2 {
                break;
            }
            let w_column = self.column_of(j);
            keep(&mut rows, &|i| self.inverse(i, j, w_column));
        }
        rows.first().copied()
    }
}

/// z and the number of pivots; None on a ray.
pub fn tableau_lemke(lcp: &Lcp, d: &[f64]) -> Option<(Vec<f64>, usize)> {
    let size = d.len();
    let mut t = Tableau::new(lcp, d);
    let needy = (0..size).filter(|i| lcp.q[*i] < 0.0);
    let Some(row) = needy.min_by(|i, j| (lcp.q[*i] / d[*i]).total_cmp(&(lcp.q[*j] / d[*j]))) else {
        return Some((vec![0.0; size], 0));
    };
    t.pivot(row, size);
    let (mut pivots, mut left) = (1, row);
    loop {
        let complement = if left < size {
            left + size
        } else {
            left - size
        };
        let column = t.column_of(complement)?;
        let row = t.leaving(column)?;
        left = t.basic[row];
        t.pivot(row, column);
        pivots += 1;
        if left == 2 * size {
            break;
        }
    }
    let mut z = vec![0.0; size];
    for (variable, value) in t.basic.iter().zip(&t.rhs) {
        if (size..2 * size).contains(variable) {
            z[variable - size] = *value;
        }
    }
    Some((z, pivots))
}
