//! Node-to-segment contact: pairs, their rows and their complementarity problem.

mod adjust;
mod circles;
mod compliance;
mod crossing;
mod geometry;
mod initial;
mod interior;
mod look;
mod pair;
mod passage;
#[cfg(test)]
mod passage_tests;
mod penetration;
mod problem;
mod quartic;
mod search;
mod sites;
mod surfaces;
mod territory;
mod vertex;

pub use adjust::{Adjusted, adjust, report_adjusted};
pub use compliance::Compliance;
pub use crossing::{Crossing, Direction, Motion, crossings, line_crossings};
pub(crate) use geometry::position;
pub use geometry::{Projection, project};
pub use initial::{InitialGap, initial_gaps};
pub use interior::Interior;
pub use look::Look;
pub(crate) use look::{PENETRATING, TOUCHING};
pub use pair::{Pair, PairSite, RowForm};
pub use passage::{Passage, Touch, find_passage};
pub use penetration::report_penetrations;
pub use problem::{add_contact_forces, frictional_lcp};
pub use search::{Candidate, Pairing, all_segments, find_pairs};
pub use sites::Site;
pub use surfaces::{ContactSurfaces, contact_surfaces};
pub use territory::{Search, Territory};
pub use vertex::{Vertex, common_normal};
