//! Place of a step among the times of the analysis.

use super::loads::TimePoint;

/// Number, start and duration of a step.
#[derive(Clone, Copy)]
pub(crate) struct StepPlace {
    /// Number of the step, from 1.
    pub number: usize,
    /// Time of the analysis at which it starts.
    pub start: f64,
    /// Duration (time).
    pub period: f64,
}

impl StepPlace {
    /// The point at time `step` since the start of the step.
    pub fn time_point(&self, step: f64) -> TimePoint {
        TimePoint {
            step,
            total: self.start + step,
            period: self.period,
        }
    }
}
