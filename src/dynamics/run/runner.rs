//! Time stepping of a run: steps, and nominal increments divided by their time control; each
//! subincrement is attempted, checked, and accepted or cut back. Section 4 of docs/theory.md, Cutback.

use std::io;

use super::acceptance::{Accepted, Before, failure, start_failure};
use super::time_control::{
    Bisection, ImpactControl, NominalIncrement, Span, TimeControl, nominal_increments,
};
use crate::contact::ClosedPairs;
use crate::dynamics::events::{FailedSubincrement, Subincrement, Subincrements};
use crate::dynamics::ledger::{Accounts, Ledger, contact_violation, landings};
use crate::dynamics::results::{
    Cutback, Failure, IncrementReport, Observer, Outcome, RunSummary, SolverCounts, State, Timings,
};
use crate::dynamics::step::{Discretization, StepPlace, StepProblem, Workspace};
use crate::elements::most_strained;
use crate::model::Step;
use crate::prepare::PreparedModel;

/// Most halvings of an increment; a further failure stops the run.
const HALVINGS: u32 = 10;

/// Errors that end a run, apart from a failed increment.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The observer could not take the results.
    #[error(transparent)]
    Observer(#[from] io::Error),
}

/// Runs all steps of a model; the observer receives the start and every increment.
///
/// # Errors
/// Those of the observer. A failed increment is an [`Outcome`].
pub fn run(prepared: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
    let discretization = Discretization::new(prepared);
    let mut runner = Runner::new(&discretization, observer);
    let mut start = 0.0;
    for (index, step) in prepared.model.steps.iter().enumerate() {
        let place = StepPlace {
            number: index + 1,
            start,
            period: step.increments.period,
        };
        runner.summary.outcome = runner.step(step, place)?;
        if runner.summary.outcome != Outcome::Finished {
            break;
        }
        start += place.period;
    }
    Ok(runner.summary)
}

/// The time control of a nominal increment.
fn time_control(problem: &StepProblem, nominal: NominalIncrement) -> Box<dyn TimeControl> {
    match problem.ends_at_impacts() {
        true => Box::new(ImpactControl::new(nominal)),
        false => Box::new(Bisection::new(nominal)),
    }
}

/// Velocities of a model, with those of angles as the unknowns have them.
fn initial_velocity(discretization: &Discretization) -> Vec<f64> {
    let mut v = discretization.model.initial_velocity.clone();
    v.resize(discretization.model.dof_count(), 0.0);
    for body in &discretization.turning {
        v[body.spin] *= body.length;
    }
    v
}

/// A run in progress.
struct Runner<'m, 'o> {
    discretization: &'m Discretization<'m>,
    /// State and energies at the end of the last increment.
    state: State,
    ledger: Ledger,
    accounts: Accounts,
    summary: RunSummary,
    observer: &'o mut dyn Observer,
}

impl<'m, 'o> Runner<'m, 'o> {
    /// A run before its first step.
    fn new(discretization: &'m Discretization<'m>, observer: &'o mut dyn Observer) -> Self {
        let Discretization {
            model, elements, ..
        } = discretization;
        Runner {
            discretization,
            state: State {
                u: vec![0.0; model.dof_count()],
                v: initial_velocity(discretization),
                a: vec![0.0; model.dof_count()],
                internal: elements.initial_variables(),
                contact: ClosedPairs::default(),
            },
            ledger: Ledger::default(),
            accounts: Accounts::new(discretization),
            summary: RunSummary {
                outcome: Outcome::Finished,
                increments: 0,
                cutbacks: 0,
                events: 0,
                solver: SolverCounts::at_start(),
                timings: Timings::default(),
            },
            observer,
        }
    }

    /// Runs a step; returns how it ends.
    fn step(&mut self, step: &'m Step, place: StepPlace) -> Result<Outcome, RunError> {
        let problem = StepProblem::new(self.discretization, step, [&self.state.u, &self.state.v]);
        let mut workspace = Workspace::new(&problem);
        let outcome = self.increments(&problem, &mut workspace, step, place);
        self.summary.timings.add(&workspace.meter.timings);
        outcome
    }

    /// The motion of the start, then all increments.
    fn increments(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        step: &Step,
        place: StepPlace,
    ) -> Result<Outcome, RunError> {
        if place.number == 1
            && let Some(failure) = self.start(problem, workspace, place)?
        {
            return Ok(Outcome::Stopped(Box::new(failure)));
        }
        for nominal in nominal_increments(place, step.increments) {
            let end = self.increment(problem, workspace, nominal)?;
            if end != Outcome::Finished {
                return Ok(end);
            }
        }
        Ok(Outcome::Finished)
    }

