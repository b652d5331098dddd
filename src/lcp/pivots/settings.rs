//! Limits and tolerances of Lemke's method.

use crate::lcp::problems::TOLERANCE;

/// Settings of Lemke's method.
#[derive(Debug, Clone, PartialEq)]
pub struct LemkeSettings {
    /// Basis exchanges allowed; None for 100 + 50 per unknown.
    pub max_pivots: Option<usize>,
    /// Ratios closer than this, relative to the larger of the ratio and 1, are tied.
    pub tie_tolerance: f64,
    /// Largest residual of a solution.
    pub residual_tolerance: f64,
}

impl Default for LemkeSettings {
    fn default() -> Self {
        Self {
            max_pivots: None,
            tie_tolerance: 1e-10,
            residual_tolerance: TOLERANCE,
        }
    }
}

impl LemkeSettings {
    /// Exchanges allowed for a problem of that size.
    pub(crate) fn pivot_limit(&self, size: usize) -> usize {
        self.max_pivots.unwrap_or(100 + 50 * size)
    }
}
