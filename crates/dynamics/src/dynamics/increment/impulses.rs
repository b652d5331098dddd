//! Velocity jump at the start of an increment; the set of pairs with impact impulses is iterated
//! along with the passes. See docs/theory/impacts.md, Impact impulses (paper eq. 30).
//!
//! Criterion for keeping impulses: the rows of the iterate are near enough to the rows with which the impulses were
//! computed. See docs/numerics.md, Kept impulses.

use std::borrow::Cow;

use smallvec::{SmallVec, smallvec};

use super::contact_forces::ContactForces;
use super::contact_system::{Guess, Response};
use super::rigid_velocity::agreeing;
use crate::contact::tolerances::SOLVED_GAP;
use crate::contact::{ClosedPair, ClosedPairs, Constraint, ConstraintKey, Rows};
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{Equilibrium, StartVelocity, StepProblem, System, Workspace};
use crate::lcp::ContactState;
use crate::linear::larger;

/// Number of changes of the set of pairs with impulses after which the set is kept.
const SET_CHANGES: usize = 5;

/// The impact impulses of an increment. Impulses act on the pairs that carry a force at the end of
/// the increment, and on the pairs that touch at the start because an impact ended the previous subincrement.
#[derive(Default)]
pub(crate) struct Impulses {
    /// Keys of the pairs closed at the end of the last pass, increasing.
    closed: Vec<ConstraintKey>,
    /// Keys of the pairs that touch at the start and always have impulses, increasing.
    touching: Vec<ConstraintKey>,
    changes: usize,
    at_rest: bool,
    /// Constraints with impulses, and their Phi and Psi.
    forces: ContactForces,
    /// Constraints with impulses in the iterate.
    of_iterate: Vec<Constraint>,
    /// Keys of the pairs whose impulse may cancel a part of the impulse of their force (standing impulse), eq. (11.7),
    /// increasing.
    lent: Vec<ConstraintKey>,
    /// The velocity that impulses start from in place of V0, eq. (11.5) and eq. (11.11); `None` if impulses start from
    /// V0.
    seen: Option<Vec<f64>>,
    /// Impulses J = Bn^T Phi + Bt^T Psi plus the reaction impulses of hinges, over all dofs; empty without impulses.
    resultant: Vec<f64>,
    /// Keys and normal forces of the pairs that did not slip in the last pass, increasing.
    sticking: Vec<(ConstraintKey, f64)>,
}

/// Keys and normal forces of the pairs that do not slip, some of which may have friction at its
/// limit.
fn sticking(closed: &ClosedPairs) -> Vec<(ConstraintKey, f64)> {
    let stuck = closed.iter().filter(|pair| !pair.slips);
    stuck.map(|pair| (pair.key, pair.force[0])).collect()
}

/// Speed of approach, as a part of the largest speed at a pair, up to which the pair neither lands nor opens. A speed
/// also counts as zero if its motion in the increment is less than the gap of a solved pair.
const RESTING: f64 = 1e-9;

impl Impulses {
    /// Impulses before the first pass: `before` are the pairs closed in the last increment, `touching` the pairs that
    /// touch at the start.
    pub fn new(before: &ClosedPairs, touching: Vec<ConstraintKey>) -> Self {
        Impulses {
            closed: before.keys().collect(),
            touching,
            sticking: sticking(before),
            ..Impulses::default()
        }
    }

    /// The constraints that have impulses, with these impulses.
    pub fn acting(&self) -> impl Iterator<Item = (&Constraint, &ClosedPair)> {
        self.forces.acting()
    }

    /// Impulses J = Bn^T Phi + Bt^T Psi plus the reaction impulses of hinges, over all dofs; empty without impulses.
    pub fn resultant(&self) -> &[f64] {
        &self.resultant
    }

    /// The velocity that impulses start from: V0 of the start, or the velocity in its place.
    pub fn seen<'a>(&'a self, v0: &'a [f64]) -> &'a [f64] {
        self.seen.as_deref().unwrap_or(v0)
    }

    /// Whether a pair touches at the start because an impact ended the previous subincrement.
    pub fn touches(&self, key: ConstraintKey) -> bool {
        self.touching.binary_search(&key).is_ok()
    }

