//! Velocity jump at the start of an increment: the set of pairs that take impact impulses,
//! iterated along with the passes. Section 6 of docs/theory.md (paper eq. 30).

use std::borrow::Cow;

use super::by_bodies::{Chosen, is_large};
use super::contact_forces::ContactForces;
use super::contact_system::{ContactSystem, Guess};
use super::response::Response;
use super::steady::{Before, Steady, approach};
use crate::contact::{ClosedPairs, Constraint, ConstraintKey};
use crate::dynamics::increment::ConstraintSet;
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{StartVelocity, StepProblem, Workspace};
use crate::lcp::ContactState;
use crate::linear::larger;
use crate::model::Impact;

/// Changes of the set of pairs with impulses after which it is kept.
const SET_CHANGES: usize = 5;

/// The impact impulses of an increment: they act on the pairs that carry force at its end, and on
/// those that touch at its start where an impact ended the subincrement before.
pub(crate) struct Impulses {
    /// The pairs closed at the end of the last pass.
    closed: ClosedPairs,
    /// The pairs that touch at the start and have impulses in any case.
    pub touching: ClosedPairs,
    changes: usize,
    at_rest: bool,
    /// Constraints of the last pass with nodes without mass, which take no impulse; increasing.
    massless: Vec<ConstraintKey>,
    /// The constraints that the impulses are for.
    struck: Vec<Constraint>,
    /// Those of the iterate.
    of_iterate: Vec<Constraint>,
    /// Phi, Psi of the last pass.
    pub acting: ContactForces,
    /// Whether they are those of the rows of the iterate, as an increment may end with.
    are_exact: bool,
    /// J = Bn^T Phi + Bt^T Psi over all dofs; empty where nothing strikes.
    resultant: Vec<f64>,
}

impl Impulses {
    /// Starts with the pairs that were closed in the last increment; those that touch at the start
    /// have impulses in any case, where only some pairs are constraints.
    pub fn new(before: &ClosedPairs, set: ConstraintSet) -> Self {
        Impulses {
            closed: before.clone(),
            touching: set.touching(),
            changes: 0,
            at_rest: false,
            massless: Vec::new(),
            struck: Vec::new(),
            of_iterate: Vec::new(),
            acting: ContactForces::default(),
            are_exact: true,
            resultant: Vec::new(),
        }
    }

    /// Impulses Phi, Psi, eq. (6.2), for the constraints of the iterate, unless those at hand are near enough
    /// to theirs after the pass `before`.
    fn solve(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        constraints: &[Constraint],
        start: &State,
        before: &Before,
    ) -> Result<(), Cause> {
        let dt = before.dt;
        if problem.settings.impact == Impact::None {
            return Ok(());
        }
        // rows of the start do not change with the iterate
        let at_start = problem.weights.impulses_at_start();
        let configurations = problem.configurations(&start.u, &start.u);
        let rows = |constraint: &Constraint| match at_start {
            true => constraint.at_start(&configurations).with_force_rows(),
            false => constraint.with_force_rows(),
        };
        let is_massless = |node| problem.redistribution.is_massless(node);
        let without_mass = constraints.iter().filter(|c| c.nodes().any(is_massless));
        self.massless.clear();
        (self.massless).extend(without_mass.map(|constraint| constraint.key));
        let mut struck = std::mem::take(&mut self.of_iterate);
        struck.clear();
        struck.reserve(constraints.len());
        struck.extend((constraints.iter()).filter(|c| self.strikes(c)).map(rows));
        self.of_iterate = struck;
        let steady = Steady {
            problem,
            inertia: workspace.stiffness.inertia.as_slice(),
            before,
            v0: &start.v,
        };
        let [steady_part, exact_part] = steady.tolerances();
        let part = self.part_of_change(&steady);
        self.are_exact = part <= exact_part;
        if part <= steady_part {
            return Ok(());
        }
        self.are_exact = true;
        let system = mass_system(problem, workspace);
        let states = (self.of_iterate.iter()).map(|c| self.state(c, &start.v, dt));
        let states = states.collect();
        self.acting = impulses(self.of_iterate.clone(), states, &start.v, dt, system)?;
        std::mem::swap(&mut self.struck, &mut self.of_iterate);
        match self.acting.closed.is_empty() {
            true => self.resultant.clear(),
            false => (self.acting).write_resultant(start.v.len(), &mut self.resultant),
        }
        Ok(())
    }

