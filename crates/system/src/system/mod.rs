//! Functions that differ between operating systems. All modules that use this module are the same on all operating
//! systems.
//!
//! | functions | Linux | other Unix, macOS | others |
//! |---|---|---|---|
//! | [`on_signals`], [`exit_now`] | HUP, INT, TERM, except signals ignored at the start | HUP, INT, TERM | INT, TERM |
//! | [`without_waiting`], [`without_links`] | flags of `open` | the same | no flags |
//! | [`is_at`] | device and inode | the same | crate same-file |
//! | [`reserve`] | `fallocate` | unsupported | unsupported |
//! | [`free_space`], [`largest_file`] | `fstatvfs`, `getrlimit` | the same | unknown |
//! | [`free_memory`], [`peak_memory`] | `/proc` and control groups | unknown | unknown |
//! | [`in_large_pages`] | `madvise` | nothing | nothing |
//! | [`hand_over`] | `exec` | the same | a child whose exit code is passed on |

mod memory;
#[cfg(not(unix))]
mod portable;
mod signals;
#[cfg(unix)]
mod unix;

#[cfg(not(unix))]
use portable as here;
#[cfg(unix)]
use unix as here;

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;
use std::process::Command;

use memmap2::MmapMut;

pub use memory::{free_memory, peak_memory};
pub use signals::{HANG_UP, INTERRUPT, TERMINATE};

/// Calls `handle` with the number of each signal [`HANG_UP`], [`INTERRUPT`] or [`TERMINATE`], in a thread of its own.
/// Signals that were ignored when the program started (as by `nohup`) stay ignored. A file that exceeds the limit of
/// its size becomes an error of the write.
///
/// # Errors
/// The system refuses the handlers.
pub fn on_signals(handle: impl FnMut(i32) + Send + 'static) -> io::Result<()> {
    here::on_signals(handle)
}

/// Ends the program at once: nothing is dropped, flushed or allocated.
pub fn exit_now(code: i32) -> ! {
    signal_hook::low_level::exit(code)
}

/// Sets options so that opening a fifo or a device does not wait for its other end.
pub fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    here::without_waiting(options)
}

/// Sets options so that opening a link is an error.
pub fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    here::without_links(options)
}

/// Whether an open file still has the given name; a link to the file does not count.
pub fn is_at(file: &File, path: &Path) -> bool {
    here::is_at(file, path)
}

/// Reserves disk space for `length` bytes of a file behind its first `from` bytes; the size of the file stays the same.
///
/// # Errors
/// `StorageFull`, `QuotaExceeded` or `FileTooLarge` means that the disk lacks the space; any other error means that the
/// system or the file system cannot reserve space.
pub fn reserve(file: &File, from: u64, length: u64) -> io::Result<()> {
    here::reserve(file, from, length)
}

/// Number of free bytes on the disk of a file; `None` if the system does not report this number.
pub fn free_space(file: &File) -> Option<u64> {
    here::free_space(file)
}

/// Largest size of a file (bytes); `None` if there is no limit.
pub fn largest_file() -> Option<u64> {
    here::largest_file()
}

/// Asks the system for large pages; a refusal changes nothing.
pub fn in_large_pages(memory: MmapMut) -> MmapMut {
    #[cfg(target_os = "linux")]
    let _ = memory.advise(memmap2::Advice::HugePage);
    memory
}

/// Runs another program in place of the present program. The function returns only if the other program cannot be
/// started.
pub fn hand_over(command: &mut Command) -> io::Error {
    here::hand_over(command)
}
