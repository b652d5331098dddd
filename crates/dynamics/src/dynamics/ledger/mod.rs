//! Ledger of converged increments: energies and their check, contacts and their errors, bodies, nodes, rigid surfaces.

mod accounts;
mod bodies;
mod contact_ledger;
mod energy;
mod energy_checks;
mod nodal_results;
mod pair_work;
mod surface_work;
mod terms;
mod touches;

pub(crate) use accounts::Accounts;
pub(crate) use contact_ledger::contact_violation;
pub(crate) use energy::Ledger;
pub(crate) use energy_checks::{check_balance, check_energy_gain};
pub(crate) use nodal_results::{landings, node_path};
