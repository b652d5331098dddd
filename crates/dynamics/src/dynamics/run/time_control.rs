//! Time control of a step: how the increments of its grid are divided. Section 4 of docs/theory.md,
//! Cutback, and section 6, Impacts as events.
//!
//! Nominal time increments of a step and their bisection. Section 4 of docs/theory.md, Cutback.
//!
//! Fixed grid: a nominal increment in halves, quarters ... that join again as soon as they align.
//! Section 4 of docs/theory.md, Cutback.
//!
//! Impact events: a nominal increment in subincrements that end at impacts, or halfway where one
//! fails. Section 6 of docs/theory.md, Impacts as events.

use crate::archive::{Archive, ArchiveError, carry_fields};
use crate::dynamics::step::{Interval, StepPlace};
use crate::model::{Incrementation, Increments};

/// The next subincrement of a time control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NextSubincrement {
    pub interval: Interval,
    /// Whether the next impact ends it.
    pub until_impact: bool,
    /// Length of the increment that it is part of (time).
    pub nominal: f64,
}

/// Divides one nominal increment.
pub(crate) trait TimeControl {
    /// The next subincrement; none at the end of the nominal increment.
    fn next(&self) -> Option<NextSubincrement>;

    /// Number of halvings of the next subincrement.
    fn halvings(&self) -> u32;

    /// Continues from the end of an accepted interval.
    fn accepted(&mut self, interval: &Interval, how: Ended);

    /// Truncation error above which a converged interval of this length is repeated; none where it counts as it is.
    fn largest_error(&self, _dt: f64) -> Option<f64> {
        None
    }

    /// Cuts an interval that failed, or whose truncation error is too large.
    fn failed(&mut self, interval: &Interval, error: Option<f64>);

    /// Carries how far the nominal increment is solved.
    ///
    /// # Errors
    /// What is read is no such control.
    fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError>;

    /// Whether an interval of this length may be cut once more; `dt_min` is the least of the step.
    fn may_be_cut(&self, dt: f64, dt_min: f64) -> bool {
        self.halvings() < HALVINGS && dt / 2.0 >= dt_min
    }
}

/// How an accepted interval ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ended {
    /// Whether an impact has ended it.
    pub at_impact: bool,
    /// Passes that it took.
    pub passes: usize,
    /// Its truncation error, beside the displacements.
    pub error: f64,
}

/// Most halvings of an increment; a further failure stops the run.
const HALVINGS: u32 = 10;

/// A step's duration counts as a multiple of its increment within this relative difference.
const WHOLE: f64 = 1e-6;

/// One nominal increment of a step, in step time.
#[derive(Clone, Copy)]
pub(crate) struct NominalIncrement {
    pub place: StepPlace,
    pub from: f64,
    pub to: f64,
    pub length: f64,
    pub dt_min: f64,
}

impl NominalIncrement {
    /// Part number `part` of 2^halvings.
    pub fn part(&self, part: u32, halvings: u32) -> Interval {
        let parts = f64::from(1_u32 << halvings);
        let at = |k: u32| match k {
            0 => self.from,
            k if k == 1 << halvings => self.to,
            k => self.from + self.length * (f64::from(k) / parts),
        };
        Interval {
            start: self.place.time_point(at(part)),
            end: self.place.time_point(at(part + 1)),
            dt: self.length / parts,
        }
    }
}

/// The nominal increments of a step.
pub(crate) fn nominal_increments(
    place: StepPlace,
    Increments { dt, dt_min, .. }: Increments,
) -> impl Iterator<Item = NominalIncrement> {
    let count = increments_of(place.end(), dt);
    (0..count).map(move |i| {
        let from = dt * i as f64;
        let to = if i + 1 == count {
            place.end()
        } else {
            dt * (i + 1) as f64
        };
        // the nominal length keeps the factors of K* valid; only a last, shorter one differs
        let is_shorter = to - from < dt * (1.0 - WHOLE);
        NominalIncrement {
            place,
            from,
            to,
            length: if is_shorter { to - from } else { dt },
            dt_min,
        }
    })
}

/// Number of increments of length `dt` in a step; the last may be shorter.
fn increments_of(period: f64, dt: f64) -> usize {
    let ratio = period / dt;
    let whole = ratio.round();
    let count = if (ratio - whole).abs() <= WHOLE * whole {
        whole
    } else {
        ratio.ceil()
    };
    (count as usize).max(1)
}

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
    fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        carry_fields!(archive, self => Bisection { part, halvings; nominal })
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

/// Impact events within a nominal increment, after which its rest is one subincrement without events:
/// chattering contacts must not stall a run.
const MOST_EVENTS: usize = 50;
/// Halvings of a subincrement from which on nodes land within it.
const EVENT_HALVINGS: u32 = 2;

