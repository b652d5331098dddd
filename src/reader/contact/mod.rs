//! Contact pairs, general contact and rigid surfaces.

mod assignment;
mod general_contact;
mod initialization;
mod interactions;
pub(crate) mod pairs;
pub(crate) mod rigid_surface;

pub(crate) use rigid_surface::Rigid;
