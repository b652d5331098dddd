//! The subcommand `lcp`, by the methods of docs/theory.md, section 8.

use std::fs;

use crate::cli::args::LcpArgs;
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::terminal::print;
use crate::lcp::solve_json;
use crate::output::regular_file;

/// Solves a complementarity problem given as JSON and prints the answer as JSON.
pub(in crate::cli) fn lcp(args: &LcpArgs) -> Result<Exit, CliError> {
    let text = regular_file(&args.problem).and_then(|_| fs::read_to_string(&args.problem));
    let text = text.map_err(|source| CliError::Problem {
        path: args.problem.clone(),
        source,
    })?;
    let answer = solve_json(&text);
    print(&[answer.text])?;
    Ok(if answer.solved {
        Exit::Finished
    } else {
        Exit::Stopped
    })
}
