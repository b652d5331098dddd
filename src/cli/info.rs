//! The subcommand `info`.

use super::args::InfoArgs;
use super::error::CliError;
use super::exit::Exit;
use super::terminal::print;
use crate::output::ResultSummary;

/// Describes a result file.
pub(super) fn info(args: &InfoArgs) -> Result<Exit, CliError> {
    print(&ResultSummary::read(&args.result)?.lines())?;
    Ok(Exit::Finished)
}
