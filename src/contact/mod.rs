//! Contact of slave nodes with segments and corners: surfaces, search, targets, constraints and
//! their complementarity problem, crossing and tunnelling.

mod constraints;
mod crossing;
mod geometry;
mod search;
mod targets;
pub(crate) mod tolerances;
mod tunnelling;

pub use constraints::{
    ClosedPair, ClosedPairs, Compliance, Configurations, Constraint, ConstraintKey, DelassusSpace,
    PerDof, RowForm, Rows, Scope, frictional_lcp,
};
pub use crossing::{Crossing, Direction, Motion, crossings, line_crossings};
pub(crate) use geometry::position;
pub use geometry::{
    Along, ContactSurfaces, Interior, Positions, Projection, contact_surfaces, project,
};
pub use search::{Candidate, ListedSlave, Search, Territory, all_segments};
pub use targets::{ContactTarget, Corner, PairTarget, SlaveNode, common_normal, find_targets};
pub use tunnelling::{Penetration, crossed_edges, find_penetration};
