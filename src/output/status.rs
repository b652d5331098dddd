//! `JOB.sta`: one line per increment in fixed columns.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use super::console::{closed, sticking};
use super::draft::{Draft, Existing};
use super::error::at;
use super::format::{scientific, signed};
use crate::deck::open_regular;
use crate::dynamics::IncrementReport;
use crate::model::Model;

const TITLE: &str = "# stickslip status file, format 1";

/// Time between increments below which their lines are written together.
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

/// Names of the displacements that the deck monitors, such as `U2(13)`, with their dofs.
pub(crate) fn monitored(model: &Model) -> Vec<(String, usize)> {
    let name = |&dof: &usize| format!("U{}({})", dof % 2 + 1, model.node_name(dof / 2));
    let dofs = model.sets.monitored.iter();
    dofs.map(|dof| (name(dof), *dof)).collect()
}

/// State of a status file: its length, and the check sum of its text.
pub(crate) type Written = (u64, [u8; 32]);

/// Writes the status file.
pub(crate) struct StatusFile {
    file: BufWriter<File>,
    path: PathBuf,
    /// The draft of the file until it replaces an earlier file; `None` afterwards.
    draft: Option<Draft>,
    /// Number of bytes of the text, and its check sum.
    length: u64,
    sum: Sha256,
    /// Further columns: dofs with the widths of their columns.
    monitored: Vec<(usize, usize)>,
    /// Time at which lines were last written to the disk.
    written: Instant,
}

impl StatusFile {
    /// Begins the file, which gets its name with [`Self::publish`].
    pub fn create(path: &Path, model: &Model) -> io::Result<Self> {
        let (mut status, names) = Self::at(path, model)?;
        status.write_all(format!("{TITLE}\n#{}\n", &names[1..]).as_bytes())?;
        status.flush()?;
        Ok(status)
    }

    /// Begins the file with the text that an earlier file had when a checkpoint was written (`written`).
    ///
    /// # Errors
    /// The earlier file has another text, or the file system refuses the file.
    pub fn go_on(path: &Path, model: &Model, (length, sum): Written) -> io::Result<Self> {
        let mut text = Vec::new();
        let read = open_regular(path).and_then(|file| file.take(length).read_to_end(&mut text));
        read.map_err(at(path))?;
        if text.len() as u64 != length || Sha256::digest(&text).as_slice() != sum {
            let other = "it is not the status file of the run that the checkpoint is of";
            return Err(at(path)(io::Error::other(other)));
        }
        let (mut status, _) = Self::at(path, model)?;
        status.write_all(&text)?;
        status.flush()?;
        Ok(status)
    }

    /// Puts the file in place of an earlier one.
    pub fn publish(&mut self) -> io::Result<()> {
        let named = |draft: Draft| draft.publish(&self.path, Existing::Replaced).map(drop);
        (self.draft.take().map_or(Ok(()), named)).map_err(at(&self.path))
    }

    /// A status file without text, and the line with the names of its columns.
    fn at(path: &Path, model: &Model) -> io::Result<(Self, String)> {
        let mut names: String = (COLUMNS.iter())
            .map(|(name, width)| format!("{name:>width$}"))
            .collect();
        let mut columns = Vec::new();
        for (name, dof) in monitored(model) {
            let width = DISPLACEMENT.max(name.chars().count() + 1);
            names.push_str(&format!("{name:>width$}"));
            columns.push((dof, width));
        }
        let mut draft = Draft::claimed(path).map_err(at(path))?;
        let status = StatusFile {
            file: BufWriter::new(draft.file().try_clone().map_err(at(path))?),
            path: path.to_owned(),
            draft: Some(draft),
            length: 0,
            sum: Sha256::new(),
            monitored: columns,
            written: Instant::now(),
        };
        Ok((status, names))
    }

    /// Brings all lines to the disk itself, and returns the state of the file.
    pub fn sync(&mut self) -> io::Result<Written> {
        self.flush()?;
        self.file.get_ref().sync_data().map_err(at(&self.path))?;
        Ok((self.length, self.sum.clone().finalize().into()))
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.length += bytes.len() as u64;
        self.sum.update(bytes);
        self.file.write_all(bytes).map_err(at(&self.path))
    }

    /// Writes the lines so far to the disk.
    pub fn flush(&mut self) -> io::Result<()> {
        self.written = Instant::now();
        self.file.flush().map_err(at(&self.path))
    }

    /// Writes the line of an increment, with the number of its attempts; `error` is the relative energy balance.
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
        line.push('\n');
        self.write_all(line.as_bytes())?;
        match self.written.elapsed() >= PAUSE {
            true => self.flush(),
            false => Ok(()),
        }
    }
}
