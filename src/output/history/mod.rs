//! Histories of the result file, one row per increment: energies and solver, nodes, bodies, contacts,
//! rigid surfaces.

mod bodies;
mod contacts;
mod histories;
mod nodes;
mod rigid_surfaces;
mod strains;

pub(crate) use histories::History;
