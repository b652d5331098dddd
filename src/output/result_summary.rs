//! A finished or running job as read back from its result file: the content of `info`.

use std::path::{Path, PathBuf};

use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, FileBuilder, Group, H5Type};
use thiserror::Error;

use super::checks::{self, CHECKS, Check};
use super::column::ROWS;
use super::error::FileError;
use super::format::{bytes, counted, general, label, scientific, wrap};
use super::model_group::BodyTimes;
use super::run_record::UNFINISHED;
use super::warnings::{BALANCE, Findings, Losses, Touches, hourglass_part, never_closed, part};
use crate::deck::open_regular;
use crate::dynamics::{Energy, Touch};
use crate::linear::{larger, largest};
use crate::model::ContactFormulation;

/// Reason why a result file could not be read.
#[derive(Debug, Error)]
pub enum SummaryError {
    /// The file does not exist or may not be read.
    #[error(transparent)]
    Open(#[from] FileError),
    /// The file is not a complete result file of this program.
    #[error("{} is not a result file of stickslip: {source}", path.display())]
    Content {
        /// The file that was read.
        path: PathBuf,
        /// The reason that the library gives.
        source: hdf5::Error,
    },
}

/// Numbers and texts of a result file.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultSummary {
    /// The file that was read.
    pub path: PathBuf,
    /// Size of the file (bytes).
    pub size: u64,
    /// Version and commit of the program that wrote it.
    pub version: String,
    /// The command that started the run.
    pub command: String,
    /// Time at which the run started.
    pub started: String,
    /// Time at which the run ended; empty if it has not ended.
    pub finished: String,
    /// Exit status; -1 if the run has not ended.
    pub exit_status: i64,
    /// Largest number of bytes of memory in use; `None` if the run has not ended or the system does not report it.
    pub peak_memory: Option<i64>,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// Names of the contacts, with the largest normal force of each contact.
    pub contacts: Vec<(String, f64)>,
    /// Number of landings.
    pub landings: usize,
    /// Number of steps begun.
    pub steps: i64,
    /// Number of increments.
    pub increments: usize,
    /// Last time of the history.
    pub time: f64,
    /// Times of the frames.
    pub frames: Vec<f64>,
    /// Last value of each energy.
    pub energy: Energy,
    /// Accounts of energy that are missing in an older file.
    unrecorded: Vec<&'static str>,
    /// Largest energy or external work of the history.
    pub largest_energy: f64,
    /// The checks with their largest values.
    checks: Vec<(&'static Check, f64)>,
    /// Losses of energy.
    losses: Losses,
    /// Warnings about the run, in lines of the screen.
    pub warnings: Vec<String>,
}

impl ResultSummary {
    /// Reads a result file.
    pub fn read(path: &Path) -> Result<Self, SummaryError> {
        let data = open_regular(path).and_then(|file| file.metadata());
        let data = data.map_err(FileError::new("read", path))?;
        let content = |source| SummaryError::Content {
            path: path.to_owned(),
            source,
        };
        Self::read_file(path, data.len()).map_err(content)
    }

    fn read_file(path: &Path, size: u64) -> hdf5::Result<Self> {
        // Without a lock, so that a result can be read while its run writes.
        let file = FileBuilder::new()
            .with_fapl(|properties| properties.file_locking(false))
            .open(path)?;
        let (run, history) = (file.group("run")?, file.group("history")?);
        let times: Vec<f64> = column(&history, "time")?;
        let steps: Vec<i64> = column(&history, "step")?;
        let (energy, unrecorded, largest_energy) = read_energy(&history.group("energy")?)?;
        let balance: Vec<f64> = column(&history, "energy/balance")?;
        let contacts = history.group("contact")?;
        let losses = Losses::new(&energy, read_handovers(&contacts)?, largest_energy);
        let whole = larger(largest_energy, energy.round_off / BALANCE);
        let worst = part(largest(&balance), whole);
        let findings = read_findings(&file, losses, [worst, largest_energy, whole])?;
        Ok(ResultSummary {
            path: path.to_owned(),
            size,
            version: format!("{} ({})", text(&run, "version")?, text(&run, "commit")?),
            command: text(&run, "command")?,
            started: text(&run, "started")?,
            finished: text(&run, "finished")?,
            exit_status: run.attr("exit_status")?.read_scalar()?,
            peak_memory: (run.attr("peak_memory").ok())
                .and_then(|attribute| attribute.read_scalar().ok()),
            nodes: file.dataset("model/node_labels")?.size(),
            elements: file.dataset("model/element_labels")?.size(),
            contacts: read_contacts(&contacts)?,
            landings: column::<f64>(&history, "impacts/time")?.len(),
            steps: steps.iter().copied().max().unwrap_or(0),
            increments: times.len().saturating_sub(1),
            time: times.last().copied().unwrap_or(0.0),
            frames: read_frames(&file)?,
            energy,
            unrecorded,
            largest_energy,
            checks: read_checks(&history)?,
            losses,
            warnings: findings.lines(),
        })
    }

