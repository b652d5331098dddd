//! The observer of a run: writes each increment to the result file, status file, log and screen, and
//! completes them at the end.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

use super::checks::Checks;
use super::console::{Console, Log, Verbosity};
use super::draft::{Existing, link, write_whole};
use super::error::{OutputError, at};
use super::failure::{cutback_advice, cutback_lines, failure_lines, held_lines};
use super::format::{bytes, counted, scientific, wrap};
use super::frames::{Frame, FrameSchedule};
use super::job::Claim;
use super::model_group::check_names;
use super::monitor::{Monitor, Remarks, lcp_lines, timing_lines};
use super::restart::{Checkpoint, RestartOrigin};
use super::result_file::ResultFile;
use super::run_record::RunRecord;
use super::status::{StatusFile, Written};
use super::strain::warning_lines;
use crate::archive::{Archive, ArchiveError};
use crate::contact::ContactSurfaces;
use crate::dynamics::{Cause, Cutback, Failure, IncrementReport, Observer, Outcome, RunSummary};
use crate::model::{Model, RestartOutput};

/// Largest number of cutbacks that the screen shows.
const SCREEN_CUTBACKS: usize = 20;
/// Largest number of increments with energy put in by contact that the log shows.
const LOGGED_CONTACT_ENERGIES: usize = 100;

/// Writes the files of a run, its screen and its log.
pub struct ResultWriter<'a> {
    model: &'a Model,
    result: ResultFile<'a>,
    /// The result file, which is created with the first frame.
    status: Option<StatusFile>,
    /// The status file of a continued run, until its first increment.
    continued: Option<StatusFile>,
    console: Console,
    schedule: FrameSchedule<'a>,
    monitor: Monitor,
    /// The last good state: the final frame of a run that stops.
    last: Frame,
    /// The numbers of its increment.
    numbers: IncrementReport,
    is_last_written: bool,
    started: Instant,
    /// Time spent on output.
    spent: Duration,
    interrupt: Interrupt,
    claim: Claim,
    checkpoints: Checkpoints,
    /// Time at which the last checkpoint was written, or the run began.
    checkpointed: Instant,
    is_checkpoint_due: bool,
    /// Whether the next checkpoint is kept along with later ones.
    is_checkpoint_kept: bool,
}

/// Checkpoints of a run, which are written where the deck requests them and when the run is interrupted.
#[derive(Debug, Clone, Default)]
pub struct Checkpoints {
    /// The program: version and commit.
    pub program: String,
    /// Deck and options of the run.
    pub origin: RestartOrigin,
    /// Wall-clock time from one checkpoint to the next, if the deck does not give their times.
    pub every: Option<Duration>,
}

