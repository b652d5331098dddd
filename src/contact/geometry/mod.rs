//! Surfaces as nodes and segments, projection of a point on a segment, and the inside of the
//! bodies.

mod interior;
mod projection;
mod surfaces;

pub use interior::Interior;
pub(crate) use projection::position;
pub use projection::{Positions, Projection, project};
pub use surfaces::{Along, ContactSurfaces, contact_surfaces};
