//! Accounts of converged increments: energies, contacts, bodies, nodes, rigid surfaces.

mod acceptance;
mod accounts;
mod bodies;
mod contact_ledger;
mod energy;
mod energy_check;
mod nodal_results;
mod pressure;
mod rigid_surfaces;

pub(crate) use acceptance::{Accepted, start_failure};
pub(crate) use accounts::Accounts;
pub(crate) use energy::Ledger;
pub(crate) use nodal_results::{landings, motion};
