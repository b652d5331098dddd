//! The allocator of the program: if the system refuses memory, the program ends with exit code 4 and a line that states
//! the memory that was requested.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io;
use std::io::Write;

use super::error::Exit;
use crate::output::memory_need;
use crate::system::exit_now;

/// The allocator of the system. If the system has no memory, the program ends with [`Exit::FileSystem`]; the results
/// already written stay, as after a kill.
#[derive(Debug, Clone, Copy, Default)]
pub struct Allocator;

// SAFETY: all is passed on to the allocator of the system.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        there(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        there(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        there(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Returns the memory, or ends the program if there is no memory.
#[inline]
fn there(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() {
        end(size);
    }
    memory
}

/// Ends the program without allocating memory.
#[cold]
fn end(size: usize) -> ! {
    const MEGABYTE: u64 = 1_000_000;
    let mut screen = io::stderr();
    let more = (size as u64).div_ceil(MEGABYTE);
    let _ = write!(
        screen,
        "error: out of memory: {more} MB more are not to be had"
    );
    if let Some(need) = memory_need() {
        let all = need.div_ceil(MEGABYTE);
        let _ = write!(screen, "; the run needs about {all} MB in all");
    }
    let _ = writeln!(
        screen,
        ": use a coarser mesh, end other programs, or raise the limit (ulimit -v)"
    );
    exit_now(Exit::FileSystem as i32)
}