    /// Solves for the impulses Phi and Psi of the constraints of the iterate, eq. (6.2). After the pass `before`, the
    /// available impulses are kept if they are near enough to the new impulses.
    fn solve(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        constraints: &[Constraint],
        start: &State,
        before: &EarlierPass,
    ) -> Result<(), Cause> {
        let dt = before.dt;
        if !problem.has_impulses() {
            return Ok(());
        }
        // rows at the start do not change with the iterate
        let at_start = problem.integration.impulses_at_start();
        let configurations = problem.configurations(&start.u, &start.u);
        let rows = |constraint: &Constraint| match at_start {
            true => constraint.at_start(&configurations).with_force_rows(),
            false => constraint.clone().with_force_rows(),
        };
        let mut struck = std::mem::take(&mut self.of_iterate);
        struck.clear();
        struck.reserve(constraints.len());
        let strikes = |c: &&Constraint| self.strikes(c) && has_mass(problem, c);
        struck.extend(constraints.iter().filter(strikes).map(rows));
        self.of_iterate = struck;
        if self.seen.is_none()
            && !self.of_iterate.is_empty()
            && let Cow::Owned(seen) = agreeing(problem, workspace, start)?
        {
            self.seen = Some(seen);
        }
        let v0 = self.seen.as_deref().unwrap_or(&start.v);
        let steady = Steady {
            problem,
            inertia: workspace.stiffness.inertia.as_slice(),
            before,
            v0,
        };
        let standing = self.standing(problem, v0, dt);
        let pairs = self.of_iterate.iter().zip(&standing);
        let pairs = pairs.filter(|(_, impulse)| **impulse > 0.0);
        let pairs: Vec<ConstraintKey> = pairs.map(|(constraint, _)| constraint.key).collect();
        let part = match pairs.is_empty() && self.lent.is_empty() {
            true => self.part_of_change(&steady),
            false => f64::INFINITY,
        };
        if part <= EXACT * problem.settings.tolerance {
            return Ok(());
        }
        self.lent = pairs;
        let system = workspace.m();
        let states = (self.of_iterate.iter()).map(|c| self.state(c, v0, dt));
        let states = states.collect();
        let closed = standing_impulses(&self.of_iterate, standing, states, v0, dt, system)?;
        self.forces.relinearize(&mut self.of_iterate);
        self.forces.closed = closed;
        match self.forces.closed.is_empty() {
            true => self.resultant.clear(),
            false => {
                (self.forces).write_resultant(start.v.len(), &mut self.resultant);
                // on bodies that turn the impulses act by the arms of the start
                let nothing = vec![0.0; start.v.len()];
                let turning = &problem.unknowns.turning;
                turning.hand_over([&start.u, &nothing], false, &mut self.resultant);
                self.add_hinges(problem, workspace, start)?;
            }
        }
        Ok(())
    }

    /// Adds the reaction impulses C^T Lambda of the hinges to the impulses of contact, with the arms at the start.
    fn add_hinges(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        start: &State,
    ) -> Result<(), Cause> {
        if problem.hinges.are_none() {
            return Ok(());
        }
        let nothing = vec![0.0; start.v.len()];
        let mut mass = workspace.m();
        mass.respond(&self.resultant)?;
        let answer = mass.hinge_forces();
        let mut of_hinges = nothing.clone();
        problem.hinges.add_forces(&answer, &mut of_hinges);
        let turning = &problem.unknowns.turning;
        turning.hand_over([&start.u, &nothing], false, &mut of_hinges);
        let both = self.resultant.iter_mut().zip(&of_hinges);
        both.for_each(|(j, of_hinges)| *j += of_hinges);
        Ok(())
    }

    /// Standing impulses P0 = dt Pn, eq. (11.7), of constraints of bodies that turn, if they did not slip in the last
    /// pass and neither land nor open. The standing impulses are zero for all other constraints; the list is empty if
    /// bodies that turn are driven.
    fn standing(&self, problem: &StepProblem, v0: &[f64], dt: f64) -> Vec<f64> {
        let turning = &problem.unknowns.turning;
        let of_pair = |constraint: &Constraint| {
            let stuck = (self.sticking).binary_search_by_key(&constraint.key, |stuck| stuck.0);
            let Ok(at) = stuck else { return 0.0 };
            let speeds = constraint.dofs.iter().map(|&dof| v0[dof].abs());
            let none = SOLVED_GAP * constraint.scale / dt;
            let resting = larger(RESTING * speeds.fold(0.0, larger), none);
            let rests = approach(constraint, v0, dt).abs() <= resting;
            match rests && constraint.mu > 0.0 && constraint.nodes().any(|n| turning.moves(n)) {
                true => dt * self.sticking[at].1,
                false => 0.0,
            }
        };
        match turning.are_driven() {
            true => Vec::new(),
            false => self.of_iterate.iter().map(of_pair).collect(),
        }
    }

