//! The house itself: layers of the source, and documents that agree with it.

mod circles;
mod equations;
mod imports;
mod layers;
mod names;
mod numbers;
mod sources;
mod subjects;
mod table;
