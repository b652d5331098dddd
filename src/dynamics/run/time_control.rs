//! Time control of a step: how the increments of its grid are divided. Section 4 of docs/theory.md,
//! Cutback, and section 6, Impacts as events.

use crate::dynamics::step::Interval;

/// What a time control wants solved next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub interval: Interval,
    /// Length of the last subincrement, where the next impact may end this one.
    pub until_impact: Option<f64>,
}

/// Divides one nominal increment.
pub(crate) trait TimeControl {
    /// What is to be solved next; none at the end of the nominal increment.
    fn next(&self) -> Option<Span>;

    /// How often what comes next has been halved.
    fn halvings(&self) -> u32;

    /// Goes on from the end of an accepted interval, which an impact may have ended.
    fn accepted(&mut self, interval: &Interval, ends_at_impact: bool);

    /// Halves an interval that failed.
    fn failed(&mut self, interval: &Interval);
}