    /// Largest value over all increments of a check, which is a dataset of `/history/certificate`.
    pub fn check(&self, name: &str) -> Option<f64> {
        let mut checks = self.checks.iter();
        checks
            .find(|(check, _)| check.name == name)
            .map(|(_, value)| *value)
    }

    /// The summary as text.
    pub fn lines(&self) -> Vec<String> {
        let name = self.path.display();
        let mut lines = vec![
            label("file", &format!("{name} ({})", bytes(self.size))),
            label("program", &format!("stickslip {}", self.version)),
            label("command", &self.command),
        ];
        lines.push(label("run", &self.end()));
        if let Some(peak) = self.peak_memory {
            lines.push(label("memory", &bytes(peak.unsigned_abs())));
        }
        let model = [
            counted(self.nodes, "node"),
            counted(self.elements, "element"),
        ];
        lines.extend(wrap("model", &model));
        lines.extend(self.progress());
        lines.extend(self.contact_lines());
        lines.extend(self.energy_lines());
        lines.extend(checks::line(&self.checks));
        lines.extend(self.warnings.iter().cloned());
        lines
    }

    fn end(&self) -> String {
        let finished = &self.finished;
        let how = match self.exit_status {
            UNFINISHED => "still running or killed".to_owned(),
            0 => format!("finished {finished}, exit status 0"),
            1 => format!("stopped in the solve {finished}, exit status 1"),
            129 | 130 | 143 => {
                let status = self.exit_status;
                format!("stopped by a signal {finished}, exit status {status}")
            }
            status => format!("ended {finished}, exit status {status}"),
        };
        format!("started {}, {how}", self.started)
    }

    fn progress(&self) -> Vec<String> {
        let ends = match (self.frames.first(), self.frames.last()) {
            (Some(first), Some(last)) => {
                format!(" from {} to {}", general(*first, 4), general(*last, 4))
            }
            _ => String::new(),
        };
        let pieces = [
            counted(self.steps.unsigned_abs() as usize, "step"),
            counted(self.increments, "increment"),
            format!("time {}", general(self.time, 6)),
            format!("{}{ends}", counted(self.frames.len(), "frame")),
        ];
        wrap("results", &pieces)
    }

    fn contact_lines(&self) -> Vec<String> {
        let mut lines: Vec<String> = (self.contacts.iter())
            .map(|(name, normal)| format!("{name}, largest normal force {}", general(*normal, 4)))
            .map(|text| label("contact", &text))
            .collect();
        if !lines.is_empty() {
            lines.push(label("", &counted(self.landings, "landing")));
        }
        lines
    }

