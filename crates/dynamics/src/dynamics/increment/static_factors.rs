//! Decides when K is factorised anew in static increments, by the measured rates of kept and of new factors. See
//! docs/numerics.md, Kept factors of static steps.

use serde::{Deserialize, Serialize};

use super::refactorization::FactorRule;
use crate::dynamics::results::Cause;

/// Rate of the corrections from which on kept factors never save time.
const POOR: f64 = 0.3;
/// Expected rate of the corrections with kept factors, until the rate is measured.
const EXPECTED: f64 = 0.03;
/// Rate of the first pass with new factors up to which kept factors are tried again.
const SMOOTH: f64 = 0.01;
/// Least expected rate of the corrections with new factors.
const LEAST: f64 = 1e-4;
/// Cost of a factorisation, in passes.
const COST: f64 = 2.0;
/// Error of an iterate, relative to the increment, up to which the factors at this iterate show if the equilibrium is
/// stable.
const NEAR: f64 = 1e-3;
/// Rates of the corrections that the increments of a static step have measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct StaticRates {
    /// Rate of the corrections, within an increment, with the factors with which the increment began.
    kept: f64,
    /// Rate of the corrections with new factors, divided by the error of the iterate at which these factors are made.
    growth: f64,
    /// Relative correction of the first pass.
    first: f64,
}

impl Default for StaticRates {
    fn default() -> Self {
        StaticRates {
            kept: EXPECTED,
            growth: POOR,
            first: 1.0,
        }
    }
}

/// The factors of the passes of an attempt.
pub(super) struct StaticFactors {
    rates: StaticRates,
    /// Whether factors may serve in more than one pass.
    may_be_kept: bool,
    tolerance: f64,
    /// Whether the factors of the pass before the last and of the last pass were made in this attempt.
    are_own: [bool; 2],
    /// Number of passes so far.
    passes: usize,
    /// Number of passes since the last factorisation.
    age: usize,
    /// Error of the iterate at which the factors were made, relative to the increment.
    made_at: f64,
    /// Expected rate of the corrections with the factors.
    rate: f64,
    /// Correction of the last pass.
    last: Option<f64>,
    /// Whether the last correction was smaller than the correction before it. If the correction was not smaller, the
    /// contact states are still changing.
    falls: bool,
    /// Whether a pass has used the factors of an earlier pass.
    have_been_kept: bool,
}

impl StaticFactors {
    /// The factors of an attempt, which may begin with available factors.
    pub fn new(rates: StaticRates, rule: FactorRule, tolerance: f64) -> Self {
        StaticFactors {
            rates,
            may_be_kept: rule == FactorRule::Kept,
            tolerance,
            are_own: [false; 2],
            passes: 0,
            age: 0,
            made_at: 1.0,
            rate: rates.kept,
            last: None,
            falls: true,
            have_been_kept: false,
        }
    }

    /// Expected error of the next iterate, relative to the increment.
    fn error(&self) -> f64 {
        self.last
            .map_or(self.rates.first, |last| last * self.rate.min(1.0))
    }

    /// Whether K is to be factorised before the next pass.
    ///
    /// ```text
    /// n(theta) = ln(e/tolerance)/(-ln theta)
    /// n(theta) + s > COST + n(growth e) + s_new
    /// ```
    ///
    /// Here e is the error of the iterate at which factors would be made. The cost s of finding whether the end is
    /// stable is zero if the factors belong to an iterate near the end, else it is the cost of another factorisation.
    pub fn are_worn(&self) -> bool {
        if !self.may_be_kept || !self.falls || self.rate >= POOR {
            return true;
        }
        let error = self.error();
        let left = |rate: f64| ((error / self.tolerance).ln() / -rate.ln()).max(0.0);
        let of_stability = |made_at: f64| if made_at <= NEAR { 0.0 } else { COST };
        let new = (self.rates.growth * error).clamp(LEAST, POOR);
        left(self.rate) + of_stability(self.made_at) > COST + left(new) + of_stability(error)
    }

    /// Begins a pass with new factors or with the factors of the last pass.
    pub fn begin(&mut self, is_new: bool) {
        self.are_own = [self.are_own[1], self.are_own[1] || is_new];
        if is_new {
            self.age = 0;
        } else {
            self.have_been_kept = true;
        }
    }

