//! The observer of a run: passes each increment on to result file, status file, log and screen, and
//! closes them at the end.

use std::fs;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use super::error::{OutputError, at};
use super::file::{Claim, RunRecord, check_names, phases};
use super::frames::FrameSchedule;
use super::interrupt::Interrupt;
use super::last::LastState;
use super::result_file::ResultFile;
use super::summary::{Balance, Watch};
use super::text::{
    Console, Log, Progress, StatusFile, StrainWatch, Table, Verbosity, bytes, counted,
    cutback_lines, failure_lines, general, increment_line, row, scientific, warning_lines, wrap,
};
use crate::dynamics::{
    Cause, Cutback, Failure, IncrementReport, Observer, Outcome, RunSummary, SolverCounts,
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
    result: ResultFile,
    /// Created with the first frame.
    status: Option<StatusFile>,
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
    interrupt: Interrupt,
    claim: Claim,
}

impl<'a> ResultWriter<'a> {
    /// Begins the files of a job and prints to the standard output.
    pub fn create(
        model: &'a Model,
        claim: Claim,
        record: &RunRecord,
        verbosity: Verbosity,
    ) -> Result<Self, OutputError> {
        let shown = verbosity != Verbosity::Quiet;
        let live = shown && io::stdout().is_terminal() && io::stderr().is_terminal();
        let screen = shown.then(|| Box::new(io::stdout()) as Box<dyn Write>);
        Self::with_screen(model, claim, record, verbosity, screen, live)
    }

    /// The same with a screen of choice, and a live line on the terminal or not.
    pub fn with_screen(
        model: &'a Model,
        claim: Claim,
        record: &RunRecord,
        verbosity: Verbosity,
        screen: Option<Box<dyn Write>>,
        live: bool,
    ) -> Result<Self, OutputError> {
        check_names(model)?;
        let log = Log::new(claim.log()?, &claim.files().log);
        let result = ResultFile::create(&claim.draft()?, &claim.files().result, model, record)?;
        Ok(ResultWriter {
            model,
            result,
            status: None,
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
            interrupt: Interrupt::default(),
            claim,
        })
    }

    /// Ends the run after the increment in which `interrupt` asks for it.
    pub fn heed(&mut self, interrupt: &Interrupt) {
        self.interrupt = interrupt.clone();
    }

    /// What there is to read of the results after an error: up to which time.
    pub fn kept(&self) -> Option<String> {
        let is_kept = self.status.is_some() && self.result.is_readable();
        is_kept.then(|| {
            let time = scientific(self.last.frame, 6);
            format!("the results up to time {time} are kept")
        })
    }

    /// Why the screen was given up; a closed pipe is no reason.
    pub fn lost_screen(&mut self) -> Option<io::Error> {
        self.console.lost()
    }

    /// With the first frame the files of the job appear, in place of those of an earlier run.
    fn publish(&mut self) -> io::Result<()> {
        if self.status.is_none() {
            let status = StatusFile::create(&self.claim.files().status)?;
            self.console.begin_log()?;
            self.claim.publish()?;
            self.status = Some(status);
        }
        Ok(())
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
        if summary.outcome != Outcome::Finished {
            self.write_last_state()?;
        }
        self.publish()?;
        let exit_status = match &summary.outcome {
            Outcome::Finished if self.console.is_lost() => 4,
            Outcome::Finished => 0,
            Outcome::Stopped(failure) => {
                self.print_failure(failure)?;
                1
            }
            Outcome::Interrupted => {
                self.print_interrupt(summary)?;
                self.interrupt.exit_status()
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
        self.result
            .frame(self.model, last.time, &last.state, &last.nodal)?;
        (last.written, last.frame) = (true, last.time);
        Ok(())
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
            self.publish()?;
        }
        self.last.set(report, due);
        Ok(())
    }

    fn print_increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        let error = self.balance.relative(report.energy.balance);
        let attempts = std::mem::take(&mut self.failed_attempts) + 1;
        if let (Some(status), 1..) = (&mut self.status, report.increment) {
            status.write(report, attempts, error)?;
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
            let path = self.claim.files().failed_lcp(failure.increment);
            replace(&path, &failed.problem.to_json()).map_err(at(&path))?;
            let line = format!("lcp      {} holds the problem", path.display());
            self.console.alarm(&line)?;
        }
        self.print_kept()
    }

    fn print_interrupt(&mut self, summary: &RunSummary) -> io::Result<()> {
        let pieces = [
            format!("{} asked for the end", self.interrupt.name()),
            format!("increment {} is the last", summary.increments),
        ];
        for line in wrap("stopped", &pieces) {
            self.console.alarm(&line)?;
        }
        self.print_kept()
    }

    /// Up to where the results are good.
    fn print_kept(&mut self) -> io::Result<()> {
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

    fn wants_stop(&self) -> bool {
        self.interrupt.signal().is_some()
    }
}

/// Writes a file in place of what has its name, be it a link or a fifo.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => fs::write(path, text),
    }
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
        Outcome::Stopped(_) | Outcome::Interrupted => "stopped",
    };
    wrap(done, &pieces)
}
