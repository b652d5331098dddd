//! A finished or running job as read back from its result file: the content of `info`.

use std::io;
use std::path::{Path, PathBuf};

use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, FileBuilder, Group, H5Type};
use thiserror::Error;

use super::losses::{Losses, part};
use super::totals::error_line;
use super::touches::Touches;
use super::warnings::{Findings, never_closed};
use crate::dynamics::{ContactViolation, Energy, Touch};
use crate::linear::{larger, largest};
use crate::output::error::reason;
use crate::output::file::{BodyTimes, ROWS, UNFINISHED, regular_file};
use crate::output::text::{bytes, counted, general, label, scientific, wrap};

/// Why a result file could not be read.
#[derive(Debug, Error)]
pub enum SummaryError {
    /// The file does not exist or may not be read.
    #[error("cannot read {}: {}", path.display(), reason(source))]
    Open {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file is not a complete result file of this program.
    #[error("{} is not a result file of stickslip: {source}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Why.
        source: hdf5::Error,
    },
}

/// Figures of a result file.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultSummary {
    /// The file.
    pub path: PathBuf,
    /// Its size in bytes.
    pub size: u64,
    /// Version and commit of the program that wrote it.
    pub version: String,
    /// The command that started it.
    pub command: String,
    /// When the run started.
    pub started: String,
    /// When it ended; empty when it did not.
    pub finished: String,
    /// Exit status, -1 when the run did not end.
    pub exit_status: i64,
    /// Most bytes of memory in use at a time; none of a run that did not end, or where the system does not
    /// tell.
    pub peak_memory: Option<i64>,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// Names of the contacts with the largest normal force of each.
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
    pub energies: Vec<(String, f64)>,
    /// Largest energy or external work of the history.
    pub largest_energy: f64,
    /// Largest absolute balance of the history.
    pub worst_balance: f64,
    /// Largest relative force residual of the history.
    pub residual: f64,
    /// Where the energy has gone.
    losses: Losses,
    /// How far the pairs were from the contact law at most; none without contact, and of a file from
    /// before there was this history.
    pub violation: Option<ContactViolation>,
    /// Warnings about the run, in lines of the screen.
    pub warnings: Vec<String>,
}

impl ResultSummary {
    /// Reads a result file.
    pub fn read(path: &Path) -> Result<Self, SummaryError> {
        let open = |source| SummaryError::Open {
            path: path.to_owned(),
            source,
        };
        let size = regular_file(path).map_err(open)?.len();
        let content = |source| SummaryError::Content {
            path: path.to_owned(),
            source,
        };
        Self::read_file(path, size).map_err(content)
    }

    fn read_file(path: &Path, size: u64) -> hdf5::Result<Self> {
        // Without a lock, so that a result can be read while its run writes.
        let file = FileBuilder::new()
            .with_fapl(|properties| properties.file_locking(false))
            .open(path)?;
        let (run, history) = (file.group("run")?, file.group("history")?);
        let times: Vec<f64> = column(&history, "time")?;
        let steps: Vec<i64> = column(&history, "step")?;
        let (energies, largest_energy) = read_energies(&history.group("energy")?)?;
        let balance: Vec<f64> = column(&history, "energy/balance")?;
        let worst = part(largest(&balance), largest_energy);
        let losses = losses(
            &energies,
            read_handovers(&history.group("contact")?)?,
            largest_energy,
        );
        let findings = read_findings(&file, losses, [worst, largest_energy])?;
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
            contacts: read_contacts(&history.group("contact")?)?,
            landings: column::<f64>(&history, "impacts/time")?.len(),
            steps: steps.iter().copied().max().unwrap_or(0),
            increments: times.len().saturating_sub(1),
            time: times.last().copied().unwrap_or(0.0),
            frames: read_frames(&file)?,
            energies,
            largest_energy,
            worst_balance: largest(&balance),
            residual: largest(&column::<f64>(&history, "solver/residual")?),
            losses,
            violation: read_violation(&history)?,
            warnings: findings.lines(),
        })
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
        lines.push(error_line(self.residual, self.violation));
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
        let pieces: Vec<String> = (self.energies.iter())
            .map(|(name, value)| format!("{} {}", name.replace('_', " "), scientific(*value, 4)))
            .collect();
        let mut lines = wrap("energy", &pieces);
        let part = scientific(part(self.worst_balance, self.largest_energy), 1);
        lines.push(label("", &format!("balance {part} of the largest energy")));
        lines.extend(self.losses.lines());
        lines
    }
}

/// Accounts of the energy ledger, in the order of the summary.
const ACCOUNTS: [&str; 11] = [
    "kinetic",
    "strain",
    "external_work",
    "normal_contact_work",
    "friction_dissipation",
    "impact_loss",
    "landing_return",
    "release_loss",
    "damping",
    "material_dissipation",
    "numerical_dissipation",
];

/// Accounts that most runs have no entry in: told where they are not zero.
const RARE_ACCOUNTS: [&str; 3] = ["landing_return", "release_loss", "damping"];

