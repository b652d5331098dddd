//! Group `/VTKHDF`: the field frames, as a temporal unstructured grid with a fixed mesh.

mod fields;
mod mesh;
mod place;
mod requested;
mod steps;

pub(crate) use fields::Fields;
pub(super) use mesh::{connectivity, number};
pub(crate) use requested::{ENERGY_DENSITY, LOGARITHMIC_STRAIN};
