//! Histories of the result file, one row per increment: energies and solver, nodes, elements, bodies,
//! contacts, rigid surfaces.

mod bodies;
mod contacts;
mod elements;
mod histories;
mod nodes;
mod rigid_surfaces;
mod sets;
mod strains;

pub(crate) use histories::History;
