//! `run` with a substitute reader and solver.

mod files;
mod run;
