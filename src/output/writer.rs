use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use super::balance::Balance;
use super::console::{Console, Verbosity};
use super::echo::wrap;
use super::error::OutputError;
use super::failure::failure_lines;
use super::format::{bytes, counted, general, scientific};
use super::frames::FrameSchedule;
use super::job::JobFiles;
use super::log::{Log, cutback_lines, increment_line};
use super::names::check_names;
use super::progress::Progress;
use super::record::{RunRecord, phases};
use super::result_file::ResultFile;
use super::screen::{Table, row};
use super::status::StatusFile;
use super::strain::{StrainWatch, warning_lines};
use super::warnings::Watch;
use crate::dynamics::{
    Cause, Cutback, Failure, IncrementReport, NodalResults, Observer, Outcome, RunSummary,
    SolverCounts, State,
};
use crate::linear::larger;
use crate::model::Model;

/// Cutbacks that the screen shows.
const SCREEN_CUTBACKS: usize = 20;
/// Increments with energy from contact that the log shows.
const LOGGED_GAINS: usize = 100;

/// Writes everything a run leaves behind: result file, status file, log and screen.
pub struct ResultWriter<'a> {
    model: &'a Model,
    files: JobFiles,
    result: ResultFile,
    status: StatusFile,
    console: Console,
    verbosity: Verbosity,
    table: Table,
    schedule: FrameSchedule<'a>,
    balance: Balance,
    watch: Watch,
    strain: StrainWatch,
    last: LastState,
    /// Failed attempts since the last increment.
    failed_attempts: usize,
    /// Failed attempts of the run.
    cutbacks: usize,
    landings: usize,
    /// Largest violation of Coulomb's cone.
    cone_violation: f64,
    started: Instant,
    spent: Duration,
}

/// The last good state: the final frame of a run that stops.
#[derive(Default)]
struct LastState {
    time: f64,
    state: State,
    nodal: NodalResults,
    /// Whether it is in the file.
    written: bool,
}

impl LastState {
    /// Copies the state into the memory at hand.
    fn set(&mut self, report: &IncrementReport, written: bool) {
        let (state, nodal) = (&report.state, &report.nodal);
        self.time = report.time;
        self.state.u.clone_from(&state.u);
        self.state.v.clone_from(&state.v);
        self.state.a.clone_from(&state.a);
        self.nodal.reaction.clone_from(&nodal.reaction);
        self.nodal.contact_force.clone_from(&nodal.contact_force);
        self.nodal.gap.clone_from(&nodal.gap);
        self.nodal.status.clone_from(&nodal.status);
        self.nodal.pressure.clone_from(&nodal.pressure);
        self.nodal.slip.clone_from(&nodal.slip);
        self.written = written;
    }
}

impl<'a> ResultWriter<'a> {
    /// Creates the files of a job, replacing old ones, and prints to the standard output.
    pub fn create(
        model: &'a Model,
        files: &JobFiles,
        record: &RunRecord,
        verbosity: Verbosity,
    ) -> Result<Self, OutputError> {
        let shown = verbosity != Verbosity::Quiet;
        let live = shown && io::stdout().is_terminal() && io::stderr().is_terminal();
        let screen = shown.then(|| Box::new(io::stdout()) as Box<dyn Write>);
        Self::with_screen(model, files, record, verbosity, screen, live)
    }

    /// The same with a screen of choice, and a live line on the terminal or not.
    pub fn with_screen(
        model: &'a Model,
        files: &JobFiles,
        record: &RunRecord,
        verbosity: Verbosity,
        screen: Option<Box<dyn Write>>,
        live: bool,
    ) -> Result<Self, OutputError> {
        check_names(model)?;
        create_folder(&files.result)?;
        remove_old(files)?;
        let log = Log::create(&files.log).map_err(OutputError::at(&files.log))?;
        let status = StatusFile::create(&files.status).map_err(OutputError::at(&files.status))?;
        let result = ResultFile::create(&files.result, model, record)
            .map_err(OutputError::at(&files.result))?;
        Ok(ResultWriter {
            model,
            files: files.clone(),
            result,
            status,
            console: Console::new(screen, Progress::new(model, live), log),
            verbosity,
            table: Table::new(model),
            schedule: FrameSchedule::new(model),
            balance: Balance::new(model),
            watch: Watch::default(),
            strain: StrainWatch::default(),
            last: LastState::default(),
            failed_attempts: 0,
            cutbacks: 0,
            landings: 0,
            cone_violation: 0.0,
            started: Instant::now(),
            spent: Duration::ZERO,
        })
    }

