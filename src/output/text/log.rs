//! `JOB.log`: its file, and the convergence tables and cutbacks that only the log holds.

use std::fs::File;
use std::io::{self, LineWriter, Write};
use std::path::{Path, PathBuf};

use super::advice::{advice, course_text};
use super::format::scientific;
use super::layout::{wrap, wrap_words};
use crate::dynamics::{Cutback, IncrementReport, PassReport};
use crate::model::Model;
use crate::output::error::at;

/// Writes the log.
pub(crate) struct Log {
    file: LineWriter<File>,
    path: PathBuf,
    /// Lines that wait until the log begins; none afterwards.
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

    /// Empties the file and writes the buffered lines.
    pub fn begin(&mut self) -> io::Result<()> {
        let waiting = self.waiting.take().unwrap_or_default();
        let emptied = self.file.get_mut().set_len(0);
        emptied
            .and_then(|()| self.file.write_all(waiting.as_bytes()))
            .map_err(at(&self.path))
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

/// The convergence table of an increment.
pub(crate) fn pass_table(passes: &[PassReport]) -> Vec<String> {
    if passes.is_empty() {
        return vec![];
    }
    let header = "     pass  residual correction  active   stick     LCP  pivots".to_owned();
    let row = |(i, pass): (usize, &PassReport)| {
        format!(
            "     {:>4}{:>10}{:>11}{:>8}{:>8}{:>8}{:>8}",
            i + 1,
            scientific(pass.residual, 2),
            scientific(pass.correction, 2),
            pass.active,
            pass.stick,
            pass.lcp_size,
            pass.pivots,
        )
    };
    let rows = passes.iter().enumerate().map(row);
    std::iter::once(header).chain(rows).collect()
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

/// The lines about a cutback: increment, cause, and how the passes went.
pub(crate) fn cutback_lines(cutback: &Cutback, model: &Model) -> Vec<String> {
    let failure = &cutback.failure;
    let pieces = [
        format!(
            "increment {} at {}, dt {} -> {}",
            failure.increment,
            scientific(failure.time, 3),
            scientific(failure.dt, 2),
            scientific(cutback.next_dt, 2),
        ),
        failure.cause.to_string(),
    ];
    let mut lines = wrap("cutback", &pieces);
    let course = failure.course.as_deref();
    lines.extend(
        course
            .into_iter()
            .flat_map(|course| wrap_words("", &course_text(course, model))),
    );
    lines
}

/// What to change so that an attempt as the failed one need not be repeated; empty without advice.
pub(crate) fn cutback_advice(cutback: &Cutback, model: &Model) -> Vec<String> {
    let text = advice(&cutback.failure, model);
    (text.into_iter())
        .flat_map(|text| wrap_words("advice", &text))
        .collect()
}