    /// One nominal increment, divided by its time control: attempt, check, accept or cut back.
    fn increment(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        nominal: NominalIncrement,
    ) -> Result<Outcome, RunError> {
        let mut control = time_control(problem, nominal);
        while let Some(span) = control.next() {
            if self.observer.wants_stop() {
                return Ok(Outcome::Interrupted);
            }
            let halvings = control.halvings();
            let attempt = self.attempt(problem, workspace, span, nominal.length);
            let before = Before {
                state: &self.state,
                ledger: &self.ledger,
            };
            let checked = attempt.and_then(|found| {
                Accepted::new(problem, workspace, before, found, halvings, &nominal)
            });
            match checked {
                Ok(accepted) => {
                    let Subincrement {
                        interval, is_cut, ..
                    } = accepted.subincrement;
                    control.accepted(&interval, is_cut);
                    self.accept(problem, workspace, nominal.place, accepted)?;
                }
                Err(failed) => {
                    control.failed(&failed.0);
                    let number = self.summary.increments + 1;
                    let failure = failure(number, nominal.place, *failed, halvings);
                    if let Some(failure) = self.cut_back(failure, nominal.dt_min)? {
                        return Ok(Outcome::Stopped(Box::new(failure)));
                    }
                }
            }
        }
        Ok(Outcome::Finished)
    }

    /// Solves a span, or its part up to the next impact; `nominal` is the length of the nominal
    /// increment.
    fn attempt(
        &self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        span: Span,
        nominal: f64,
    ) -> Result<Subincrement, FailedSubincrement> {
        workspace.meter.counts = SolverCounts::default();
        let mut subincrements = Subincrements {
            problem,
            workspace,
            start: &self.state,
            rest: span.interval,
            nominal,
        };
        match span.until_impact {
            true => subincrements.next(),
            false => subincrements.rest(),
        }
    }

    /// Reports a failed attempt that is to be repeated with half its length; returns it when
    /// halves would fail too, or it may not be halved again.
    fn cut_back(&mut self, failure: Failure, dt_min: f64) -> Result<Option<Failure>, RunError> {
        let next_dt = failure.dt / 2.0;
        if failure.cause.stays() || failure.halvings == HALVINGS || next_dt < dt_min {
            return Ok(Some(failure));
        }
        self.summary.cutbacks += 1;
        self.observer.cutback(&Cutback { failure, next_dt })?;
        Ok(None)
    }

    /// Makes a converged increment the state of the run and reports it.
    fn accept(
        &mut self,
        problem: &StepProblem,
        workspace: &Workspace,
        place: StepPlace,
        Accepted {
            subincrement,
            ledger,
        }: Accepted,
    ) -> Result<(), RunError> {
        let Subincrement {
            interval,
            solved,
            is_cut,
        } = subincrement;
        let accounted = (self.accounts).enter(problem, &solved, interval, &ledger);
        let solver = SolverCounts {
            violation: contact_violation(problem, &workspace.search, &self.state, &solved),
            converged: true,
            ..workspace.meter.counts
        };
        self.summary.solver.add(&solver);
        self.summary.increments += 1;
        self.summary.events += usize::from(is_cut);
        let mut report = IncrementReport {
            increment: self.summary.increments,
            step: place.number,
            time: interval.end.total,
            step_time: interval.end.step,
            dt: interval.dt,
            ends_step: interval.end.step == place.period,
            energy: ledger.energy,
            contact_energy: ledger.contact_energy,
            strain: most_strained(&ledger.elements),
            elements: ledger.elements.clone(),
            landings: landings(problem, &self.state, &solved, interval),
            solver,
            passes: solved.passes,
            state: solved.end,
            ..accounted
        };
        let all_dofs = self
            .discretization
            .has_more_dofs()
            .then(|| report.state.clone());
        report.keep_nodes(self.discretization.model.mesh.node_count());
        self.observer.increment(&report)?;
        self.ledger = ledger;
        self.state = all_dofs.unwrap_or(report.state);
        Ok(())
    }

    /// Completes the start state (velocity of supports and equations, acceleration; at rest in a static step) and
    /// reports it, or gives the failure when it is not finite.
    fn start(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        place: StepPlace,
    ) -> Result<Option<Failure>, RunError> {
        match problem.integration.has_rates {
            true => {
                let now = place.time_point(0.0);
                let State { u, v, .. } = &mut self.state;
                problem.unknowns.prescribe_velocity(now, u, v);
                problem.follow_donors(&mut self.state.v);
                self.state.a = workspace.start_acceleration(problem, &self.state, now);
            }
            false => self.state.v.fill(0.0),
        }
        self.ledger = Ledger::new(problem, &self.state);
        if let Some(failure) = start_failure(&self.state, &self.ledger, place) {
            return Ok(Some(failure));
        }
        let (state, ledger) = (&self.state, &self.ledger);
        let mut report = IncrementReport {
            step: place.number,
            energy: self.ledger.energy,
            solver: SolverCounts::at_start(),
            state: state.clone(),
            elements: ledger.elements.clone(),
            ..self.accounts.start(problem, state, ledger)
        };
        report.keep_nodes(self.discretization.model.mesh.node_count());
        self.observer.increment(&report)?;
        Ok(None)
    }
}