    /// Relative difference, in parts of the largest forces, between the impulses with the rows of the iterate and the
    /// available impulses; infinite if the available impulses belong to other constraints.
    fn part_of_change(&self, steady: &Steady) -> f64 {
        let (struck, before) = (&self.of_iterate, &self.forces.constraints);
        let same_set = (before.iter().map(|c| c.key)).eq(struck.iter().map(|c| c.key));
        if !same_set {
            return f64::INFINITY;
        }
        let largest = steady.largest_forces(struck);
        let both = before.iter().zip(struck);
        both.map(|(before, now)| {
            let state = self.forces.closed.state(now.key);
            steady.part([before, now], state, &largest)
        })
        .fold(0.0, larger)
    }

    /// The velocity that the equilibrium of an iterate with the given constraints needs at the start. The velocity is
    /// V0+ if U_theta depends on V0+, or if the mass of bodies that turn acts by other arms in the iterate than at the
    /// start. Otherwise the velocity is V0, and the impulses enter separately without a solve with the mass matrix M.
    pub fn start_velocity<'a>(
        &'a mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        constraints: &[Constraint],
        start: &'a State,
        before: &EarlierPass,
    ) -> Result<StartVelocity<'a>, Cause> {
        self.solve(problem, workspace, constraints, start, before)?;
        match problem.integration.lags() || problem.unknowns.turning.turn_mass() {
            true => self.velocity(workspace, start),
            false => Ok(StartVelocity {
                v0p: Cow::Borrowed(&start.v),
                impulse: &self.resultant,
            }),
        }
    }

    /// Velocity V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1).
    pub fn velocity<'a>(
        &self,
        workspace: &mut Workspace,
        start: &'a State,
    ) -> Result<StartVelocity<'a>, Cause> {
        let v0p = match self.resultant.as_slice() {
            [] => Cow::Borrowed(start.v.as_slice()),
            impulse => Cow::Owned(workspace.m().respond_from(&start.v, impulse)?),
        };
        Ok(StartVelocity { v0p, impulse: &[] })
    }

    /// State of a pair in the last impulses; a pair without an impulse there sticks if it approaches.
    fn state(&self, constraint: &Constraint, v0: &[f64], dt: f64) -> ContactState {
        let key = constraint.key;
        match (self.forces.constraints).binary_search_by_key(&key, |struck| struck.key) {
            // the other pairs of the slave node do not determine the state of this pair
            Ok(_) => self.forces.closed.own_state(key),
            Err(_) if approach(constraint, v0, dt) < 0.0 => ContactState::Stick,
            Err(_) => ContactState::Open,
        }
    }

    /// Whether the set of pairs stayed the same after the last pass.
    pub fn are_at_rest(&self) -> bool {
        self.at_rest
    }

    /// Enters the pairs in contact after a pass. Returns whether the pairs are the same as before, the pairs with a
    /// standing impulse still do not slip, and the impulses belong to these pairs. After some changes the set of pairs
    /// is kept: impulses on any set of pairs remove energy and never add energy.
    pub fn rest(&mut self, problem: &StepProblem, contact: &ContactForces) -> bool {
        self.sticking = match problem.unknowns.turning.are_driven() {
            true => Vec::new(),
            false => sticking(&contact.closed),
        };
        let constraints = contact.constraints.iter();
        let massless: Vec<ConstraintKey> =
            (constraints.filter(|c| !has_mass(problem, c)).map(|c| c.key)).collect();
        let sticks = |key: &ConstraintKey| {
            let stuck = &self.sticking;
            stuck.binary_search_by_key(key, |stuck| stuck.0).is_ok()
        };
        // pairs that have impulses only because they are closed
        let is_free =
            |key: &ConstraintKey| !self.touches(*key) && massless.binary_search(key).is_err();
        let before = self.closed.iter().copied().filter(is_free);
        self.at_rest = !problem.has_impulses()
            || contact.closed.keys().filter(is_free).eq(before) && self.lent.iter().all(sticks)
            || self.changes >= SET_CHANGES;
        if !self.at_rest {
            self.closed.clear();
            self.closed.extend(contact.closed.keys());
            self.changes += 1;
        }
        self.are_at_rest()
    }

    fn strikes(&self, constraint: &Constraint) -> bool {
        self.closed.binary_search(&constraint.key).is_ok()
            || constraint.segments().any(|key| self.touches(key))
    }
}