    /// By which part of the largest forces the impulses with the rows of the iterate differ from those at hand: any
    /// where these are for others.
    fn part_of_change(&self, steady: &Steady) -> f64 {
        let struck = &self.of_iterate;
        let same_set = (self.struck.iter().map(|c| c.key)).eq(struck.iter().map(|c| c.key));
        if !same_set {
            return f64::INFINITY;
        }
        let largest = steady.largest_forces(struck);
        let both = self.struck.iter().zip(struck);
        both.map(|(before, now)| {
            let state = self.acting.closed.state(now.key);
            steady.part([before, now], state, &largest)
        })
        .fold(0.0, larger)
    }

    /// What the equilibrium of an iterate with the given constraints needs of the velocity of the start: V0
    /// with the impulses beside it, so that nothing is solved with M, unless U_theta depends on V0+.
    pub fn start_velocity<'a>(
        &'a mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        constraints: &[Constraint],
        start: &'a State,
        before: &Before,
    ) -> Result<StartVelocity<'a>, Cause> {
        self.solve(problem, workspace, constraints, start, before)?;
        match problem.weights.lags() {
            true => self.velocity(problem, workspace, start),
            false => Ok(StartVelocity {
                v0p: Cow::Borrowed(&start.v),
                impulse: &self.resultant,
            }),
        }
    }

    /// Velocity V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1).
    pub fn velocity<'a>(
        &self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        start: &'a State,
    ) -> Result<StartVelocity<'a>, Cause> {
        let v0p = match self.resultant.as_slice() {
            [] => Cow::Borrowed(start.v.as_slice()),
            impulse => Cow::Owned(mass_system(problem, workspace).respond(&start.v, impulse)?),
        };
        Ok(StartVelocity { v0p, impulse: &[] })
    }

    /// State of a pair in the impulses before; where it was not among them, it sticks if it approaches.
    fn state(&self, constraint: &Constraint, v0: &[f64], dt: f64) -> ContactState {
        let key = constraint.key;
        match self.struck.binary_search_by_key(&key, |struck| struck.key) {
            Ok(_) => self.acting.closed.state(key),
            Err(_) if approach(constraint, v0, dt) < 0.0 => ContactState::Stick,
            Err(_) => ContactState::Open,
        }
    }

    /// Whether the set of pairs stayed the same after the last pass, and its impulses are those of the iterate.
    pub fn are_at_rest(&self) -> bool {
        self.at_rest && self.are_exact
    }

    /// Takes over the pairs in contact after a pass; whether they are the same as before, and the impulses theirs. After
    /// some changes the set is kept: impulses of any set take energy, never give it.
    pub fn rest(&mut self, problem: &StepProblem, closed: &ClosedPairs) -> bool {
        let rest = problem.settings.impact == Impact::None
            || self.free_keys(closed).eq(self.free_keys(&self.closed))
            || self.changes >= SET_CHANGES;
        self.at_rest = rest;
        if !rest {
            self.closed.clone_from(closed);
            self.changes += 1;
        }
        self.are_at_rest()
    }

    /// Keys of the pairs that have impulses only because they are closed.
    fn free_keys(&self, closed: &ClosedPairs) -> impl Iterator<Item = ConstraintKey> {
        let keys = closed.iter().map(|pair| pair.key);
        keys.filter(|key| !self.touching.closes(*key) && self.have_mass(*key))
    }

    fn have_mass(&self, key: ConstraintKey) -> bool {
        self.massless.binary_search(&key).is_err()
    }

    fn strikes(&self, constraint: &Constraint) -> bool {
        let is_struck =
            self.closed.closes(constraint.key) || self.touching.has_segment_of(constraint);
        is_struck && self.have_mass(constraint.key)
    }
}

/// M with its complementarity problems.
fn mass_system<'a>(problem: &'a StepProblem, workspace: &'a mut Workspace) -> ContactSystem<'a> {
    ContactSystem {
        map: &problem.unknowns.map,
        system: workspace.m(),
        method: problem.method(),
    }
}

