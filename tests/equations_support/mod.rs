//! Scanners of the documents and the source.

pub mod names;
pub mod numbers;
pub mod table;
