//! Receiver of the results of a run while it goes on.

use std::io;

use super::failure::Failure;
use super::increment_report::IncrementReport;

/// An attempt at an increment that failed and is repeated with half the length.
#[derive(Debug, Clone, PartialEq)]
pub struct Cutback {
    /// The failed attempt.
    pub failure: Failure,
    /// Length of the next attempt at the increment (time).
    pub next_dt: f64,
}

/// Receives the results of a run while it goes on. The solver itself neither prints nor opens
/// files.
pub trait Observer {
    /// Receives a finished increment (number 0 is the start).
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()>;

    /// Receives a failed attempt, which is repeated with half the length.
    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()>;

    /// Whether the run is to end here; called before every attempt at an increment.
    fn wants_stop(&self) -> bool {
        false
    }

    /// Whether a checkpoint is due; called after every increment.
    fn wants_checkpoint(&self) -> bool {
        false
    }

    /// Receives all data on which the rest of the run depends, for [`crate::dynamics::resume`]: when a checkpoint is
    /// wanted, and before the run ends on request.
    fn checkpoint(&mut self, _checkpoint: Vec<u8>) -> io::Result<()> {
        Ok(())
    }
}
