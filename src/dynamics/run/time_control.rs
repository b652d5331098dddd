//! Time control of a step: how the increments of its grid are divided. Section 4 of docs/theory.md,
//! Cutback, and section 6, Impacts as events.

use crate::dynamics::step::Interval;

/// The next subincrement of a time control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub interval: Interval,
    /// Whether the next impact ends it.
    pub until_impact: bool,
}

/// Divides one nominal increment.
pub(crate) trait TimeControl {
    /// The next subincrement; none at the end of the nominal increment.
    fn next(&self) -> Option<Span>;

    /// Number of halvings of the next subincrement.
    fn halvings(&self) -> u32;

    /// Continues from the end of an accepted interval, which an impact may have ended.
    fn accepted(&mut self, interval: &Interval, ends_at_impact: bool);

    /// Halves an interval that failed.
    fn failed(&mut self, interval: &Interval);
}
