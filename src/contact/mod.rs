//! Node-to-segment contact: pairs, their rows and their complementarity problem.

mod constraints;
mod crossing;
mod geometry;
mod search;
mod targets;
pub(crate) mod tolerances;
pub use constraints::{Compliance, Pair, RowForm, add_contact_forces, frictional_lcp};
pub use crossing::{
    Crossing, Direction, Motion, NodeContact, Penetration, crossings, find_penetration,
    line_crossings,
};
pub(crate) use geometry::position;
pub use geometry::{ContactSurfaces, Interior, Projection, contact_surfaces, project};
pub use search::{Candidate, Search, Territory, all_segments};
pub(crate) use search::{Circle, CircleTree};
pub use targets::{
    ContactTarget, Corner, PairTarget, Pairing, SlaveNode, common_normal, find_targets,
};
