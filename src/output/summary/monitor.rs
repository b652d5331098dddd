//! Running checks of a run, increment by increment: conservation, strains, contacts and counts, and
//! the closing lines that report them.

use std::mem::{Discriminant, discriminant};

use super::balance::Balance;
use super::warnings::Watch;
use crate::dynamics::{Cause, Course, Cutback, IncrementReport};
use crate::elements::Strained;
use crate::linear::larger;
use crate::model::Model;
use crate::output::text::{StrainWatch, counted, scientific, wrap};

/// Follows a run.
pub(crate) struct Monitor {
    /// Energy balance, energy from contact, momentum.
    pub balance: Balance,
    watch: Watch,
    strain: StrainWatch,
    /// Failed attempts since the last increment.
    failed_attempts: usize,
    cutbacks: usize,
    /// Causes of the cutbacks so far, each with the course of the passes.
    kinds: Vec<(Discriminant<Cause>, Option<Discriminant<Course>>)>,
    landings: usize,
    /// Largest violation of Coulomb's cone by forces and by total impulses.
    cone_violations: [f64; 2],
}

/// Remarks on an increment besides its line in the table.
pub(crate) struct Remarks {
    /// Energy that contact put in.
    pub contact_energy: Option<f64>,
    /// The most strained element, the first time it is beyond the range of its material.
    pub strained: Option<Strained>,
}

impl Monitor {
    /// Follows a run of `model`.
    pub fn new(model: &Model) -> Self {
        Monitor {
            balance: Balance::new(model),
            watch: Watch::default(),
            strain: StrainWatch::new(model),
            failed_attempts: 0,
            cutbacks: 0,
            kinds: Vec::new(),
            landings: 0,
            cone_violations: [0.0; 2],
        }
    }

    /// Enters an accepted increment.
    pub fn add(&mut self, report: &IncrementReport) -> Remarks {
        let contact_energy = self.balance.add(report);
        self.watch.add(report);
        self.landings += report.landings.len();
        for contact in &report.contacts {
            let [force, impulse] = &mut self.cone_violations;
            *force = larger(*force, contact.cone_violation);
            *impulse = larger(*impulse, contact.impulse_cone_violation);
        }
        Remarks {
            contact_energy,
            strained: self.strain.add(report),
        }
    }

    /// Counts a cutback; returns their number so far.
    pub fn add_cutback(&mut self) -> usize {
        self.failed_attempts += 1;
        self.cutbacks += 1;
        self.cutbacks
    }

    /// Whether a cutback is the first of its cause and course.
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

    /// Attempts at the increment just accepted, including the failed ones.
    pub fn take_attempts(&mut self) -> usize {
        std::mem::take(&mut self.failed_attempts) + 1
    }

    /// The closing lines: conservation, largest strain, contact.
    pub fn lines(&self, model: &Model) -> Vec<String> {
        let mut lines = vec![self.balance_line()];
        lines.extend(self.balance.losses().lines());
        lines.push(self.strain.line(model));
        if !model.contacts.is_empty() {
            let [force, impulse] = self.cone_violations.map(|part| scientific(part, 1));
            let landings = counted(self.landings, "landing");
            let cone =
                format!("outside Coulomb's cone at most: forces {force}, impulses {impulse}");
            lines.extend(wrap("contact", &[format!("{landings};"), cone]));
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

    fn balance_line(&self) -> String {
        let worst = scientific(self.balance.worst(), 1);
        let mut line = format!("energy balance {worst} of the largest energy");
        if let Some(drift) = self.balance.momentum_drift() {
            line.push_str(&format!("; momentum {}", scientific(drift, 1)));
        }
        line
    }

    /// The warnings at the end of the run.
    pub fn warnings(&self, model: &Model) -> Vec<String> {
        self.watch.findings(model, &self.balance).lines()
    }
}
