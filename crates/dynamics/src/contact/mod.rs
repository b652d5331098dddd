//! Contact of slave nodes with segments and corners: surfaces, search, targets, constraints and
//! their complementarity problem, crossing and tunnelling.

mod active_constraints;
mod arcs;
mod bend;
mod bulge;
mod closed_pairs;
mod common_normal;
mod compliance;
mod constraint;
mod crossing;
mod curves;
mod delassus;
mod disc;
mod geometry;
mod interior;
mod keys;
mod kinds;
mod lists;
mod node_to_corner;
mod node_to_segment;
mod pairing;
mod positions;
mod projection;
#[cfg(test)]
mod seam_tests;
mod search;
mod selection;
mod slave_node;
mod slave_segments;
mod stiffness;
mod surface_to_surface;
mod target;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod tolerances;
mod tunnelling;
#[cfg(test)]
mod tunnelling_tests;

pub use active_constraints::{ActiveConstraints, ConstraintSet};
pub use arcs::{MasterArc, SurfaceArc};
pub use bulge::{Bulge, Lift};
pub use closed_pairs::{ClosedPair, ClosedPairs};
pub use common_normal::common_normal;
pub use compliance::{Compliance, ConstraintGroup};
pub use constraint::{Configurations, Constraint, RowForm, Rows, SurfaceParts};
pub use crossing::{Crossing, CrossingSense, QuadraticMotion, crossings, line_crossings};
pub use delassus::{DelassusSpace, frictional_lcp};
pub use geometry::{Along, ContactSurfaces, contact_surfaces, shortest_faces};
pub use interior::Interior;
pub use keys::{ConstraintKey, NodeAtSegment, SlaveKey};
pub use lists::PerDof;
pub use pairing::{SlaveChoice, find_means, find_targets};
pub use positions::Positions;
pub(crate) use positions::position;
pub use projection::{Projection, project};
pub use search::{Candidate, ListedSlave, Search, Territory, all_segments};
pub use slave_node::SlaveNode;
pub use target::{ContactTarget, Corner, PairTarget};
pub use tunnelling::{crossed_edges, find_penetration, sunk_nodes};
