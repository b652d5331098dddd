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
    /// The command has done everything.
    Finished = 0,
    /// The run stopped during the solve; the results up to that point are valid.
    Stopped = 1,
    /// The deck was rejected; no result file was touched.
    Rejected = 2,
    /// The command line is wrong, or asks for threads that cannot be started.
    Usage = 3,
    /// A file or the screen could not be read or written, results exist already, or another run has
    /// the job; or the run does not fit into the free memory.
    FileSystem = 4,
    /// The terminal was closed (SIGHUP); the results up to that point are valid.
    HungUp = 129,
    /// The run was interrupted (SIGINT); the results up to that point are valid.
    Interrupted = 130,
    /// The run was terminated (SIGTERM); the results up to that point are valid.
    Terminated = 143,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

/// Reason why a command failed.
#[derive(Debug, Error)]
pub(super) enum CliError {
    /// A file cannot be read or written: a deck, a complementarity problem, or a file that the command makes.
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
    /// There is no checkpoint from which the run can continue.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The files of the earlier run do not belong to its checkpoint.
    #[error("cannot go on: {0}; the files stay as they are")]
    GoOn(io::Error),
    /// The earlier job was extended beyond the end of its deck, so the deck has no place at which another job could
    /// continue.
    #[error(
        "{} is of a job that --extend took beyond the end of its deck: give it the longer step, and run it anew",
        .0.display()
    )]
    Extended(PathBuf),
    /// A result cannot be written.
    #[error("cannot write the results: {0}")]
    Write(#[from] io::Error),
    /// A result cannot be written in the middle of a run.
    #[error("cannot write the results: {source}{}", after(kept))]
    Broken {
        /// The reason, with the file.
        source: io::Error,
        /// Text that says which results can be read.
        kept: Option<String>,
    },
    /// The checkpoint of an earlier job does not fit the model of the deck.
    #[error("cannot go on from the checkpoint: {source}{}", after(kept))]
    OfAnotherModel {
        /// Name of the data that does not fit.
        source: ArchiveError,
        /// Text that says which results can be read.
        kept: Option<String>,
    },
    /// Writing to the standard output failed for a reason other than a closed pipe.
    #[error("cannot write the standard output: {}", reason(.0))]
    Screen(io::Error),
    /// Signals cannot be received.
    #[error("cannot receive signals: {0}")]
    Signals(io::Error),
    /// The editor breaks the protocol, or its connection has ended.
    #[error("the connection to the editor is broken: {0}")]
    Editor(String),
    /// The result file cannot be read.
    #[error(transparent)]
    Summary(#[from] SummaryError),
    /// There is no keyword and no code with this name.
    #[error(
        "{word} is neither a keyword nor the code of a message{}{}",
        suggestion(meant),
        told(about)
    )]
    Unexplained {
        /// The word that was asked for.
        word: String,
        /// The keyword or code that was probably meant.
        meant: Option<&'static str>,
        /// Keywords whose text has the word.
        about: Vec<&'static str>,
    },
    /// The file that the command would write exists already.
    #[error("{} exists already; --overwrite replaces it", path.display())]
    Exists {
        /// The file that exists.
        path: PathBuf,
    },
    /// No Python has the package with the command that was asked for.
    #[error(
        "`stickslip {0}` is a command of the Python package, which is not found: {cure} installs it; or name in \
         STICKSLIP_PYTHON the Python that has it",
        cure = cure(.0)
    )]
    NoPackage(&'static str),
    /// Python cannot be started.
    #[error("cannot start {}: {source}", path.display())]
    Python {
        /// Path of the Python interpreter.
        path: PathBuf,
        /// Reason that the system gives.
        source: io::Error,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// Number of threads that were asked for.
        threads: usize,
        /// The reason that the library gives.
        reason: String,
    },
}

impl CliError {
    /// Exit code for the error.
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

/// Command that installs the package with everything that a command of the package needs.
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
