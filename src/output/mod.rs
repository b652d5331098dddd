//! Result file, status file, log and screen.
