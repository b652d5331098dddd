//! Summary of a run, its warnings and energy balance.

mod balance;
mod header;
mod run_summary;
mod warnings;

pub(crate) use balance::Balance;
pub use header::{deck_line, program_lines};
pub use run_summary::{ResultSummary, SummaryError};
pub(crate) use warnings::Watch;
