//! The result file as a whole: all groups of `JOB.vtkhdf`, with disk space secured before each
//! history row and frame, and a flush after each frame.

use std::path::{Path, PathBuf};
use std::{fs, io};

use hdf5::{File, FileBuilder};

use super::error::{at, io_error};
use super::file::{Fields, Record, RunRecord, Space};
use super::frame::Frame;
use super::history::History;
use crate::dynamics::{IncrementReport, RunSummary};
use crate::model::Model;

/// `JOB.vtkhdf` while it is being written.
pub(super) struct ResultFile {
    /// Its final path.
    path: PathBuf,
    file: File,
    fields: Fields,
    history: History,
    record: Record,
    space: Space,
    /// Whether the library has failed, so that the content of the file is unknown.
    is_broken: bool,
}

impl ResultFile {
    /// Creates the file as `draft`, or replaces it, with everything known before the run; messages
    /// name it `path`.
    pub fn create(
        draft: &Path,
        path: &Path,
        model: &Model,
        record: &RunRecord,
    ) -> io::Result<Self> {
        let builder = || {
            FileBuilder::new()
                .with_fcpl(|properties| properties.obj_track_times(false))
                .create(draft)
        };
        let file = builder().map_err(io_error).map_err(at(path))?;
        let parts = Self::build(&file, model, record);
        let (fields, history, record) = parts.map_err(io_error).map_err(at(path))?;
        let mut result = ResultFile {
            path: path.to_owned(),
            space: Space::new(draft, &file).map_err(at(path))?,
            fields,
            history,
            record,
            file,
            is_broken: false,
        };
        result.room()?;
        Ok(result)
    }

    fn build(
        file: &File,
        model: &Model,
        record: &RunRecord,
    ) -> hdf5::Result<(Fields, History, Record)> {
        super::file::model::write(file, model)?;
        let fields = Fields::create(file, model)?;
        let history = History::create(file, model)?;
        let record = Record::create(file, record)?;
        file.flush()?;
        Ok((fields, history, record))
    }

    /// Appends the history row of an increment.
    pub fn history(&mut self, model: &Model, report: &IncrementReport) -> io::Result<()> {
        self.room()?;
        let written = self.history.write(model, report);
        self.checked(written)
    }

    /// Appends a frame and writes everything to the disk, so that the file is readable even when
    /// the program is killed; then reserves space for the next rows.
    pub fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        self.room()?;
        let written = (self.fields.write(frame))
            .and_then(|()| self.history.flush())
            .and_then(|()| self.file.flush());
        self.checked(written)?;
        self.space.written();
        self.room()
    }

    /// Completes the run record.
    pub fn finish(
        &mut self,
        summary: &RunSummary,
        exit_status: u8,
        output: f64,
        total: f64,
    ) -> io::Result<()> {
        let written = (self.history.flush())
            .and_then(|()| self.record.finish(summary, exit_status, output, total))
            .and_then(|()| self.file.flush());
        self.checked(written)?;
        self.space.release();
        Ok(())
    }

    /// Marks the end of a run without summary.
    pub fn abandon(&mut self, exit_status: u8) -> io::Result<()> {
        if self.is_broken {
            return Ok(());
        }
        let written = (self.history.flush())
            .and_then(|()| self.record.close(exit_status))
            .and_then(|()| self.file.flush());
        self.checked(written)?;
        self.space.release();
        Ok(())
    }

    /// Whether the frames written can be read.
    pub fn is_readable(&self) -> bool {
        !self.is_broken
    }

    /// Reserves disk space for the next rows: a file that the library has written only in part is
    /// lost as a whole.
    fn room(&mut self) -> io::Result<()> {
        self.space.ensure().map_err(at(&self.path))
    }

    fn checked(&mut self, done: hdf5::Result<()>) -> io::Result<()> {
        self.is_broken |= done.is_err();
        done.map_err(io_error).map_err(at(&self.path))
    }

    /// Frames in the file.
    pub fn frames(&self) -> usize {
        self.fields.count()
    }

    /// Name and size for the last line on the screen.
    pub fn name_and_size(&self) -> (String, u64) {
        let name = self.path.display().to_string();
        (name, fs::metadata(&self.path).map_or(0, |data| data.len()))
    }
}
