//! `JOB.sta`: one line per increment in fixed columns.

use std::fs::File;
use std::io;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::console::{closed, sticking};
use super::error::at;
use super::format::{scientific, signed};
use crate::dynamics::IncrementReport;
use crate::model::Model;

const TITLE: &str = "# stickslip status file, format 1";

/// Lines of increments that follow each other faster are written together.
const PAUSE: Duration = Duration::from_millis(200);

/// Names of the columns with their widths.
const COLUMNS: [(&str, usize); 13] = [
    ("step", 7),
    ("inc", 11),
    ("att", 5),
    ("pass", 5),
    ("active", 8),
    ("stick", 8),
    ("time", 18),
    ("step_time", 18),
    ("dt", 18),
    ("residual", 10),
    ("lcp", 8),
    ("pivots", 8),
    ("energy_error", 13),
];

/// Width of the column of a displacement, unless its name is longer.
const DISPLACEMENT: usize = 18;

/// Names of the displacements that the deck wants to see, such as `U2(13)`, with their dofs.
pub(crate) fn monitored(model: &Model) -> Vec<(String, usize)> {
    let name = |&dof: &usize| format!("U{}({})", dof % 2 + 1, model.node_name(dof / 2));
    let dofs = model.sets.monitored.iter();
    dofs.map(|dof| (name(dof), *dof)).collect()
}

/// Writes the status file.
pub(crate) struct StatusFile {
    file: BufWriter<File>,
    path: PathBuf,
    /// Further columns: dofs with the widths of their columns.
    monitored: Vec<(usize, usize)>,
    /// When lines were last written to the disk.
    written: Instant,
}

impl StatusFile {
    /// Creates the file, or empties it.
    pub fn create(path: &Path, model: &Model) -> io::Result<Self> {
        let (mut status, names) = Self::at(path, File::create(path), model)?;
        writeln!(status.file, "{TITLE}\n#{}", &names[1..]).map_err(at(path))?;
        status.flush()?;
        Ok(status)
    }

    /// Goes on behind the first `length` bytes of the file.
    pub fn go_on(path: &Path, model: &Model, length: u64) -> io::Result<Self> {
        let mut file = File::options().write(true).open(path).map_err(at(path))?;
        let cut = file
            .set_len(length)
            .and_then(|()| file.seek(SeekFrom::End(0)));
        cut.map_err(at(path))?;
        Ok(Self::at(path, Ok(file), model)?.0)
    }

    /// Writes to a file; with the names of its columns.
    fn at(path: &Path, file: io::Result<File>, model: &Model) -> io::Result<(Self, String)> {
        let mut names: String = (COLUMNS.iter())
            .map(|(name, width)| format!("{name:>width$}"))
            .collect();
        let mut columns = Vec::new();
        for (name, dof) in monitored(model) {
            let width = DISPLACEMENT.max(name.chars().count() + 1);
            names.push_str(&format!("{name:>width$}"));
            columns.push((dof, width));
        }
        let status = StatusFile {
            file: BufWriter::new(file.map_err(at(path))?),
            path: path.to_owned(),
            monitored: columns,
            written: Instant::now(),
        };
        Ok((status, names))
    }

    /// Writes all lines to the disk and gives the length of the file.
    pub fn length(&mut self) -> io::Result<u64> {
        self.flush()?;
        Ok(self
            .file
            .get_ref()
            .metadata()
            .map_err(at(&self.path))?
            .len())
    }

    /// Writes the lines so far to the disk.
    pub fn flush(&mut self) -> io::Result<()> {
        self.written = Instant::now();
        self.file.flush().map_err(at(&self.path))
    }

    /// Writes the line of an increment with the number of its attempts; `error` is the relative
    /// energy balance.
    pub fn write(
        &mut self,
        report: &IncrementReport,
        attempts: usize,
        error: f64,
    ) -> io::Result<()> {
        let solver = &report.solver;
        let values = [
            report.step.to_string(),
            report.increment.to_string(),
            attempts.to_string(),
            solver.passes.to_string(),
            closed(report).to_string(),
            sticking(report).to_string(),
            scientific(report.time, 10),
            scientific(report.step_time, 10),
            scientific(report.dt, 10),
            scientific(solver.residual, 2),
            solver.lcp_size.to_string(),
            solver.pivots.to_string(),
            signed(error, 3),
        ];
        let mut line = String::new();
        for (value, (_, width)) in values.iter().zip(COLUMNS) {
            line.push_str(&format!("{value:>width$}"));
        }
        for &(dof, width) in &self.monitored {
            let value = scientific(report.state.u[dof], 10);
            line.push_str(&format!("{value:>width$}"));
        }
        writeln!(self.file, "{line}").map_err(at(&self.path))?;
        match self.written.elapsed() >= PAUSE {
            true => self.flush(),
            false => Ok(()),
        }
    }
}
