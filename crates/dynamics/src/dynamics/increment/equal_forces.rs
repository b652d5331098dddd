//! Weight of the equal-force rule: it keeps the forces of pairs that can carry the same force near their forces in the
//! last pass. See docs/theory/complementarity.md, Equal-force rule.

/// First weight of the rule, as a part of the compliance of a constraint.
pub(super) const FIRST_WEIGHT: f64 = 1e-5;
/// Factor on the weight from pass to pass.
const DECREASE: f64 = 0.1;
/// Least weight: with a smaller weight, the round-off of the gaps moves the forces.
const LEAST_WEIGHT: f64 = 1e-7;
/// Ratio of successive corrections above which corrections crawl: a weight at its least value then falls further.
const CRAWLING: f64 = 0.7;
/// Weight of the equal-force rule for corrections that crawl.
const WEIGHT_OF_CRAWLING: f64 = 1e-9;
/// Correction, in tolerances, below which a correction that does not decrease is round-off.
pub(super) const ROUND_OFF: f64 = 100.0;

/// Weight eps of eq. (5.3) from pass to pass.
///
/// Forces of pairs that are almost the same keep changing at the rate eps/(eps + lambda), where lambda is the
/// compliance of the pairs' difference relative to their own compliance. The weight therefore decreases from pass to
/// pass, which makes the changes of forces of almost equal pairs die away faster. If small corrections stay as large as
/// before with the same weight, the round-off of the gaps moves the forces, and the weight returns to its first value.
pub(crate) struct EqualForces {
    tolerance: f64,
    weight: f64,
    correction: f64,
    /// Whether the weight is less than in the last pass, so that a slow mode moves more.
    has_decreased: bool,
    holds: bool,
}

impl EqualForces {
    /// The state before the first pass of passes with the given `tolerance`.
    pub fn new(tolerance: f64) -> Self {
        EqualForces {
            tolerance,
            weight: FIRST_WEIGHT,
            correction: f64::INFINITY,
            has_decreased: false,
            holds: false,
        }
    }

    /// The weight of the next pass, if the search for the closed pairs is over (`settled`).
    pub fn weight(&self, settled: bool) -> Option<f64> {
        settled.then_some(self.weight)
    }

    /// Whether the weight has decreased since the last pass: a slow mode then moves more, which is not divergence.
    pub fn moves_more(&self) -> bool {
        self.has_decreased
    }

    /// Enters the relative correction of a pass; the pass used the weight if the search for the closed pairs is over
    /// (`settled`).
    pub fn take_in(&mut self, correction: f64, settled: bool) {
        if !settled {
            return;
        }
        let grows = correction >= self.correction;
        let crawls = !grows && correction > CRAWLING * self.correction;
        self.correction = correction;
        let stays = (grows || crawls) && !self.has_decreased;
        self.holds |= stays && correction < ROUND_OFF * self.tolerance;
        let weight = match self.weight {
            _ if self.holds => FIRST_WEIGHT,
            weight if weight > 2.0 * LEAST_WEIGHT => DECREASE * weight,
            _ if crawls => WEIGHT_OF_CRAWLING,
            weight => weight,
        };
        self.has_decreased = weight < 0.5 * self.weight;
        self.weight = weight;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_after_a_decrease_is_that_of_a_slow_mode() {
        let mut rule = EqualForces::new(1e-11);
        for correction in [1e-10, 2e-10, 1e-10] {
            rule.take_in(correction, true);
        }
        assert!(
            rule.weight(true)
                .is_some_and(|weight| weight < 2.0 * LEAST_WEIGHT)
        );
    }

    #[test]
    fn crawling_needs_a_smaller_weight_unless_it_is_round_off() {
        for (correction, expected) in [(1e-8, WEIGHT_OF_CRAWLING), (1e-10, FIRST_WEIGHT)] {
            let mut rule = EqualForces::new(1e-11);
            for part in [4.0, 2.0, 1.0, 0.99] {
                rule.take_in(part * correction, true);
            }
            assert_eq!(rule.weight(true), Some(expected), "{correction:e}");
        }
    }

    #[test]
    fn the_weight_decreases_until_round_off_grows() {
        let mut rule = EqualForces::new(1e-11);
        let mut weight = |correction| {
            rule.take_in(correction, true);
            rule.weight(true).unwrap_or(0.0)
        };
        let about = |weight: f64, expected: f64| (weight / expected - 1.0).abs() < 1e-12;
        assert!(about(weight(1e-4), 1e-6));
        assert!(about(weight(1e-3), 1e-7), "a slow mode moves more");
        assert!(about(weight(1e-10), 1e-7));
        assert!(about(weight(2e-10), 1e-5), "round-off grows");
        assert!(about(weight(1e-10), 1e-5));
    }
}
