//! Implementation for systems other than Unix, with the standard library and the crates signal-hook and same-file.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;
use std::process::{self, Command};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use same_file::Handle;
use signal_hook::flag;

use super::signals::{INTERRUPT, TERMINATE};

/// Time between two checks for a signal.
const POLL: Duration = Duration::from_millis(50);

pub fn on_signals(mut handle: impl FnMut(i32) + Send + 'static) -> io::Result<()> {
    let wanted = [INTERRUPT, TERMINATE].map(|signal| (signal, Arc::new(AtomicBool::new(false))));
    for (signal, has_come) in &wanted {
        flag::register(*signal, has_come.clone())?;
    }
    let look = move || {
        loop {
            thread::sleep(POLL);
            let come = wanted
                .iter()
                .filter(|(_, has_come)| has_come.swap(false, Ordering::Relaxed));
            come.for_each(|(signal, _)| handle(*signal));
        }
    };
    thread::Builder::new().name("signals".into()).spawn(look)?;
    Ok(())
}

pub fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    options
}

pub fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    options
}

pub fn is_at(file: &File, path: &Path) -> bool {
    let open = file.try_clone().and_then(Handle::from_file);
    let is_same = |open| Handle::from_path(path).is_ok_and(|named| named == open);
    !path.is_symlink() && open.is_ok_and(is_same)
}

pub fn reserve(_: &File, _: u64, _: u64) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

pub fn free_space(_: &File) -> Option<u64> {
    None
}

pub fn largest_file() -> Option<u64> {
    None
}

pub fn memory_limits() -> [Option<u64>; 2] {
    [None; 2]
}

pub fn hand_over(command: &mut Command) -> io::Error {
    match command.status() {
        Ok(status) => process::exit(status.code().unwrap_or(1)),
        Err(error) => error,
    }
}