impl<'a> ResultWriter<'a> {
    /// Begins the files of a job and prints to the standard output; `surfaces` are the surfaces of the contacts of the
    /// model.
    pub fn create(
        (model, surfaces): (&'a Model, &[ContactSurfaces]),
        claim: Claim,
        record: &RunRecord,
        verbosity: Verbosity,
    ) -> Result<Self, OutputError> {
        let started = Instant::now();
        check_names(model)?;
        let log = Log::new(claim.log()?, &claim.files().log);
        let result = ResultFile::create(
            &claim.draft()?,
            &claim.files().result,
            (model, surfaces),
            record,
        )?;
        Ok(ResultWriter {
            model,
            result,
            status: None,
            continued: None,
            console: Console::new(model, verbosity, log),
            schedule: FrameSchedule::new(model),
            monitor: Monitor::new(model),
            last: Frame::default(),
            numbers: IncrementReport::default(),
            is_last_written: false,
            started,
            spent: started.elapsed(),
            interrupt: Interrupt::default(),
            claim,
            checkpoints: Checkpoints::default(),
            checkpointed: started,
            is_checkpoint_due: false,
            is_checkpoint_kept: false,
        })
    }

    /// Continues from a checkpoint, with the rows and frames before it, behind the old text of the log. The old files
    /// stay unchanged until the first increment, or the end of the run, shows that the run really continues.
    ///
    /// # Errors
    /// The result or status file cannot be read, or does not belong to the checkpoint.
    pub fn go_on(&mut self, checkpoint: &Checkpoint) -> io::Result<()> {
        let files = self.claim.files().clone();
        let mut archive = Archive::Reading(&checkpoint.files);
        let earlier = (files.result.as_path(), checkpoint.origin.run.as_str());
        let written = self.transfer(&mut archive, Some(earlier), Written::default())?;
        self.continued = Some(StatusFile::go_on(&files.status, self.model, written)?);
        Ok(())
    }

    /// Begins the files with the state of a checkpoint of another job.
    ///
    /// # Errors
    /// The checkpoint belongs to another model, or a file cannot be written.
    pub fn begin_at(&mut self, checkpoint: &Checkpoint) -> io::Result<()> {
        let mut archive = Archive::Reading(&checkpoint.files);
        self.transfer_state(&mut archive)
            .map_err(io::Error::other)?;
        let mut report = self.numbers.clone();
        report.state = self.last.state.clone();
        report.nodal = self.last.nodal.clone();
        report.elements = Arc::clone(&self.last.elements);
        let checks = Checks::new(&report, &self.monitor.balance);
        self.result.history(&report, &checks);
        self.result.frame(&mut self.last);
        self.is_last_written = true;
        self.result.write()?;
        self.publish()
    }

    /// Transfers the progress of the run, and the last good state.
    fn transfer_state(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        self.schedule.transfer(archive)?;
        self.monitor.transfer(archive)?;
        self.last.transfer(archive)?;
        archive.transfer(&mut self.numbers)
    }

    /// Transfers the state of the files, and returns the state of the status file.
    fn transfer(
        &mut self,
        archive: &mut Archive,
        earlier: Option<(&Path, &str)>,
        mut status: Written,
    ) -> io::Result<Written> {
        let carried = (self.transfer_state(archive))
            .and_then(|()| archive.transfer(&mut self.is_last_written))
            .and_then(|()| archive.transfer(&mut status));
        carried.map_err(io::Error::other)?;
        self.result.transfer(archive, earlier)?;
        Ok(status)
    }

    /// Writes all results so far to the disk, and then a checkpoint.
    fn write_checkpoint(&mut self, solver: Vec<u8>) -> io::Result<()> {
        let Some(status) = &mut self.status else {
            return Ok(());
        };
        let written = status.sync()?;
        self.result.write_through()?;
        self.result.sync()?;
        let mut archive = Archive::new();
        self.transfer(&mut archive, None, written)?;
        let checkpoint = Checkpoint {
            program: self.checkpoints.program.clone(),
            origin: self.checkpoints.origin.clone(),
            time: self.last.time,
            place: self.schedule.place(),
            ends_step: self.numbers.ends_step,
            files: archive.into_bytes(),
            solver,
        };
        let files = self.claim.files();
        checkpoint.write(&files.restart)?;
        if std::mem::take(&mut self.is_checkpoint_kept) {
            let kept = files.kept_checkpoint(self.schedule.place());
            link(&files.restart, &kept).map_err(at(&kept))?;
        }
        (self.checkpointed, self.is_checkpoint_due) = (Instant::now(), false);
        Ok(())
    }

    /// Notes whether a checkpoint is due after an increment: as the deck requests, after some time since the last one,
    /// or at the end of the last step.
    fn note_due(&mut self, report: &IncrementReport) {
        let of_step = |restart: &&RestartOutput| restart.from_step <= report.step;
        let wanted = self.model.restarts.iter().rfind(of_step);
        let every = wanted.map_or(0, |restart| restart.every);
        let [_, increments] = self.schedule.place();
        let by_deck = every > 0 && (report.ends_step || increments.is_multiple_of(every));
        let is_end = report.ends_step && report.step == self.model.steps.len();
        let by_time = |every| is_end || self.checkpointed.elapsed() >= every;
        let is_asked = by_deck || self.checkpoints.every.is_some_and(by_time);
        self.is_checkpoint_kept = by_deck && wanted.is_some_and(|restart| restart.keeps_all);
        self.is_checkpoint_due |= report.increment > 0 && is_asked;
    }

    /// Ends the run after the increment in which `interrupt` requests it.
    pub fn heed(&mut self, interrupt: &Interrupt) {
        self.interrupt = interrupt.clone();
    }

    /// Sets the deck and options of checkpoints, and their times.
    pub fn keep_checkpoints(&mut self, checkpoints: Checkpoints) {
        self.checkpoints = checkpoints;
    }

    /// Text after an error: the time up to which the results can be read.
    pub fn kept(&self) -> Option<String> {
        let time = self
            .result
            .readable_time()
            .filter(|_| self.status.is_some())?;
        let time = scientific(time, 6);
        Some(format!("the results up to time {time} are kept"))
    }

    /// Error of a failed screen; `None` for a closed pipe.
    pub fn lost_screen(&mut self) -> Option<io::Error> {
        self.console.lost()
    }

    /// After the first frame, puts the files of the job in place of those of an earlier run. The result comes first,
    /// because other files without a result would block the next run.
    fn publish(&mut self) -> io::Result<()> {
        if self.status.is_some() {
            return Ok(());
        }
        let continued = self.continued.take();
        let goes_on = continued.is_some();
        let path = &self.claim.files().status;
        let mut status = continued.map_or_else(|| StatusFile::create(path, self.model), Ok)?;
        self.claim.publish()?;
        if !goes_on {
            self.claim.forget_checkpoints()?;
        }
        status.publish()?;
        self.status = Some(status);
        match goes_on {
            true => self.console.log.go_on(),
            false => self.console.log.begin(),
        }
    }

    /// Prints a line on the screen and in the log.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        self.console.line(text)
    }

