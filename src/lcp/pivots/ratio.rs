//! The lexicographic ratio test.
//!
//! The right-hand side is perturbed to q + eps p + eps^2 e_1 + eps^3 e_2 + ..., p > 0, with eps
//! smaller than anything that occurs: ratios that tie on q are compared on p, then on the columns
//! of the inverse basis. The entries of p follow the golden ratio, so that the second comparison
//! almost always decides.

use super::basis::{Basis, PivotMatrix, Values, Variable};

/// The first perturbation p, of length n: 1 + fractional part of i / golden ratio.
pub(crate) fn perturbation(n: usize) -> Vec<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (1..=n).map(|i| 1.0 + (i as f64 * GOLDEN).fract()).collect()
}

/// Candidates of a ratio test, with the column entry that divides their value.
pub(crate) struct Candidates {
    rows: Vec<(Variable, f64)>,
    tolerance: f64,
}

impl Candidates {
    /// Rows that may leave, with positive divisors; ratios within `tolerance` are tied.
    pub fn new(rows: Vec<(Variable, f64)>, tolerance: f64) -> Self {
        Self { rows, tolerance }
    }

    /// Keeps the candidates whose ratio value / divisor ties with the smallest.
    pub fn keep_smallest(&mut self, value: impl Fn(Variable) -> f64) {
        let ratios: Vec<f64> = self.rows.iter().map(|(v, y)| value(*v) / y).collect();
        let smallest = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let limit = smallest + self.tolerance * smallest.abs().max(1.0);
        let mut ratio = ratios.into_iter();
        self.rows
            .retain(|_| ratio.next().is_some_and(|r| r <= limit));
    }

    /// Whether a variable is still a candidate.
    pub fn contains(&self, variable: Variable) -> bool {
        self.rows.iter().any(|(v, _)| *v == variable)
    }

    /// The first of the remaining candidates.
    pub fn first(&self) -> Option<Variable> {
        self.rows.first().map(|(v, _)| *v)
    }

    /// The candidate that remains when ties are broken by the values of p and then by the columns
    /// of the inverse basis.
    pub fn break_ties<M: PivotMatrix>(
        mut self,
        basis: &Basis<M>,
        perturbed: &Values,
    ) -> Option<Variable> {
        if self.rows.len() > 1 {
            self.keep_smallest(|v| perturbed.get(v));
        }
        for j in 0..basis.size() {
            if self.rows.len() < 2 {
                break;
            }
            let column = basis.solve(&basis.column(Variable::W(j)));
            self.keep_smallest(|v| column.get(v));
        }
        self.first()
    }
}