/// Whether all nodes of a constraint have mass; other constraints have no impulse.
fn has_mass(problem: &StepProblem, constraint: &Constraint) -> bool {
    let mut nodes = constraint.nodes();
    !nodes.any(|node| problem.redistribution.is_massless(node))
}

/// Impact impulses Phi and Psi of constraints at the start of an increment. The velocity after the impulses is V0+ =
/// V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1) (paper eq. 30), and Phi and Psi satisfy eq. (6.2):
///
/// ```text
/// 0 <= Phi  complementary to  Gn V0+ + (2/dt) max(g0, 0) >= 0
/// |Psi| <= mu Phi, Psi opposes Gt V0+
/// ```
///
/// Where G = B, impulses never increase the kinetic energy. The search begins with the given states.
///
/// Problems of many constraints are solved by blocks that use the given gaps and slips, so the round-off of V0 does not
/// enter the effect of the impulses.
fn impulses(
    constraints: &[Constraint],
    states: Vec<ContactState>,
    v0: &[f64],
    dt: f64,
    system: &mut System,
) -> Result<ClosedPairs, Cause> {
    // Gn V0 + (2/dt) max(g0, 0) and Gt V0, eq. (6.2); 0 if their motion in an increment is negligible
    let resolved = |c: &Constraint, rate: f64| match c.resolved(dt * rate) {
        0.0 => 0.0,
        _ => rate,
    };
    let rates =
        |c: &Constraint| [approach(c, v0, dt), c.slip_change(v0)].map(|rate| resolved(c, rate));
    let given: Vec<[f64; 2]> = constraints.iter().map(rates).collect();
    if given.iter().all(|[approach, _]| *approach >= 0.0) {
        return Ok(ClosedPairs::default());
    }
    let guess = Guess {
        states,
        forces: None,
        weight: None,
    };
    if !system.is_factorized() {
        system.factorize()?;
    }
    let mut closed = ClosedPairs::default();
    let all: Vec<&Constraint> = constraints.iter().collect();
    if system.by_bodies(&all).is_none() {
        system.solve_contact(&all, &given, &guess, &mut closed, None)?;
        return Ok(closed);
    }
    let posed = |(constraint, &given): (&Constraint, &[f64; 2])| {
        constraint.with_gap_and_slip(given, constraint.scale / dt)
    };
    let posed: Vec<Constraint> = constraints.iter().zip(&given).map(posed).collect();
    let nothing = vec![0.0; v0.len()];
    let mut response = Response::begin(system, [&nothing, &nothing], &posed)?;
    let all: Vec<&Constraint> = posed.iter().collect();
    let mut free = Vec::new();
    response.gaps_and_slips(system, posed.iter(), &mut free);
    system.solve_contact(&all, &free, &guess, &mut closed, Some(&mut response))?;
    Ok(closed)
}

/// Impulses of constraints of which some have a standing impulse P0, with Phi + P0 >= 0 in place of Phi >= 0, eq.
/// (11.7). The vector V0 - M^-1 Bn^T P0 is the velocity without the standing impulses. If an impulse would cancel all
/// of a standing impulse P0, this P0 is set to zero and the impulses are computed anew.
fn standing_impulses(
    constraints: &[Constraint],
    mut standing: Vec<f64>,
    states: Vec<ContactState>,
    v0: &[f64],
    dt: f64,
    mut system: System,
) -> Result<ClosedPairs, Cause> {
    while standing.iter().any(|impulse| *impulse > 0.0) {
        if !system.is_factorized() {
            system.factorize()?;
        }
        let mut taken = vec![0.0; v0.len()];
        for (constraint, impulse) in constraints.iter().zip(&standing) {
            constraint.add_force([-impulse, 0.0], &mut taken);
        }
        let v = system.respond_from(v0, &taken)?;
        let closed = impulses(constraints, states.clone(), &v, dt, &mut system)?;
        let mut all_push = true;
        for (constraint, impulse) in constraints.iter().zip(&mut standing) {
            if *impulse > 0.0 && closed.keys().all(|key| key != constraint.key) {
                (*impulse, all_push) = (0.0, false);
            }
        }
        if all_push {
            let less = closed.iter().map(|pair| {
                let at = constraints.iter().position(|c| c.key == pair.key);
                let mut less = pair.clone();
                less.force[0] -= at.map_or(0.0, |at| standing[at]);
                less
            });
            return Ok(less.collect());
        }
    }
    impulses(constraints, states, v0, dt, &mut system)
}

