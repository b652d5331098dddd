//! Running checks of a run, increment by increment: conservation (docs/theory.md, section 9), energy put in
//! by contact (section 7), strains, contacts and counts; the closing lines that report them.

use std::mem::{Discriminant, discriminant};

use super::format::{bytes, counted, general, scientific, wrap};
use super::memory::peak_memory;
use super::model_group::{body_times, contact_names};
use super::run_record::phases;
use super::strain::StrainWatch;
use super::warnings::{Findings, Losses, Touches, never_closed, part};
use crate::archive::{Archive, ArchiveError};
use crate::dynamics::{
    Cause, ContactViolation, Course, Cutback, Energy, IncrementReport, Momentum, Outcome,
    RunSummary, SolverCounts, Touch,
};
use crate::elements::Strained;
use crate::linear::larger;
use crate::model::{Bodies, Connector, Equation, Model};

/// Follows a run.
pub(crate) struct Monitor {
    /// Energy balance, energy from contact, momentum.
    pub balance: Balance,
    strain: StrainWatch,
    /// Whether each contact has closed, or been struck.
    closed: Vec<bool>,
    touches: Vec<Touch>,
    /// Length of the longest increment at whose end something moves, not that of a static step, and the last time.
    dt: f64,
    time: f64,
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
            strain: StrainWatch::new(model),
            closed: vec![false; model.contacts.len()],
            touches: Vec::new(),
            dt: 0.0,
            time: 0.0,
            failed_attempts: 0,
            cutbacks: 0,
            kinds: Vec::new(),
            landings: 0,
            cone_violations: [0.0; 2],
        }
    }

    /// Carries what is known of the run, but for the kinds of cutbacks that the log has explained.
    pub fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let Monitor {
            balance,
            strain,
            closed,
            touches,
            dt,
            time,
            failed_attempts,
            cutbacks,
            kinds: _,
            landings,
            cone_violations,
        } = self;
        archive.carry(balance)?;
        strain.carry(archive)?;
        archive.carry(closed)?;
        archive.carry(touches)?;
        archive.carry(dt)?;
        archive.carry(time)?;
        archive.carry(failed_attempts)?;
        archive.carry(cutbacks)?;
        archive.carry(landings)?;
        archive.carry(cone_violations)
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
            let [force, impulse] = &mut self.cone_violations;
            *force = larger(*force, contact.cone_violation);
            *impulse = larger(*impulse, contact.impulse_cone_violation);
        }
        Remarks {
            contact_energy,
            strained: self.strain.add(report),
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

    /// The warnings at the end of the run; large strains are reported at their increment.
    pub fn warnings(&self, model: &Model) -> Vec<String> {
        let closed = self.closed.iter().copied();
        let contacts: Vec<(String, bool)> = contact_names(model).into_iter().zip(closed).collect();
        let findings = Findings {
            balance: self.balance.worst(),
            losses: self.balance.losses(),
            strain: None,
            open: match self.time > 0.0 {
                true => never_closed(&contacts),
                false => Vec::new(),
            },
            touches: Touches::new(&self.touches, self.balance.largest),
            dt: self.dt,
            time: self.time,
            bodies: body_times(model, &Bodies::new(&model.mesh)),
        };
        findings.lines()
    }
}

/// Follows the energy balance, the energy that contact puts in and, of a free model, the momentum.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Balance {
    /// Largest energy or external work so far.
    largest: f64,
    /// Largest absolute balance so far.
    worst: f64,
    /// The last energies.
    last: Energy,
    /// Normal work of nodes that took the place of others so far.
    handover_work: f64,
    contact_energy: ContactEnergy,
    /// Momentum at the start of a model without external forces.
    start: Option<Momentum>,
    /// Mass of all bodies.
    mass: f64,
    /// Largest sqrt(2 M T) so far, which the linear momenta of all bodies do not exceed.
    momentum: f64,
    /// Largest change of the linear momentum so far, what mass-proportional damping took put back.
    drift: f64,
    free: bool,
}

/// Increments in which the normal contact forces did positive work: with energy-momentum contact
/// those that a pair enters with a negative gap.
#[derive(Debug, Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct ContactEnergy {
    /// Number of these increments.
    pub count: usize,
    /// The energy that contact put in.
    pub energy: f64,
}

impl Balance {
    /// The balance of a model's run.
    pub fn new(model: &Model) -> Self {
        let free = model.equations.iter().all(keeps_momentum)
            && model.connectors.iter().all(Connector::has_no_resultant)
            && model.steps.iter().all(|step| {
                step.supports.is_empty()
                    && step.point_loads.is_empty()
                    && step.body_forces.is_empty()
                    && step.pressures.is_empty()
                    && step.tractions.is_empty()
            });
        let elements = model.mesh.elements.iter();
        let bodies = model.turning_bodies().flat_map(|(_, body)| &body.masses);
        let of_points: f64 = bodies.map(|(_, mass)| mass).sum();
        Balance {
            free,
            mass: of_points + elements.map(|e| model.element_mass(e)).sum::<f64>(),
            ..Balance::default()
        }
    }

