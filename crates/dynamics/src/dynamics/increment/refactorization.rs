//! Decides when K* is factorised anew in dynamic increments, by the measured rate of the corrections. See
//! docs/numerics.md, Kept factors of the stiffness.

use super::corrections::Corrections;
use crate::dynamics::results::Cause;
use crate::model::Factorization;

/// Expected rate of the corrections with fresh factors, until the rate is measured.
const FRESH_RATE: f64 = 0.03;
/// Cost of a factorisation, in passes.
const COST: f64 = 1.0;

/// Rule for the factors of K* that an attempt uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FactorRule {
    /// The available factors are used as long as this saves time.
    Kept,
    /// New factors are made for every pass.
    EveryPass,
}

impl FactorRule {
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
    corrections: Corrections,
    /// Whether the factors were made in this attempt.
    own: bool,
    /// Number of passes so far.
    passes: usize,
    /// Number of passes since the last factorisation.
    age: usize,
    worn: bool,
    /// Rate of the corrections with fresh factors.
    fresh_rate: f64,
}

impl Refactorization {
    /// Factors of an attempt, which begins with new factors if these are due.
    pub fn new(rule: FactorRule, are_due: bool, tolerance: f64) -> Self {
        Refactorization {
            rule,
            tolerance,
            corrections: Corrections::new(),
            own: false,
            passes: 0,
            age: 0,
            worn: are_due || rule != FactorRule::Kept,
            fresh_rate: FRESH_RATE,
        }
    }

    /// Corrections of the passes so far.
    pub fn corrections(&self) -> &Corrections {
        &self.corrections
    }

    /// Whether factors may serve in more than one pass.
    pub fn may_be_kept(&self) -> bool {
        self.rule == FactorRule::Kept
    }

    /// Whether K* is to be factorised before the next pass.
    pub fn are_worn(&self) -> bool {
        self.worn
    }

    /// Whether all passes so far had the same factors.
    pub fn are_of_all_passes(&self) -> bool {
        !self.own || self.age == self.passes
    }

    /// Whether no pass was made yet.
    pub fn are_first(&self) -> bool {
        self.passes == 0
    }

    /// Notes that K* has been factorised.
    pub fn renew(&mut self) {
        (self.own, self.age) = (true, 0);
    }

    /// Enters the relative correction of a pass. A growing correction is not divergence if `may_grow` is true.
    ///
    /// At the rate theta of the corrections, n(theta) = ln(correction/tolerance)/-ln(theta) further passes are needed.
    /// The factors are worn if n(theta) is larger than the number of passes with fresh factors plus the cost of the
    /// factorisation.
    pub fn take_in(&mut self, correction: f64, may_grow: bool) -> Result<(), Cause> {
        self.corrections.take_in(correction, may_grow)?;
        self.age += 1;
        self.passes += 1;
        let rate = self.corrections.rate();
        if self.own && self.age == 2 {
            self.fresh_rate = rate.clamp(FRESH_RATE, 0.5);
        }
        let left = |rate: f64| {
            if rate < 1.0 {
                ((correction / self.tolerance).ln() / -rate.ln()).max(0.0)
            } else {
                99.0
            }
        };
        self.worn = self.rule == FactorRule::EveryPass
            || (self.age >= 2 && left(rate) > COST + left(self.fresh_rate));
        Ok(())
    }
}
