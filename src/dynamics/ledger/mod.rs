//! Ledger of converged increments: energies and their check, contacts and their errors, bodies, nodes, rigid surfaces.

mod accounts;
mod bodies;
mod contact_ledger;
mod contact_violation;
mod energy;
mod energy_check;
mod nodal_results;
mod pressure;
mod rigid_surfaces;
mod touches;

pub(crate) use accounts::Accounts;
pub(crate) use contact_violation::contact_violation;
pub(crate) use energy::Ledger;
pub(crate) use energy_check::{check_balance, check_energy_gain};
pub(crate) use nodal_results::{landings, motion};
