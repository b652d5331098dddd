//! Screen and log together: each printed line goes to both, and losing the screen does not end the
//! run.

use std::io::{self, ErrorKind, Write};

use super::log::Log;
use super::progress::Progress;
use crate::dynamics::{IncrementReport, PassReport};

/// How much is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Verbosity {
    /// Nothing on the standard output; errors and the account of a stop go to the standard error.
    Quiet,
    /// The header and a table of 20 to 50 lines.
    #[default]
    Normal,
    /// Also the passes of every increment in the log.
    Verbose,
}

/// The screen with its live line, and the log, which gets everything the screen does.
pub(crate) struct Console {
    screen: Option<Box<dyn Write>>,
    /// Why the screen was given up, if it was not a closed pipe.
    lost: Option<io::Error>,
    /// Whether there was no screen from the start.
    quiet: bool,
    progress: Progress,
    log: Log,
}

impl Console {
    /// Prints to `screen`, if any, and to the log.
    pub fn new(screen: Option<Box<dyn Write>>, progress: Progress, log: Log) -> Self {
        Console {
            quiet: screen.is_none(),
            screen,
            lost: None,
            progress,
            log,
        }
    }

    /// Prints a line. A screen that cannot be written, such as a closed pipe, is given up: the run
    /// goes on without.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        let mut done = Ok(());
        if let Some(screen) = &mut self.screen {
            self.progress.suspend(|| {
                done = writeln!(screen, "{text}").and_then(|()| screen.flush());
            });
        }
        if let Err(error) = done {
            self.screen = None;
            self.lost = Some(error).filter(|error| error.kind() != ErrorKind::BrokenPipe);
        }
        self.log.line(text)
    }

    /// Why the screen was given up; a closed pipe is no reason.
    pub fn lost(&mut self) -> Option<io::Error> {
        self.lost.take()
    }

    /// Whether the screen was given up otherwise than as a closed pipe.
    pub fn is_lost(&self) -> bool {
        self.lost.is_some()
    }

    /// Begins the log with the lines so far.
    pub fn begin_log(&mut self) -> io::Result<()> {
        self.log.begin()
    }

    /// Prints a line that even a quiet run shows, on the standard error.
    pub fn alarm(&mut self, text: &str) -> io::Result<()> {
        if self.quiet {
            // A closed pipe is no reason to stop.
            let _ = writeln!(io::stderr(), "{text}");
        }
        self.line(text)
    }

    /// Writes a line to the log only.
    pub fn detail(&mut self, text: &str) -> io::Result<()> {
        self.log.line(text)
    }

    /// Writes the passes of an increment to the log.
    pub fn passes(&mut self, passes: &[PassReport]) -> io::Result<()> {
        self.log.passes(passes)
    }

    /// Moves the live line on.
    pub fn progress(&self, report: &IncrementReport) {
        self.progress.show(report);
    }

    /// Removes the live line.
    pub fn finish(&self) {
        self.progress.finish();
    }
}
