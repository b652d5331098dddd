use std::io::{self, Write};

use super::log::Log;
use super::progress::Progress;
use crate::dynamics::{IncrementReport, PassReport};

/// How much is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Verbosity {
    /// Nothing on the screen.
    Quiet,
    /// The header and a table of 20 to 50 lines.
    #[default]
    Normal,
    /// Also the passes of every increment in the log.
    Verbose,
}

/// The screen with its live line, and the log, which gets everything the screen does.
pub(super) struct Console {
    screen: Option<Box<dyn Write>>,
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
            progress,
            log,
        }
    }

    /// Prints a line. A screen that cannot be written, such as a closed pipe, is given up.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        let mut failed = false;
        if let Some(screen) = &mut self.screen {
            self.progress.suspend(|| {
                failed = writeln!(screen, "{text}")
                    .and_then(|()| screen.flush())
                    .is_err();
            });
        }
        if failed {
            self.screen = None;
        }
        self.log.line(text)
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
