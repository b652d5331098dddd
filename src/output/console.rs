//! Screen and log: each printed line goes to both, and a run continues when the screen fails. The screen
//! has a table of increments, 80 columns wide, and on a terminal a progress bar; the log also has the
//! convergence of passes and the cutbacks.

use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal, LineWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::draft::{Draft, Existing};
use super::error::at;
use super::failure::pass_table;
use super::format::{scientific, signed};
use crate::dynamics::{IncrementReport, PassReport};
use crate::model::Model;

/// Amount of output on the screen and in the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Verbosity {
    /// The standard output stays empty; errors and the report of a stop go to the standard error.
    Quiet,
    /// The screen shows the header and a table of 20 to 50 lines.
    #[default]
    Normal,
    /// The log has the passes of every increment, too.
    Verbose,
}

/// The screen with its live line, and the log, which gets every line that the screen gets.
pub(crate) struct Console {
    screen: Option<Box<dyn Write>>,
    /// Error of a failed screen; `None` for a closed pipe.
    lost: Option<io::Error>,
    verbosity: Verbosity,
    table: Table,
    progress: ProgressLine,
    pub log: Log,
}

impl Console {
    /// Prints to the standard output, unless the run is quiet, and to the log; the live line appears only on a
    /// terminal.
    pub fn new(model: &Model, verbosity: Verbosity, log: Log) -> Self {
        let shown = verbosity != Verbosity::Quiet;
        let live = shown && io::stdout().is_terminal() && io::stderr().is_terminal();
        Console {
            screen: shown.then(|| Box::new(io::stdout()) as Box<dyn Write>),
            lost: None,
            verbosity,
            table: Table::new(model),
            progress: ProgressLine::new(model, live),
            log,
        }
    }

    /// Prints an accepted increment: its line in the table if it has one, and its passes in the log of a verbose run;
    /// `error` is the relative energy balance.
    pub fn increment(&mut self, report: &IncrementReport, error: f64) -> io::Result<()> {
        if self.verbosity == Verbosity::Verbose {
            self.log.line(&increment_line(report))?;
            self.log.passes(&report.passes)?;
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

    /// Prints a line. After a failure of the screen, such as a closed pipe, the run continues without the screen.
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

    /// Error of a failed screen; `None` for a closed pipe.
    pub fn lost(&mut self) -> Option<io::Error> {
        self.lost.take()
    }

    /// Whether the screen has failed, except by a closed pipe.
    pub fn is_lost(&self) -> bool {
        self.lost.is_some()
    }

    /// Prints a line that even a quiet run shows, on the standard error.
    pub fn alarm(&mut self, text: &str) -> io::Result<()> {
        if self.verbosity == Verbosity::Quiet {
            // A closed pipe is no reason to stop.
            let _ = writeln!(io::stderr(), "{text}");
        }
        self.line(text)
    }

    /// Removes the live line.
    pub fn finish(&self) {
        self.progress.finish();
    }
}

/// Number of lines after which the header is repeated.
const HEADER_EVERY: usize = 40;

/// Upper bound of the number of lines a run without cutbacks prints.
const MOST_LINES: f64 = 50.0;

const HEADER: &str =
    "step   incr      time       dt pass active stick residual  LCP pivots energy err";

/// Chooses the lines of the table.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// Increment of each step (time).
    increments: Vec<f64>,
    /// Number of nominal increments from one line to the next.
    stride: f64,
    /// Number of nominal increments since the last line; a subincrement counts in proportion to its length.
    since: f64,
    /// Number of lines so far.
    lines: usize,
}

impl Table {
    /// A table with 20 to 50 lines for the nominal increments of the model's steps.
    pub fn new(model: &Model) -> Self {
        let increments = model.steps.iter().map(|step| step.increments);
        Table {
            stride: stride(increments.clone().map(|i| (i.period / i.dt).ceil()).sum()) as f64,
            increments: increments.map(|i| i.dt).collect(),
            since: 0.0,
            lines: 0,
        }
    }

    /// Whether an increment gets a line in the table.
    pub fn shows(&mut self, report: &IncrementReport) -> bool {
        let whole = self.increments.get(report.step.wrapping_sub(1));
        self.since += whole.map_or(1.0, |dt| report.dt / dt);
        let due = self.since >= self.stride - 0.5 || report.ends_step;
        if due {
            self.since = 0.0;
        }
        due && report.increment > 0
    }

    /// The header, if it is due before the next line.
    pub fn header(&mut self) -> Option<&'static str> {
        let due = self.lines.is_multiple_of(HEADER_EVERY);
        self.lines += 1;
        due.then_some(HEADER)
    }
}

/// The line of an increment; `error` is the relative energy balance.
pub(crate) fn row(report: &IncrementReport, error: f64) -> String {
    let solver = &report.solver;
    format!(
        "{:>4}{:>7}{:>10}{:>9}{:>5}{:>7}{:>6}{:>9}{:>5}{:>7}{:>11}",
        report.step,
        report.increment,
        scientific(report.time, 3),
        scientific(report.dt, 2),
        solver.passes,
        closed(report),
        sticking(report),
        scientific(solver.residual, 1),
        solver.lcp_size,
        solver.pivots,
        signed(error, 1),
    )
}