/// A nominal increment that is solved up to the step time `from`.
pub(crate) struct ImpactControl {
    nominal: NominalIncrement,
    from: f64,
    events: usize,
    /// End of the nominal increment and ends of its halves; the last entry bounds the next
    /// subincrement.
    ends: Vec<f64>,
}

impl ImpactControl {
    /// Starts with the increment as a whole.
    pub fn new(nominal: NominalIncrement) -> Self {
        ImpactControl {
            from: nominal.from,
            events: 0,
            ends: vec![nominal.to],
            nominal,
        }
    }
}

impl TimeControl for ImpactControl {
    fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        carry_fields!(archive, self => ImpactControl { from, events, ends; nominal })
    }

    fn next(&self) -> Option<NextSubincrement> {
        let to = *self.ends.last()?;
        let NominalIncrement { place, length, .. } = self.nominal;
        let is_whole = self.from == self.nominal.from && to == self.nominal.to;
        Some(NextSubincrement {
            interval: Interval {
                start: place.time_point(self.from),
                end: place.time_point(to),
                dt: if is_whole { length } else { to - self.from },
            },
            until_impact: self.events < MOST_EVENTS && self.halvings() < EVENT_HALVINGS,
            nominal: length,
        })
    }

    fn halvings(&self) -> u32 {
        self.ends.len().saturating_sub(1) as u32
    }

    fn accepted(&mut self, interval: &Interval, how: Ended) {
        self.from = interval.end.step;
        if how.at_impact {
            self.events += 1;
        } else {
            self.ends.pop();
        }
    }

    fn failed(&mut self, interval: &Interval, _: Option<f64>) {
        self.ends.push(self.from + interval.dt / 2.0);
    }
}

/// Passes up to which an increment is easy.
const EASY_PASSES: usize = 5;
/// Easy increments after which they grow.
const EASY_INCREMENTS: u32 = 2;
/// Growth of an increment after easy ones.
const GROWTH: f64 = 1.5;
/// Part of an increment that is tried after it has failed.
const CUT: f64 = 0.25;
/// Part of an increment that is not left over for one of its own.
const LEFT_OVER: f64 = 1e-6;
/// Rejections in a row because of the truncation error.
const REJECTIONS: u32 = 2;
/// Least part of a rejected increment that is tried next.
const LEAST_PART: f64 = 0.3;
/// Part of the length with an error of the tolerance that is tried after a rejection, and that an increment grows to.
const SAFE: f64 = 0.85;
const SAFE_GROWTH: f64 = 0.9;
/// Growth that is worth new factors of K*.
const WORTHWHILE: f64 = 1.25;

/// Automatic increments of a whole step, shorter where one fails and longer after easy ones: by their passes, cut to a
/// quarter where one fails, or by their truncation error (section 4 of docs/theory.md, Automatic increments).
pub(crate) struct Automatic {
    /// The step.
    nominal: NominalIncrement,
    increments: Increments,
    /// Whether impacts end subincrements.
    ends_at_impacts: bool,
    from: f64,
    dt: f64,
    /// Increments in a row that allow growth.
    easy: u32,
    /// Cuts since the last accepted increment.
    cuts: u32,
    /// Those of them because of the truncation error, in a row.
    rejections: u32,
    /// Impacts in a row that have ended subincrements.
    events: usize,
}

impl Automatic {
    /// Starts with the first increment of a step.
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

    /// The step as one increment.
    pub fn nominal(&self) -> NominalIncrement {
        self.nominal
    }

