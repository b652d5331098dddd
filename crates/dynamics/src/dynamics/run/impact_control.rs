//! Impact events: a nominal increment is divided into subincrements that end at impacts; a subincrement that fails is
//! halved. See docs/theory/impacts.md, Impacts as events.

use super::nominal_increments::NominalIncrement;
use super::time_control::{Ended, NextSubincrement, TimeControl};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::step::Interval;

/// Largest number of impact events within a nominal increment. Behind the last of these events the rest of the
/// increment is one subincrement without events, so that chattering contacts do not stall a run.
pub(super) const MOST_EVENTS: usize = 50;
/// Number of halvings of a subincrement from which on nodes land within the subincrement.
pub(super) const EVENT_HALVINGS: u32 = 2;

/// A nominal increment that is solved up to the step time `from`.
pub(crate) struct ImpactControl {
    nominal: NominalIncrement,
    from: f64,
    events: usize,
    /// End of the nominal increment and ends of its halves; the last entry of the list limits the next subincrement.
    ends: Vec<f64>,
}

impl ImpactControl {
    /// Starts with the nominal increment as a whole.
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
    fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => ImpactControl { from, events, ends; nominal })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::run::nominal_increments::tests::nominal;
    use crate::dynamics::run::time_control::testing::{IMPACT, SMOOTH};

    /// The first part, of the given length, of an interval that ends at an impact.
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
