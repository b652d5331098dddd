//! Automatic increments of a step, whose length follows from their passes or from their truncation error. See
//! docs/theory/time.md, Automatic increments.

use super::impact_control::{EVENT_HALVINGS, MOST_EVENTS};
use super::nominal_increments::NominalIncrement;
use super::time_control::{Ended, NextSubincrement, TimeControl};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::step::{Interval, StepPlace};
use crate::model::{Incrementation, Increments};

/// Largest number of passes of an easy increment.
const EASY_PASSES: usize = 5;
/// Number of easy increments in a row after which increments grow.
const EASY_INCREMENTS: u32 = 2;
/// Factor by which an increment grows after easy increments.
const GROWTH: f64 = 1.5;
/// Factor by which the length of an increment changes after it has failed.
const CUT: f64 = 0.25;
/// Rest of the step, as a part of an increment, below which this rest is added to the increment.
const LEFT_OVER: f64 = 1e-6;
/// Largest number of rejections in a row because of the truncation error.
const REJECTIONS: u32 = 2;
/// Least factor on the length of an increment after a rejection.
const LEAST_PART: f64 = 0.3;
/// Safety factors on the length whose truncation error would equal the tolerance: after a rejection, and for growth.
const SAFE: f64 = 0.85;
const SAFE_GROWTH: f64 = 0.9;
/// Least growth for which new factors of K* are worth their cost.
const WORTHWHILE: f64 = 1.25;

/// Automatic increments of a whole step: longer after easy increments, shorter after failed increments. If the passes
/// decide the length of increments, a failed increment is cut to a quarter; the truncation error may decide the length
/// instead (docs/theory/time.md, Automatic increments).
pub(crate) struct Automatic {
    /// The step.
    nominal: NominalIncrement,
    increments: Increments,
    /// Whether impacts end subincrements.
    ends_at_impacts: bool,
    from: f64,
    dt: f64,
    /// Number of last increments, in a row, that allow growth.
    easy: u32,
    /// Number of cuts since the last accepted increment.
    cuts: u32,
    /// Number of cuts since the last accepted increment that are rejections because of the
    /// truncation error.
    rejections: u32,
    /// Number of last impacts, in a row, that have ended subincrements.
    events: usize,
}

impl Automatic {
    /// Starts a step with its first increment.
    pub fn new(place: StepPlace, increments: Increments, ends_at_impacts: bool) -> Self {
        Automatic {
            nominal: NominalIncrement {
                place,
                from: 0.0,
                to: place.end(),
                length: increments.dt,
                dt_min: increments.dt_min,
            },
            increments,
            ends_at_impacts,
            from: 0.0,
            dt: increments.dt,
            easy: 0,
            cuts: 0,
            rejections: 0,
            events: 0,
        }
    }

    /// The whole step as one increment.
    pub fn nominal(&self) -> NominalIncrement {
        self.nominal
    }

    /// Growth that an accepted increment allows the next increment; `None` if the increment was not easy.
    fn allowed_growth(&self, how: Ended) -> Option<f64> {
        let growth = match self.increments.incrementation {
            Incrementation::Error { tolerance } => {
                let safe = SAFE_GROWTH * (tolerance / how.error).sqrt();
                (safe > WORTHWHILE).then(|| safe.min(GROWTH))
            }
            _ => (how.passes <= EASY_PASSES).then_some(GROWTH),
        };
        growth.filter(|_| self.cuts == 0)
    }
}

