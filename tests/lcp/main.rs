//! Complementarity problems, general and frictional, with known answers.

#[allow(dead_code)] // shared with the benches
mod block;
mod blocks;
mod dependent;
mod frictional;
mod general;
mod joints;
mod means;
#[allow(dead_code)] // shared with the benches
mod problems;
mod properties;
mod random;
#[allow(dead_code)] // shared with tests/dynamics, which use all of it
#[path = "../dynamics/blocks.rs"]
mod rectangles;
#[allow(dead_code)] // shared with the benches
mod tableau;
