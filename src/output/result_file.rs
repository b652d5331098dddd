//! The result file as a whole: all groups of `JOB.vtkhdf`. Frames and history rows wait in memory and
//! are written together, with disk space secured beforehand.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{fs, io};

use hdf5::{File, FileBuilder};

use super::checks::{self, Checks};
use super::column::GrowingColumns;
use super::error::{at, io_error};
use super::fields;
use super::frames::Frame;
use super::history::History;
use super::local;
use super::run_record::{RecordWriter, RunRecord, run_id};
use super::space::Space;
use crate::archive::Archive;
use crate::contact::ContactSurfaces;
use crate::deck::open_regular;
use crate::dynamics::{IncrementReport, RunSummary};
use crate::model::Model;

/// Largest number of bytes of frames that wait in memory (but at least one frame): more bytes mean fewer writes. Disk
/// space for them is reserved beforehand; if there is less space, the second number holds.
const WAITING_BYTES: [usize; 2] = [8 << 20, 2 << 20];

/// Ratio of the bytes of frames to the bytes of history rows that may wait.
const FRAMES_TO_HISTORY: usize = 4;

/// `JOB.vtkhdf` while it is being written.
pub(super) struct ResultFile<'m> {
    /// Path of the file once its first frame is complete.
    path: PathBuf,
    file: File,
    fields: GrowingColumns<'m, Frame>,
    history: GrowingColumns<'m, IncrementReport>,
    checks: GrowingColumns<'m, Checks>,
    record: RecordWriter,
    space: Space,
    pace: Pace,
    /// Number of frames.
    frames: usize,
    /// Time of the last frame.
    frame_time: f64,
    /// Whether the library has failed, so that the content of the file is unknown.
    is_broken: bool,
}

