//! Scale factors that are powers of two: multiplication by them is exact.

use nalgebra::DMatrix;

/// Sweeps over rows and columns when a matrix is equilibrated.
const SWEEPS: usize = 4;

/// Largest power of two <= |x|; 1 for zero.
pub(crate) fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    if x == 0.0 {
        return 1.0;
    }
    f64::from_bits(x.abs().to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
}

/// Row factors r and column factors c that bring the entries r_i M_ij c_j near 1.
pub(crate) struct Equilibration {
    /// Row factors.
    pub rows: Vec<f64>,
    /// Column factors.
    pub columns: Vec<f64>,
}

impl Equilibration {
    /// Factors for `m`: rows and columns are divided in turn by the root of largest times smallest
    /// entry, rounded to powers of two. Rows and columns of zeros keep the factor 1.
    pub fn of(m: &DMatrix<f64>) -> Self {
        let (mut rows, mut columns) = (vec![1.0; m.nrows()], vec![1.0; m.ncols()]);
        for _ in 0..SWEEPS {
            for (i, factor) in rows.iter_mut().enumerate() {
                *factor = inverse_mean((0..m.ncols()).map(|j| (m[(i, j)] * columns[j]).abs()));
            }
            for (j, factor) in columns.iter_mut().enumerate() {
                *factor = inverse_mean((0..m.nrows()).map(|i| (m[(i, j)] * rows[i]).abs()));
            }
        }
        Self { rows, columns }
    }

    /// The scaled matrix r_i M_ij c_j.
    pub fn apply(&self, m: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| {
            m[(i, j)] * self.rows[i] * self.columns[j]
        })
    }
}

/// One over the geometric mean of the largest and the smallest non-zero entry.
fn inverse_mean(entries: impl Iterator<Item = f64>) -> f64 {
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
    for entry in entries.filter(|e| *e > 0.0) {
        smallest = smallest.min(entry);
        largest = largest.max(entry);
    }
    if largest == 0.0 {
        1.0
    } else {
        1.0 / power_of_two(smallest.sqrt() * largest.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_of_two_keeps_the_exponent() {
        assert_eq!(power_of_two(1.0), 1.0);
        assert_eq!(power_of_two(-7.9), 4.0);
        assert_eq!(power_of_two(0.3), 0.25);
        assert_eq!(power_of_two(0.0), 1.0);
        assert_eq!(power_of_two(5e-324), f64::MIN_POSITIVE);
    }

    #[test]
    fn equilibration_undoes_row_and_column_scales() {
        let m = DMatrix::from_fn(3, 3, |i, j| {
            10f64.powi(8 * i as i32 - 9 * j as i32) * (1.0 + (i + j) as f64)
        });
        let scaled = Equilibration::of(&m).apply(&m);
        assert!(scaled.iter().all(|v| (0.1..10.0).contains(v)), "{scaled}");
    }
}
