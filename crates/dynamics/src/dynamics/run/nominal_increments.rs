//! Nominal time increments of a step and their parts. See docs/theory/time.md, Cutback.

use crate::dynamics::step::{Interval, StepPlace};
use crate::model::Increments;

/// Relative difference within which a step's duration counts as a multiple of its increment.
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
    /// Part number `part` of the 2^`halvings` parts of the increment.
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;

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