    /// Enters the relative correction of a pass.
    ///
    /// # Errors
    /// Returns an error if the first pass used earlier factors and hardly decreased the correction,
    /// so the pass has led away from the solution.
    pub fn take_in(&mut self, correction: f64) -> Result<(), Cause> {
        self.age += 1;
        let of_last = self.are_own[0];
        match self.last {
            None => self.rates.first = correction,
            Some(last) => {
                let rate = match correction {
                    0.0 => 0.0,
                    _ => correction / last,
                };
                self.falls = rate < POOR;
                let is_first = self.passes == 1;
                if !of_last {
                    self.rates.kept = rate;
                    if is_first && rate >= POOR {
                        return Err(Cause::NotConverged);
                    }
                } else if is_first && rate <= SMOOTH && self.rates.kept >= POOR {
                    self.rates.kept = EXPECTED;
                }
                if self.age > 1 {
                    self.rate = rate;
                }
                if self.age == 2 && self.are_own[1] && last > 0.0 {
                    self.rates.growth = rate / last;
                }
            }
        }
        if self.age == 1 && self.are_own[1] {
            self.made_at = correction;
            self.rate = self.rates.growth * correction;
        }
        self.passes += 1;
        self.last = Some(correction);
        Ok(())
    }

    /// Enters the relative correction of the pass that ends the attempt.
    pub fn end(&mut self, correction: f64) {
        if self.age == 0 && self.are_own[1] {
            self.made_at = correction;
        }
    }

    /// Whether a pass has used the factors of an earlier pass.
    pub fn have_been_kept(&self) -> bool {
        self.have_been_kept
    }

    /// Whether the factors show if the equilibrium is stable.
    pub fn are_near(&self) -> bool {
        self.made_at <= NEAR
    }

    /// Rates of the corrections that the attempt has measured.
    pub fn rates(&self) -> StaticRates {
        self.rates
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-11;

    /// Number of passes and of factorisations of an increment. The error of the iterates falls by `growth` times the
    /// error at which the factors were made. The first error is `first`; with the factors of the last increment, the
    /// error falls at the rate `kept`.
    fn solve(rates: &mut StaticRates, growth: f64, [first, kept]: [f64; 2]) -> [usize; 2] {
        let mut factors = StaticFactors::new(*rates, FactorRule::Kept, TOLERANCE);
        let (mut error, mut rate, mut count) = (first, kept, [0; 2]);
        while error > TOLERANCE {
            let is_new = factors.are_worn();
            factors.begin(is_new);
            if is_new {
                rate = growth * error;
                count[1] += 1;
            }
            count[0] += 1;
            if factors.take_in(error).is_err() {
                break;
            }
            error *= rate;
        }
        *rates = factors.rates();
        count
    }

    #[test]
    fn smooth_increments_have_one_factorisation_near_their_end() {
        let mut rates = StaticRates::default();
        for increment in 0..10 {
            let [passes, factorizations] = solve(&mut rates, 0.3, [0.01, 3e-3]);
            let most = if increment == 0 { 2 } else { 1 };
            assert!(factorizations <= most, "{increment}: {factorizations}");
            assert!(passes <= 6, "{increment}: {passes}");
        }
    }

    #[test]
    fn kept_factors_that_do_not_pay_are_tried_again_where_motions_are_smooth() {
        let mut rates = StaticRates::default();
        assert_eq!(solve(&mut rates, 0.3, [0.5, 0.9]), [2, 1], "given up");
        assert!(rates.kept >= POOR);
        solve(&mut rates, 0.3, [0.02, 0.9]);
        assert_eq!(rates.kept, EXPECTED);
    }

    #[test]
    fn new_factors_of_a_pass_that_ends_tell_the_stability() {
        let rates = StaticRates::default();
        let mut factors = StaticFactors::new(rates, FactorRule::Kept, TOLERANCE);
        factors.begin(true);
        assert!(!factors.are_near());
        factors.end(1e-12);
        assert!(factors.are_near());
    }

    #[test]
    fn every_pass_has_new_factors_by_the_other_rule() {
        let mut factors =
            StaticFactors::new(StaticRates::default(), FactorRule::EveryPass, TOLERANCE);
        for error in [1.0, 1e-3, 1e-7] {
            assert!(factors.are_worn());
            factors.begin(true);
            factors.take_in(error).expect("new factors");
        }
        assert!(!factors.have_been_kept());
    }
}