    /// Growth that an accepted increment allows the next one; none where it was not easy.
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
    fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        carry_fields!(archive, self => Automatic {
            from, dt, easy, cuts, rejections, events; nominal, increments, ends_at_impacts
        })
    }

    fn next(&self) -> Option<NextSubincrement> {
        let left = self.nominal.to - self.from;
        let by_error = matches!(self.increments.incrementation, Incrementation::Error { .. });
        let (end, dt) = if self.dt >= left * (1.0 - LEFT_OVER) {
            (self.nominal.to, left)
        } else if by_error && 2.0 * self.dt >= left {
            // no short one is left over
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
        // what an impact has cut short says nothing of the whole
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
mod nominal_tests {
    use super::*;

    /// Ends of subincrements.
    pub const SMOOTH: Ended = Ended {
        at_impact: false,
        passes: 4,
        error: 0.0,
    };
    pub const IMPACT: Ended = Ended {
        at_impact: true,
        passes: 4,
        error: 0.0,
    };

    /// The increment from 0.3 to 0.4 of a step that starts at 2.
    pub fn nominal() -> NominalIncrement {
        NominalIncrement {
            place: StepPlace {
                number: 1,
                start: 2.0,
                period: 1.0,
                extension: 0.0,
            },
            from: 0.3,
            to: 0.4,
            length: 0.1,
            dt_min: 0.0,
        }
    }

    #[test]
    fn increments_fill_the_step() {
        assert_eq!(increments_of(1.0, 0.1), 10);
        assert_eq!(increments_of(13333.0 * 1.5e-5, 1.5e-5), 13333);
        assert_eq!(increments_of(1.05, 0.1), 11);
        assert_eq!(increments_of(0.05, 0.1), 1);
    }

    #[test]
    fn the_last_increment_may_be_shorter() {
        let place = StepPlace {
            period: 0.25,
            ..nominal().place
        };
        let increments = Increments::fixed(0.1, 0.25);
        let all: Vec<NominalIncrement> = nominal_increments(place, increments).collect();
        assert_eq!(all.len(), 3);
        assert_eq!((all[1].to, all[2].to), (all[2].from, 0.25));
        assert_eq!((all[0].length, all[1].length), (0.1, 0.1));
        assert!((all[2].length - 0.05).abs() < 1e-15);
    }

    #[test]
    fn parts_of_an_increment_meet() {
        let parts: Vec<Interval> = (0..4).map(|k| nominal().part(k, 2)).collect();
        assert_eq!((parts[0].start.step, parts[3].end.step), (0.3, 0.4));
        for pair in parts.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
        }
        assert!(parts.iter().all(|part| part.dt == 0.025));
    }
}

#[cfg(test)]
mod tests {
    use super::nominal_tests::{SMOOTH, nominal};
    use super::*;

    #[test]
    fn parts_join_as_soon_as_they_align() {
        let mut control = Bisection::new(nominal());
        let mut lengths = Vec::new();
        while let Some(NextSubincrement { interval, .. }) = control.next() {
            // the first half of the increment needs two halvings, its second none
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

#[cfg(test)]
mod impact_control_tests {
    use super::nominal_tests::{IMPACT, SMOOTH, nominal};
    use super::*;

    /// The first part of an interval, up to an impact.
    fn up_to(interval: Interval, length: f64) -> Interval {
        let end = interval.start.step + length;
        Interval {
            end: nominal().place.time_point(end),
            dt: length,
            ..interval
        }
    }

    #[test]
    fn subincrements_fill_the_increment() {
        let mut control = ImpactControl::new(nominal());
        let mut lengths = Vec::new();
        let mut next = |control: &ImpactControl| {
            let span = control.next().expect("something is left");
            lengths.push((span.interval.dt * 1e3).round());
            span.interval
        };
        let whole = next(&control);
        control.accepted(&up_to(whole, 0.02), IMPACT);
        let rest = next(&control);
        control.failed(&rest, None);
        assert_eq!(control.halvings(), 1);
        let half = next(&control);
        control.accepted(&half, SMOOTH);
        let other = next(&control);
        control.accepted(&other, SMOOTH);
        assert_eq!(control.next(), None);
        assert_eq!(lengths, [100.0, 80.0, 40.0, 40.0]);
        assert_eq!(other.end, whole.end);
    }

    #[test]
    fn what_fails_with_events_is_solved_without() {
        let mut control = ImpactControl::new(nominal());
        let mut with_events = Vec::new();
        for _ in 0..3 {
            let span = control.next().expect("something is left");
            with_events.push(span.until_impact);
            control.failed(&span.interval, None);
        }
        assert_eq!(with_events, [true, true, false]);
        while let Some(span) = control.next() {
            with_events.push(span.until_impact);
            control.accepted(&span.interval, SMOOTH);
        }
        assert_eq!(with_events[3..], [false, false, true, true]);
    }

    #[test]
    fn contacts_that_chatter_do_not_stall() {
        let mut control = ImpactControl::new(nominal());
        let mut count = 0;
        while let Some(NextSubincrement {
            interval,
            until_impact: true,
            ..
        }) = control.next()
        {
            count += 1;
            control.accepted(&up_to(interval, 1e-4), IMPACT);
        }
        assert_eq!(count, MOST_EVENTS);
        let rest = control.next().expect("the rest");
        assert_eq!(rest.interval.end, nominal().place.time_point(nominal().to));
    }
}

#[cfg(test)]
mod automatic_tests {
    use super::nominal_tests::{SMOOTH, nominal};
    use super::*;

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
        // the cut one is not easy, and what is left ends the step
        let expected = [
            0.1, 0.1, 0.15, 0.15, 0.05625, 0.05625, 0.05625, 0.084375, 0.084375, 0.1265625,
            0.0359375,
        ];
        assert_eq!(lengths.len(), expected.len());
        for (length, expected) in lengths.iter().zip(expected) {
            assert!((length - expected).abs() < 1e-12, "{length} {expected}");
        }
    }

    /// Runs a step of length 1 whose increments have errors `error(dt)`; lengths of the accepted and of the repeated ones.
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
