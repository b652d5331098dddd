//! Time stepping of a run: steps, and nominal increments divided by their time control; each
//! subincrement is attempted, checked, and accepted or cut back. Section 4 of docs/theory.md, Cutback.

use std::io;

use super::acceptance::{Accepted, Before, failure, start_failure};
use super::time_control::{
    Automatic, Bisection, Ended, ImpactControl, NominalIncrement, Span, TimeControl,
    nominal_increments,
};
use super::truncation_error::{Ends, TruncationError};
use crate::contact::ClosedPairs;
use crate::contact::ConstraintSet;
use crate::dynamics::events::{FailedSubincrement, Subincrement, Subincrements};
use crate::dynamics::increment::{Attempt, Failed, Path, Solved};
use crate::dynamics::ledger::{Accounts, Ledger, contact_violation, landings};
use crate::dynamics::results::{
    Cause, Cutback, Failure, IncrementReport, Observer, Outcome, RunSummary, SolverCounts, State,
    Timings,
};
use crate::dynamics::step::{
    ClosedConstraints, Discretization, Interval, StepPlace, StepProblem, Workspace,
};
use crate::elements::{Motion, most_strained};
use crate::linear::largest;
use crate::model::{Incrementation, Procedure, Step};
use crate::prepare::PreparedModel;

/// Displacement of a static increment, beside that at the rate of the last one, from which on it may be a jump.
const FAR: f64 = 5.0;
/// Displacement increment beside the displacements from which on it counts.
const COUNTS: f64 = 0.01;
/// Displacement beside that of a longer increment, both at their rate, up to which it is none.
const SHRINKS: f64 = 1.5;

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

/// The ends of an increment of length `dt` from a state.
fn ends<'a>(start: &'a State, solved: &'a Solved, dt: f64) -> Ends<'a> {
    Ends {
        u1: &solved.end.u,
        v0: &start.v,
        v1: &solved.end.v,
        dt,
    }
}

