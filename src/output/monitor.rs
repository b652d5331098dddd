//! Checks of a run, increment by increment: conservation and energy that contact puts in (docs/theory/impacts.md,
//! Ledger, and docs/theory/contact.md, Energy-momentum contact), strains, contacts and counts; the closing lines that
//! report them.

use std::mem::{Discriminant, discriminant};

use super::balance::Balance;
use super::checks::{self, Checks};
use super::format::{bytes, counted, general, label, scientific, wrap};
use super::model_group::{body_times, contact_names};
use super::run_record::phases;
use super::strain::StrainWatch;
use super::warnings::{Findings, Touches, never_closed};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::{
    Cause, Course, Cutback, IncrementReport, Outcome, RunSummary, SolverCounts, Touch,
};
use crate::elements::Strained;
use crate::linear::larger;
use crate::model::{Bodies, Model};
use crate::system::peak_memory;

/// Follows a run and checks it.
pub(crate) struct Monitor {
    /// Energy balance, energy put in by contact, and momentum.
    pub balance: Balance,
    strain: StrainWatch,
    /// For each contact, whether it has closed or been struck.
    closed: Vec<bool>,
    touches: Vec<Touch>,
    /// Length of the longest increment at whose end something moves; static steps do not count.
    dt: f64,
    /// Time at the end of the last increment.
    time: f64,
    /// Number of failed attempts since the last increment.
    failed_attempts: usize,
    cutbacks: usize,
    /// Causes of the cutbacks so far, each with the course of the passes.
    kinds: Vec<(Discriminant<Cause>, Option<Discriminant<Course>>)>,
    landings: usize,
    /// Largest values of the checks.
    checks: Checks,
    /// Largest force that holds a motion resisted by facets only, relative to the normal forces at its body.
    held: f64,
}

/// Remarks on an increment, in addition to its line in the table.
pub(crate) struct Remarks {
    /// Energy that contact put in.
    pub contact_energy: Option<f64>,
    /// Values of the checks in the increment.
    pub checks: Checks,
    /// The most strained element, when it exceeds the range of its material for the first time.
    pub strained: Option<Strained>,
    /// Whether a motion that only facets resist is held for the first time.
    pub holds: bool,
}

impl Monitor {
    /// Follows a run of `model`.
    pub fn new(model: &Model) -> Self {
        Monitor {
            balance: Balance::new(model),
            strain: StrainWatch::new(model),
            closed: vec![false; model.contacts.len()],
            touches: Vec::new(),
            dt: 0.0,
            time: 0.0,
            failed_attempts: 0,
            cutbacks: 0,
            kinds: Vec::new(),
            landings: 0,
            checks: Checks::default(),
            held: 0.0,
        }
    }

