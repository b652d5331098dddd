//! Screen and log together: each printed line goes to both, and a run continues when the screen
//! fails.

use std::io::{self, ErrorKind, IsTerminal, Write};

use super::log::{Log, increment_line};
use super::progress::Progress;
use super::screen::{Table, row};
use crate::dynamics::{IncrementReport, PassReport};
use crate::model::Model;

/// How much is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Verbosity {
    /// Nothing on the standard output; errors and the report of a stop go to the standard error.
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
    /// Error of a failed screen; none for a closed pipe.
    lost: Option<io::Error>,
    verbosity: Verbosity,
    table: Table,
    progress: Progress,
    log: Log,
}

impl Console {
    /// Prints to the standard output, unless the run is quiet, and to the log; the live line is on
    /// a terminal only.
    pub fn new(model: &Model, verbosity: Verbosity, log: Log) -> Self {
        let shown = verbosity != Verbosity::Quiet;
        let live = shown && io::stdout().is_terminal() && io::stderr().is_terminal();
        Console {
            screen: shown.then(|| Box::new(io::stdout()) as Box<dyn Write>),
            lost: None,
            verbosity,
            table: Table::new(model),
            progress: Progress::new(model, live),
            log,
        }
    }

    /// Prints an accepted increment: its line in the table where one is due, and its passes in the
    /// log of a verbose run; `error` is the relative energy balance.
    pub fn increment(&mut self, report: &IncrementReport, error: f64) -> io::Result<()> {
        if self.verbosity == Verbosity::Verbose {
            self.detail(&increment_line(report))?;
            self.passes(&report.passes)?;
        }
        if self.table.shows(report) {
            if let Some(header) = self.table.header() {
                self.line(header)?;
            }
            self.line(&row(report, error))?;
        }
        self.progress.show(report);
        Ok(())
    }

    /// Prints several lines.
    pub fn lines(&mut self, lines: impl IntoIterator<Item = String>) -> io::Result<()> {
        lines.into_iter().try_for_each(|line| self.line(&line))
    }

    /// Prints a line. After a failure of the screen, such as a closed pipe, the run continues
    /// without it.
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

    /// Error of a failed screen; none for a closed pipe.
    pub fn lost(&mut self) -> Option<io::Error> {
        self.lost.take()
    }

    /// Whether the screen has failed, except by a closed pipe.
    pub fn is_lost(&self) -> bool {
        self.lost.is_some()
    }

    /// Begins the log with the lines so far.
    pub fn begin_log(&mut self) -> io::Result<()> {
        self.log.begin()
    }

    /// Prints a line that even a quiet run shows, on the standard error.
    pub fn alarm(&mut self, text: &str) -> io::Result<()> {
        if self.verbosity == Verbosity::Quiet {
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

    /// Removes the live line.
    pub fn finish(&self) {
        self.progress.finish();
    }
}