/// A run in progress.
struct Runner<'m, 'o> {
    discretization: &'m Discretization<'m>,
    /// State and energies at the end of the last increment.
    state: State,
    ledger: Ledger,
    /// Largest displacement increment and length of a static increment that has led too far (length; time).
    rejected: Option<[f64; 2]>,
    /// Prescribed dofs of the last static step.
    supported: Vec<usize>,
    /// Procedure of the step before.
    procedure: Procedure,
    /// The motion of the last increment, in a static step.
    path: Option<Path>,
    /// Measures the increments, in a step whose truncation error decides their length.
    accuracy: Option<TruncationError>,
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
            supported: Vec::new(),
            rejected: None,
            procedure: Procedure::Dynamic,
            path: None,
            accuracy: None,
            accounts: Accounts::new(discretization),
            summary: RunSummary {
                outcome: Outcome::Finished,
                increments: 0,
                cutbacks: 0,
                rejections: 0,
                events: 0,
                solver: SolverCounts::at_start(),
                timings: Timings::default(),
            },
            observer,
        }
    }

    /// Runs a step; returns how it ends.
    fn step(&mut self, step: &'m Step, place: StepPlace) -> Result<Outcome, RunError> {
        let mut problem =
            StepProblem::new(self.discretization, step, [&self.state.u, &self.state.v]);
        self.release_supports(&mut problem);
        let mut workspace = Workspace::new(&problem);
        self.path = None;
        let outcome = self.increments(&problem, &mut workspace, step, place);
        self.summary.timings.add(&workspace.meter.timings);
        outcome
    }

    /// Lets the forces of the supports that a static step has not any more fade over it.
    fn release_supports(&mut self, problem: &mut StepProblem) {
        if problem.integration.has_rates {
            return;
        }
        if let Some(end) = &mut self.ledger.end {
            let missing = end.missing(self.state.u.len());
            let released = self
                .supported
                .iter()
                .filter(|dof| problem.unknowns.is_free(**dof));
            let released: Vec<(usize, f64)> = released.map(|&dof| (dof, missing[dof])).collect();
            released
                .iter()
                .for_each(|&(dof, force)| end.load[dof] += force);
            problem.loads.release(released);
        }
        self.supported = problem.unknowns.prescribed().collect();
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
        let is_static = |procedure: Procedure| procedure == Procedure::Static;
        if place.number > 1 && is_static(self.procedure) != is_static(step.procedure) {
            self.begin_motion(problem, workspace, place);
            self.ledger.change_procedure(problem, &self.state);
        }
        self.procedure = step.procedure;
        let decides = matches!(step.increments.incrementation, Incrementation::Error { .. });
        let State { u, a, .. } = &self.state;
        self.accuracy = decides.then(|| TruncationError::new(u, a));
        if step.increments.incrementation != Incrementation::Fixed {
            let at_impacts = problem.ends_at_impacts();
            let mut control = Automatic::new(place, step.increments, at_impacts);
            let nominal = control.nominal();
            return self.increment(problem, workspace, nominal, &mut control);
        }
        for nominal in nominal_increments(place, step.increments) {
            let control = &mut *time_control(problem, nominal);
            let end = self.increment(problem, workspace, nominal, control)?;
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
        control: &mut dyn TimeControl,
    ) -> Result<Outcome, RunError> {
        while let Some(span) = control.next() {
            if self.observer.wants_stop() {
                return Ok(Outcome::Interrupted);
            }
            let halvings = control.halvings();
            let attempt = self.attempt(problem, workspace, span);
            let before = Before {
                state: &self.state,
                ledger: &self.ledger,
            };
            let checked = attempt.and_then(|found| {
                Accepted::new(problem, workspace, before, found, halvings, &nominal)
            });
            let checked = checked.and_then(|accepted| self.measured(problem, accepted, control));
            match checked {
                Ok((accepted, error)) => {
                    let Subincrement {
                        interval,
                        is_cut,
                        ref solved,
                    } = accepted.subincrement;
                    let how = Ended {
                        at_impact: is_cut,
                        passes: solved.passes.len(),
                        error: error.unwrap_or(0.0),
                    };
                    control.accepted(&interval, how);
                    self.accept(problem, workspace, nominal.place, (accepted, error))?;
                }
                Err(failed) => {
                    let dt = failed.0.dt;
                    let error = match failed.1.cause {
                        Cause::Inaccurate { error, .. } => Some(error),
                        _ => None,
                    };
                    let may_be_cut = error.is_some() || control.may_be_cut(dt, nominal.dt_min);
                    control.failed(&failed.0, error);
                    let next_dt = control.next().map_or(dt, |span| span.interval.dt);
                    let number = self.summary.increments + 1;
                    let failure = failure(number, nominal.place, *failed, halvings);
                    let next_dt = may_be_cut.then_some(next_dt);
                    if let Some(failure) = self.cut_back(failure, next_dt)? {
                        return Ok(Outcome::Stopped(Box::new(failure)));
                    }
                }
            }
        }
        Ok(Outcome::Finished)
    }

    /// An accepted increment with its truncation error, where that decides the increments of the step.
    ///
    /// # Errors
    /// [`Cause::Inaccurate`] where it is so large that the increment is to be repeated.
    fn measured(
        &self,
        problem: &StepProblem,
        accepted: Accepted,
        control: &dyn TimeControl,
    ) -> Result<(Accepted, Option<f64>), FailedSubincrement> {
        let Some(accuracy) = &self.accuracy else {
            return Ok((accepted, None));
        };
        let Subincrement {
            interval, solved, ..
        } = &accepted.subincrement;
        let error = accuracy.of(problem, &ends(&self.state, solved, interval.dt));
        match control.largest_error(interval.dt) {
            Some(tolerance) if error > tolerance => {
                let failed = Failed {
                    cause: Cause::Inaccurate { error, tolerance },
                    course: None,
                    worst: None,
                    passes: accepted.subincrement.solved.passes,
                };
                Err(Box::new((accepted.subincrement.interval, failed)))
            }
            _ => Ok((accepted, Some(error))),
        }
    }

    /// Solves a span, or its part up to the next impact.
    fn attempt(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        span: Span,
    ) -> Result<Subincrement, FailedSubincrement> {
        workspace.meter.counts = SolverCounts::default();
        if !problem.integration.has_rates {
            return self.equilibrium(problem, workspace, span.interval);
        }
        let mut subincrements = Subincrements {
            problem,
            workspace,
            start: &self.state,
            rest: span.interval,
            nominal: span.nominal,
        };
        match span.until_impact {
            true => subincrements.next(),
            false => subincrements.rest(),
        }
    }

    /// Solves an increment of a static step, from the motion of the last one.
    fn equilibrium(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        interval: Interval,
    ) -> Result<Subincrement, FailedSubincrement> {
        let attempt = Attempt {
            problem,
            workspace,
            start: &self.state,
            interval,
            set: ConstraintSet::All,
            guess: self.path.as_ref(),
        };
        let fail = |failed| Box::new((interval, failed));
        let solved = attempt.solve().map_err(fail)?;
        let checked = self
            .check_stability(problem, workspace, &solved)
            .and_then(|()| self.check_way(workspace, &solved, interval.dt));
        match checked {
            Ok(()) => Ok(Subincrement {
                interval,
                solved,
                is_cut: false,
            }),
            Err(cause) => Err(fail(Failed {
                cause,
                course: None,
                worst: None,
                passes: solved.passes,
            })),
        }
    }

    /// The equilibrium at the end of a static increment must be stable.
    fn check_stability(
        &self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        solved: &Solved,
    ) -> Result<(), Cause> {
        let end = &solved.end;
        let contact = ClosedConstraints {
            acting: solved.contact.forces.acting().collect(),
            at: problem.configurations(&self.state.u, &end.u),
        };
        let motion = Motion::at(&end.u, &end.internal);
        let stable = workspace.check_stability(problem, motion, &contact);
        stable.map_err(|error| match problem.unsolvable(error) {
            Cause::Indefinite { node } => Cause::Unstable { node },
            other => other,
        })
    }

    /// A static increment must not lead to another equilibrium: much farther than at the rate of the last increment,
    /// in the first one than by its tangent, unless the way becomes shorter with the increment. Bodies that contact
    /// alone holds may move freely up to it.
    fn check_way(&mut self, workspace: &Workspace, solved: &Solved, dt: f64) -> Result<(), Cause> {
        let expected = match &self.path {
            Some(path) => dt * largest(&path.v),
            None => solved.tangent_way,
        };
        let way = largest(&solved.d);
        let shrinks = |[before, dt_before]: [f64; 2]| way <= SHRINKS * before * dt / dt_before;
        let counts = way > COUNTS * largest(&solved.end.u);
        let is_far = workspace.pins.are_none() && counts && way > FAR * expected;
        if !is_far || self.rejected.is_some_and(shrinks) {
            self.rejected = None;
            return Ok(());
        }
        self.rejected = Some([way, dt]);
        let size = |dof: &usize| solved.d[*dof].abs();
        let most = (0..solved.d.len()).max_by(|i, k| size(i).total_cmp(&size(k)));
        Err(Cause::Jump {
            node: most.unwrap_or(0) / 2,
        })
    }

    /// Reports a failed attempt that is to be repeated with a smaller length; returns it when
    /// that would fail too, or there is none.
    fn cut_back(
        &mut self,
        failure: Failure,
        next_dt: Option<f64>,
    ) -> Result<Option<Failure>, RunError> {
        let next_dt = match next_dt {
            Some(next_dt) if !failure.cause.stays() => next_dt,
            _ => return Ok(Some(failure)),
        };
        match failure.cause {
            Cause::Inaccurate { .. } => self.summary.rejections += 1,
            _ => self.summary.cutbacks += 1,
        }
        self.observer.cutback(&Cutback { failure, next_dt })?;
        Ok(None)
    }

    /// Makes a converged increment the state of the run and reports it.
    fn accept(
        &mut self,
        problem: &StepProblem,
        workspace: &Workspace,
        place: StepPlace,
        (accepted, truncation_error): (Accepted, Option<f64>),
    ) -> Result<(), RunError> {
        let Accepted {
            subincrement,
            ledger,
        } = accepted;
        let Subincrement {
            interval,
            solved,
            is_cut,
        } = subincrement;
        if let Some(accuracy) = &mut self.accuracy {
            accuracy.accept(&ends(&self.state, &solved, interval.dt));
        }
        let path = (!problem.integration.has_rates).then(|| solved.static_path(interval.dt));
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
            truncation_error,
            energy: ledger.energy,
            contact_energy: ledger.contact_energy,
            strain: most_strained(&ledger.elements),
            elements: ledger.elements.clone(),
            landings: match problem.integration.has_rates {
                true => landings(problem, &self.state, &solved, interval),
                false => Vec::new(),
            },
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
        self.path = path;
        self.ledger = ledger;
        self.state = all_dofs.unwrap_or(report.state);
        Ok(())
    }

    /// Velocity of supports and equations, and acceleration, at the start of a dynamic step that is not the
    /// continuation of another; at rest at that of a static one.
    fn begin_motion(&mut self, problem: &StepProblem, workspace: &mut Workspace, place: StepPlace) {
        if !problem.integration.has_rates {
            self.state.v.fill(0.0);
            self.state.a.fill(0.0);
            return;
        }
        let now = place.time_point(0.0);
        let State { u, v, .. } = &mut self.state;
        problem.unknowns.prescribe_velocity(now, u, v);
        problem.follow_donors(&mut self.state.v);
        let dofs = self.state.u.len();
        let contact = (self.ledger.end.as_ref()).map_or(vec![0.0; dofs], |end| end.contact(dofs));
        self.state.a = workspace.start_acceleration(problem, &self.state, &contact, now);
    }

    /// Completes the start state (velocity of supports and equations, acceleration; at rest in a static step) and
    /// reports it, or gives the failure when it is not finite.
    fn start(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        place: StepPlace,
    ) -> Result<Option<Failure>, RunError> {
        self.begin_motion(problem, workspace, place);
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
