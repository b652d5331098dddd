//! Nodes, elements, sets and surfaces.

mod element_type;
mod instances;
mod line_elements;
mod mesh_index;
pub(crate) mod nodes_elements;
mod outline;
mod places;
mod profile;
mod references;
pub(crate) mod sets;
pub(crate) mod surface;

pub(crate) use mesh_index::MeshIndex;
pub(crate) use outline::{Block, Outline, StepCards};
pub(crate) use places::Places;
pub(crate) use sets::Sets;
pub(crate) use surface::{Found, Surfaces, side_count};