/// Last value of each energy, and the largest that counts as the balance's scale.
fn read_energies(at: &Group) -> hdf5::Result<(Vec<(String, f64)>, f64)> {
    let mut energies = vec![];
    let mut scale: f64 = 0.0;
    for name in ACCOUNTS {
        let is_newer = name == "material_dissipation" || RARE_ACCOUNTS.contains(&name);
        if is_newer && !at.link_exists(name) {
            continue; // a file from before there was this account
        }
        let values: Vec<f64> = column(at, name)?;
        if energies.len() < 3 {
            scale = larger(scale, largest(&values));
        }
        let last = values.last().copied().unwrap_or(0.0);
        if last != 0.0 || !RARE_ACCOUNTS.contains(&name) {
            energies.push((name.to_owned(), last));
        }
    }
    Ok((energies, scale))
}

/// Where the energy has gone, from the last value of each energy and the normal work of handovers.
fn losses(energies: &[(String, f64)], handover_work: f64, largest: f64) -> Losses {
    let last = |wanted: &str| {
        let found = energies.iter().find(|(name, _)| name == wanted);
        found.map_or(0.0, |(_, energy)| *energy)
    };
    let energy = Energy {
        normal_contact_work: last("normal_contact_work"),
        friction_dissipation: last("friction_dissipation"),
        impact_loss: last("impact_loss"),
        landing_return: last("landing_return"),
        release_loss: last("release_loss"),
        damping: last("damping"),
        material_dissipation: last("material_dissipation"),
        numerical_dissipation: last("numerical_dissipation"),
        ..Energy::default()
    };
    Losses::new(&energy, handover_work, largest)
}

/// Figures that the warnings are made from; datasets that older files lack are left out.
fn read_findings(
    file: &Group,
    losses: Losses,
    [balance, largest_energy]: [f64; 2],
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
    let dt = largest(&increments);
    Ok(Findings {
        balance,
        losses,
        strain: strain.map(|strain| largest(&strain)),
        open: match dt > 0.0 {
            true => read_open(&history.group("contact")?)?,
            false => Vec::new(),
        },
        touches: Touches::new(&read_touches(&history).unwrap_or_default(), largest_energy),
        dt,
        time: times.last().copied().unwrap_or(0.0),
        bodies: (edge.into_iter().zip(body))
            .map(|(edge, body)| BodyTimes { edge, body })
            .collect(),
    })
}

/// The touches of the bodies, as far as the warnings need them.
fn read_touches(history: &Group) -> hdf5::Result<Vec<Touch>> {
    let at = history.group("touches")?;
    let [start, end, energy] = ["start", "end", "energy"].map(|name| column::<f64>(&at, name));
    let [first, last, nodes, corner, bodies] =
        ["first", "last", "nodes", "corner", "bodies"].map(|name| column::<i64>(&at, name));
    let (start, end, energy) = (start?, end?, energy?);
    let (first, last, nodes, corner, bodies) = (first?, last?, nodes?, corner?, bodies?);
    let count = |number: i64| number.unsigned_abs() as usize;
    let body = |number: i64| usize::try_from(number).ok();
    let touch = |k: usize| Touch {
        bodies: [body(bodies[2 * k]), body(bodies[2 * k + 1])],
        start: start[k],
        end: end[k],
        first: count(first[k]),
        last: count(last[k]),
        nodes: count(nodes[k]),
        is_at_corner: corner[k] != 0,
        energy: energy[k],
        ..Touch::default()
    };
    let rows = [
        start.len(),
        end.len(),
        energy.len(),
        first.len(),
        last.len(),
        nodes.len(),
        corner.len(),
    ];
    let complete = rows.into_iter().fold(bodies.len() / 2, usize::min);
    Ok((0..complete).map(touch).collect())
}

/// Normal work of nodes that took the place of others, of all contacts; 0 of a file from before there was this
/// account.
fn read_handovers(at: &Group) -> hdf5::Result<f64> {
    let last = |name: String| {
        let work = column::<f64>(at, &format!("{name}/handover_work")).unwrap_or_default();
        work.last().copied().unwrap_or(0.0)
    };
    Ok(at.member_names()?.into_iter().map(last).sum())
}

/// How far the pairs were from the contact law at most, where the file has contacts and says it.
fn read_violation(history: &Group) -> hdf5::Result<Option<ContactViolation>> {
    let solver = history.group("solver")?;
    if history.group("contact")?.member_names()?.is_empty() || !solver.link_exists("overlap") {
        return Ok(None);
    }
    let most = |name| column::<f64>(&solver, name).map(|values| largest(&values));
    Ok(Some(ContactViolation {
        overlap: most("overlap")?,
        gap: most("gap_violation")?,
        slip: most("slip_violation")?,
        penetration: match solver.link_exists("penetration") {
            true => most("penetration")?,
            false => f64::NAN,
        },
    }))
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
        Ok((name, largest(&normal)))
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

/// A dataset; of the history its complete rows.
fn column<T: H5Type>(at: &Group, name: &str) -> hdf5::Result<Vec<T>> {
    let dataset = at.dataset(name)?;
    let mut values = dataset.read_raw()?;
    if let Some(complete) = complete_rows(&dataset)? {
        let row = values.len() / dataset.shape()[0].max(1);
        values.truncate(complete * row);
    }
    Ok(values)
}

/// How many rows of a dataset are complete, by the innermost of its groups that says it; none does of what is
/// written at once, and in a file from before there was this number.
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
