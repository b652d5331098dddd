//! One pass of an increment: errors, contact states, work of the complementarity problem.

/// One pass of an increment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PassReport {
    /// Relative force residual with the contact forces of the pass.
    pub residual: f64,
    /// Relative displacement correction.
    pub correction: f64,
    /// Number of pairs with Pn > 0.
    pub active: usize,
    /// Number of active pairs that stick.
    pub stick: usize,
    /// Number of pairs in the complementarity problem.
    pub lcp_size: usize,
    /// Number of pivots of Lemke's method.
    pub pivots: usize,
}