/// Impulses of many constraints by blocks, if that is how they are solved, from what is given of gaps and slips
/// without impulses: the constraints take these as their own, so that the round-off of V0 stays out of
/// what impulses add.
fn by_bodies(
    constraints: &[Constraint],
    given: &[[f64; 2]],
    dofs: usize,
    (guess, system, dt): (&Guess, &mut ContactSystem, f64),
    closed: &mut ClosedPairs,
) -> Result<Option<usize>, Cause> {
    if !is_large(constraints.len()) {
        return Ok(None);
    }
    let places: Vec<usize> = (0..constraints.len()).collect();
    let chosen = |all| Chosen {
        all,
        places: &places,
    };
    if !chosen(constraints).are_by_bodies(system) {
        return Ok(None);
    }
    let posed = |(constraint, &[gap, slip]): (&Constraint, &[f64; 2])| Constraint {
        gap,
        slip,
        scale: constraint.scale / dt,
        ..constraint.clone()
    };
    let posed: Vec<Constraint> = constraints.iter().zip(given).map(posed).collect();
    let chosen = chosen(&posed);
    let nothing = vec![0.0; dofs];
    let mut response = Response::begin(system, [&nothing, &nothing], &posed)?;
    let mut free = Vec::new();
    response.gaps_and_slips(system, &posed, &mut free);
    system.solve_by_bodies(&mut response, &chosen, &free, guess, closed)
}

/// Impact impulses Phi, Psi of constraints at the start of an increment, for the velocity after them
/// V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1) (paper eq. 30), posed as eq. (6.2):
///
/// ```text
/// 0 <= Phi  complementary to  Gn V0+ + (2/dt) max(g0, 0) >= 0
/// |Psi| <= mu Phi, Psi opposes Gt V0+
/// ```
///
/// so that kinetic energy never grows where G = B. The search begins with the given states.
fn impulses(
    constraints: Vec<Constraint>,
    states: Vec<ContactState>,
    v0: &[f64],
    dt: f64,
    mut system: ContactSystem,
) -> Result<ContactForces, Cause> {
    // Gn V0 + (2/dt) max(g0, 0) and Gt V0, eq. (6.2); 0 where what they make of an increment is nothing
    let resolved = |c: &Constraint, rate: f64| match c.resolved(dt * rate) {
        0.0 => 0.0,
        _ => rate,
    };
    let rates =
        |c: &Constraint| [approach(c, v0, dt), c.slip_change(v0)].map(|rate| resolved(c, rate));
    let given: Vec<[f64; 2]> = constraints.iter().map(rates).collect();
    if given.iter().all(|[approach, _]| *approach >= 0.0) {
        return Ok(ContactForces::default());
    }
    let guess = Guess {
        states,
        forces: None,
        weight: None,
    };
    if !system.system.is_factorized() {
        system.system.factorize()?;
    }
    let mut closed = ClosedPairs::default();
    let dofs = v0.len();
    let pivots = match by_bodies(
        &constraints,
        &given,
        dofs,
        (&guess, &mut system, dt),
        &mut closed,
    )? {
        Some(pivots) => pivots,
        None => {
            let all: Vec<&Constraint> = constraints.iter().collect();
            system.solve(&all, &given, &guess, &mut closed)?
        }
    };
    Ok(ContactForces {
        problem_size: constraints.len(),
        closed,
        pivots,
        constraints,
        ..ContactForces::default()
    })
}

#[cfg(test)]
mod tests {
    use super::super::steady::tests::turned;
    use super::*;
    use crate::contact::ClosedPair;
    use crate::dynamics::step::{ClosedConstraints, Discretization, Equilibrium};
    use crate::elements::Motion;
    use crate::model::{Frames, Increments, Procedure, Scheme, Settings, Step};
    use crate::prepare::{PreparedModel, redistribution_tests::block};

    const DT: f64 = 0.1;
    /// Dofs of a block of one element.
    const DOFS: usize = 8;

    /// Calls `test` with a step of a free block of one element, of which K* and M are factorised.
    fn with_block(settings: Settings, test: impl FnOnce(&StepProblem, &mut Workspace)) {
        let prepared = PreparedModel::new(block([1, 1], |_, _| false, |_, _| true));
        let discretization = Discretization::new(&prepared);
        let step = Step {
            name: None,
            procedure: Procedure::Dynamic,
            increments: Increments {
                dt: DT,
                period: 1.0,
                dt_min: 0.0,
                direct: true,
            },
            settings,
            supports: vec![],
            point_loads: vec![],
            body_forces: vec![],
            pressures: vec![],
            tractions: vec![],
            frames: Frames::Default,
        };
        let still = [0.0; DOFS];
        let problem = StepProblem::new(&discretization, &step, [&still, &still]);
        let mut workspace = Workspace::new(&problem);
        let contact = ClosedConstraints {
            acting: vec![],
            at: problem.configurations(&still, &still),
        };
        let motion = Motion::at(&still, &[]);
        (workspace.factorize(&problem, DT, motion, &contact)).expect("positive definite");
        test(&problem, &mut workspace);
    }