/// Number of closed pairs of all contacts.
pub(crate) fn closed(report: &IncrementReport) -> usize {
    report.contacts.iter().map(|contact| contact.closed).sum()
}

/// Number of sticking pairs of all contacts.
pub(crate) fn sticking(report: &IncrementReport) -> usize {
    report.contacts.iter().map(|contact| contact.sticking).sum()
}

/// The smallest interval of 1, 2, 5, 10, 20, ... increments that gives no more lines than allowed.
fn stride(increments: f64) -> usize {
    let mut power = 1usize;
    while increments.is_finite() && power < usize::MAX / 100 {
        for stride in [power, 2 * power, 5 * power] {
            if increments / stride as f64 <= MOST_LINES {
                return stride;
            }
        }
        power *= 10;
    }
    1
}

/// Number of steps of the progress bar.
const TICKS: u64 = 10_000;

/// Part of a run from which on the remaining time is shown; before, it would be a guess.
const TOLD: f64 = 0.01;

/// The live line below the table; it is not shown if the output is not a terminal.
pub(crate) struct ProgressLine {
    bar: Option<ProgressBar>,
    nominal: NominalIncrements,
}

/// The nominal increments of a run, and the time when the run began.
struct NominalIncrements {
    /// Duration and number of nominal increments of every step.
    steps: Vec<(f64, f64)>,
    started: Instant,
}

impl ProgressLine {
    /// A live line, or none if it is not wanted.
    pub fn new(model: &Model, live: bool) -> Self {
        let steps = model.steps.iter().map(|step| step.increments);
        let nominal = NominalIncrements {
            steps: steps
                .map(|i| (i.period, (i.period / i.dt).ceil()))
                .collect(),
            started: Instant::now(),
        };
        let bar = live.then(|| {
            let bar = ProgressBar::new(TICKS);
            bar.set_style(style());
            bar
        });
        ProgressLine { bar, nominal }
    }

    /// Shows an increment.
    pub fn show(&self, report: &IncrementReport) {
        let Some(bar) = &self.bar else { return };
        let nominal = &self.nominal;
        let part = nominal.part(report.step, report.step_time);
        bar.set_message(nominal.text(report, part, nominal.started.elapsed()));
        bar.set_position((part * TICKS as f64) as u64);
    }

    /// Removes the line, runs `print`, and draws the line again.
    pub fn suspend(&self, print: impl FnOnce()) {
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }

    /// Removes the live line from the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl NominalIncrements {
    /// Part of all nominal increments of the run that are done at a time of a step; steps are counted from 1.
    fn part(&self, step: usize, step_time: f64) -> f64 {
        let before = self.steps.iter().take(step.saturating_sub(1));
        let mut done: f64 = before.map(|(_, count)| count).sum();
        if let Some((period, count)) = self.steps.get(step.wrapping_sub(1)) {
            done += step_time / period * count;
        }
        let all: f64 = self.steps.iter().map(|(_, count)| count).sum();
        (done / all).clamp(0.0, 1.0)
    }

    /// Text of the line: step, increment, time, contacts and, after a while, the remaining time.
    fn text(&self, report: &IncrementReport, part: f64, elapsed: Duration) -> String {
        let mut text = format!(
            "step {}/{}  incr {}  time {}  active {}",
            report.step,
            self.steps.len(),
            report.increment,
            scientific(report.time, 3),
            closed(report),
        );
        let left = elapsed.as_secs_f64() * (1.0 / part - 1.0);
        if let (true, Ok(left)) = (part >= TOLD, Duration::try_from_secs_f64(left)) {
            text.push_str(&format!("  {:#} left", HumanDuration(left)));
        }
        text
    }
}

/// A bar that is full only at the end; the part that is not done consists of dots.
fn style() -> ProgressStyle {
    ProgressStyle::with_template("{percent:>3} % [{bar:12}] {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=.")
}

/// Writes the log.
pub(crate) struct Log {
    file: LineWriter<File>,
    path: PathBuf,
    /// Lines that wait until the log begins; `None` afterwards.
    waiting: Option<String>,
}

impl Log {
    /// A log that buffers its lines until [`Log::begin`]; until then the file keeps an old text.
    pub fn new(file: File, path: &Path) -> Self {
        Log {
            file: LineWriter::new(file),
            path: path.to_owned(),
            waiting: Some(String::new()),
        }
    }

    /// Writes the buffered lines behind the old text of the file.
    pub fn go_on(&mut self) -> io::Result<()> {
        let waiting = self.waiting.take().unwrap_or_default();
        let at_end = self.file.get_mut().seek(SeekFrom::End(0));
        at_end
            .and_then(|_| self.file.write_all(waiting.as_bytes()))
            .map_err(at(&self.path))
    }

