//! Errors of the commands with their messages, and the exit codes listed in docs/output.md, section
//! "Exit codes".

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use thiserror::Error;

use crate::archive::ArchiveError;
use crate::output::{
    CheckpointError, FileError, MemoryError, NameError, OutputError, SummaryError, reason,
};

/// Exit codes of the program: a contract with scripts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// Everything is done.
    Finished = 0,
    /// Stopped in the solve; the results up to there are valid.
    Stopped = 1,
    /// The deck was rejected; no result file was touched.
    Rejected = 2,
    /// The command line is wrong, or asks for threads that cannot be started.
    Usage = 3,
    /// A file or the screen could not be read or written, results exist already, or another run has
    /// the job; the run does not fit into the free memory.
    FileSystem = 4,
    /// The terminal was closed (SIGHUP); the results up to there are valid.
    HungUp = 129,
    /// Interrupted (SIGINT); the results up to there are valid.
    Interrupted = 130,
    /// Terminated (SIGTERM); the results up to there are valid.
    Terminated = 143,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

/// Why a command failed.
#[derive(Debug, Error)]
pub(super) enum CliError {
    /// A file cannot be read or written: a deck, a complementarity problem, or what the command makes.
    #[error(transparent)]
    File(#[from] FileError),
    /// A name of the deck is not possible in the result file.
    #[error(transparent)]
    Name(#[from] NameError),
    /// The run does not fit into the free memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The files of the job cannot be created.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// There is no checkpoint to go on from.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The files of the earlier run are not those of its checkpoint.
    #[error("cannot go on: {0}; the files stay as they are")]
    GoOn(io::Error),
    /// A job that goes beyond the end of its deck has no place in it where another one could go on.
    #[error(
        "{} is of a job that --extend took beyond the end of its deck: give it the longer step, and run it anew",
        .0.display()
    )]
    Extended(PathBuf),
    /// A result cannot be written.
    #[error("cannot write the results: {0}")]
    Write(#[from] io::Error),
    /// The same in the middle of a run.
    #[error("cannot write the results: {source}{}", after(kept))]
    Broken {
        /// Why, with the file.
        source: io::Error,
        /// Which results can be read.
        kept: Option<String>,
    },
    /// The checkpoint of an earlier job does not fit the model of the deck.
    #[error("cannot go on from the checkpoint: {source}{}", after(kept))]
    OfAnotherModel {
        /// What does not fit.
        source: ArchiveError,
        /// Which results can be read.
        kept: Option<String>,
    },
    /// Writing to the standard output failed, except by a closed pipe.
    #[error("cannot write the standard output: {}", reason(.0))]
    Screen(io::Error),
    /// Signals cannot be received.
    #[error("cannot receive signals: {0}")]
    Signals(io::Error),
    /// The editor says what is not the protocol, or is gone.
    #[error("the connection to the editor is broken: {0}")]
    Editor(String),
    /// The result file cannot be read.
    #[error(transparent)]
    Summary(#[from] SummaryError),
    /// There is no keyword and no code of this name.
    #[error(
        "{word} is neither a keyword nor the code of a message{}{}",
        suggestion(meant),
        told(about)
    )]
    Unexplained {
        /// What was asked for.
        word: String,
        /// What was probably meant.
        meant: Option<&'static str>,
        /// Keywords that speak of it.
        about: Vec<&'static str>,
    },
    /// A file that the command makes exists.
    #[error("{} exists already; --overwrite replaces it", path.display())]
    Exists {
        /// The file that exists.
        path: PathBuf,
    },
    /// No Python has the package, of which a command is asked for.
    #[error(
        "`stickslip {0}` is a command of the Python package, which is not found: {cure} installs it; or name in \
         STICKSLIP_PYTHON the Python that has it",
        cure = cure(.0)
    )]
    NoPackage(&'static str),
    /// Python cannot be started.
    #[error("cannot start {}: {source}", path.display())]
    Python {
        /// Its path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// Number of threads asked for.
        threads: usize,
        /// The reason that the library gives.
        reason: String,
    },
}

impl CliError {
    /// Its exit code.
    pub fn exit(&self) -> Exit {
        match self {
            CliError::Name(_) | CliError::Output(OutputError::Name(_)) => Exit::Rejected,
            CliError::Threads { .. } | CliError::Unexplained { .. } => Exit::Usage,
            _ => Exit::FileSystem,
        }
    }
}

fn suggestion(meant: &Option<&str>) -> String {
    meant.map_or(String::new(), |meant| format!("; did you mean {meant}?"))
}

fn told(about: &[&str]) -> String {
    let names: Vec<String> = about.iter().map(|name| format!("*{name}")).collect();
    match names.is_empty() {
        true => String::new(),
        false => format!("; keywords about it: {}", names.join(", ")),
    }
}

/// What installs the package with all that a command needs.
fn cure(command: &str) -> String {
    let extra = match command.split(' ').next() {
        Some("plot") => "[plot]",
        Some("sweep") => "[sweep]",
        Some("export") => "[convert]",
        _ => "",
    };
    format!("pip install \"stickslip{extra}\"")
}

fn after(kept: &Option<String>) -> String {
    kept.as_ref()
        .map_or(String::new(), |kept| format!("; {kept}"))
}
