//! Signals that request the end of a run.
//!
//! After the first signal the run ends with the current increment and complete results. A second signal ends the
//! program at once.

use std::io;
use std::time::{Duration, Instant};

use super::error::Exit;
use super::terminal::complain;
use crate::output::Interrupt;
use crate::system::{HANG_UP, TERMINATE, exit_now, on_signals};

/// Time after the first signal within which further signals count as the same request: often a process and its group
/// both get a signal.
const ONE_REQUEST: Duration = Duration::from_millis(250);

/// Starts to receive signals, except signals that were ignored when the program started (as by `nohup`).
///
/// # Errors
/// The system refuses the signal handlers.
pub(super) fn receive() -> io::Result<Interrupt> {
    let interrupt = Interrupt::default();
    let request = interrupt.clone();
    let mut first: Option<Instant> = None;
    on_signals(move |signal| match first {
        None => {
            first = Some(Instant::now());
            request.request(signal);
            complain("stopping after this increment; a second signal stops at once");
        }
        Some(first) if first.elapsed() > ONE_REQUEST => exit_now(128 + signal),
        Some(_) => {}
    })?;
    Ok(interrupt)
}

/// The exit code of a run that a signal has ended.
pub(super) fn exit(interrupt: &Interrupt) -> Exit {
    match interrupt.signal() {
        Some(HANG_UP) => Exit::HungUp,
        Some(TERMINATE) => Exit::Terminated,
        _ => Exit::Interrupted,
    }
}
