//! The end of a run: outcome, counts and times of its phases.

use std::time::Duration;

use super::failure::Failure;
use super::increment_report::SolverCounts;

/// Wall-clock time of each phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Timings {
    /// Internal force, tangent and loads.
    pub assembly: Duration,
    /// Factorisations.
    pub factorization: Duration,
    /// Solves with the factors, including solves for the Delassus matrices.
    pub solve: Duration,
    /// Contact search: territories and their candidates.
    pub search: Duration,
    /// Pairing of candidates, constraint rows and Delassus matrices, penetration check.
    pub contact: Duration,
    /// Complementarity problems.
    pub lcp: Duration,
}

/// Outcome of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// All steps of the run are done.
    Finished,
    /// An increment failed for good; the results before this increment are valid.
    Stopped(Box<Failure>),
    /// The observer requested the end of the run; the results up to this end are valid.
    Interrupted,
}

/// Totals of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSummary {
    /// Outcome of the run.
    pub outcome: Outcome,
    /// Number of increments done.
    pub increments: usize,
    /// Number of cutbacks.
    pub cutbacks: usize,
    /// Number of increments that were repeated because of their truncation error.
    pub rejections: usize,
    /// Number of increments that an impact ended (`IMPACT TIME=EVENT`).
    pub events: usize,
    /// Counters summed over the increments; `lcp_size`, `residual` and `violation` are the largest
    /// values.
    pub solver: SolverCounts,
    /// Wall-clock time of each phase.
    pub timings: Timings,
}
