//! How kept factors of K* wear over the increments of a dynamic step, and when new ones pay. docs/numerics.md, Kept factors
//! of the stiffness.

use serde::{Deserialize, Serialize};

/// Increments whose mean number of passes is that of new factors.
const NEW: u32 = 5;
/// Part of the least such mean that passes may have beyond it.
const SLACK: f64 = 0.05;
/// Cost of a factorisation, with the compliance of the contacts, in passes.
const COST: f64 = 5.0;
/// Part by which new factors must lower the passes to have paid.
const GAIN: f64 = 0.1;
/// Part of the last number in the mean of the latest ones.
const LATEST: f64 = 0.2;
/// Largest multiple of its cost from which on a factorisation pays.
const MOST: f64 = 64.0;

/// Passes of the increments with the factors at hand.
///
/// Factors of K* are rented: every pass beyond those that new ones have needed is rent, and once it comes to the price of new
/// ones, they are bought. If passes grow evenly with the age of the factors, that is the best age.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Wear {
    /// Increments since the last factorisation.
    increments: u32,
    /// Mean number of passes of the first of them.
    new: f64,
    /// Least such mean of the step.
    least: f64,
    /// Mean number of passes of the latest.
    latest: f64,
    /// The same before the last factorisation.
    before: Option<f64>,
    /// Passes beyond the least mean.
    excess: f64,
    /// Multiple of its cost from which on a factorisation pays.
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
            excess: 0.0,
            bound: 1.0,
        }
    }
}

impl Wear {
    /// Whether new factors pay.
    pub fn is_due(&self) -> bool {
        self.excess > self.bound * COST
    }

    /// K* is factorised.
    pub fn renew(&mut self) {
        *self = Wear {
            before: (self.increments >= NEW)
                .then_some(self.latest)
                .or(self.before),
            bound: self.bound,
            least: self.least,
            ..Wear::default()
        };
    }

    /// Sees what the passes of new factors are, and whether these have paid.
    fn judge(&mut self) {
        self.least = self.least.min(self.new);
        if let Some(before) = self.before {
            let has_paid = self.new < (1.0 - GAIN) * before;
            let longer = (2.0 * self.bound).min(MOST);
            self.bound = if has_paid { 1.0 } else { longer };
        }
    }

    /// Takes in the passes of an increment with the factors at hand.
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

    /// Ages at which factors are renewed, in so many increments with the passes of an age.
    fn ages(increments: u32, passes: impl Fn(u32) -> usize) -> Vec<u32> {
        let mut wear = Wear::default();
        let (mut age, mut ages) = (0, Vec::new());
        for _ in 0..increments {
            if wear.is_due() {
                wear.renew();
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
        assert!(ages(10_000, |age| if age % 3 == 0 { 3 } else { 2 }).len() <= 7);
    }

    #[test]
    fn renewals_that_do_not_pay_become_rarer() {
        let mut wear = Wear::default();
        let renewed: Vec<u32> = (0..10_000)
            .filter(|increment| {
                let is_due = wear.is_due();
                if is_due {
                    wear.renew();
                }
                wear.take_in(if *increment < 10 { 4 } else { 8 });
                is_due
            })
            .collect();
        let since: Vec<u32> = renewed.windows(2).map(|ends| ends[1] - ends[0]).collect();
        assert!(since.is_sorted(), "{since:?}");
        assert!(since.last() > Some(&(10 * since[0])), "{since:?}");
    }
}
