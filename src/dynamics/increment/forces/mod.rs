//! Contact forces of the passes, impulses, and their complementarity problems.

mod by_bodies;
mod contact_forces;
mod contact_system;
mod equal_forces;
mod impulses;
mod response;
mod steady;

pub(crate) use contact_forces::ContactForces;
pub(crate) use contact_system::ContactSystem;
pub(crate) use equal_forces::EqualForces;
pub(crate) use impulses::Impulses;
pub(crate) use steady::Before;
