//! Summary of a run, its warnings and energy balance.

mod balance;
mod header;
mod losses;
mod monitor;
mod run_summary;
mod totals;
mod touches;
mod warnings;

pub use header::{deck_line, program_lines};
pub(crate) use monitor::{Monitor, Remarks};
pub use run_summary::{ResultSummary, SummaryError};
pub(crate) use totals::{error_line, lcp_lines, timing_lines};
