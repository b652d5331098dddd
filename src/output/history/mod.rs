//! Histories: one row per increment.

mod bodies;
mod contacts;
mod histories;
mod nodes;
mod rigid_surfaces;
mod strains;

pub(crate) use histories::History;
