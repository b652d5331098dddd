//! Contact constraints: gap, slip and their rows, compliance and Delassus operator.

mod compliance;
mod delassus;
mod pair;

pub use compliance::Compliance;
pub use delassus::{add_contact_forces, frictional_lcp};
pub use pair::{Pair, RowForm};
