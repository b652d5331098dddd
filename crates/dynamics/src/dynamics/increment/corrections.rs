//! Decrease of the corrections from pass to pass: their rate, and whether they grow. See docs/theory/time.md.

use crate::dynamics::results::Cause;

/// Correction of a pass, relative to the increment, above which the iterate of the pass is not a solution even if its
/// forces are in balance.
const NEAR: f64 = 1e-4;
/// Ratio of successive corrections above which the corrections hardly decrease.
const STAGNANT: f64 = 0.5;
/// Number of passes after which slave nodes keep their targets; in earlier passes corrections may go to and fro with
/// the targets.
pub(super) const SEARCHING_PASSES: usize = 4;
/// Number of later passes in a row that may let the correction grow before an attempt is given up.
const GROWING: usize = 3;

/// Corrections of the passes of an attempt.
pub(super) struct Corrections {
    /// Passes done.
    passes: usize,
    /// The last correction, relative to the increment.
    last: f64,
    /// The last correction divided by the correction before it.
    rate: f64,
    /// Number of last passes, in a row, in which the correction has grown.
    growing: usize,
}

impl Corrections {
    /// None yet.
    pub fn new() -> Self {
        Corrections {
            passes: 0,
            last: f64::INFINITY,
            rate: 0.0,
            growing: 0,
        }
    }

    /// Whether the last correction was so small that the iterate may be the solution.
    pub fn are_near(&self) -> bool {
        self.last < NEAR
    }

    /// The last correction divided by the correction before it.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Whether the corrections hardly decrease; if small corrections hardly decrease, they are round-off.
    pub fn stagnate(&self) -> bool {
        self.rate > STAGNANT
    }

    /// Enters the relative correction of a pass. A growing correction is not divergence if `may_grow` is true.
    pub fn take_in(&mut self, correction: f64, may_grow: bool) -> Result<(), Cause> {
        let is_first = self.last == f64::INFINITY;
        let rate = match correction {
            0.0 => 0.0,
            _ => correction / self.last,
        };
        self.passes += 1;
        (self.last, self.rate) = (correction, rate);
        if is_first {
            return Ok(());
        }
        let grows = rate >= 1.0 && !may_grow && self.passes > SEARCHING_PASSES;
        self.growing = if grows { self.growing + 1 } else { 0 };
        match self.growing >= GROWING {
            true => Err(Cause::Diverged),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_in_a_row_is_divergence_unless_it_may_be() {
        for may_grow in [false, true] {
            let mut all = Corrections::new();
            let corrections = [1.0, 1e-3, 1e-6, 1e-10, 6e-8, 2e-7, 3e-7];
            let ends = corrections.map(|correction| all.take_in(correction, may_grow));
            let diverged = ends.iter().any(|end| matches!(end, Err(Cause::Diverged)));
            assert_eq!(diverged, !may_grow);
        }
    }
}
