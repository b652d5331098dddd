//! The subcommands.

mod check;
mod explain;
mod flatten;
mod info;
mod lcp;
mod overrides;
mod run;

pub(super) use check::check;
pub(super) use explain::explain;
pub(super) use flatten::flatten;
pub(super) use info::info;
pub(super) use lcp::lcp;
pub(super) use run::run;
