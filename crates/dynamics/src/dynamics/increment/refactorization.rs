//! When K* is factorised anew: by the measured rate of the corrections. docs/numerics.md, Kept factors of the
//! stiffness.

use crate::dynamics::results::Cause;
use crate::model::Factorization;

/// Correction of a pass beside the increment above which its iterate is no solution, whatever the forces
/// say.
const NEAR: f64 = 1e-4;
/// Rate that fresh factors are expected to have, until it has been measured.
const FRESH_RATE: f64 = 0.03;
/// Cost of a factorisation, in passes.
const COST: f64 = 1.0;
/// Rate of corrections that become hardly smaller.
const STAGNANT: f64 = 0.5;
/// Passes after which slave nodes keep their targets: before, corrections may go to and fro with them.
pub(super) const SEARCHING_PASSES: usize = 4;
/// Passes in a row that then grow the correction before an attempt is given up.
const GROWING: usize = 3;

/// Which factors an attempt uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FactorRule {
    /// Those at hand, as long as they pay.
    Kept,
    /// New ones at every pass.
    EveryPass,
    /// New ones at every pass, in which closed pairs are held, eq. (4.13).
    Held,
}

impl FactorRule {
    /// Whether every pass has new factors.
    fn is_every_pass(self) -> bool {
        matches!(self, FactorRule::EveryPass | FactorRule::Held)
    }

    /// The rules in the order in which they are tried.
    pub fn order(choice: Factorization) -> &'static [FactorRule] {
        match choice {
            Factorization::Keep => &[FactorRule::Kept, FactorRule::EveryPass],
            Factorization::EveryPass => &[FactorRule::EveryPass],
        }
    }
}

/// Factors of K* within an attempt.
pub(super) struct Refactorization {
    rule: FactorRule,
    tolerance: f64,
    /// Passes done.
    passes: usize,
    /// Whether the factors are of this attempt.
    own: bool,
    /// Passes since the last factorisation.
    age: usize,
    worn: bool,
    correction: f64,
    /// Last correction over the one before.
    rate: f64,
    /// Rate of fresh factors.
    fresh_rate: f64,
    growing: usize,
}

impl Refactorization {
    pub fn new(rule: FactorRule, tolerance: f64) -> Self {
        Refactorization {
            rule,
            tolerance,
            passes: 0,
            own: false,
            age: 0,
            worn: rule != FactorRule::Kept,
            correction: f64::INFINITY,
            rate: 0.0,
            fresh_rate: FRESH_RATE,
            growing: 0,
        }
    }

    /// Whether K* holds closed pairs.
    pub fn hold_pairs(&self) -> bool {
        self.rule == FactorRule::Held
    }

    /// Whether K* is to be factorised before the next pass.
    pub fn are_worn(&self) -> bool {
        self.worn
    }

    /// K* is factorised.
    pub fn renew(&mut self) {
        (self.own, self.age) = (true, 0);
    }

    /// Whether the last correction was so small that the iterate may be the solution.
    pub fn are_near(&self) -> bool {
        self.correction < NEAR
    }

    /// Last correction over the one before.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Whether the corrections become hardly smaller: where they are small, that is round-off.
    pub fn stagnate(&self) -> bool {
        self.rate > STAGNANT
    }

    /// Takes in the relative correction of a pass. That it grows is no divergence where it `may_grow`.
    ///
    /// n(theta) = ln(correction/tolerance)/-ln(theta) passes are left at the rate theta; the factors are
    /// worn when that is more than with fresh ones and the factorisation.
    pub fn take_in(&mut self, correction: f64, may_grow: bool) -> Result<(), Cause> {
        let rate = match correction {
            0.0 => 0.0,
            _ => correction / self.correction,
        };
        let is_first = self.correction == f64::INFINITY;
        self.passes += 1;
        self.age += 1;
        (self.correction, self.rate) = (correction, rate);
        if is_first {
            self.worn = self.rule.is_every_pass();
            return Ok(());
        }
        if self.own && self.age == 2 {
            self.fresh_rate = rate.clamp(FRESH_RATE, 0.5);
        }
        let grows = rate >= 1.0 && !may_grow && self.passes > SEARCHING_PASSES;
        self.growing = if grows { self.growing + 1 } else { 0 };
        if self.growing >= GROWING {
            return Err(Cause::Diverged);
        }
        let left = |rate: f64| {
            if rate < 1.0 {
                ((correction / self.tolerance).ln() / -rate.ln()).max(0.0)
            } else {
                99.0
            }
        };
        self.worn = self.rule.is_every_pass()
            || (self.age >= 2 && left(rate) > COST + left(self.fresh_rate));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_in_a_row_is_divergence_unless_it_may_be() {
        for may_grow in [false, true] {
            let mut factors = Refactorization::new(FactorRule::EveryPass, 1e-11);
            let corrections = [1.0, 1e-3, 1e-6, 1e-10, 6e-8, 2e-7, 3e-7];
            let ends = corrections.map(|correction| factors.take_in(correction, may_grow));
            let diverged = ends.iter().any(|end| matches!(end, Err(Cause::Diverged)));
            assert_eq!(diverged, !may_grow);
        }
    }
}
