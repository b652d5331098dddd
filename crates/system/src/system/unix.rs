//! Unix.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread;

use rustix::fs::{OFlags, fstatvfs};
use rustix::process::{Resource, getrlimit};
use signal_hook::consts::SIGXFSZ;
use signal_hook::flag;
use signal_hook::iterator::Signals;

use super::signals::{HANG_UP, INTERRUPT, TERMINATE};

pub fn on_signals(mut handle: impl FnMut(i32) + Send + 'static) -> io::Result<()> {
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
    let ignored = ignored_signals();
    let wanted = [HANG_UP, INTERRUPT, TERMINATE].into_iter();
    let mut signals = Signals::new(wanted.filter(|signal| ignored >> (signal - 1) & 1 == 0))?;
    thread::Builder::new()
        .name("signals".into())
        .spawn(move || signals.forever().for_each(&mut handle))?;
    Ok(())
}

/// The signals that were ignored when the program started, signal n as bit n - 1; 0 on systems other than Linux, which
/// do not report these signals.
fn ignored_signals() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}

pub fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    options.custom_flags(OFlags::NONBLOCK.bits().cast_signed())
}

pub fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    options.custom_flags(OFlags::NOFOLLOW.bits().cast_signed())
}

pub fn is_at(file: &File, path: &Path) -> bool {
    let id = |data: Metadata| (data.dev(), data.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(open), Ok(named)) => id(open) == id(named),
        _ => false,
    }
}

#[cfg(target_os = "linux")]
pub fn reserve(file: &File, from: u64, length: u64) -> io::Result<()> {
    use rustix::fs::{FallocateFlags, fallocate};
    Ok(fallocate(file, FallocateFlags::KEEP_SIZE, from, length)?)
}

#[cfg(not(target_os = "linux"))]
pub fn reserve(_: &File, _: u64, _: u64) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

pub fn free_space(file: &File) -> Option<u64> {
    let disk = fstatvfs(file).ok()?;
    Some(disk.f_bavail.saturating_mul(disk.f_frsize))
}

pub fn largest_file() -> Option<u64> {
    limit(Resource::Fsize)
}

/// Largest number of bytes of addresses and of data that this process may have; `None` if there is no limit.
pub fn memory_limits() -> [Option<u64>; 2] {
    [Resource::As, Resource::Data].map(limit)
}

fn limit(resource: Resource) -> Option<u64> {
    getrlimit(resource).current
}

pub fn hand_over(command: &mut Command) -> io::Error {
    command.exec()
}
