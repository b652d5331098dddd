//! Node-to-segment contact: pairs, their rows and their complementarity problem.

mod constraints;
mod crossing;
mod geometry;
mod search;
mod targets;
pub use constraints::{Compliance, Pair, RowForm, add_contact_forces, frictional_lcp};
pub use crossing::{
    Crossing, Direction, Motion, Passage, Touch, crossings, find_passage, line_crossings,
};
pub(crate) use geometry::position;
pub use geometry::{ContactSurfaces, Interior, Projection, contact_surfaces, project};
pub use search::{Candidate, Search, Territory, all_segments};
pub(crate) use search::{Circle, CircleTree};
pub use targets::{Look, PairSite, Pairing, Site, Vertex, common_normal, find_pairs};
pub(crate) use targets::{PENETRATING, TOUCHING};
