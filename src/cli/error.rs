use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::Exit;
use crate::output::{NameError, OutputError, SummaryError};

/// Why a command did not get to its end.
#[derive(Debug, Error)]
pub(super) enum CliError {
    /// The deck cannot be read.
    #[error("cannot read the deck {}: {source}", path.display())]
    Deck {
        /// The deck.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Files of an earlier run are in the way.
    #[error(
        "{} exists already; --overwrite replaces the results of an earlier run",
        list(files)
    )]
    Exists {
        /// The files.
        files: Vec<PathBuf>,
    },
    /// A name of the deck cannot stand in the result file.
    #[error(transparent)]
    Name(#[from] NameError),
    /// The files of the job cannot be created.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A result cannot be written.
    #[error("cannot write the results: {0}")]
    Write(#[from] io::Error),
    /// The result file cannot be read.
    #[error(transparent)]
    Summary(#[from] SummaryError),
    /// A complementarity problem cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Problem {
        /// Its file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// Their number.
        threads: usize,
        /// Why.
        reason: String,
    },
}

impl CliError {
    /// The exit code that tells of it.
    pub fn exit(&self) -> Exit {
        match self {
            CliError::Name(_) | CliError::Output(OutputError::Name(_)) => Exit::Rejected,
            CliError::Threads { .. } => Exit::Usage,
            CliError::Deck { .. }
            | CliError::Problem { .. }
            | CliError::Exists { .. }
            | CliError::Output(OutputError::Create { .. })
            | CliError::Write(_)
            | CliError::Summary(_) => Exit::FileSystem,
        }
    }
}

fn list(files: &[PathBuf]) -> String {
    let names: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
    names.join(", ")
}
