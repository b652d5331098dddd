//! The solver as a library: problems with known answers.

mod blocks;
mod elastic_bar;
mod invariants;
mod loads;
mod patch;