    /// Puts a file with the buffered lines in place of the old one; whoever has the lock of this file has the job.
    pub fn begin(&mut self) -> io::Result<()> {
        let waiting = self.waiting.take().unwrap_or_default();
        let begun = || {
            let mut draft = Draft::claimed(&self.path)?;
            draft.file().write_all(waiting.as_bytes())?;
            // a file system without locks has none of the old file either
            let _ = draft.file().try_lock();
            draft.publish(&self.path, Existing::Replaced)
        };
        self.file = LineWriter::new(begun().map_err(at(&self.path))?);
        Ok(())
    }

    /// Writes a line.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        match &mut self.waiting {
            Some(waiting) => {
                waiting.push_str(text);
                waiting.push('\n');
                Ok(())
            }
            None => writeln!(self.file, "{text}").map_err(at(&self.path)),
        }
    }

    /// Writes the passes of an increment.
    pub fn passes(&mut self, passes: &[PassReport]) -> io::Result<()> {
        (pass_table(passes).iter()).try_for_each(|line| self.line(line))
    }
}

/// The line above an increment's convergence table.
pub(crate) fn increment_line(report: &IncrementReport) -> String {
    format!(
        "increment {} of step {}: time {}, dt {}",
        report.increment,
        report.step,
        scientific(report.time, 6),
        scientific(report.dt, 3),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;
    use std::sync::{Arc, Mutex};

    use indicatif::{ProgressDrawTarget, TermLike};

    #[test]
    fn twenty_to_fifty_lines() {
        assert_eq!(stride(10.0), 1);
        assert_eq!(stride(1000.0), 20);
        assert_eq!(stride(13333.0), 500);
        assert_eq!(stride(f64::NAN), 1);
        for increments in 50..20_000 {
            let lines = increments / stride(f64::from(increments)) as i32;
            assert!((20..=50).contains(&lines), "{increments}: {lines}");
        }
    }

    #[test]
    fn cut_back_increments_count_by_their_length() {
        let mut table = Table {
            increments: vec![0.1],
            stride: 2.0,
            since: 0.0,
            lines: 0,
        };
        let mut shows = |increment, dt, ends_step| {
            table.shows(&IncrementReport {
                increment,
                step: 1,
                dt,
                ends_step,
                ..IncrementReport::default()
            })
        };
        assert!(!shows(0, 0.0, false));
        assert!(!shows(1, 0.1, false));
        assert!(shows(2, 0.1, false));
        let shown = (3..19).filter(|&k| shows(k, 0.0125, false)).count();
        assert_eq!(shown, 1);
        assert!(shows(19, 0.1, true));
    }

    #[test]
    fn lines_are_as_wide_as_the_header() {
        let report = IncrementReport {
            increment: 13_333,
            step: 1,
            ..IncrementReport::default()
        };
        assert_eq!(row(&report, -1e-12).len(), HEADER.len());
        assert_eq!(HEADER.len(), 80);
    }

    /// The live line of a run with two steps of 100 and 300 increments, at a time of a step.
    fn line(step: usize, step_time: f64, seconds: u64) -> (String, f64) {
        let nominal = NominalIncrements {
            steps: vec![(1.0, 100.0), (0.5, 300.0)],
            started: Instant::now(),
        };
        let report = IncrementReport {
            increment: 12_345,
            step,
            step_time,
            ..IncrementReport::default()
        };
        let part = nominal.part(step, step_time);
        (
            nominal.text(&report, part, Duration::from_secs(seconds)),
            part,
        )
    }

    #[test]
    fn the_line_tells_the_step_and_what_is_left() {
        let (text, part) = line(1, 0.0, 5);
        assert_eq!((part, text.contains("left")), (0.0, false), "{text}");
        let (text, part) = line(1, 1.0, 60);
        assert_eq!(part, 0.25);
        assert!(
            text.starts_with("step 1/2  incr 12345  time ") && text.ends_with("  3m left"),
            "{text}"
        );
        let (text, part) = line(2, 0.5, 60);
        assert_eq!(part, 1.0);
        assert!(text.ends_with("  0s left"), "{text}");
        assert!("100 % [............] ".len() + text.len() < 80, "{text}");
    }

    /// A terminal that keeps the last line that was drawn.
    #[derive(Debug, Clone, Default)]
    struct Screen(Arc<Mutex<String>>);

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            80
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, _: &str) -> io::Result<()> {
            Ok(())
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            if text.contains('[') {
                text.clone_into(&mut self.0.lock().expect("one thread"));
            }
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn the_bar_is_full_at_the_end_only() {
        for (part, is_full) in [(0.0, false), (0.94, false), (0.999, false), (1.0, true)] {
            let screen = Screen::default();
            let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
            let bar = ProgressBar::with_draw_target(Some(TICKS), target).with_style(style());
            bar.set_position((part * TICKS as f64) as u64);
            bar.abandon();
            let line = screen.0.lock().expect("one thread").clone();
            assert_eq!(line.contains("============"), is_full, "{part}: {line}");
            assert_eq!(line.contains(".]"), !is_full, "{part}: {line}");
        }
    }
}
