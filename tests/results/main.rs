//! Result files written by the library. No process is started here: it would inherit open files and their locks.

#[path = "../dynamics/blocks.rs"]
#[allow(dead_code)] // shared with the tests of the solver
mod blocks;
mod file;
mod observed_run;
mod writers;