    fn pairs<const N: usize>(slaves: [usize; N]) -> ClosedPairs {
        slaves
            .map(|slave| ClosedPair::touching(slave, 0))
            .into_iter()
            .collect()
    }

    #[test]
    fn the_set_is_at_rest_once_a_pass_does_not_change_it() {
        with_block(Settings::default(), |problem, _| {
            let (one, two) = (pairs([0]), pairs([0, 1]));
            let mut impulses = Impulses::new(&one, ConstraintSet::All);
            assert!(impulses.rest(problem, &one));
            assert!(!impulses.rest(problem, &two) && impulses.rest(problem, &two));
            // pairs that touch at the start strike in any case, nodes without mass in none
            let mut touching = Impulses::new(&one, ConstraintSet::All);
            touching.touching = pairs([1]);
            assert!(touching.rest(problem, &two));
            let mut massless = Impulses::new(&one, ConstraintSet::All);
            massless.massless = vec![two.iter().last().expect("two").key];
            assert!(massless.rest(problem, &two));
        });
    }

    #[test]
    fn after_some_changes_the_set_is_kept() {
        with_block(Settings::default(), |problem, _| {
            let sets = [pairs([0]), pairs([0, 1])];
            let mut impulses = Impulses::new(&sets[0], ConstraintSet::All);
            let changes = (1..=9).filter(|k| !impulses.rest(problem, &sets[k % 2]));
            assert_eq!(changes.collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
            assert_eq!(impulses.closed, sets[1]);
        });
    }

    #[test]
    fn the_pairs_of_the_last_increment_have_impulses() {
        with_block(Settings::default(), |_, _| {
            let impulses = Impulses::new(&pairs([0]), ConstraintSet::All);
            assert!(impulses.strikes(&turned(0.0)));
            let impulses = Impulses::new(&pairs([1]), ConstraintSet::All);
            assert!(!impulses.strikes(&turned(0.0)));
        });
    }

    /// A node slides and falls on to ground that turns from pass to pass: impulses that are near those of its rows
    /// will do while the passes go on, but not where they end.
    #[test]
    fn an_increment_ends_with_the_impulses_of_its_own_rows() {
        let settings = Settings {
            scheme: Scheme::Ss22 {
                theta1: 1.0,
                theta2: 1.0,
            },
            ..Settings::default()
        };
        with_block(settings, |problem, workspace| {
            let mut start = State {
                u: vec![0.0; DOFS],
                v: vec![0.0; DOFS],
                ..State::default()
            };
            (start.v[0], start.v[1]) = (1.0, -2.0);
            let forces = Equilibrium {
                load: vec![0.0; DOFS],
                internal: vec![1e3; DOFS],
                inertia: vec![0.0; DOFS],
                ..Equilibrium::default()
            };
            let closed = pairs([0]);
            let mut impulses = Impulses::new(&closed, ConstraintSet::All);
            let mut pass = |impulses: &mut Impulses, angle, correction| {
                let before = Before::new(&forces, correction, DT);
                let rows = [turned(angle)];
                (impulses.start_velocity(problem, workspace, &rows, &start, &before))
                    .expect("solved");
                let rests = impulses.rest(problem, &closed);
                assert_eq!(rests, impulses.are_at_rest());
                (
                    rests,
                    impulses
                        .acting
                        .closed
                        .iter()
                        .map(|pair| pair.force)
                        .collect::<Vec<_>>(),
                )
            };
            let (rests, first) = pass(&mut impulses, 0.0, 1e-2);
            assert!(rests && first.len() == 1 && first[0][0] > 0.0);
            let (rests, kept) = pass(&mut impulses, 1e-6, 1e-2);
            assert!(!rests && kept == first, "near, not exact");
            let (rests, solved) = pass(&mut impulses, 1e-6, 1e-6);
            assert!(rests && solved != first, "exact");
            let (rests, kept) = pass(&mut impulses, 1e-6 + 1e-14, 1e-6);
            assert!(rests && kept == solved, "the difference is round-off");
        });
    }
}