    /// Prints a line on the screen and in the log.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        self.console.line(text)
    }

    /// Writes a line to the log only.
    pub fn detail(&mut self, text: &str) -> io::Result<()> {
        self.console.detail(text)
    }

    /// Ends the run: the last good state of a stopped run, the record and the closing lines.
    pub fn finish(&mut self, summary: &RunSummary) -> io::Result<()> {
        self.console.finish();
        let exit_status = match &summary.outcome {
            Outcome::Finished => 0,
            Outcome::Stopped(failure) => {
                self.write_last_state()?;
                self.print_failure(failure)?;
                1
            }
        };
        let (output, total) = (self.spent, self.started.elapsed());
        let (output, total) = (output.as_secs_f64(), total.as_secs_f64());
        self.result.finish(summary, exit_status, output, total)?;
        self.print_totals(summary, output, total)
    }

    /// Ends a run that gives no summary; the record gets the exit status.
    pub fn abandon(&mut self, exit_status: u8) -> io::Result<()> {
        self.console.finish();
        self.result.abandon(exit_status)
    }

    fn write_last_state(&mut self) -> io::Result<()> {
        let last = &mut self.last;
        if last.written || last.state.u.is_empty() {
            return Ok(());
        }
        last.written = true;
        self.result
            .frame(self.model, last.time, &last.state, &last.nodal)
    }

    fn record_increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        if let Some(gain) = self.balance.add(report) {
            self.print_gain(report.increment, gain)?;
        }
        self.watch.add(report);
        if let Some(strained) = self.strain.add(report) {
            for line in warning_lines(strained, report, self.model) {
                self.console.line(&line)?;
            }
        }
        self.landings += report.landings.len();
        for contact in &report.contacts {
            self.cone_violation = larger(self.cone_violation, contact.cone_violation);
        }
        self.result.history(self.model, report)?;
        let due = self.schedule.is_due(report);
        if due {
            (self.result).frame(self.model, report.time, &report.state, &report.nodal)?;
        }
        self.last.set(report, due);
        Ok(())
    }

    fn print_increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        let error = self.balance.relative(report.energy.balance);
        let attempts = std::mem::take(&mut self.failed_attempts) + 1;
        if report.increment > 0 {
            self.status.write(report, attempts, error)?;
        }
        if self.verbosity == Verbosity::Verbose {
            self.console.detail(&increment_line(report))?;
            self.console.passes(&report.passes)?;
        }
        if self.table.shows(report) {
            if let Some(header) = self.table.header() {
                self.console.line(header)?;
            }
            self.console.line(&row(report, error))?;
        }
        self.console.progress(report);
        Ok(())
    }

    /// The energy that contact put in goes to the log, increment by increment up to a number.
    fn print_gain(&mut self, increment: usize, gain: f64) -> io::Result<()> {
        let count = self.balance.gains().count;
        if count > LOGGED_GAINS {
            return Ok(());
        }
        let (energy, part) = (scientific(gain, 2), self.balance.relative(gain));
        let part = scientific(part, 1);
        self.console.detail(&format!(
            "contact  put energy in in increment {increment}: {energy}, {part} of the largest"
        ))?;
        if count == LOGGED_GAINS {
            self.console
                .detail("         further such increments are counted only")?;
        }
        Ok(())
    }

    /// All cutbacks go to the log, the first ones to the screen too.
    fn print_cutback(&mut self, cutback: &Cutback) -> io::Result<()> {
        self.cutbacks += 1;
        for line in cutback_lines(cutback) {
            match self.cutbacks <= SCREEN_CUTBACKS {
                true => self.console.line(&line)?,
                false => self.console.detail(&line)?,
            }
        }
        if self.cutbacks == SCREEN_CUTBACKS {
            self.console
                .line("         further cutbacks stand in the log only")?;
        }
        Ok(())
    }

    fn print_failure(&mut self, failure: &Failure) -> io::Result<()> {
        for line in failure_lines(failure, self.model, &self.last.state.u) {
            self.console.alarm(&line)?;
        }
        if let Cause::Lcp(failed) = &failure.cause {
            let path = self.files.failed_lcp(failure.increment);
            fs::write(&path, failed.problem.to_json())?;
            let line = format!("lcp      {} holds the problem", path.display());
            self.console.alarm(&line)?;
        }
        let (name, _) = self.result.name_and_size();
        let pieces = match self.result.frames() {
            0 => vec![format!("{name} has no frame")],
            _ => vec![
                format!("{name} is valid up to its last frame"),
                format!("time {}", scientific(self.last.time, 6)),
            ],
        };
        for line in wrap("results", &pieces) {
            self.console.alarm(&line)?;
        }
        Ok(())
    }

    fn print_totals(&mut self, summary: &RunSummary, output: f64, total: f64) -> io::Result<()> {
        for line in timing_lines(summary, output, total) {
            self.console.line(&line)?;
        }
        let mut balance = format!(
            "energy balance {} of the largest energy",
            scientific(self.balance.worst(), 1)
        );
        if let Some(drift) = self.balance.momentum_drift() {
            balance.push_str(&format!("; momentum {}", scientific(drift, 1)));
        }
        self.console.line(&balance)?;
        self.console.line(&self.strain.line(self.model))?;
        if !self.model.contacts.is_empty() {
            self.console.line(&format!(
                "contact  {}; largest violation of Coulomb's cone {}",
                counted(self.landings, "landing"),
                scientific(self.cone_violation, 1),
            ))?;
        }
        let gains = self.balance.gains();
        if gains.count > 0 {
            let part = scientific(self.balance.relative(gains.energy), 1);
            self.console.line(&format!(
                "         contact put energy in in {}: {part} of the largest in all",
                counted(gains.count, "increment")
            ))?;
        }
        if summary.solver.lcps > 0 {
            for line in lcp_lines(&summary.solver) {
                self.console.line(&line)?;
            }
        }
        for line in self.watch.findings(self.model, &self.balance).lines() {
            self.console.line(&line)?;
        }
        let (name, size) = self.result.name_and_size();
        let frames = counted(self.result.frames(), "frame");
        let line = format!("wrote {name} ({frames}, {})", bytes(size));
        self.console.line(&line)
    }
}

