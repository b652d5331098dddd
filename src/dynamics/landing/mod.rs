//! Landing return: the energy that landings have taken, given back as kinetic energy.

mod landing_return;
mod pattern;
mod release_return;
mod shares;

pub(crate) use landing_return::return_landings;
pub(crate) use release_return::return_release;
