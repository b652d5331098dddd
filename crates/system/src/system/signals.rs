//! Numbers of signals, which are the same on all systems that have them.

/// The terminal was closed.
pub const HANG_UP: i32 = 1;

/// The user has interrupted the program.
pub const INTERRUPT: i32 = 2;

/// Another process has asked the program to end.
pub const TERMINATE: i32 = 15;
