//! Time stepping of a run: steps, and nominal increments divided by their time control. Each
//! subincrement is attempted, checked, and accepted or cut back. See docs/theory/time.md, Cutback.

use std::{io, iter};

use super::acceptance::{Accepted, SubincrementStart, failure, failure_at_start, start_failure};
use super::automatic::Automatic;
use super::bisection::Bisection;
use super::impact_control::ImpactControl;
use super::nominal_increments::{NominalIncrement, nominal_increments};
use super::time_control::{Ended, NextSubincrement, TimeControl};
use super::truncation_error::{Ends, TruncationError};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::contact::ClosedPairs;
use crate::contact::ConstraintSet;
use crate::dynamics::events::{FailedSubincrement, Subincrement, Subincrements};
use crate::dynamics::increment::{Attempt, Failed, Path, Solved};
use crate::dynamics::landing::factorize_anew;
use crate::dynamics::ledger::{Accounts, Ledger, contact_violation, landings};
use crate::dynamics::results::{
    Cause, Cutback, Failure, IncrementReport, Observer, Outcome, RunSummary, SolverCounts, State,
    Timings, Unbalanced,
};
use crate::dynamics::step::{
    ClosedConstraints, Discretization, Equilibrium, Interval, Seen, StepPlace, StepProblem,
    TimePoint, Workspace, initial_temperatures,
};
use crate::elements::most_strained;
use crate::linear::{LinearError, larger};
use crate::model::{Incrementation, Procedure, Step};
use crate::prepare::{PreparedModel, deepest_fault};

/// Ratio of the displacement of a static increment to the displacement at the rate of the last increment, above which
/// the increment may be a jump.
const FAR: f64 = 5.0;
/// Displacement increment, relative to the displacements, below which the increment is not a jump.
const COUNTS: f64 = 0.01;
/// An increment that is repeated with a shorter length is no jump if its rate of displacement is at most this multiple
/// of the rate of the rejected longer increment.
const SHRINKS: f64 = 1.5;

