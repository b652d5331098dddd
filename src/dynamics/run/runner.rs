//! Time stepping of a run: steps, increments, cutbacks by bisection and subincrements between
//! impacts. Section 4 of docs/theory.md, Cutback, and section 6, Impacts as events.

use std::io;

use super::nominal_increment::{NominalIncrement, WHOLE, increments_of};
use crate::contact::ContactSurfaces;
use crate::dynamics::events::{MOST_EVENTS, Subincrement, Subincrements};
use crate::dynamics::increment::{Attempt, ClosedPairs, Failed, Solved};
use crate::dynamics::ledger::{Accepted, Accounts, Ledger, landings, start_failure};
use crate::dynamics::results::{
    Cutback, Failure, IncrementReport, Observer, Outcome, RunSummary, SolverCounts, State, Timings,
};
use crate::dynamics::step::{
    Interval, Loads, Mass, Parts, StepPlace, StepProblem, Unknowns, Weights, Workspace,
};
use crate::elements::Elements;
use crate::model::{ImpactTime, Increments, Model, Step};
use crate::prepare::PreparedModel;

/// Halvings of an increment before the run stops.
const HALVINGS: u32 = 10;
/// Halvings of an increment because of the energy that contact puts in.
const GAIN_HALVINGS: u32 = 5;

/// Why a run could not go on, apart from a failed increment.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The observer could not take the results.
    #[error(transparent)]
    Observer(#[from] io::Error),
}

/// Runs all steps of a model; the observer receives the start and every increment.
///
/// # Errors
/// The observer's. A failed increment is no error but an [`Outcome`].
pub fn run(prepared: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
    let model = prepared.model();
    let elements = Elements::new(model);
    let mass = Mass::new(&elements, model.mesh.node_count());
    let parts = Parts::new(model);
    let contacts = prepared.contact_surfaces();
    let mut runner = Runner {
        model,
        elements: &elements,
        mass: &mass,
        parts: &parts,
        contacts,
        state: State {
            u: vec![0.0; model.mesh.dof_count()],
            v: model.initial_velocity.clone(),
            a: vec![0.0; model.mesh.dof_count()],
        },
        contact: ClosedPairs::default(),
        ledger: Ledger::default(),
        accounts: Accounts::new(model, &mass, contacts),
        increment: 0,
        cutbacks: 0,
        events: 0,
        timings: Timings::default(),
        totals: SolverCounts {
            converged: true,
            ..SolverCounts::default()
        },
        observer,
    };
    let mut outcome = Outcome::Finished;
    let mut start = 0.0;
    for (number, step) in model.steps.iter().enumerate() {
        match runner.step(number + 1, step, start)? {
            Outcome::Finished => start += step.increments.period,
            stopped => {
                outcome = stopped;
                break;
            }
        }
    }
    Ok(RunSummary {
        outcome,
        increments: runner.increment,
        cutbacks: runner.cutbacks,
        events: runner.events,
        solver: runner.totals,
        timings: runner.timings,
    })
}

/// State of a run.
struct Runner<'m, 'o> {
    model: &'m Model,
    elements: &'m Elements,
    mass: &'m Mass,
    parts: &'m Parts,
    contacts: &'m [ContactSurfaces],
    state: State,
    contact: ClosedPairs,
    ledger: Ledger,
    accounts: Accounts,
    increment: usize,
    cutbacks: usize,
    events: usize,
    timings: Timings,
    totals: SolverCounts,
    observer: &'o mut dyn Observer,
}