impl<'m> ResultFile<'m> {
    /// Creates the file as `draft`, or replaces it, with everything known before the run; messages
    /// name it `path`.
    pub fn create(
        draft: &Path,
        path: &Path,
        (model, surfaces): (&'m Model, &[ContactSurfaces]),
        record: &RunRecord,
    ) -> io::Result<Self> {
        let builder = || {
            FileBuilder::new()
                .with_fcpl(|properties| properties.obj_track_times(false))
                .create_excl(draft)
        };
        let file = builder().map_err(io_error).map_err(at(path))?;
        let parts = || {
            super::model_group::write(&file, model)?;
            super::model_data::write(&file.group("model")?, model, surfaces)?;
            let local = local::elements(model);
            let fields = fields::create(&file, model, &local)?;
            let history = History::create(&file, model, &local)?;
            let checks = checks::create(&file.group("history")?, model)?;
            let record = RecordWriter::create(&file, record)?;
            file.flush()?;
            Ok((fields, history, checks, record))
        };
        let (fields, history, checks, record) = parts().map_err(io_error).map_err(at(path))?;
        let mut result = ResultFile {
            path: path.to_owned(),
            space: Space::new(draft).map_err(at(path))?,
            pace: Pace::new(),
            frames: 0,
            frame_time: 0.0,
            fields,
            history,
            checks,
            record,
            file,
            is_broken: false,
        };
        result.room_for_more()?;
        Ok(result)
    }

    /// Appends the history row of an increment and of its checks, which wait in memory.
    pub fn history(&mut self, report: &IncrementReport, checks: &Checks) {
        self.history.push(report);
        self.checks.push(checks);
    }

    /// Appends a frame, which waits in memory.
    pub fn frame(&mut self, frame: &mut Frame) {
        frame.index = self.frames;
        self.fields.push(frame);
        self.frames += 1;
        self.frame_time = frame.time;
    }

    /// Writes the rows and frames that wait in memory if they are many, if writing takes little of the time of the run,
    /// or if the last write was some time ago.
    pub fn write_when_due(&mut self) -> io::Result<()> {
        let is_much = self.fields.is_full() || self.history.is_full();
        let has_frame = self.fields.is_waiting();
        match is_much || (has_frame && self.pace.is_due()) || self.pace.is_late() {
            true => self.write_through(),
            false => Ok(()),
        }
    }

    /// Transfers the numbers of rows in the file; it must follow [`Self::write_through`] when a checkpoint is written.
    /// When a checkpoint is read, these rows are copied from `earlier`: the file of the stopped run, and its id.
    pub fn transfer(
        &mut self,
        archive: &mut Archive,
        earlier: Option<(&Path, &str)>,
    ) -> io::Result<()> {
        let mut written = [
            self.fields.written(),
            self.history.written(),
            self.checks.written(),
        ];
        archive.transfer(&mut written).map_err(io::Error::other)?;
        archive
            .transfer(&mut self.frames)
            .map_err(io::Error::other)?;
        archive
            .transfer(&mut self.frame_time)
            .map_err(io::Error::other)?;
        let Some((earlier, id)) = earlier else {
            return Ok(());
        };
        open_regular(earlier).map_err(at(earlier))?;
        let [fields, history, checks] = &written;
        let file = File::open(earlier).map_err(io_error).map_err(at(earlier))?;
        if run_id(&file).as_deref() != Some(id) {
            let other = "it is not the result of the run that the checkpoint is of";
            return Err(at(earlier)(io::Error::other(other)));
        }
        let copied = (|| {
            self.fields.copy(&file, fields)?;
            self.history.copy(&file, history)?;
            self.checks.copy(&file, checks)
        })();
        copied.map_err(io_error).map_err(at(earlier))?;
        self.write_through()
    }

    /// Brings everything that has been written to the disk itself.
    pub fn sync(&self) -> io::Result<()> {
        self.space.sync().map_err(at(&self.path))
    }

    /// Writes everything to the disk, so that the file is readable even when the program is killed; then reserves space
    /// for further rows.
    pub fn write_through(&mut self) -> io::Result<()> {
        let start = Instant::now();
        self.room()?;
        self.write()?;
        self.space.written();
        self.pace.written(start);
        self.room_for_more()
    }

    /// Writes the rows that wait in memory; the numbers of frames and rows, on which readers rely, are written last.
    pub fn write(&mut self) -> io::Result<()> {
        let written = (self.fields.flush())
            .and_then(|()| self.history.flush())
            .and_then(|()| self.checks.flush());
        self.checked(written)?;
        self.flush()?;
        let counted = (self.fields.note_counts()).and_then(|()| self.history.note_counts());
        self.checked(counted)?;
        self.flush()
    }

    /// Writes all data that the library holds. The end of the file is noted last. Until then the noted end lies behind
    /// everything that the library may write, because a file with addresses beyond its end cannot be read.
    fn flush(&mut self) -> io::Result<()> {
        let end = self.space.move_end_ahead().map_err(at(&self.path))?;
        let flushed = self.file.flush();
        self.checked(flushed)?;
        self.space.settle_end(end).map_err(at(&self.path))
    }

    /// Completes the run record, after everything else.
    pub fn finish(
        &mut self,
        summary: &RunSummary,
        exit_status: u8,
        output: f64,
        total: f64,
    ) -> io::Result<()> {
        let written = (self.record).finish(summary, exit_status, output, total);
        self.checked(written)?;
        self.flush()?;
        self.space.release();
        Ok(())
    }

    /// Marks the end of a run without summary.
    pub fn abandon(&mut self, exit_status: u8) -> io::Result<()> {
        if self.is_broken {
            return Ok(());
        }
        self.write()?;
        let written = self.record.close(exit_status);
        self.checked(written)?;
        self.flush()?;
        self.space.release();
        Ok(())
    }

    /// Time of the last frame that can be read after waiting rows have been written; `None` if there is no frame.
    pub fn readable_time(&self) -> Option<f64> {
        (self.frames > 0 && !self.is_broken).then_some(self.frame_time)
    }

    /// Reserves disk space for the rows that may wait next: for many rows, or for fewer if the disk is nearly full.
    fn room_for_more(&mut self) -> io::Result<()> {
        let [many, few] = WAITING_BYTES;
        self.let_wait(many);
        self.room().or_else(|_| {
            self.space.release();
            self.let_wait(few);
            self.room()
        })
    }

    fn let_wait(&mut self, bytes: usize) {
        self.fields.let_wait(bytes);
        self.history.let_wait(bytes / FRAMES_TO_HISTORY);
        self.checks.let_wait(bytes / FRAMES_TO_HISTORY);
    }

    /// Reserves disk space for all rows that may wait, because a file that the library has written only in part is
    /// completely lost.
    fn room(&mut self) -> io::Result<()> {
        let growth = self.fields.growth() + self.history.growth() + self.checks.growth();
        self.space.ensure(growth).map_err(at(&self.path))
    }

    fn checked(&mut self, done: hdf5::Result<()>) -> io::Result<()> {
        self.is_broken |= done.is_err();
        done.map_err(io_error).map_err(at(&self.path))
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Name and size for the last line on the screen.
    pub fn name_and_size(&self) -> (String, u64) {
        let name = self.path.display().to_string();
        (name, fs::metadata(&self.path).map_or(0, |data| data.len()))
    }
}

/// Longest time for which results wait in memory while a run continues.
const LONGEST: Duration = Duration::from_secs(1);

/// Smallest ratio of the time of a run to the time of its writes.
const MULTIPLE: u32 = 30;

/// Decides when to write: a write is due when all writes so far, and another one like the last, need little of the time
/// of the run. Increments that take long are written at once.
pub(super) struct Pace {
    start: Instant,
    /// Time at which the last write ended.
    last: Option<Instant>,
    /// Time of the run from which on the next write is due.
    due: Duration,
    /// Total time of all writes.
    spent: Duration,
}

impl Pace {
    /// The first write is due at once.
    pub fn new() -> Self {
        Pace {
            start: Instant::now(),
            last: None,
            due: Duration::ZERO,
            spent: Duration::ZERO,
        }
    }

    /// Whether a write is due.
    pub fn is_due(&self) -> bool {
        self.start.elapsed() >= self.due
    }

    /// Whether the last write was some time ago.
    pub fn is_late(&self) -> bool {
        self.last.is_some_and(|last| last.elapsed() >= LONGEST)
    }

    /// Notes a write that began at `start` and has just ended.
    pub fn written(&mut self, start: Instant) {
        let end = Instant::now();
        let write = end - start;
        self.spent += write;
        self.due = MULTIPLE * (self.spent + write);
        self.last = Some(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn before(milliseconds: u64) -> Instant {
        let time = Instant::now().checked_sub(Duration::from_millis(milliseconds));
        time.expect("some time ago")
    }

    #[test]
    fn writes_are_short_against_the_run_but_none_waits_for_long() {
        let mut pace = Pace::new();
        assert!(pace.is_due(), "the first");
        pace.written(before(5));
        assert!(!pace.is_due());
        pace.start = before(5 * 2 * u64::from(MULTIPLE) - 100);
        assert!(!pace.is_due(), "a second like the first");
        pace.start = before(5 * 2 * u64::from(MULTIPLE) + 100);
        assert!(pace.is_due(), "long enough a run for two");
        pace.written(before(2000));
        assert!(!pace.is_due());
        assert!(!pace.is_late());
        pace.last = Some(before(1001));
        assert!(pace.is_late(), "a second");
    }
}
