//! Complementarity problems, general and frictional, with known answers.

mod block;
mod blocks;
mod frictional;
mod general;
mod problems;
mod properties;
mod random;
mod tableau;
