//! Fixed grid: a nominal increment in halves, quarters ... that join again as soon as they align.
//! Section 4 of docs/theory.md, Cutback.

use super::nominal_increment::NominalIncrement;
use super::time_control::{Span, TimeControl};
use crate::dynamics::step::Interval;

/// A nominal increment of which the parts up to number `part` of 2^`halvings` are done.
pub(crate) struct Bisection {
    nominal: NominalIncrement,
    part: u32,
    halvings: u32,
}

impl Bisection {
    /// Starts with the increment as a whole.
    pub fn new(nominal: NominalIncrement) -> Self {
        Bisection {
            nominal,
            part: 0,
            halvings: 0,
        }
    }
}

impl TimeControl for Bisection {
    fn next(&self) -> Option<Span> {
        let interval = || self.nominal.part(self.part, self.halvings);
        (self.part < 1 << self.halvings).then(|| Span {
            interval: interval(),
            until_impact: false,
        })
    }

    fn halvings(&self) -> u32 {
        self.halvings
    }

    fn accepted(&mut self, _: &Interval, _: bool) {
        self.part += 1;
        while self.halvings > 0 && self.part.is_multiple_of(2) {
            (self.part, self.halvings) = (self.part / 2, self.halvings - 1);
        }
    }

    fn failed(&mut self, _: &Interval) {
        (self.part, self.halvings) = (2 * self.part, self.halvings + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::run::nominal_increment::tests::nominal;

    #[test]
    fn parts_join_as_soon_as_they_align() {
        let mut control = Bisection::new(nominal());
        let mut lengths = Vec::new();
        while let Some(Span { interval, .. }) = control.next() {
            // the first half of the increment needs two halvings, its second none
            if interval.start.step < 0.34 && interval.dt > 0.026 {
                control.failed(&interval);
            } else {
                lengths.push(interval.dt);
                control.accepted(&interval, false);
            }
        }
        assert_eq!(lengths, [0.025, 0.025, 0.05]);
        assert_eq!(control.halvings(), 0);
    }
}
