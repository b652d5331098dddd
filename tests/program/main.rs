//! The program as users run it: exit codes, files, kills, memory.

mod exit;
mod json;
mod killed;
mod lcp;
mod memory;
mod repeat;
mod restart;
mod rubber_ring;
mod run;
#[path = "../results/writers.rs"]
mod writers;
