//! Checks across keywords: the quality of the mesh, magnitudes, contacts, and whether the steps suit the material.

mod amplitudes;
mod hinges;
mod mesh;
mod model;
mod overlap;
mod revolution;

pub(super) use amplitudes::amplitudes;
pub(super) use hinges::hinges;
pub(super) use mesh::{coincident_nodes, magnitudes, mesh};
pub(super) use model::{
    braked_flight, density, fixed_slaves, motion, prescribed_throughout, proportion, thickness,
};
pub(super) use overlap::overlap;
pub(super) use revolution::{axis, half_plane};
