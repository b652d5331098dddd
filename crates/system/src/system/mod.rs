//! What only some operating systems have. Everything above this module is the same on all of them.
//!
//! | functions | Linux | other Unix, macOS | others |
//! |---|---|---|---|
//! | [`on_signals`], [`exit_now`] | HUP, INT, TERM but those ignored at the start | HUP, INT, TERM | INT, TERM |
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
/// Signals stay ignored that the program was started to ignore (as by `nohup`). A file beyond the limit of its size
/// becomes an error where it is written.
///
/// # Errors
/// Those of the system.
pub fn on_signals(handle: impl FnMut(i32) + Send + 'static) -> io::Result<()> {
    here::on_signals(handle)
}

/// Ends the program at once: nothing is dropped, flushed or allocated.
pub fn exit_now(code: i32) -> ! {
    signal_hook::low_level::exit(code)
}

/// Opening a fifo or a device does not wait for its other end.
pub fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    here::without_waiting(options)
}

/// Opening a link is an error.
pub fn without_links(options: &mut OpenOptions) -> &mut OpenOptions {
    here::without_links(options)
}

/// Whether an open file still has that name. A link to it does not count.
pub fn is_at(file: &File, path: &Path) -> bool {
    here::is_at(file, path)
}

/// Reserves disk space for `length` bytes of a file behind its first `from`; its size stays.
///
/// # Errors
/// `StorageFull`, `QuotaExceeded` and `FileTooLarge` where there is no such space; any other where the system or the
/// file system reserves none.
pub fn reserve(file: &File, from: u64, length: u64) -> io::Result<()> {
    here::reserve(file, from, length)
}

/// Bytes that are free where a file is; none where the system does not tell.
pub fn free_space(file: &File) -> Option<u64> {
    here::free_space(file)
}

/// Bytes that a file may have at most; none where there is no limit.
pub fn largest_file() -> Option<u64> {
    here::largest_file()
}

/// Asks for large pages: without them all is as it was.
pub fn in_large_pages(memory: MmapMut) -> MmapMut {
    #[cfg(target_os = "linux")]
    let _ = memory.advise(memmap2::Advice::HugePage);
    memory
}

/// Runs another program in place of this one. It returns only where that cannot be started.
pub fn hand_over(command: &mut Command) -> io::Error {
    here::hand_over(command)
}