/// Errors that end a run; a failed increment is not among these errors.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The observer could not receive the results.
    #[error(transparent)]
    Observer(#[from] io::Error),
    /// A checkpoint belongs to another model.
    #[error("the checkpoint cannot be read: {0}")]
    Checkpoint(#[from] ArchiveError),
}

/// Runs all steps of a model; the observer receives the start and every increment.
///
/// # Errors
/// The observer has failed. A failed increment is an [`Outcome`], not an error.
pub fn run(prepared: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
    let discretization = Discretization::new(prepared);
    Runner::new(&discretization, observer).steps(None, 0.0)
}

/// Continues a run from a checkpoint that its observer has received, with the same bits, and beyond the end of the last
/// step by a time `extension`. The observer receives the increments after the checkpoint. The summary contains only the
/// times of the continuation.
///
/// # Errors
/// The observer has failed, or the checkpoint belongs to another model.
pub fn resume(
    prepared: &PreparedModel,
    checkpoint: &[u8],
    extension: f64,
    observer: &mut dyn Observer,
) -> Result<RunSummary, RunError> {
    let discretization = Discretization::new(prepared);
    let archive = Archive::Reading(checkpoint);
    Runner::new(&discretization, observer).steps(Some(archive), extension)
}

/// The nominal increments of a step with their time controls.
fn nominal_controls(
    problem: &StepProblem,
    place: StepPlace,
    step: &Step,
) -> Box<dyn Iterator<Item = (NominalIncrement, Box<dyn TimeControl>)>> {
    let ends_at_impacts = problem.ends_at_impacts();
    if step.increments.incrementation != Incrementation::Fixed {
        let control = Automatic::new(place, step.increments, ends_at_impacts);
        return Box::new(iter::once((control.nominal(), Box::new(control) as _)));
    }
    let with_control = move |nominal| -> (NominalIncrement, Box<dyn TimeControl>) {
        match ends_at_impacts {
            true => (nominal, Box::new(ImpactControl::new(nominal))),
            false => (nominal, Box::new(Bisection::new(nominal))),
        }
    };
    Box::new(nominal_increments(place, step.increments).map(with_control))
}

/// Progress of a run.
#[derive(Default, serde::Serialize, serde::Deserialize)]
struct RunProgress {
    /// Number of the step, from 1.
    step: usize,
    /// Displacement and velocity at the start of the step.
    start: [Vec<f64>; 2],
    /// Forces of supports that fade over the step (dof, force).
    released: Vec<(usize, f64)>,
    /// Index of the nominal increment in the step.
    nominal: usize,
}

/// Initial velocities of a model; the velocity of an angle is multiplied by a length of its body, as in the unknowns.
fn initial_velocity(discretization: &Discretization) -> Vec<f64> {
    let mut v = discretization.model.initial_velocity.clone();
    v.resize(discretization.model.dof_count(), 0.0);
    for body in &discretization.turning {
        v[body.spin] *= body.length;
    }
    v
}

/// Data for the truncation error of an increment of length `dt` that starts from a state.
fn ends<'a>(start: &'a State, solved: &'a Solved, dt: f64) -> Ends<'a> {
    Ends {
        u1: &solved.end.u,
        v0: &start.v,
        v1: &solved.end.v,
        dt,
    }
}

/// A static increment that has led too far.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
struct RejectedTravel {
    /// Largest displacement increment (length).
    travel: f64,
    /// Length of the increment (time).
    dt: f64,
}

/// A run in progress.
struct Runner<'m, 'o> {
    discretization: &'m Discretization<'m>,
    /// State and energies at the end of the last increment.
    state: State,
    ledger: Ledger,
    /// Largest displacements and forces of earlier steps, on which tolerances are based.
    seen: Seen,
    /// The last attempt at a static increment, if this attempt has led too far.
    rejected: Option<RejectedTravel>,
    /// Procedure of the last step.
    procedure: Procedure,
    /// The motion of the last increment, in a static step.
    path: Option<Path>,
    /// Truncation error of the increments, in a step in which this error decides their length.
    accuracy: Option<TruncationError>,
    accounts: Accounts,
    summary: RunSummary,
    progress: RunProgress,
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
                temperature: initial_temperatures(model),
                contact: ClosedPairs::default(),
            },
            ledger: Ledger::default(),
            seen: Seen::new(&discretization.parts),
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
            progress: RunProgress::default(),
            observer,
        }
    }

    /// Runs the steps, the last one longer than in the deck by a time `extension`; `resumed` is the checkpoint from
    /// which the steps continue.
    fn steps(
        mut self,
        mut resumed: Option<Archive>,
        extension: f64,
    ) -> Result<RunSummary, RunError> {
        if let Some(archive) = &mut resumed {
            self.transfer(archive)?;
        }
        let model = self.discretization.model;
        let first = self.progress.step.max(1);
        let mut start = 0.0;
        for (step, number) in model.steps.iter().zip(1..) {
            let place = StepPlace {
                number,
                start,
                period: step.increments.period,
                extension: if number == model.steps.len() {
                    extension
                } else {
                    0.0
                },
            };
            if number >= first {
                self.summary.outcome = self.step(step, place, resumed.take())?;
            }
            if self.summary.outcome != Outcome::Finished {
                break;
            }
            start += place.period;
        }
        Ok(self.summary)
    }

    /// Transfers the data that increments hand on, except workspace and time control of the step.
    fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let dofs = self.state.u.len();
        transfer_fields!(archive, self => Runner {
            [ledger, accounts] progress, state, rejected, procedure, path, accuracy;
            discretization, seen, summary, observer
        })?;
        let State { u, v, a, .. } = &self.state;
        if [u, v, a].map(Vec::len) != [dofs; 3] {
            return Err(ArchiveError::Size);
        }
        transfer_fields!(archive, &mut self.summary => RunSummary {
            increments, cutbacks, rejections, events, solver; outcome, timings
        })
    }

    /// Hands the observer all data on which the rest of the run depends.
    fn checkpoint(
        &mut self,
        workspace: &mut Workspace,
        control: &mut dyn TimeControl,
    ) -> Result<(), RunError> {
        let mut archive = Archive::new();
        self.transfer(&mut archive)?;
        workspace.transfer(&mut archive)?;
        control.transfer(&mut archive)?;
        Ok(self.observer.checkpoint(archive.into_bytes())?)
    }

    /// Runs a step, or its rest after the checkpoint `resumed`; returns how the step ends.
    fn step(
        &mut self,
        step: &'m Step,
        place: StepPlace,
        resumed: Option<Archive>,
    ) -> Result<Outcome, RunError> {
        if resumed.is_none() {
            self.progress = RunProgress {
                step: place.number,
                start: [self.state.u.clone(), self.state.v.clone()],
                ..RunProgress::default()
            };
        }
        let start = self.progress.start.each_ref().map(Vec::as_slice);
        let mut problem = StepProblem::new(self.discretization, step, start);
        match resumed {
            None => {
                self.release(&mut problem, step);
                self.path = None;
            }
            Some(_) => problem.release(&self.progress.released),
        }
        let mut workspace = Workspace::new(&problem, std::mem::take(&mut self.seen));
        let outcome = self.increments(&problem, &mut workspace, step, place, resumed);
        self.seen = std::mem::take(&mut workspace.seen);
        self.summary.timings.add(&workspace.meter.timings);
        outcome
    }

    /// Removes the forces of contacts that a step removes, and of supports that the step no longer has: at once in a
    /// dynamic step, gradually over a static or quasi-static step.
    fn release(&mut self, problem: &mut StepProblem, step: &Step) {
        let removed = &step.contacts.removed;
        (self.state.contact).retain(|pair| !removed.contains(&pair.key.contact()));
        let unknowns = &problem.unknowns;
        let is_gone = |dof: usize| unknowns.depends(dof) && !unknowns.is_prescribed(dof);
        let released = (self.ledger.end.as_mut()).map(|end| end.release(removed, is_gone));
        if !problem.integration.fades() {
            return;
        }
        self.progress.released = released.unwrap_or_default();
        problem.release(&self.progress.released);
    }

    /// Runs the motion of the start and all increments, or the increments after the checkpoint
    /// `resumed`.
    fn increments(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        step: &Step,
        place: StepPlace,
        mut resumed: Option<Archive>,
    ) -> Result<Outcome, RunError> {
        match &mut resumed {
            Some(archive) => workspace.transfer(archive)?,
            None => {
                if let Some(failure) = self.begin(problem, workspace, step, place)? {
                    return Ok(Outcome::Stopped(Box::new(failure)));
                }
            }
        }
        let done = self.progress.nominal;
        let nominals = nominal_controls(problem, place, step).enumerate();
        for (index, (nominal, mut control)) in nominals.skip(done) {
            self.progress.nominal = index;
            if let Some(mut archive) = resumed.take() {
                control.transfer(&mut archive)?;
            }
            let end = self.increment(problem, workspace, nominal, &mut *control)?;
            if end != Outcome::Finished {
                return Ok(end);
            }
        }
        Ok(Outcome::Finished)
    }

    /// Computes the motion at the start of a step; returns a failure if the motion at the start of
    /// the analysis is not finite.
    fn begin(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        step: &Step,
        place: StepPlace,
    ) -> Result<Option<Failure>, RunError> {
        if place.number == 1
            && let Some(failure) = self.start(problem, workspace, place)?
        {
            return Ok(Some(failure));
        }
        if let Some(failure) = self.overlap(problem, step, place) {
            return Ok(Some(failure));
        }
        let is_static = |procedure: Procedure| procedure == Procedure::Static;
        if place.number > 1 && is_static(self.procedure) != is_static(step.procedure) {
            if let Err(error) = self.begin_motion(problem, workspace, place) {
                let increments = self.summary.increments;
                return Ok(Some(failure_at_start(error.into(), increments, place)));
            }
            self.ledger.change_procedure(problem, &self.state);
        }
        self.procedure = step.procedure;
        let State { u, a, .. } = &self.state;
        self.accuracy = match step.increments.incrementation {
            Incrementation::Error { tolerance } => {
                let whole = Interval {
                    start: place.time_point(0.0),
                    end: place.time_point(place.end()),
                    dt: place.end(),
                };
                let parted = problem.fits.travel(whole);
                Some(TruncationError::new([u, a], parted, tolerance))
            }
            _ => None,
        };
        Ok(None)
    }

    /// The failure of a step that adds a contact whose bodies overlap.
    fn overlap(&self, problem: &StepProblem, step: &Step, place: StepPlace) -> Option<Failure> {
        let model = problem.model;
        let before = &model.steps.get(place.number.checked_sub(2)?)?.contacts;
        let is_added = |contact: &&usize| !step.contacts.removed.contains(contact);
        let added: Vec<&usize> = before.removed.iter().filter(is_added).collect();
        if added.is_empty() {
            return None;
        }
        let nodes = 0..model.mesh.node_count();
        let x: Vec<[f64; 2]> = nodes.map(|n| problem.position(&self.state.u, n)).collect();
        let bodies = model.mesh.bodies();
        let deepest = |contact: &usize| deepest_fault(&problem.contacts[*contact], &x, &bodies);
        let found = added.into_iter().find_map(deepest)?;
        let cause = Cause::Overlaps {
            slave: found.slave,
            segment: found.segment,
            depth: -found.gap,
        };
        Some(failure_at_start(cause, self.summary.increments, place))
    }

    /// Runs one nominal increment, divided by its time control: attempt, check, acceptance or
    /// cutback.
    fn increment(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        nominal: NominalIncrement,
        control: &mut dyn TimeControl,
    ) -> Result<Outcome, RunError> {
        loop {
            if self.observer.wants_checkpoint() {
                self.checkpoint(workspace, control)?;
            }
            let Some(span) = control.next() else {
                return Ok(Outcome::Finished);
            };
            if self.observer.wants_stop() {
                self.checkpoint(workspace, control)?;
                return Ok(Outcome::Interrupted);
            }
            let halvings = control.halvings();
            let attempt = self.attempt(problem, workspace, span);
            let before = SubincrementStart {
                state: &self.state,
                ledger: &self.ledger,
            };
            let checked = attempt.and_then(|found| {
                Accepted::new(problem, workspace, before, found, halvings, &nominal)
            });
            let checked =
                checked.and_then(|accepted| self.measured(problem, workspace, accepted, control));
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
                    self.accept(problem, workspace, nominal.place, accepted, error)?;
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
                    let (interval, failed) = *failed;
                    let failure = failure(number, nominal.place, interval, failed, halvings);
                    let next_dt = may_be_cut.then_some(next_dt);
                    if let Some(failure) = self.cut_back(failure, next_dt)? {
                        return Ok(Outcome::Stopped(Box::new(failure)));
                    }
                }
            }
        }
    }

    /// An accepted increment with its truncation error, in a step in which this error decides the increments. If the
    /// error is too large, it is computed again without the part of the motion that is too stiff for the increment.
    ///
    /// # Errors
    /// Returns [`Cause::Inaccurate`] if the error is so large that the increment is to be repeated;
    /// also the errors of [`factorize_anew`].
    fn measured(
        &self,
        problem: &StepProblem,
        workspace: &mut Workspace<'m>,
        accepted: Accepted,
        control: &dyn TimeControl,
    ) -> Result<(Accepted, Option<f64>), FailedSubincrement> {
        let Some(accuracy) = &self.accuracy else {
            return Ok((accepted, None));
        };
        let Subincrement {
            interval, solved, ..
        } = &accepted.subincrement;
        let ends = ends(&self.state, solved, interval.dt);
        let e = accuracy.of(problem, &ends);
        let error = accuracy.relative(problem, &workspace.seen, &ends, &e);
        let most = control.largest_error(interval.dt);
        let Some(tolerance) = most.filter(|&most| error > most) else {
            return Ok((accepted, Some(error)));
        };
        let mut filtered = || -> Result<f64, Cause> {
            factorize_anew(problem, workspace, &self.state, interval.dt, solved)?;
            let e = TruncationError::filter(problem, workspace.k(), interval.dt, &e)?;
            Ok(accuracy.relative(problem, &workspace.seen, &ends, &e))
        };
        let cause = match filtered() {
            Ok(error) if error <= tolerance => return Ok((accepted, Some(error))),
            Ok(error) => Cause::Inaccurate { error, tolerance },
            Err(cause) => cause,
        };
        let failed = Failed {
            cause,
            course: None,
            worst: None,
            passes: accepted.subincrement.solved.passes,
        };
        Err(Box::new((accepted.subincrement.interval, failed)))
    }

    /// Solves a subincrement, or its part up to the next impact.
    fn attempt(
        &mut self,
        problem: &StepProblem<'m>,
        workspace: &mut Workspace<'m>,
        span: NextSubincrement,
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

    /// Solves an increment of a static step, from the motion of the last increment.
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
            .check_stability(problem, workspace, &solved, interval.end)
            .and_then(|()| self.check_jump(problem, workspace, &solved, interval.dt));
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

    /// Checks that the equilibrium at the end of a static increment is stable.
    fn check_stability(
        &self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        solved: &Solved,
        now: TimePoint,
    ) -> Result<(), Cause> {
        let end = &solved.end;
        let followers = (problem.loads).changes(now, &end.u);
        let contact = ClosedConstraints {
            acting: solved.contact.forces.acting().collect(),
            at: problem.configurations(&self.state.u, &end.u),
            pairs_stiffen: false,
            followers: &followers,
            out_of_balance: &solved.equilibrium.out_of_balance,
            held: &solved.held,
        };
        let motion = end.motion();
        let stable = workspace.check_stability(problem, motion, &contact, solved.tells_stability);
        stable.map_err(|error| match problem.unsolvable(error) {
            Cause::Indefinite { node } => Cause::Unstable { node },
            other => other,
        })
    }

    /// Checks that a static increment does not lead to another equilibrium, that is, much farther than at the rate of
    /// the last increment, or (in the first increment) than by the tangent. An increment also passes the check if its
    /// displacement decreases with the length of the increment, or is below the resolution of the passes. Bodies that
    /// only contact holds are not checked, since they may move freely until contact begins. If contact alone holds some
    /// bodies, the other bodies may move as far as by the tangent.
    fn check_jump(
        &mut self,
        problem: &StepProblem,
        workspace: &Workspace,
        solved: &Solved,
        dt: f64,
    ) -> Result<(), Cause> {
        let pins = &workspace.pins;
        let is_held: Vec<bool> = match pins.are_none() {
            true => Vec::new(),
            false => (0..solved.d.len() / 2).map(|n| !pins.hold(n)).collect(),
        };
        let of_held = |dof: &usize| is_held.get(dof / 2).copied().unwrap_or(true);
        let dofs: Vec<usize> = (0..solved.d.len()).filter(of_held).collect();
        let largest = |d: &[f64]| dofs.iter().map(|&dof| d[dof].abs()).fold(0.0, larger);
        let by_tangent = || largest(&solved.tangent);
        let expected = match &self.path {
            Some(path) if pins.are_none() => dt * largest(&path.v),
            Some(path) => larger(dt * largest(&path.v), by_tangent()),
            None => by_tangent(),
        };
        let travel = largest(&solved.d);
        let shrinks = |before: RejectedTravel| travel <= SHRINKS * before.travel * dt / before.dt;
        let unresolved = workspace.seen.unresolved(problem, &solved.end.u);
        let least = unresolved.into_iter().fold(0.0, larger);
        let counts = travel > larger(COUNTS * largest(&solved.end.u), least);
        let is_far = counts && travel > FAR * expected;
        if !is_far || self.rejected.is_some_and(shrinks) {
            self.rejected = None;
            return Ok(());
        }
        self.rejected = Some(RejectedTravel { travel, dt });
        let size = |dof: &&usize| solved.d[**dof].abs();
        let most = dofs.iter().max_by(|i, k| size(i).total_cmp(&size(k)));
        Err(Cause::Jump {
            node: most.map_or(0, |dof| dof / 2),
        })
    }

    /// Reports a failed attempt that is to be repeated with a smaller length. Returns the failure if the repetition
    /// would also fail, or if there is no smaller length.
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
        workspace: &mut Workspace,
        place: StepPlace,
        accepted: Accepted,
        truncation_error: Option<f64>,
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
        let Equilibrium { load, internal, .. } = &solved.equilibrium;
        (workspace.seen).take_in(problem, &solved.end.u, [load, internal]);
        let path = (!problem.integration.has_rates).then(|| solved.static_path(interval.dt));
        let accounted = (self.accounts).enter(problem, &self.state, &solved, interval, &ledger);
        let (held, part) = held_motions(problem, workspace, &solved);
        let solver = SolverCounts {
            held: part,
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
            ends_step: interval.end.step == place.end(),
            truncation_error,
            energy: ledger.energy,
            contact_energy: ledger.contact_energy,
            strain: most_strained(&ledger.elements),
            elements: ledger.elements.clone(),
            landings: match problem.integration.has_rates {
                true => landings(problem, &self.state, &solved, interval),
                false => Vec::new(),
            },
            held,
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

    /// Computes the velocity of supports and equations, and the acceleration, at the start of a dynamic step that does
    /// not continue another dynamic step. At the start of a static step velocity and acceleration are zero.
    fn begin_motion(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        place: StepPlace,
    ) -> Result<(), LinearError> {
        if !problem.integration.has_rates {
            self.state.v.fill(0.0);
            self.state.a.fill(0.0);
            return Ok(());
        }
        let now = place.time_point(0.0);
        let State { u, v, .. } = &mut self.state;
        problem.unknowns.prescribe_velocity(now, u, v);
        problem.follow_donors(&mut self.state.v);
        workspace.start_hinges(problem, &mut self.state)?;
        let dofs = self.state.u.len();
        let contact = (self.ledger.end.as_ref()).map_or(vec![0.0; dofs], |end| end.contact(dofs));
        self.state.a = workspace.start_acceleration(problem, &self.state, &contact, now);
        Ok(())
    }

    /// Completes the start state (velocity of supports and equations, acceleration; at rest in a static step) and
    /// reports it. Returns a failure if the start state is not finite.
    fn start(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        place: StepPlace,
    ) -> Result<Option<Failure>, RunError> {
        if let Err(error) = self.begin_motion(problem, workspace, place) {
            return Ok(Some(failure_at_start(error.into(), 0, place)));
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

/// Forces that hold motions which only facets resist, in a static increment: the body with the largest force, and the
/// largest force relative to the normal forces on its body, if this ratio is above the tolerance.
fn held_motions(
    problem: &StepProblem,
    workspace: &Workspace,
    solved: &Solved,
) -> (Option<Box<Unbalanced>>, f64) {
    let (held, u) = (&solved.held, &solved.end.u);
    let at = |node: usize| problem.position(u, node);
    let acting: Vec<_> = solved.contact.forces.acting().collect();
    let part = held.part(&workspace.pins, &at, &acting);
    match part > problem.settings.tolerance {
        true => (held.strongest(&workspace.pins, problem, u), part),
        false => (None, 0.0),
    }
}
