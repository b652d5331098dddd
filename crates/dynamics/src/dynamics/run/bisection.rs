//! Fixed grid: a nominal increment is divided into halves, quarters and so on, which join again as
//! soon as they align. See docs/theory/time.md, Cutback.

use super::nominal_increments::NominalIncrement;
use super::time_control::{Ended, NextSubincrement, TimeControl};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::step::Interval;

/// A nominal increment whose parts up to number `part` of 2^`halvings` are done.
pub(crate) struct Bisection {
    nominal: NominalIncrement,
    part: u32,
    halvings: u32,
}

impl Bisection {
    /// Starts with the nominal increment as a whole.
    pub fn new(nominal: NominalIncrement) -> Self {
        Bisection {
            nominal,
            part: 0,
            halvings: 0,
        }
    }
}

impl TimeControl for Bisection {
    fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Bisection { part, halvings; nominal })
    }

    fn next(&self) -> Option<NextSubincrement> {
        let interval = || self.nominal.part(self.part, self.halvings);
        (self.part < 1 << self.halvings).then(|| NextSubincrement {
            interval: interval(),
            until_impact: false,
            nominal: self.nominal.length,
        })
    }

    fn halvings(&self) -> u32 {
        self.halvings
    }

    fn accepted(&mut self, _: &Interval, _: Ended) {
        self.part += 1;
        while self.halvings > 0 && self.part.is_multiple_of(2) {
            (self.part, self.halvings) = (self.part / 2, self.halvings - 1);
        }
    }

    fn failed(&mut self, _: &Interval, _: Option<f64>) {
        (self.part, self.halvings) = (2 * self.part, self.halvings + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::run::nominal_increments::tests::nominal;
    use crate::dynamics::run::time_control::testing::SMOOTH;

    #[test]
    fn parts_join_as_soon_as_they_align() {
        let mut control = Bisection::new(nominal());
        let mut lengths = Vec::new();
        while let Some(NextSubincrement { interval, .. }) = control.next() {
            // the first half of the increment needs two halvings, the second half none
            if interval.start.step < 0.34 && interval.dt > 0.026 {
                control.failed(&interval, None);
            } else {
                lengths.push(interval.dt);
                control.accepted(&interval, SMOOTH);
            }
        }
        assert_eq!(lengths, [0.025, 0.025, 0.05]);
        assert_eq!(control.halvings(), 0);
    }
}