impl Observer for ResultWriter<'_> {
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        let start = Instant::now();
        self.record_increment(report)?;
        self.print_increment(report)?;
        self.spent += start.elapsed();
        Ok(())
    }

    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()> {
        self.failed_attempts += 1;
        self.print_cutback(cutback)?;
        self.console.passes(&cutback.failure.passes)
    }
}

fn create_folder(file: &Path) -> Result<(), OutputError> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => {
            fs::create_dir_all(folder).map_err(OutputError::at(folder))
        }
        _ => Ok(()),
    }
}

/// Removes the files of an earlier run: one that is still going on keeps writing to its own.
fn remove_old(files: &JobFiles) -> Result<(), OutputError> {
    for path in files.existing() {
        fs::remove_file(path).map_err(|source| OutputError::Create {
            path: path.to_owned(),
            source,
        })?;
    }
    Ok(())
}

/// What the complementarity problems took, by method.
fn lcp_lines(solver: &SolverCounts) -> Vec<String> {
    let problems = counted(solver.lcps, "problem");
    let pieces = [
        format!("{problems}, at most {}", counted(solver.lcp_size, "pair")),
        counted(solver.active_set_iterations, "active-set iteration"),
        counted(solver.gauss_seidel_sweeps, "sweep"),
        counted(solver.lemke_calls, "Lemke solve"),
    ];
    wrap("LCP", &pieces)
}

/// Time of the run and the parts of its phases.
fn timing_lines(summary: &RunSummary, output: f64, total: f64) -> Vec<String> {
    let part = |name: &str, seconds: f64| {
        let percent = 100.0 * seconds / total.max(f64::MIN_POSITIVE);
        format!("{name} {percent:.0} %")
    };
    let mut pieces = vec![format!(
        "in {} s: {}, {}",
        general(total, 3),
        counted(summary.increments, "increment"),
        counted(summary.cutbacks, "cutback")
    )];
    if summary.events > 0 {
        pieces.push(format!("{} cut at impacts", summary.events));
    }
    let phases = phases(&summary.timings);
    pieces.extend(phases.iter().map(|&(name, seconds)| part(name, seconds)));
    pieces.push(part("output", output));
    let done = match summary.outcome {
        Outcome::Finished => "done",
        Outcome::Stopped(_) => "stopped",
    };
    wrap(done, &pieces)
}
