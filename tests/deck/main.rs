//! From deck to model: what is read, what is refused, and what is written back.

mod assembly;
mod errors;
mod flat;
mod fuzz;
mod left_out;
mod levels;
mod model;
mod owners;
mod parameters;
mod picture;
#[path = "../shared/reading.rs"]
mod reading;
mod reference;
mod syntax;
mod temperatures;
mod ties;