    /// Enters an increment; returns the energy that contact put in, if it did.
    pub fn add(&mut self, report: &IncrementReport) -> Option<f64> {
        let Energy {
            kinetic,
            strain,
            external_work,
            balance,
            ..
        } = report.energy;
        for energy in [kinetic, strain, external_work] {
            self.largest = larger(self.largest, energy.abs());
        }
        self.worst = larger(self.worst, balance.abs());
        if self.free {
            let most = (2.0 * self.mass * kinetic).sqrt();
            self.momentum = larger(self.momentum, most);
            self.add_momentum(report.momentum);
        }
        self.last = report.energy;
        self.handover_work = report.contacts.iter().map(|c| c.handover_work).sum();
        if let Some(added) = report.contact_energy {
            self.contact_energy.count += 1;
            self.contact_energy.energy += added;
        }
        report.contact_energy
    }

    /// The increments in which contact put energy in.
    pub fn contact_energy(&self) -> ContactEnergy {
        self.contact_energy
    }

    fn add_momentum(&mut self, momentum: Momentum) {
        let [dx, dy] = momentum.damped_linear;
        let [x, y] = [momentum.linear[0] + dx, momentum.linear[1] + dy];
        let [x0, y0] = self.start.get_or_insert(momentum).linear;
        self.drift = larger(self.drift, (x - x0).hypot(y - y0));
    }

    /// `balance` as a part of the largest energy so far.
    pub fn relative(&self, balance: f64) -> f64 {
        part(balance, self.largest)
    }

    /// The worst balance so far as a part of the largest energy.
    pub fn worst(&self) -> f64 {
        part(self.worst, self.largest)
    }

    /// Where the energy has gone so far.
    pub fn losses(&self) -> Losses {
        Losses::new(&self.last, self.handover_work, self.largest)
    }

    /// The change of a free model's linear momentum as a part of the largest momenta of its bodies.
    pub fn momentum_drift(&self) -> Option<f64> {
        self.free.then(|| part(self.drift, self.momentum))
    }
}

/// Whether the forces of an equation have no resultant: the sum of its coefficients is zero for
/// each direction.
fn keeps_momentum(equation: &Equation) -> bool {
    let own = [(equation.dof, -1.0)];
    let terms = own.iter().chain(&equation.terms);
    let mut sums = [[0.0; 2]; 2];
    for &(dof, c) in terms {
        let [sum, size] = &mut sums[dof % 2];
        (*sum, *size) = (*sum + c, *size + f64::abs(c));
    }
    sums.iter()
        .all(|[sum, size]| sum.abs() <= Equation::ROUND_OFF * size)
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

/// Penetration, in lengths of an edge, that is shown: less is round-off of positions.
const SHOWN_PENETRATION: f64 = 1e-9;

/// The largest errors of the increments: relative force residual and, with contacts, how far their pairs
/// are from the contact law.
pub(crate) fn error_line(residual: f64, violation: Option<ContactViolation>) -> String {
    let mut line = format!("error    residual {}", scientific(residual, 1));
    if let Some(violation) = violation {
        let ContactViolation {
            overlap,
            gap,
            slip,
            penetration,
        } = violation;
        let deepest = scientific(penetration, 1);
        let [overlap, gap, slip] = [overlap, gap, slip].map(|part| scientific(part, 0));
        line.push_str(&format!(
            "; overlap {overlap}, gap {gap}, slip {slip} of a segment"
        ));
        if penetration > SHOWN_PENETRATION {
            line.push_str(&format!("; edges cross by {deepest} of an edge"));
        }
    }
    line
}

/// Work of the complementarity problems by method; empty without any.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_balance_that_is_no_number_is_the_worst() {
        let report = |balance| IncrementReport {
            energy: Energy {
                kinetic: 1.0,
                balance,
                ..Energy::default()
            },
            ..IncrementReport::default()
        };
        let mut balance = Balance::default();
        for value in [1e-3, f64::NAN, 1e-9] {
            balance.add(&report(value));
        }
        assert!(balance.worst().is_nan());
    }

    #[test]
    fn errors_of_contact_are_shown_where_there_is_any() {
        assert_eq!(error_line(8.1e-12, None), "error    residual 8.1e-12");
        let violation = ContactViolation {
            overlap: 0.0,
            gap: 3e-13,
            slip: f64::NAN,
            penetration: 1e-10,
        };
        let line = error_line(8.1e-12, Some(violation));
        let expected = "error    residual 8.1e-12; overlap 0e+00, gap 3e-13, slip nan of a segment";
        assert_eq!(line, expected);
        let penetration = 3.71e-5;
        let crossed = ContactViolation {
            penetration,
            ..violation
        };
        let line = error_line(8.1e-12, Some(crossed));
        assert_eq!(
            line,
            format!("{expected}; edges cross by 3.7e-05 of an edge")
        );
    }
}