/// Part of the tolerance of forces up to which impulses may differ from the impulses with the rows of the iterate.
const EXACT: f64 = 1e-2;

/// The forces of the last pass, and the length of the increment.
pub(crate) struct EarlierPass<'a> {
    /// Forces of the iterate of the last pass.
    forces: &'a Equilibrium,
    /// Length of the increment.
    pub dt: f64,
}

impl<'a> EarlierPass<'a> {
    /// A last pass with the forces of its iterate, in an increment of length dt.
    pub fn new(forces: &'a Equilibrium, dt: f64) -> Self {
        EarlierPass { forces, dt }
    }
}

/// Speed Gn V0 + (2/dt) max(g0, 0), eq. (6.2), of a constraint with its force rows as derivative rows, plus the rate at
/// which a fit shrinks.
pub(super) fn approach(constraint: &Constraint, v0: &[f64], dt: f64) -> f64 {
    constraint.normal_motion(v0) - constraint.shrinkage / dt
        + 2.0 / dt * constraint.start_gap.max(0.0)
}

/// Scales by which a change of impulses is measured.
pub(super) struct Steady<'a> {
    pub problem: &'a StepProblem<'a>,
    /// Largest diagonal entries of (2/dt²) M of every part.
    pub inertia: &'a [f64],
    pub before: &'a EarlierPass<'a>,
    pub v0: &'a [f64],
}

impl Steady<'_> {
    /// The largest force at the dofs of some constraints, of every part.
    pub fn largest_forces(&self, constraints: &[Constraint]) -> SmallVec<[f64; 16]> {
        let Equilibrium {
            load,
            internal,
            inertia,
            ..
        } = self.before.forces;
        let mut most = smallvec![0.0; self.inertia.len()];
        for &dof in constraints.iter().flat_map(|constraint| &constraint.dofs) {
            let most = &mut most[self.problem.parts.part(dof)];
            for force in [load, internal, inertia] {
                *most = larger(*most, force[dof].abs());
            }
        }
        most
    }

    /// Change of the impulses of a constraint, in parts of the largest forces, if its rows change from `before` to
    /// `now`. An impulse that changes the velocity of a node by dV is at most M_ii dV, which is a force 2/dt times as
    /// large.
    pub fn part(
        &self,
        [before, now]: [&Constraint; 2],
        state: ContactState,
        largest: &[f64],
    ) -> f64 {
        if before.dofs != now.dofs {
            return f64::INFINITY;
        }
        let dt = self.before.dt;
        let change = dt * change(before, now, state, (self.v0, dt));
        let of_dof = |&dof: &usize| {
            let part = self.problem.parts.part(dof);
            match change * self.inertia[part] {
                0.0 => 0.0,
                force => force / largest[part],
            }
        };
        now.dofs.iter().map(of_dof).fold(0.0, larger)
    }
}

/// Change of the velocity after the impulses of a constraint if its rows change from `before` to `now`. The change is
/// the sum of three changes: of the approach and of the slip rate, as far as the impulses stop the approach and the
/// slip rate, and of the direction of the velocity jump.
fn change(
    before: &Constraint,
    now: &Constraint,
    state: ContactState,
    (v0, dt): (&[f64], f64),
) -> f64 {
    let approach = [before, now].map(|c| approach(c, v0, dt));
    let slide = [before, now].map(|c| c.tangential_motion(v0));
    let jump = match state {
        ContactState::Open => 0.0,
        ContactState::Stick => approach[0].abs() + slide[0].abs(),
        ContactState::SlipPlus | ContactState::SlipMinus => {
            (1.0 + before.friction()) * approach[0].abs()
        }
    };
    let [of_before, of_now] = [before, now].map(|c| {
        let Rows { normal, tangential } = &c.force_rows;
        normal.iter().chain(tangential)
    });
    let turns = of_before.zip(of_now).map(|(b, n)| (b - n).abs());
    let turn = turns.fold((before.mu - now.mu).abs(), larger);
    let slips = match state {
        ContactState::Stick => (slide[0] - slide[1]).abs(),
        _ => 0.0,
    };
    (approach[0] - approach[1]).abs() + slips + turn * jump
}