impl<'m> Runner<'m, '_> {
    fn step(&mut self, number: usize, step: &'m Step, start: f64) -> Result<Outcome, RunError> {
        let place = StepPlace {
            number,
            start,
            period: step.increments.period,
        };
        let problem = StepProblem {
            model: self.model,
            elements: self.elements,
            mass: self.mass,
            parts: self.parts,
            contacts: self.contacts,
            settings: step.settings,
            weights: Weights::new(step.settings.scheme),
            unknowns: Unknowns::new(self.model, self.elements, step, &self.state.u),
            loads: Loads::new(self.model, step),
        };
        let mut workspace = Workspace::new(&problem);
        if number == 1
            && let Some(failure) = self.report_start(&problem, &mut workspace, place)?
        {
            return Ok(Outcome::Stopped(Box::new(failure)));
        }
        let outcome = self.increments(&problem, &mut workspace, place, step.increments);
        self.timings.add(&workspace.meter.timings);
        outcome
    }

    /// The increments of a step.
    fn increments(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        place: StepPlace,
        Increments {
            dt, period, dt_min, ..
        }: Increments,
    ) -> Result<Outcome, RunError> {
        let count = increments_of(period, dt);
        for i in 0..count {
            let from = dt * i as f64;
            let to = if i + 1 == count {
                period
            } else {
                dt * (i + 1) as f64
            };
            // The nominal length keeps the factors valid; only a last, shorter one differs.
            let length = if to - from < dt * (1.0 - WHOLE) {
                to - from
            } else {
                dt
            };
            let nominal = NominalIncrement {
                from,
                to,
                length,
                dt_min,
            };
            let end = match problem.settings.impact_time {
                ImpactTime::Increment => {
                    self.increment_in_halves(problem, workspace, place, nominal)
                }
                ImpactTime::Event => {
                    self.increment_with_impacts(problem, workspace, place, nominal)
                }
            };
            if let Some(end) = end? {
                return Ok(end);
            }
        }
        Ok(Outcome::Finished)
    }

    /// One increment of the nominal, in halves, quarters ... where it does not converge; how the run
    /// ends, if it does.
    fn increment_in_halves(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        place: StepPlace,
        nominal: NominalIncrement,
    ) -> Result<Option<Outcome>, RunError> {
        // The next piece is number `piece` of 2^halvings.
        let (mut piece, mut halvings) = (0_u32, 0_u32);
        while piece < 1 << halvings {
            if self.observer.wants_stop() {
                return Ok(Some(Outcome::Interrupted));
            }
            let interval = nominal.piece(place, piece, halvings);
            workspace.meter.counts = SolverCounts::default();
            let attempt = Attempt {
                problem,
                workspace,
                start: &self.state,
                interval,
                active: None,
            };
            let solved = attempt.solve(&self.contact);
            match solved.and_then(|s| self.checked(problem, s, interval.dt, halvings, nominal)) {
                Ok(entered) => {
                    self.accept(problem, place, interval, entered, workspace.meter.counts)?;
                    piece += 1;
                    while halvings > 0 && piece % 2 == 0 {
                        (piece, halvings) = (piece / 2, halvings - 1);
                    }
                }
                Err(failed) => {
                    let failure = self.failure(place, interval, failed, halvings);
                    if let Some(failure) = self.cut_back(failure, nominal.dt_min)? {
                        return Ok(Some(Outcome::Stopped(Box::new(failure))));
                    }
                    (piece, halvings) = (2 * piece, halvings + 1);
                }
            }
        }
        Ok(None)
    }

    /// One increment of the nominal, in pieces that end at impacts, or halfway where one does not
    /// converge; how the run ends, if it does.
    fn increment_with_impacts(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        place: StepPlace,
        nominal: NominalIncrement,
    ) -> Result<Option<Outcome>, RunError> {
        let (mut events, mut from, mut last) = (0, nominal.from, nominal.length);
        // Ends of what is left, and of its halves; the next piece goes no further than the last.
        let mut ends = vec![nominal.to];
        while let Some(&to) = ends.last() {
            if self.observer.wants_stop() {
                return Ok(Some(Outcome::Interrupted));
            }
            let is_whole = from == nominal.from && to == nominal.to;
            let rest = Interval {
                start: place.time_point(from),
                end: place.time_point(to),
                dt: if is_whole { nominal.length } else { to - from },
            };
            workspace.meter.counts = SolverCounts::default();
            let mut pieces = Subincrements {
                problem,
                workspace,
                start: &self.state,
                contact: &self.contact,
                rest,
                nominal: nominal.length,
                last,
            };
            let next = match events < MOST_EVENTS {
                true => pieces.next(),
                false => pieces.rest(),
            };
            let halvings = ends.len() as u32 - 1;
            let checked = next.and_then(|piece| {
                let Subincrement {
                    interval,
                    solved,
                    is_cut,
                } = piece;
                let checked = self.checked(problem, solved, interval.dt, halvings, nominal);
                let entered = checked.map_err(|failed| Box::new((interval, failed)))?;
                Ok((interval, entered, is_cut))
            });
            match checked {
                Ok((interval, entered, is_cut)) => {
                    self.accept(problem, place, interval, entered, workspace.meter.counts)?;
                    (from, last) = (interval.end.step, interval.dt);
                    if is_cut {
                        (events, self.events) = (events + 1, self.events + 1);
                    } else {
                        ends.pop();
                    }
                }
                Err(broken) => {
                    let (interval, failed) = *broken;
                    let failure = self.failure(place, interval, failed, halvings);
                    if let Some(failure) = self.cut_back(failure, nominal.dt_min)? {
                        return Ok(Some(Outcome::Stopped(Box::new(failure))));
                    }
                    ends.push(from + interval.dt / 2.0);
                }
            }
        }
        Ok(None)
    }

    /// A converged increment with its energies, which must be finite; one into which contact puts
    /// energy is halved, a few times.
    fn checked(
        &self,
        problem: &StepProblem,
        solved: Solved,
        dt: f64,
        halvings: u32,
        nominal: NominalIncrement,
    ) -> Result<Accepted, Failed> {
        let may_be_halved = halvings < GAIN_HALVINGS && dt / 2.0 >= nominal.dt_min;
        let before = (&self.state, &self.ledger);
        Accepted::new(problem, before, solved, dt, may_be_halved)
    }

    fn failure(
        &self,
        place: StepPlace,
        interval: Interval,
        failed: Failed,
        halvings: u32,
    ) -> Failure {
        let Failed {
            cause,
            worst,
            passes,
        } = failed;
        Failure {
            increment: self.increment + 1,
            step: place.number,
            time: interval.start.total,
            dt: interval.dt,
            cause,
            worst,
            passes,
            halvings,
        }
    }

    /// Reports a failed attempt that is to be repeated with half its length; gives it back if it
    /// may not be halved any more.
    fn cut_back(&mut self, failure: Failure, dt_min: f64) -> Result<Option<Failure>, RunError> {
        let next_dt = failure.dt / 2.0;
        if failure.halvings == HALVINGS || next_dt < dt_min {
            return Ok(Some(failure));
        }
        self.cutbacks += 1;
        self.observer.cutback(&Cutback { failure, next_dt })?;
        Ok(None)
    }

    /// Takes over a converged increment and reports it.
    fn accept(
        &mut self,
        problem: &StepProblem,
        place: StepPlace,
        interval: Interval,
        Accepted { solved, ledger }: Accepted,
        solver: SolverCounts,
    ) -> Result<(), RunError> {
        self.ledger = ledger;
        let accounted = (self.accounts).enter(problem, &solved, interval, &self.ledger.strains);
        let landings = landings(problem, &self.state, &self.contact, &solved, interval);
        let solver = SolverCounts {
            converged: true,
            ..solver
        };
        self.totals.add(&solver);
        self.increment += 1;
        let report = IncrementReport {
            increment: self.increment,
            step: place.number,
            time: interval.end.total,
            step_time: interval.end.step,
            dt: interval.dt,
            ends_step: interval.end.step == place.period,
            energy: self.ledger.energy,
            strain: self.elements.most_strained(&solved.end.u),
            landings,
            solver,
            passes: solved.passes,
            state: solved.end,
            ..accounted
        };
        self.contact = ClosedPairs::new(&solved.forces);
        self.observer.increment(&report)?;
        self.state = report.state;
        Ok(())
    }

    /// Completes the start state (velocity of supports and equations, acceleration) and reports it, or gives
    /// the failure when it is not finite.
    fn report_start(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace<'m>,
        place: StepPlace,
    ) -> Result<Option<Failure>, RunError> {
        let now = place.time_point(0.0);
        problem.unknowns.prescribe_velocity(now, &mut self.state.v);
        self.state.a = problem.start_acceleration(workspace.m(), &self.state, now);
        self.ledger = Ledger::new(problem, &self.state);
        if let Some(failure) = start_failure(&self.state, &self.ledger, place) {
            return Ok(Some(failure));
        }
        let report = IncrementReport {
            step: place.number,
            energy: self.ledger.energy,
            solver: SolverCounts {
                converged: true,
                ..SolverCounts::default()
            },
            state: self.state.clone(),
            ..self
                .accounts
                .start(problem, &self.state, &self.ledger.strains)
        };
        self.observer.increment(&report)?;
        Ok(None)
    }
}
