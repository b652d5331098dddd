//! Wear of kept factors of K* over the increments of a dynamic step: when new factors pay, and in which state K* is
//! then assembled. See docs/numerics.md, Kept factors of the stiffness.

use serde::{Deserialize, Serialize};

/// Number of increments over which the mean number of passes of new factors is measured.
const NEW: u32 = 5;
/// Excess of the number of passes over its least mean that is allowed, as a part of this mean.
const SLACK: f64 = 0.05;
/// Cost of a factorisation, including the compliance of the contacts, in passes.
const COST: f64 = 10.0;
/// Part by which new factors must reduce the number of passes to have paid their cost.
const GAIN: f64 = 0.1;
/// Weight of the last number of passes in the running mean.
const LATEST: f64 = 0.2;
/// Factor by which [`Wear::bound`] grows after factors on trial that have not paid.
const RARER: f64 = 4.0;
/// Largest multiple of the cost of a factorisation that excess passes must reach.
const MOST: f64 = 256.0;

/// State for which new factors of K* are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FactoredState {
    /// The state of the iterate.
    Iterate,
    /// The state of the bodies without displacements, whose factors are then turned with the bodies.
    Unstrained,
}

/// Passes of the increments with the present factors.
///
/// The choice between old and new factors of K* is a choice between renting and buying. Every pass beyond the number of
/// passes with new factors is rent; when the rent reaches the cost of a factorisation, K* is factorised. If passes grow
/// evenly with the age of the factors, the best age for new factors is the age at which the rent reaches the cost of a
/// factorisation. New factors are on trial: if strains change in the next increments, these factors can be worse than
/// the factors of the unstrained bodies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Wear {
    /// Number of increments since the last factorisation.
    increments: u32,
    /// Mean number of passes in the first increments since the last factorisation.
    new: f64,
    /// Least value, since the start of the step, of the mean number of passes in the first increments after a
    /// factorisation.
    least: f64,
    /// Running mean of the number of passes.
    latest: f64,
    /// Running mean before the factors on trial were bought.
    before: Option<f64>,
    /// Whether factors on trial have not paid.
    has_failed: bool,
    /// Sum of the passes beyond the least mean (the rent).
    excess: f64,
    /// Multiple of the cost of a factorisation that the excess passes must reach.
    bound: f64,
}

impl Default for Wear {
    fn default() -> Self {
        Wear {
            increments: 0,
            new: 0.0,
            least: f64::INFINITY,
            latest: 0.0,
            before: None,
            has_failed: false,
            excess: 0.0,
            bound: 1.0,
        }
    }
}

impl Wear {
    /// Whether new factors pay at the start of an increment.
    pub fn is_due(&self) -> bool {
        self.has_failed || self.excess > self.bound * COST
    }

    /// Notes that K* is factorised for increments of another length, or for one pass; returns the state for which K* is
    /// factorised.
    pub fn begin(&mut self) -> FactoredState {
        *self = Wear {
            bound: self.bound,
            ..Wear::default()
        };
        FactoredState::Iterate
    }

    /// Notes that K* is factorised: at the `start` of an increment, or because the factors have worn in its passes.
    /// Returns the state for which the factors are made.
    pub fn renew(&mut self, at_start: bool) -> FactoredState {
        if !at_start && self.before.is_some() {
            self.fail();
        }
        let state = match self.has_failed {
            true => FactoredState::Unstrained,
            false => FactoredState::Iterate,
        };
        let is_bought = at_start && !self.has_failed && self.is_due();
        *self = Wear {
            before: is_bought.then_some(self.latest),
            bound: self.bound,
            least: self.least,
            ..Wear::default()
        };
        state
    }

    /// Notes that the factors on trial have not paid.
    fn fail(&mut self) {
        self.has_failed = true;
        self.bound = (RARER * self.bound).min(MOST);
    }

    /// Measures the passes of new factors, and decides whether these factors have paid.
    fn judge(&mut self) {
        if let Some(before) = self.before.take() {
            match self.new < (1.0 - GAIN) * before {
                true => self.bound = 1.0,
                false => self.fail(),
            }
        }
        self.least = self.least.min(self.new);
    }

    /// Enters the passes of an increment with the present factors.
    pub fn take_in(&mut self, passes: usize) {
        let passes = passes as f64;
        self.increments += 1;
        if self.increments <= NEW {
            self.new += (passes - self.new) / f64::from(self.increments);
            self.latest = self.new;
            if self.increments == NEW {
                self.judge();
            }
        } else {
            self.latest += LATEST * (passes - self.latest);
            self.excess = (self.excess + passes - (1.0 + SLACK) * self.least).max(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ages at which factors are renewed within a number of increments; `passes` gives the passes
    /// at an age.
    fn ages(increments: u32, passes: impl Fn(u32) -> usize) -> Vec<u32> {
        let mut wear = Wear::default();
        let (mut age, mut ages) = (0, Vec::new());
        for _ in 0..increments {
            if wear.is_due() {
                assert_eq!(wear.renew(true), FactoredState::Iterate);
                ages.push(std::mem::take(&mut age));
            }
            wear.take_in(passes(age));
            age += 1;
        }
        ages
    }

    #[test]
    fn rent_and_price_of_factors_are_alike_where_passes_grow_evenly() {
        let passes = |age: u32| 4 + age as usize / 5;
        let ages = ages(1000, passes);
        assert!(ages.len() > 50);
        let rent = |age: u32| (0..age).map(|age| passes(age) - 4).sum::<usize>() as f64;
        let is_priced = |&age: &u32| (rent(age) - COST).abs() <= 3.0;
        assert!(ages.iter().all(is_priced), "{ages:?}");
    }

    #[test]
    fn factors_that_do_not_age_stay() {
        assert!(ages(10_000, |_| 6).is_empty());
    }

    #[test]
    fn factors_that_have_not_paid_give_way_and_come_more_rarely() {
        let mut wear = Wear::default();
        let mut renewed: Vec<(u32, FactoredState)> = Vec::new();
        for increment in 0..10_000_u32 {
            if wear.is_due() {
                renewed.push((increment, wear.renew(true)));
            }
            wear.take_in(if increment < 10 { 4 } else { 8 });
        }
        let (trials, others): (Vec<&(u32, FactoredState)>, Vec<_>) =
            (renewed.iter()).partition(|(_, state)| *state == FactoredState::Iterate);
        assert_eq!(trials.len(), others.len());
        let since: Vec<u32> = trials
            .windows(2)
            .map(|ends| ends[1].0 - ends[0].0)
            .collect();
        assert!(since.is_sorted(), "{since:?}");
        assert!(since.last() > Some(&(20 * since[0])), "{since:?}");
    }

    #[test]
    fn factors_on_trial_that_wear_in_the_passes_have_failed() {
        let mut wear = Wear::default();
        for increment in 0..20 {
            wear.take_in(if increment < NEW { 4 } else { 8 });
        }
        assert!(wear.is_due());
        assert_eq!(wear.renew(true), FactoredState::Iterate);
        assert_eq!(wear.renew(false), FactoredState::Unstrained);
        assert!(!wear.is_due());
        assert_eq!(wear.renew(false), FactoredState::Iterate, "no trial");
        assert_eq!(wear.bound, RARER);
    }
}
