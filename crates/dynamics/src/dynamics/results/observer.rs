//! Who receives the results of a run as it goes.

use std::io;

use super::failure::Failure;
use super::increment_report::IncrementReport;

/// An attempt at an increment that failed and is repeated with half the length.
#[derive(Debug, Clone, PartialEq)]
pub struct Cutback {
    /// The failed attempt.
    pub failure: Failure,
    /// Length of the next attempt.
    pub next_dt: f64,
}

/// Receives the results of a run as it goes. The numerics neither print nor open files.
pub trait Observer {
    /// An increment is done (number 0: the start).
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()>;

    /// An increment is repeated with half its length.
    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()>;

    /// Whether the run shall end here; asked before every attempt at an increment.
    fn wants_stop(&self) -> bool {
        false
    }

    /// Whether a checkpoint is due; asked after every increment.
    fn wants_checkpoint(&self) -> bool {
        false
    }

    /// All that the rest of the run depends on, for [`crate::dynamics::resume`]: when it is wanted, and before the run ends
    /// because it shall.
    fn checkpoint(&mut self, _checkpoint: Vec<u8>) -> io::Result<()> {
        Ok(())
    }
}
