//! The subcommand `info`.

use crate::cli::args::InfoArgs;
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::terminal::print;
use crate::output::ResultSummary;

/// Describes a result file.
pub(in crate::cli) fn info(args: &InfoArgs) -> Result<Exit, CliError> {
    print(&ResultSummary::read(&args.result)?.lines())?;
    Ok(Exit::Finished)
}