impl TimeControl for Automatic {
    fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Automatic {
            from, dt, easy, cuts, rejections, events; nominal, increments, ends_at_impacts
        })
    }

    fn next(&self) -> Option<NextSubincrement> {
        let left = self.nominal.to - self.from;
        let by_error = matches!(self.increments.incrementation, Incrementation::Error { .. });
        let (end, dt) = if self.dt >= left * (1.0 - LEFT_OVER) {
            (self.nominal.to, left)
        } else if by_error && 2.0 * self.dt >= left {
            // two equal halves, so that no short increment is left over
            (self.from + left / 2.0, left / 2.0)
        } else if by_error {
            // the same length keeps the factors of K* valid
            (self.from + self.dt, self.dt)
        } else {
            let end = self.from + self.dt;
            (end, end - self.from)
        };
        (left > 0.0).then(|| NextSubincrement {
            interval: Interval {
                start: self.nominal.place.time_point(self.from),
                end: self.nominal.place.time_point(end),
                dt,
            },
            until_impact: self.ends_at_impacts
                && self.events < MOST_EVENTS
                && self.cuts - self.rejections < EVENT_HALVINGS,
            nominal: self.dt,
        })
    }

    fn halvings(&self) -> u32 {
        self.cuts
    }

    fn largest_error(&self, dt: f64) -> Option<f64> {
        let may_be_rejected = self.rejections < REJECTIONS && dt > self.nominal.dt_min;
        match self.increments.incrementation {
            Incrementation::Error { tolerance } => may_be_rejected.then_some(tolerance),
            _ => None,
        }
    }

    fn accepted(&mut self, interval: &Interval, how: Ended) {
        let growth = self.allowed_growth(how);
        (self.from, self.cuts, self.rejections) = (interval.end.step, 0, 0);
        self.events = if how.at_impact { self.events + 1 } else { 0 };
        // an increment that an impact has cut short says nothing about the length of whole ones
        if how.at_impact {
            return;
        }
        self.easy = growth.map_or(0, |_| self.easy + 1);
        if let Some(growth) = growth
            && self.easy >= EASY_INCREMENTS
        {
            self.dt = (growth * self.dt).min(self.increments.dt_max);
            self.easy = 0;
        }
    }

    fn failed(&mut self, interval: &Interval, error: Option<f64>) {
        let part = match (self.increments.incrementation, error) {
            (Incrementation::Error { tolerance }, Some(error)) => {
                self.rejections += 1;
                (SAFE * (tolerance / error).sqrt()).max(LEAST_PART)
            }
            (Incrementation::Error { .. }, None) => 0.5,
            _ => CUT,
        };
        self.dt = match error {
            Some(_) => (part * interval.dt).max(self.nominal.dt_min),
            None => part * interval.dt,
        };
        self.cuts += 1;
        self.easy = 0;
    }

    fn may_be_cut(&self, dt: f64, dt_min: f64) -> bool {
        let part = match self.increments.incrementation {
            Incrementation::Error { .. } => 0.5,
            _ => CUT,
        };
        part * dt >= dt_min
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::run::nominal_increments::tests::nominal;
    use crate::dynamics::run::time_control::testing::SMOOTH;

    #[test]
    fn increments_grow_after_easy_ones_and_are_cut_to_a_quarter() {
        let increments = Increments {
            dt: 0.1,
            period: 1.0,
            dt_min: 1e-3,
            dt_max: 0.3,
            incrementation: Incrementation::Passes,
        };
        let mut control = Automatic::new(nominal().place, increments, false);
        let (mut lengths, mut has_failed) = (Vec::new(), false);
        while let Some(NextSubincrement { interval, .. }) = control.next() {
            if interval.end.step > 0.51 && !has_failed {
                has_failed = true;
                assert!(control.may_be_cut(interval.dt, 1e-3));
                control.failed(&interval, None);
                continue;
            }
            lengths.push(interval.dt);
            control.accepted(&interval, SMOOTH);
        }
        // the increment after a cut does not count as easy, and the rest ends the step
        let expected = [
            0.1, 0.1, 0.15, 0.15, 0.05625, 0.05625, 0.05625, 0.084375, 0.084375, 0.1265625,
            0.0359375,
        ];
        assert_eq!(lengths.len(), expected.len());
        for (length, expected) in lengths.iter().zip(expected) {
            assert!((length - expected).abs() < 1e-12, "{length} {expected}");
        }
    }

    /// Runs a step of length 1 whose increments have the error `error(start, dt)`; returns the lengths of the accepted
    /// and of the repeated increments.
    fn lengths(error: impl Fn(f64, f64) -> f64) -> [Vec<f64>; 2] {
        let increments = Increments {
            dt: 0.01,
            period: 1.0,
            dt_min: 1e-4,
            dt_max: 0.1,
            incrementation: Incrementation::Error { tolerance: 1e-4 },
        };
        let mut control = Automatic::new(nominal().place, increments, false);
        let [mut accepted, mut repeated] = [Vec::new(), Vec::new()];
        while let Some(NextSubincrement { interval, .. }) = control.next() {
            let error = error(interval.start.step, interval.dt);
            match control.largest_error(interval.dt) {
                Some(tolerance) if error > tolerance => {
                    repeated.push(interval.dt);
                    control.failed(&interval, Some(error));
                }
                _ => {
                    accepted.push(interval.dt);
                    control.accepted(&interval, Ended { error, ..SMOOTH });
                }
            }
        }
        [accepted, repeated]
    }

    #[test]
    fn increments_follow_an_error_of_second_order() {
        // an error of 1e-4 at the length 0.05
        let [accepted, repeated] = lengths(|_, dt| 0.04 * dt * dt);
        assert!(repeated.is_empty(), "{repeated:?}");
        assert!((accepted.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!(accepted[..4], [0.01, 0.01, 0.015, 0.015]);
        let longest = accepted.iter().fold(0.0, |a: f64, b| a.max(*b));
        assert!(longest > 0.036 && longest < 0.05, "{longest}");
        // the last two have one length
        let [.., a, b] = accepted[..] else { panic!() };
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn an_error_that_stays_rejects_twice_and_not_below_the_least_increment() {
        let [accepted, repeated] = lengths(|start, _| f64::from(u8::from(start >= 0.5)));
        let [first @ .., _, _] = &accepted[..] else {
            panic!()
        };
        let least = first.iter().fold(1.0, |a: f64, b| a.min(*b));
        assert!(least >= 1e-4 * (1.0 - 1e-9), "{least}");
        let before = accepted
            .iter()
            .take_while(|dt| **dt <= 0.1 + 1e-12 && **dt > 0.009)
            .count();
        assert!(before > 5 && repeated.len() < 12, "{repeated:?}");
    }
}