    /// Transfers the state of the checks, without the kinds of cutbacks that the log has explained.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Monitor {
            [strain] balance, closed, touches, dt, time, failed_attempts, cutbacks, landings, checks, held; kinds
        })
    }

    /// Enters an accepted increment.
    pub fn add(&mut self, report: &IncrementReport) -> Remarks {
        let contact_energy = self.balance.add(report);
        self.touches.extend(&report.touches);
        if report.energy.kinetic != 0.0 {
            self.dt = larger(self.dt, report.dt);
        }
        self.time = report.time;
        self.landings += report.landings.len();
        for (closed, contact) in self.closed.iter_mut().zip(&report.contacts) {
            *closed |= contact.closed > 0 || contact.impulse.impact_normal > 0.0;
        }
        let checks = Checks::new(report, &self.balance);
        self.checks.enter(checks);
        let holds = self.held == 0.0 && report.solver.held > 0.0;
        self.held = larger(self.held, report.solver.held);
        Remarks {
            contact_energy,
            checks,
            strained: self.strain.add(report),
            holds,
        }
    }

    /// Counts an attempt at an increment that is repeated.
    pub fn add_attempt(&mut self) {
        self.failed_attempts += 1;
    }

    /// Counts a cutback; returns their number so far.
    pub fn add_cutback(&mut self) -> usize {
        self.add_attempt();
        self.cutbacks += 1;
        self.cutbacks
    }

    /// Whether a cutback is the first one with its cause and course.
    pub fn is_new_kind(&mut self, cutback: &Cutback) -> bool {
        let failure = &cutback.failure;
        let course = failure.course.as_deref().map(discriminant);
        let kind = (discriminant(&failure.cause), course);
        let is_new = !self.kinds.contains(&kind);
        if is_new {
            self.kinds.push(kind);
        }
        is_new
    }

    /// Number of attempts at the increment just accepted, including failed ones.
    pub fn take_attempts(&mut self) -> usize {
        std::mem::take(&mut self.failed_attempts) + 1
    }

    /// The closing lines: checks, losses of energy, largest strain, and contact.
    pub fn lines(&self, model: &Model) -> Vec<String> {
        let mut lines = checks::line(&self.checks.of(model));
        lines.extend(self.balance.losses().lines());
        lines.push(self.strain.line(model));
        if !model.contacts.is_empty() {
            lines.push(label("contact", &counted(self.landings, "landing")));
        }
        let added = self.balance.contact_energy();
        if added.count > 0 {
            let part = scientific(self.balance.relative(added.energy), 1);
            lines.push(format!(
                "         contact put energy in in {}: {part} of the largest in all",
                counted(added.count, "increment")
            ));
        }
        lines
    }

    /// The warnings at the end of the run; large strains are reported at their increment.
    pub fn warnings(&self, model: &Model) -> Vec<String> {
        let closed = self.closed.iter().copied();
        let contacts: Vec<(String, bool)> = contact_names(model).into_iter().zip(closed).collect();
        let findings = Findings {
            balance: self.balance.worst(),
            losses: self.balance.losses(),
            strain: None,
            hourglass: self.balance.hourglass(),
            open: match self.time > 0.0 {
                true => never_closed(&contacts),
                false => Vec::new(),
            },
            touches: Touches::new(&self.touches, self.balance.largest),
            held: self.held,
            dt: self.dt,
            time: self.time,
            bodies: body_times(model, &Bodies::new(&model.mesh)),
        };
        findings.lines()
    }
}

/// Time of the run and the parts of its phases; `output` and `total` are wall-clock times in
/// seconds.
pub(crate) fn timing_lines(summary: &RunSummary, output: f64, total: f64) -> Vec<String> {
    let part = |name: &str, seconds: f64| {
        let percent = 100.0 * seconds / total.max(f64::MIN_POSITIVE);
        format!("{name} {percent:.0} %")
    };
    let mut pieces = vec![format!(
        "in {} s: {}, {}",
        general(total, 3),
        counted(summary.increments, "increment"),
        counted(summary.cutbacks, "cutback")
    )];
    if summary.rejections > 0 {
        pieces.push(format!("{} repeated for their error", summary.rejections));
    }
    if summary.events > 0 {
        pieces.push(format!("{} cut at impacts", summary.events));
    }
    let phases = phases(&summary.timings);
    pieces.extend(phases.iter().map(|&(name, seconds)| part(name, seconds)));
    pieces.push(part("output", output));
    pieces.extend(peak_memory().map(|peak| format!("memory {}", bytes(peak))));
    let done = match summary.outcome {
        Outcome::Finished => "done",
        Outcome::Stopped(_) | Outcome::Interrupted => "stopped",
    };
    wrap(done, &pieces)
}

/// Work of the complementarity problems by method; empty if there were none.
pub(crate) fn lcp_lines(solver: &SolverCounts) -> Vec<String> {
    if solver.lcps == 0 {
        return Vec::new();
    }
    let problems = counted(solver.lcps, "problem");
    let pieces = [
        format!("{problems}, at most {}", counted(solver.lcp_size, "pair")),
        counted(solver.active_set_iterations, "active-set iteration"),
        counted(solver.gauss_seidel_sweeps, "sweep"),
        counted(solver.lemke_calls, "Lemke solve"),
    ];
    wrap("LCP", &pieces)
}
