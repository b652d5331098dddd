//! The subcommand `lcp`, by the methods of docs/theory.md, section 8.

use std::fs;

use super::args::LcpArgs;
use super::error::CliError;
use super::exit::Exit;
use super::terminal::print;
use crate::lcp::solve_json;
use crate::output::regular_file;

/// Solves a complementarity problem given as JSON and prints the answer as JSON.
pub(super) fn lcp(args: &LcpArgs) -> Result<Exit, CliError> {
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