    /// Writes a line to the log only.
    pub fn detail(&mut self, text: &str) -> io::Result<()> {
        self.console.log.line(text)
    }

    /// Ends the run: writes the last good state of a stopped run, the record and the closing lines.
    pub fn finish(&mut self, summary: &RunSummary) -> io::Result<()> {
        let start = Instant::now();
        self.console.finish();
        let has_state = !self.last.state.u.is_empty();
        if summary.outcome != Outcome::Finished && !self.is_last_written && has_state {
            self.result.frame(&mut self.last);
        }
        self.result.write()?;
        self.publish()?;
        self.status.as_mut().map_or(Ok(()), StatusFile::flush)?;
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
        self.spent += start.elapsed();
        let (output, total) = (self.spent, self.started.elapsed());
        let (output, total) = (output.as_secs_f64(), total.as_secs_f64());
        self.result.finish(summary, exit_status, output, total)?;
        self.print_totals(summary, output, total)
    }

    /// Ends a run without summary; the record gets the exit status.
    pub fn abandon(&mut self, exit_status: u8) -> io::Result<()> {
        self.console.finish();
        self.result.abandon(exit_status)
    }

    fn record_increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        let remarks = self.monitor.add(report);
        self.print_remarks(report, &remarks)?;
        self.result.history(report, &remarks.checks);
        self.last.set(report);
        self.numbers = report.numbers();
        let is_frame = self.schedule.is_due(report);
        self.note_due(report);
        self.is_last_written = is_frame;
        if is_frame {
            self.result.frame(&mut self.last);
        }
        self.result.write_when_due()?;
        match is_frame || self.continued.is_some() {
            true => self.publish(),
            false => Ok(()),
        }
    }

    fn print_increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        let error = self.monitor.balance.relative(report.energy.balance);
        let attempts = self.monitor.take_attempts();
        if let (Some(status), 1..) = (&mut self.status, report.increment) {
            status.write(report, attempts, error)?;
        }
        self.console.increment(report, error)
    }

    fn print_remarks(&mut self, report: &IncrementReport, remarks: &Remarks) -> io::Result<()> {
        if let Some(energy) = remarks.contact_energy {
            self.print_contact_energy(report.increment, energy)?;
        }
        if let (true, Some(held)) = (remarks.holds, &report.held) {
            self.console.lines(held_lines(held, report, self.model))?;
        }
        match remarks.strained {
            Some(strained) => {
                let lines = warning_lines(strained, report, self.model);
                self.console.lines(lines)
            }
            None => Ok(()),
        }
    }

    /// Logs the energy that contact put in, for a limited number of increments.
    fn print_contact_energy(&mut self, increment: usize, energy: f64) -> io::Result<()> {
        let balance = &self.monitor.balance;
        let count = balance.contact_energy().count;
        if count > LOGGED_CONTACT_ENERGIES {
            return Ok(());
        }
        let part = scientific(balance.relative(energy), 1);
        let energy = scientific(energy, 2);
        self.console.log.line(&format!(
            "contact  put energy in in increment {increment}: {energy}, {part} of the largest"
        ))?;
        if count == LOGGED_CONTACT_ENERGIES {
            (self.console.log).line("         further such increments are counted only")?;
        }
        Ok(())
    }

    /// Prints a cutback: every cutback goes to the log, and the first failed ones also to the screen.
    fn print_cutback(&mut self, cutback: &Cutback) -> io::Result<()> {
        let mut lines = cutback_lines(cutback, self.model);
        if let Cause::Inaccurate { .. } = cutback.failure.cause {
            self.monitor.add_attempt();
            return lines
                .iter()
                .try_for_each(|line| self.console.log.line(line));
        }
        let count = self.monitor.add_cutback();
        if self.monitor.is_new_kind(cutback) {
            lines.extend(cutback_advice(cutback, self.model));
        }
        for line in lines {
            match count <= SCREEN_CUTBACKS {
                true => self.console.line(&line)?,
                false => self.console.log.line(&line)?,
            }
        }
        if count == SCREEN_CUTBACKS {
            self.console
                .line("         further cutbacks stand in the log only")?;
        }
        Ok(())
    }

    fn print_failure(&mut self, failure: &Failure) -> io::Result<()> {
        let last = &self.last;
        let lines = failure_lines(failure, self.model, &last.state.u, &last.elements);
        self.alarm(lines)?;
        if let Cause::Lcp(failed) = &failure.cause {
            let path = self.claim.files().failed_lcp(failure.increment);
            let problem = failed.problem.to_json();
            write_whole(&path, &problem, Existing::Replaced).map_err(at(&path))?;
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
        self.alarm(wrap("stopped", &pieces))?;
        self.print_kept()
    }

    /// Prints up to which time the results are valid.
    fn print_kept(&mut self) -> io::Result<()> {
        let (name, _) = self.result.name_and_size();
        let pieces = match self.result.frames() {
            0 => vec![format!("{name} has no frame")],
            _ => vec![
                format!("{name} is valid up to its last frame"),
                format!("time {}", scientific(self.last.time, 6)),
            ],
        };
        self.alarm(wrap("results", &pieces))
    }

    fn alarm(&mut self, lines: Vec<String>) -> io::Result<()> {
        (lines.iter()).try_for_each(|line| self.console.alarm(line))
    }

    fn print_totals(&mut self, summary: &RunSummary, output: f64, total: f64) -> io::Result<()> {
        self.console.lines(timing_lines(summary, output, total))?;
        self.console.lines(self.monitor.lines(self.model))?;
        let solver = &summary.solver;
        self.console.lines(lcp_lines(solver))?;
        self.console.lines(self.monitor.warnings(self.model))?;
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
        self.print_cutback(cutback)?;
        self.console.log.passes(&cutback.failure.passes)
    }

    fn wants_stop(&self) -> bool {
        self.interrupt.signal().is_some()
    }

    fn wants_checkpoint(&self) -> bool {
        self.is_checkpoint_due
    }

    fn checkpoint(&mut self, solver: Vec<u8>) -> io::Result<()> {
        let start = Instant::now();
        self.write_checkpoint(solver)?;
        self.spent += start.elapsed();
        Ok(())
    }
}

/// A request from outside to end the run: the number of a signal, shared between its receiver and
/// the run.
#[derive(Debug, Clone, Default)]
pub struct Interrupt {
    /// Number of the signal; 0 as long as there is no request.
    signal: Arc<AtomicI32>,
}

impl Interrupt {
    /// Requests the end of the run.
    pub fn request(&self, signal: i32) {
        self.signal.store(signal, Ordering::Relaxed);
    }

    /// The signal that requests the end, if there is one.
    pub fn signal(&self) -> Option<i32> {
        Some(self.signal.load(Ordering::Relaxed)).filter(|&signal| signal != 0)
    }

    /// Exit status that shells give to a program ended by the signal: 128 + its number.
    pub(super) fn exit_status(&self) -> u8 {
        self.signal().map_or(0, |signal| 128 + signal as u8)
    }

    /// Name of the signal.
    pub(super) fn name(&self) -> &'static str {
        match self.exit_status() {
            129 => "SIGHUP",
            130 => "SIGINT",
            143 => "SIGTERM",
            _ => "a signal",
        }
    }
}
