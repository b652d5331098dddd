//! `JOB.sta`: one line per increment in fixed columns.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::format::{push_scientific, push_signed};
use super::screen::{closed, sticking};
use crate::dynamics::IncrementReport;
use crate::model::Model;
use crate::output::error::at;

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

/// A value of a line.
enum Value {
    Count(usize),
    /// A number with its decimals.
    Number(f64, usize),
    /// The same with its sign.
    Signed(f64, usize),
}

/// A line of values right-aligned in columns. Its memory is kept: there is one for each increment.
#[derive(Default)]
struct Line {
    text: String,
    value: String,
}

impl Line {
    fn put(&mut self, value: &Value, width: usize) {
        self.value.clear();
        match *value {
            Value::Count(count) => self.value.push_str(&count.to_string()),
            Value::Number(x, decimals) => push_scientific(&mut self.value, x, decimals),
            Value::Signed(x, decimals) => push_signed(&mut self.value, x, decimals),
        }
        // Writing to a string does not fail.
        let _ = write!(self.text, "{:>width$}", self.value);
    }
}

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
    line: Line,
    /// When lines were last written to the disk.
    written: Instant,
}

impl StatusFile {
    /// Creates the file, or empties it.
    pub fn create(path: &Path, model: &Model) -> io::Result<Self> {
        let mut file = BufWriter::new(File::create(path).map_err(at(path))?);
        let mut names: String = (COLUMNS.iter())
            .map(|(name, width)| format!("{name:>width$}"))
            .collect();
        let mut columns = Vec::new();
        for (name, dof) in monitored(model) {
            let width = DISPLACEMENT.max(name.chars().count() + 1);
            names.push_str(&format!("{name:>width$}"));
            columns.push((dof, width));
        }
        writeln!(file, "{TITLE}\n#{}", &names[1..]).map_err(at(path))?;
        let mut status = StatusFile {
            file,
            path: path.to_owned(),
            monitored: columns,
            line: Line::default(),
            written: Instant::now(),
        };
        status.flush()?;
        Ok(status)
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
            Value::Count(report.step),
            Value::Count(report.increment),
            Value::Count(attempts),
            Value::Count(solver.passes),
            Value::Count(closed(report)),
            Value::Count(sticking(report)),
            Value::Number(report.time, 10),
            Value::Number(report.step_time, 10),
            Value::Number(report.dt, 10),
            Value::Number(solver.residual, 2),
            Value::Count(solver.lcp_size),
            Value::Count(solver.pivots),
            Value::Signed(error, 3),
        ];
        self.line.text.clear();
        for (value, (_, width)) in values.iter().zip(COLUMNS) {
            self.line.put(value, width);
        }
        for &(dof, width) in &self.monitored {
            self.line
                .put(&Value::Number(report.state.u[dof], 10), width);
        }
        self.line.text.push('\n');
        let text = self.line.text.as_bytes();
        self.file.write_all(text).map_err(at(&self.path))?;
        match self.written.elapsed() >= PAUSE {
            true => self.flush(),
            false => Ok(()),
        }
    }
}
