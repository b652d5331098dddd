//! Checks across keywords: the quality of the mesh, magnitudes, contacts, and whether the steps make
//! sense with the material.

mod amplitudes;
mod braked_flight;
mod coincident_nodes;
mod fixed_slaves;
mod magnitudes;
mod mesh;
mod motion;
mod overlap;
mod proportion;
mod thickness;

pub(super) use amplitudes::amplitudes;
pub(super) use braked_flight::braked_flight;
pub(super) use coincident_nodes::coincident_nodes;
pub(super) use fixed_slaves::fixed_slaves;
pub(super) use magnitudes::magnitudes;
pub(super) use mesh::mesh;
pub(super) use motion::motion;
pub(super) use overlap::overlap;
pub(super) use proportion::{Shortest, proportion, shortest};
pub(super) use thickness::thickness;