#[cfg(test)]
mod steady_tests {
    use super::*;
    use crate::contact::testing;

    /// Constraint of a node at dofs 0 and 1 over ground that is turned by an angle: n = (-sin,
    /// cos), t = (cos, sin).
    pub fn turned(angle: f64) -> Constraint {
        let (sin, cos) = angle.sin_cos();
        testing::made_up(&[0, 1], Rows::new(&[-sin, cos], &[cos, sin]))
    }

    #[test]
    fn a_turn_of_the_rows_changes_what_impulses_stop() {
        let angle = 1e-6;
        let [before, now] = [0.0, angle].map(turned);
        let of = |v0: [f64; 2], state| change(&before, &now, state, (&v0, 0.1)) / angle;
        let about = |value: f64, expected: f64| (value - expected).abs() < 1e-5;
        let (stick, slip, open) = (
            ContactState::Stick,
            ContactState::SlipPlus,
            ContactState::Open,
        );
        // motion along the ground: the approach changes by 3 angles, and the jump of the slip turns
        assert!(about(of([3.0, 0.0], slip), 3.0));
        assert!(about(of([3.0, 0.0], stick), 3.0 + 3.0));
        assert!(about(of([3.0, 0.0], open), 3.0));
        // motion on to the ground: the slip rate changes by 2 angles, and the jump of 2 turns with its friction
        assert!(about(of([0.0, -2.0], slip), 3.0));
        assert!(about(of([0.0, -2.0], stick), 2.0 + 2.0));
        assert!(about(of([0.0, -2.0], open), 0.0));
        assert_eq!(change(&now, &now, stick, (&[3.0, -2.0], 0.1)), 0.0);
    }

    #[test]
    fn another_start_gap_or_friction_changes_what_impulses_stop() {
        let before = turned(0.0);
        let (mut nearer, mut rougher) = (before.clone(), before.clone());
        (nearer.start_gap, rougher.mu) = (0.25, 0.75);
        let of =
            |now: &Constraint| change(&before, now, ContactState::SlipPlus, (&[0.0, -2.0], 0.5));
        // (2/dt) g0, and 0.25 of the jump
        assert_eq!(of(&nearer), 1.0);
        assert_eq!(of(&rougher), 0.25 * 3.0);
    }
}

#[cfg(test)]
mod tests {
    use super::steady_tests::turned;
    use super::*;
    use crate::contact::testing::{self, closed_pairs as pairs};
    use crate::dynamics::step::{
        ClosedConstraints, Discretization, Equilibrium, HeldMotions, Seen,
    };
    use crate::elements::Motion;
    use crate::model::{ContactMass, Increments, Scheme, Settings, Step};
    use crate::prepare::{PreparedModel, redistribution_tests::block};

    const DT: f64 = 0.1;
    /// Number of dofs of a block of one element.
    const DOFS: usize = 8;

    /// Calls `test` with a step of a free block of one element; K* and M of the step are
    /// factorised.
    fn with_block(settings: Settings, test: impl FnOnce(&StepProblem, &mut Workspace)) {
        with_block_of(1, settings, test);
    }

    /// Calls `test` with a step of a free block of `rows` rows with as many elements each.
    fn with_block_of(
        rows: usize,
        settings: Settings,
        test: impl FnOnce(&StepProblem, &mut Workspace),
    ) {
        let step = Step {
            settings,
            ..Step::new(Increments::fixed(DT, 1.0))
        };
        let mut model = block([rows; 2], |_, _| false, |_, _| true);
        model.steps.push(step.clone());
        let still = vec![0.0; model.mesh.dof_count()];
        let prepared = PreparedModel::new(model);
        let discretization = Discretization::new(&prepared);
        let problem = StepProblem::new(&discretization, &step, [&still, &still]);
        let mut workspace = Workspace::new(&problem, Seen::new(problem.parts));
        let contact = ClosedConstraints {
            acting: vec![],
            at: problem.configurations(&still, &still),
            pairs_stiffen: false,
            followers: &[],
            out_of_balance: &[],
            held: &HeldMotions::default(),
        };
        let motion = Motion::at(&still, &[]);
        (workspace.factorize(&problem, DT, motion, &contact)).expect("positive definite");
        test(&problem, &mut workspace);
    }

