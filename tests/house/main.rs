//! The house itself: layers of the source, and documents that agree with it.

mod circles;
mod equations;
mod imports;
mod layers;
mod names;
mod numbers;
mod pages;
mod sources;
mod subjects;
mod table;
