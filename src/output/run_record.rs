//! Group `/run`: program, deck and command of the run, its times and its end.

use std::hash::{BuildHasher, RandomState};
use std::time::SystemTime;

use hdf5::types::VarLenUnicode;
use hdf5::{File, Group};
use sha2::{Digest, Sha256};

use super::column::{group, hdf5_text, new_attribute, text_attribute};
use crate::dynamics::{RunSummary, Timings};
use crate::system::peak_memory;

/// Value of `exit_status` until the run ends.
pub const UNFINISHED: i64 = -1;

/// The attribute that distinguishes a run from all others.
const ID: &str = "id";

/// A new id, which no other run has.
pub fn new_run_id() -> String {
    let run = (SystemTime::now(), std::process::id());
    let any = || RandomState::new().hash_one(run);
    format!("{:016x}{:016x}", any(), any())
}

/// Program, deck and command of a run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RunRecord {
    /// Id that distinguishes the run from all others; a continued run keeps it.
    pub id: String,
    /// Version of the program.
    pub version: String,
    /// Commit from which the program was built.
    pub commit: String,
    /// Full text of the deck, with included files in their places.
    pub deck: String,
    /// The command as typed.
    pub command: String,
    /// Number of threads.
    pub threads: usize,
    /// Estimated memory need of the run (bytes).
    pub memory_need: u64,
}

/// Writes the run record.
pub(crate) struct RecordWriter {
    at: Group,
}

impl RecordWriter {
    /// Creates the group with everything known at the start.
    pub fn create(root: &Group, record: &RunRecord) -> hdf5::Result<Self> {
        let at = group(root, "run")?;
        let text = |name, value: &str| text_attribute(&at, name, value);
        text("program", "stickslip")?;
        text(ID, &record.id)?;
        text("version", &record.version)?;
        text("commit", &record.commit)?;
        text("deck", &record.deck)?;
        text("deck_sha256", &sha256(&record.deck))?;
        text("command", &record.command)?;
        text("started", &utc_now())?;
        text("finished", "")?;
        new_attribute(&at, "exit_status", UNFINISHED)?;
        new_attribute(&at, "threads", record.threads as i64)?;
        new_attribute(&at, "memory_need", record.memory_need as i64)?;
        Ok(RecordWriter { at })
    }

    /// Completes the record.
    pub fn finish(
        &self,
        summary: &RunSummary,
        exit_status: u8,
        output: f64,
        total: f64,
    ) -> hdf5::Result<()> {
        for (name, seconds) in phases(&summary.timings) {
            new_attribute(&self.at, &format!("seconds_{name}"), seconds)?;
        }
        new_attribute(&self.at, "seconds_output", output)?;
        new_attribute(&self.at, "seconds_total", total)?;
        new_attribute(&self.at, "increments", summary.increments as i64)?;
        new_attribute(&self.at, "cutbacks", summary.cutbacks as i64)?;
        new_attribute(&self.at, "rejections", summary.rejections as i64)?;
        new_attribute(&self.at, "events", summary.events as i64)?;
        if let Some(peak) = peak_memory() {
            new_attribute(&self.at, "peak_memory", peak as i64)?;
        }
        self.close(exit_status)
    }

    /// Marks the end of the run.
    pub fn close(&self, exit_status: u8) -> hdf5::Result<()> {
        let finished = hdf5_text(&utc_now())?;
        self.at.attr("finished")?.write_scalar(&finished)?;
        let exit_status = i64::from(exit_status);
        self.at.attr("exit_status")?.write_scalar(&exit_status)
    }
}

/// The id of the run that has written a result file; `None` if the file has no id.
pub(super) fn run_id(file: &File) -> Option<String> {
    let id = file.group("run").and_then(|at| at.attr(ID)).ok()?;
    let text = id.read_scalar::<VarLenUnicode>().ok()?;
    Some(text.to_string())
}

/// Phases of a run with their wall-clock seconds.
pub(crate) fn phases(timings: &Timings) -> [(&'static str, f64); 6] {
    [
        ("assembly", timings.assembly.as_secs_f64()),
        ("factorization", timings.factorization.as_secs_f64()),
        ("solve", timings.solve.as_secs_f64()),
        ("search", timings.search.as_secs_f64()),
        ("contact", timings.contact.as_secs_f64()),
        ("lcp", timings.lcp.as_secs_f64()),
    ]
}

fn sha256(text: &str) -> String {
    (Sha256::digest(text.as_bytes()).iter())
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// The time now as `2026-05-01T10:12:33Z`.
pub(crate) fn utc_now() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}
