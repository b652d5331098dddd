use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use hdf5::{File, FileBuilder};

use super::error::io_error;
use super::history::History;
use super::record::{Record, RunRecord};
use super::vtkhdf::Fields;
use crate::dynamics::{IncrementReport, NodalResults, RunSummary, State};
use crate::model::Model;

/// `JOB.vtkhdf` while it is being written.
pub(super) struct ResultFile {
    path: PathBuf,
    file: File,
    fields: Fields,
    history: History,
    record: Record,
}

impl ResultFile {
    /// Creates the file, or replaces it, with everything known before the run.
    pub fn create(path: &Path, model: &Model, record: &RunRecord) -> io::Result<Self> {
        Self::build(path, model, record).map_err(io_error)
    }

    fn build(path: &Path, model: &Model, record: &RunRecord) -> hdf5::Result<Self> {
        let file = FileBuilder::new()
            .with_fcpl(|properties| properties.obj_track_times(false))
            .create(path)?;
        super::model::write(&file, model)?;
        let result = ResultFile {
            path: path.to_owned(),
            fields: Fields::create(&file, model)?,
            history: History::create(&file, model)?,
            record: Record::create(&file, record)?,
            file,
        };
        result.file.flush()?;
        Ok(result)
    }

    /// Appends the history row of an increment.
    pub fn history(&mut self, model: &Model, report: &IncrementReport) -> io::Result<()> {
        self.history.write(model, report).map_err(io_error)
    }

    /// Appends a frame and writes everything to the disk, so that the file is readable even when
    /// the program is killed.
    pub fn frame(
        &mut self,
        model: &Model,
        time: f64,
        state: &State,
        nodal: &NodalResults,
    ) -> io::Result<()> {
        (self.fields.write(model, time, state, nodal))
            .and_then(|()| self.history.flush())
            .and_then(|()| self.file.flush())
            .map_err(io_error)
    }

    /// Completes the run record.
    pub fn finish(
        &mut self,
        summary: &RunSummary,
        exit_status: u8,
        output: f64,
        total: f64,
    ) -> io::Result<()> {
        (self.history.flush())
            .and_then(|()| self.record.finish(summary, exit_status, output, total))
            .and_then(|()| self.file.flush())
            .map_err(io_error)
    }

    /// Marks the end of a run without summary.
    pub fn abandon(&mut self, exit_status: u8) -> io::Result<()> {
        (self.history.flush())
            .and_then(|()| self.record.close(exit_status))
            .and_then(|()| self.file.flush())
            .map_err(io_error)
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