    #[test]
    fn the_set_is_at_rest_once_a_pass_does_not_change_it() {
        with_block(Settings::default(), |problem, _| {
            let [one, two] = [pairs([0]), pairs([0, 1])];
            let closed = |pairs| ContactForces::without_constraints(pairs);
            let mut impulses = Impulses::new(&one, Vec::new());
            assert!(impulses.rest(problem, &closed(&one)));
            assert!(!impulses.rest(problem, &closed(&two)));
            assert!(impulses.rest(problem, &closed(&two)));
            // pairs that touch at the start have impulses in any case, pairs of nodes without mass
            // never
            let mut touching = Impulses::new(&one, vec![testing::key(1, 0)]);
            assert!(touching.rest(problem, &closed(&two)));
        });
        let settings = Settings {
            contact_mass: ContactMass::Redistributed,
            ..Settings::default()
        };
        with_block_of(3, settings, |problem, _| {
            let massless = 2 * problem.redistribution.massless().next().expect("a node");
            let rows = || Rows::new(&[0.0, 1.0], &[1.0, 0.0]);
            let rests = |dof: usize| {
                let mut contact = ContactForces::without_constraints(&pairs([0]));
                let constraint = testing::made_up(&[dof, dof + 1], rows());
                contact.relinearize(&mut vec![constraint]);
                Impulses::new(&pairs([]), Vec::new()).rest(problem, &contact)
            };
            let has_mass = |node: &usize| !problem.redistribution.is_massless(*node);
            let other = (0..16).find(has_mass).expect("a node with mass");
            assert!(rests(massless) && !rests(2 * other));
        });
    }

    #[test]
    fn after_some_changes_the_set_is_kept() {
        with_block(Settings::default(), |problem, _| {
            let sets = [pairs([0]), pairs([0, 1])];
            let mut impulses = Impulses::new(&sets[0], Vec::new());
            let changes = (1..=9).filter(|k| {
                let contact = ContactForces::without_constraints(&sets[k % 2]);
                !impulses.rest(problem, &contact)
            });
            assert_eq!(changes.collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
            assert!(sets[1].keys().eq(impulses.closed));
        });
    }

    #[test]
    fn the_pairs_of_the_last_increment_have_impulses() {
        with_block(Settings::default(), |_, _| {
            let impulses = Impulses::new(&pairs([0]), Vec::new());
            assert!(impulses.strikes(&turned(0.0)));
            let impulses = Impulses::new(&pairs([1]), Vec::new());
            assert!(!impulses.strikes(&turned(0.0)));
        });
    }

    /// A node slides and falls on to ground that turns from pass to pass. Impulses whose rows have changed by round-off
    /// alone are kept.
    #[test]
    fn impulses_are_those_of_the_rows_of_the_iterate() {
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
            let mut impulses = Impulses::new(&closed, Vec::new());
            let mut pass = |impulses: &mut Impulses, angle| {
                let before = EarlierPass::new(&forces, DT);
                let rows = [turned(angle)];
                (impulses.start_velocity(problem, workspace, &rows, &start, &before))
                    .expect("solved");
                let contact = ContactForces::without_constraints(&closed);
                let rests = impulses.rest(problem, &contact);
                assert_eq!(rests, impulses.are_at_rest());
                (
                    rests,
                    impulses
                        .acting()
                        .map(|(_, pair)| pair.force)
                        .collect::<Vec<_>>(),
                )
            };
            let (rests, first) = pass(&mut impulses, 0.0);
            assert!(rests && first.len() == 1 && first[0][0] > 0.0);
            let (rests, solved) = pass(&mut impulses, 1e-6);
            assert!(rests && solved != first);
            let (rests, kept) = pass(&mut impulses, 1e-6 + 1e-14);
            assert!(rests && kept == solved, "the difference is round-off");
        });
    }
}
