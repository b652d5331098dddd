//! The exit codes listed in docs/output.md, section "Exit codes".

use std::process::ExitCode;

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
