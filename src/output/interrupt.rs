//! The flag that carries a signal from the thread that receives it into the run.

use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};

/// A request from outside to end the run: the number of a signal, shared between its receiver and
/// the run.
#[derive(Debug, Clone, Default)]
pub struct Interrupt {
    /// 0 as long as there is none.
    signal: Arc<AtomicI32>,
}

impl Interrupt {
    /// Requests the end of the run.
    pub fn request(&self, signal: i32) {
        self.signal.store(signal, Ordering::Relaxed);
    }

    /// The signal that requests the end, if there is one.
    pub fn signal(&self) -> Option<i32> {
        Some(self.signal.load(Ordering::Relaxed)).filter(|&signal| signal != 0)
    }

    /// Exit status of a program that the signal ended, as shells give it: 128 + its number.
    pub(super) fn exit_status(&self) -> u8 {
        self.signal().map_or(0, |signal| 128 + signal as u8)
    }

    /// The signal's name.
    pub(super) fn name(&self) -> &'static str {
        match self.exit_status() {
            129 => "SIGHUP",
            130 => "SIGINT",
            143 => "SIGTERM",
            _ => "a signal",
        }
    }
}