    fn energy_lines(&self) -> Vec<String> {
        let mut energy = self.energy;
        let told = ACCOUNTS.iter().filter_map(|(name, account)| {
            let value = *account(&mut energy);
            let is_told = value != 0.0 || !RARE_ACCOUNTS.contains(name);
            let value = match self.unrecorded.contains(name) {
                true => "not recorded".to_owned(),
                false => scientific(value, 4),
            };
            is_told.then(|| format!("{} {value}", name.replace('_', " ")))
        });
        let pieces: Vec<String> = told.collect();
        let mut lines = wrap("energy", &pieces);
        lines.extend(self.losses.lines());
        lines
    }
}

/// An account of the energy ledger: its dataset, and its place in the ledger.
type Account = (&'static str, fn(&mut Energy) -> &mut f64);

/// Accounts of the energy ledger, in the order of the summary; the balance is given relative to the largest of the
/// first three.
const ACCOUNTS: [Account; 12] = [
    ("kinetic", |e| &mut e.kinetic),
    ("strain", |e| &mut e.strain),
    ("external_work", |e| &mut e.external_work),
    ("thermal_work", |e| &mut e.thermal_work),
    ("normal_contact_work", |e| &mut e.normal_contact_work),
    ("friction_dissipation", |e| &mut e.friction_dissipation),
    ("impact_loss", |e| &mut e.impact_loss),
    ("landing_return", |e| &mut e.landing_return),
    ("release_loss", |e| &mut e.release_loss),
    ("damping", |e| &mut e.damping),
    ("material_dissipation", |e| &mut e.material_dissipation),
    ("numerical_dissipation", |e| &mut e.numerical_dissipation),
];

/// Scales of the accounts, which older files lack: the largest energy, and the energy that may be round-off.
const SCALES: [Account; 2] = [
    ("scale", |e| &mut e.scale),
    ("round_off", |e| &mut e.round_off),
];

/// Accounts that are zero in most runs: they are shown only if they are not zero.
const RARE_ACCOUNTS: [&str; 4] = ["thermal_work", "landing_return", "release_loss", "damping"];

/// Last value of each energy, accounts that an older file lacks (their values are zero), and the largest energy, which
/// is the scale of the balance.
fn read_energy(at: &Group) -> hdf5::Result<(Energy, Vec<&'static str>, f64)> {
    let (mut energy, mut unrecorded, mut scale) = (Energy::default(), Vec::new(), 0.0);
    for (name, account) in SCALES {
        if at.link_exists(name) {
            let values: Vec<f64> = column(at, name)?;
            *account(&mut energy) = values.last().copied().unwrap_or(0.0);
        }
    }
    for (k, (name, account)) in ACCOUNTS.iter().enumerate() {
        let is_recorded = k < 3 || at.link_exists(name);
        unrecorded.extend((!is_recorded).then_some(*name));
        let values: Vec<f64> = match is_recorded {
            true => column(at, name)?,
            false => Vec::new(),
        };
        if k < 3 {
            scale = larger(scale, largest(&values));
        }
        *account(&mut energy) = values.last().copied().unwrap_or(0.0);
    }
    let scale = larger(scale, energy.scale);
    Ok((energy, unrecorded, scale))
}

/// Numbers from which the warnings are made; datasets that older files lack are left out.
fn read_findings(
    file: &Group,
    losses: Losses,
    [balance, largest_energy, whole]: [f64; 3],
) -> hdf5::Result<Findings> {
    let history = file.group("history")?;
    let times: Vec<f64> = column(&history, "time")?;
    let increments: Vec<f64> = column(&history, "dt")?;
    let [edge, body] = ["edge_time", "wave_time"]
        .map(|name| column::<f64>(file, &format!("model/bodies/{name}")).unwrap_or_default());
    // a file from before there was the second dataset has elastic materials only
    let strain: Option<Vec<f64>> = ["largest_principal_elastic", "largest_principal"]
        .iter()
        .find_map(|name| column(&history, &format!("strain/{name}")).ok());
    let kinetic: Vec<f64> = column(&history, "energy/kinetic").unwrap_or_default();
    let energy = |name: &str| -> Vec<f64> {
        column(&history, &format!("energy/{name}")).unwrap_or_default()
    };
    let hourglass = energy("hourglass");
    let stored = energy("strain")
        .into_iter()
        .zip(energy("material_dissipation"));
    let internal: Vec<f64> = stored
        .map(|(strain, dissipated)| strain + dissipated)
        .collect();
    let moving = increments.iter().zip(&kinetic).filter(|(_, t)| **t != 0.0);
    let dt = moving.map(|(dt, _)| *dt).fold(0.0, larger);
    Ok(Findings {
        balance,
        losses,
        strain: strain.map(|strain| largest(&strain)),
        hourglass: hourglass_part([largest(&hourglass), largest(&internal)], whole),
        open: match times.last().is_some_and(|time| *time > 0.0) {
            true => read_open(&history.group("contact")?)?,
            false => Vec::new(),
        },
        held: largest(&column::<f64>(&history, "solver/held").unwrap_or_default()),
        touches: Touches::new(&read_touches(&history).unwrap_or_default(), largest_energy),
        dt,
        time: times.last().copied().unwrap_or(0.0),
        bodies: (edge.into_iter().zip(body))
            .map(|(edge, body)| BodyTimes { edge, body })
            .collect(),
    })
}

/// The touches of the bodies, with the data that the warnings need.
fn read_touches(history: &Group) -> hdf5::Result<Vec<Touch>> {
    let at = history.group("touches")?;
    let [start, end, energy] = ["start", "end", "energy"].map(|name| column::<f64>(&at, name));
    let [first, last, nodes, corner, bodies] =
        ["first", "last", "nodes", "corner", "bodies"].map(|name| column::<i64>(&at, name));
    let (start, end, energy) = (start?, end?, energy?);
    let (first, last, nodes, corner, bodies) = (first?, last?, nodes?, corner?, bodies?);
    let count = |numbers: &[i64], k: usize| Some(numbers.get(k)?.unsigned_abs() as usize);
    let body = |k: usize| Some(usize::try_from(*bodies.get(k)?).ok());
    let touch = |k: usize| {
        Some(Touch {
            bodies: [body(2 * k)?, body(2 * k + 1)?],
            start: *start.get(k)?,
            end: *end.get(k)?,
            first: count(&first, k)?,
            last: count(&last, k)?,
            nodes: count(&nodes, k)?,
            is_at_corner: *corner.get(k)? != 0,
            energy: *energy.get(k)?,
            ..Touch::default()
        })
    };
    Ok((0..).map_while(touch).collect())
}

/// Work of normal contact forces of all contacts at nodes that replaced other closed nodes; 0 for an older file without
/// this account.
fn read_handovers(at: &Group) -> hdf5::Result<f64> {
    let last = |name: String| {
        let work = column::<f64>(at, &format!("{name}/handover_work")).unwrap_or_default();
        work.last().copied().unwrap_or(0.0)
    };
    Ok(at.member_names()?.into_iter().map(last).sum())
}

/// The checks that the file has, with their largest values.
fn read_checks(history: &Group) -> hdf5::Result<Vec<(&'static Check, f64)>> {
    let at = history.group("certificate")?;
    let made = CHECKS.iter().filter(|check| at.link_exists(check.name));
    made.map(|check| Ok((check, largest(&column(&at, check.name)?))))
        .collect()
}

/// Names of the contacts without normal force and without impact in the whole run.
fn read_open(at: &Group) -> hdf5::Result<Vec<String>> {
    let has_closed = |name: &str| -> hdf5::Result<bool> {
        let closed: Vec<i64> = column(at, &format!("{name}/closed"))?;
        let struck = column::<f64>(at, &format!("{name}/impact_normal_impulse"));
        let is_struck = struck.is_ok_and(|struck| struck.iter().any(|&phi| phi > 0.0));
        Ok(is_struck || closed.iter().any(|&pairs| pairs > 0))
    };
    let contact = |name: String| has_closed(&name).map(|closed| (name, closed));
    let contacts: hdf5::Result<Vec<(String, bool)>> =
        at.member_names()?.into_iter().map(contact).collect();
    Ok(never_closed(&contacts?))
}

fn read_contacts(at: &Group) -> hdf5::Result<Vec<(String, f64)>> {
    let read = |name: String| {
        let normal: Vec<f64> = column(at, &format!("{name}/normal"))?;
        // a file from before there was this attribute is node to surface
        let formulation = text(&at.group(&name)?, "formulation").unwrap_or_default();
        let shown = match formulation == ContactFormulation::SurfaceToSurface.name() {
            true => format!("{name}, surface to surface"),
            false => name,
        };
        Ok((shown, largest(&normal)))
    };
    at.member_names()?.into_iter().map(read).collect()
}

/// Times of the frames that are complete.
fn read_frames(file: &Group) -> hdf5::Result<Vec<f64>> {
    let steps = file.group("VTKHDF/Steps")?;
    let count: i64 = steps.attr("NSteps")?.read_scalar()?;
    let mut times = steps.dataset("Values")?.read_raw()?;
    times.truncate(count.unsigned_abs() as usize);
    Ok(times)
}

/// Values of a dataset; of a history only the complete rows.
fn column<T: H5Type>(at: &Group, name: &str) -> hdf5::Result<Vec<T>> {
    let dataset = at.dataset(name)?;
    let mut values = dataset.read_raw()?;
    if let Some(complete) = complete_rows(&dataset)? {
        let row = values.len() / dataset.shape()[0].max(1);
        values.truncate(complete * row);
    }
    Ok(values)
}

/// Number of complete rows of a dataset, from the innermost of its groups that states it; `None` for a dataset that is
/// written at once, and in older files without this number.
fn complete_rows(dataset: &Dataset) -> hdf5::Result<Option<usize>> {
    let (file, path) = (dataset.file()?, dataset.name());
    let groups = path.rmatch_indices('/').filter(|(end, _)| *end > 0);
    for (end, _) in groups {
        if let Ok(count) = file.group(&path[..end])?.attr(ROWS) {
            let rows: i64 = count.read_scalar()?;
            return Ok(Some(rows.unsigned_abs() as usize));
        }
    }
    Ok(None)
}

fn text(at: &Group, name: &str) -> hdf5::Result<String> {
    let value: VarLenUnicode = at.attr(name)?.read_scalar()?;
    Ok(value.as_str().to_owned())
}
