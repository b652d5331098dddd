//! Nominal time increments of a step and their bisection. Section 4 of docs/theory.md, Cutback.

use crate::dynamics::step::{Interval, StepPlace};

/// A step's duration counts as a multiple of its increment within this relative difference.
pub(crate) const WHOLE: f64 = 1e-6;

/// One nominal increment of a step, in step time.
#[derive(Clone, Copy)]
pub(crate) struct NominalIncrement {
    pub from: f64,
    pub to: f64,
    pub length: f64,
    pub dt_min: f64,
}

impl NominalIncrement {
    /// Subincrement number `piece` of 2^halvings.
    pub fn piece(&self, place: StepPlace, piece: u32, halvings: u32) -> Interval {
        let parts = f64::from(1_u32 << halvings);
        let at = |k: u32| match k {
            0 => self.from,
            k if k == 1 << halvings => self.to,
            k => self.from + self.length * (f64::from(k) / parts),
        };
        Interval {
            start: place.time_point(at(piece)),
            end: place.time_point(at(piece + 1)),
            dt: self.length / parts,
        }
    }
}

/// Number of increments of length `dt` in a step; the last may be shorter.
pub(crate) fn increments_of(period: f64, dt: f64) -> usize {
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
mod tests {
    use super::*;

    #[test]
    fn increments_fill_the_step() {
        assert_eq!(increments_of(1.0, 0.1), 10);
        assert_eq!(increments_of(13333.0 * 1.5e-5, 1.5e-5), 13333);
        assert_eq!(increments_of(1.05, 0.1), 11);
        assert_eq!(increments_of(0.05, 0.1), 1);
    }

    #[test]
    fn pieces_of_an_increment_meet() {
        let place = StepPlace {
            number: 1,
            start: 2.0,
            period: 1.0,
        };
        let nominal = NominalIncrement {
            from: 0.3,
            to: 0.4,
            length: 0.1,
            dt_min: 0.0,
        };
        let pieces: Vec<Interval> = (0..4).map(|k| nominal.piece(place, k, 2)).collect();
        assert_eq!((pieces[0].start.step, pieces[3].end.step), (0.3, 0.4));
        for pair in pieces.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
        }
        assert!(pieces.iter().all(|piece| piece.dt == 0.025));
    }
}
