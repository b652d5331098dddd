//! Signals that request the end of a run.
//!
//! After the first one the run ends with the current increment and complete results. A second one
//! ends the program at once.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};
use std::{fs, io, thread};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::{flag, low_level};

use super::error::Exit;
use super::terminal::complain;
use crate::output::Interrupt;

/// Signals within this time of the first are the same request: a process and its group are often
/// sent one each.
const ONE_REQUEST: Duration = Duration::from_millis(250);

/// Starts to receive signals, except those that the program was started to ignore (as by `nohup`).
///
/// # Errors
/// Those of the system.
pub(super) fn receive() -> io::Result<Interrupt> {
    // A file beyond the size limit is an error where it is written and must not end the program.
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
    let ignored = ignored_signals();
    let wanted = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let mut signals = Signals::new(wanted.filter(|signal| ignored >> (signal - 1) & 1 == 0))?;
    let interrupt = Interrupt::default();
    let request = interrupt.clone();
    thread::Builder::new()
        .name("signals".into())
        .spawn(move || follow(&mut signals, &request))?;
    Ok(interrupt)
}

fn follow(signals: &mut Signals, request: &Interrupt) {
    let mut first: Option<Instant> = None;
    for signal in signals.forever() {
        match first {
            None => {
                first = Some(Instant::now());
                request.request(signal);
                complain("stopping after this increment; a second signal stops at once");
            }
            Some(first) if first.elapsed() > ONE_REQUEST => low_level::exit(128 + signal),
            Some(_) => {}
        }
    }
}

/// The exit code of a run that a signal has ended.
pub(super) fn exit(interrupt: &Interrupt) -> Exit {
    match interrupt.signal() {
        Some(SIGHUP) => Exit::HungUp,
        Some(SIGTERM) => Exit::Terminated,
        _ => Exit::Interrupted,
    }
}

/// The signals that the program was started to ignore, signal n as bit n - 1; 0 on systems
/// other than Linux, which do not report them.
fn ignored_signals() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}
