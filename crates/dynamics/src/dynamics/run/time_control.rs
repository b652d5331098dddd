//! Time control of a step: division of the increments of its grid. See docs/theory/time.md,
//! Cutback, and docs/theory/impacts.md, Impacts as events.

use crate::archive::{Archive, ArchiveError};
use crate::dynamics::step::Interval;

/// Largest number of halvings of an increment; a further failure stops the run.
const HALVINGS: u32 = 10;

/// The next subincrement of a time control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NextSubincrement {
    pub interval: Interval,
    /// Whether the next impact ends the subincrement.
    pub until_impact: bool,
    /// Length of the increment to which the subincrement belongs (time).
    pub nominal: f64,
}

/// Divides one nominal increment into subincrements.
pub(crate) trait TimeControl {
    /// The next subincrement; `None` at the end of the nominal increment.
    fn next(&self) -> Option<NextSubincrement>;

    /// Number of halvings of the next subincrement.
    fn halvings(&self) -> u32;

    /// Continues from the end of an accepted interval.
    fn accepted(&mut self, interval: &Interval, how: Ended);

    /// Truncation error above which a converged interval of a given length is repeated; `None` if the interval is
    /// accepted with any error.
    fn largest_error(&self, _dt: f64) -> Option<f64> {
        None
    }

    /// Divides an interval that has failed, or whose truncation error is too large.
    fn failed(&mut self, interval: &Interval, error: Option<f64>);

    /// Transfers the progress of the nominal increment to or from an archive.
    ///
    /// # Errors
    /// The archive belongs to another kind of time control.
    fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError>;

    /// Whether an interval of a given length may be cut once more; `dt_min` is the least length that the step allows.
    fn may_be_cut(&self, dt: f64, dt_min: f64) -> bool {
        self.halvings() < HALVINGS && dt / 2.0 >= dt_min
    }
}

/// End of an accepted interval: impact, passes and error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ended {
    /// Whether an impact has ended the interval.
    pub at_impact: bool,
    /// Number of passes of the interval.
    pub passes: usize,
    /// Truncation error of the interval, relative to the displacements.
    pub error: f64,
}

#[cfg(test)]
pub(super) mod testing {
    use super::*;

    /// An ordinary end of a subincrement, for tests.
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
}
