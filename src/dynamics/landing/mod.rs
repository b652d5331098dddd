//! Landing return: the energy that landings have taken, given back as kinetic energy.

mod landing_return;
mod pattern;
mod shares;

pub(crate) use landing_return::return_landings;
