//! Whether the rows of an iterate are so near those that impulses were solved with that these may stay. Section 6 of
//! docs/theory.md.

use smallvec::{SmallVec, smallvec};

use crate::contact::{Constraint, Rows};
use crate::dynamics::step::{Equilibrium, StepProblem};
use crate::lcp::ContactState;
use crate::linear::larger;

/// Part of the tolerance of forces by which impulses may differ from those with the rows of the iterate where an
/// increment ends.
const EXACT: f64 = 1e-2;

/// Part of the last correction by which they may differ, as parts of forces and displacements, while the passes go on:
/// a pass makes the next correction by more than this smaller only where it is about to end them.
const STEADY: f64 = 1e-3;

/// The pass before.
pub(crate) struct Before<'a> {
    /// Forces of its iterate.
    forces: &'a Equilibrium,
    /// Its relative correction.
    correction: f64,
    /// Length of the increment.
    pub dt: f64,
}

impl<'a> Before<'a> {
    /// A pass with the forces of its iterate and its relative correction, in an increment of length dt.
    pub fn new(forces: &'a Equilibrium, correction: f64, dt: f64) -> Self {
        Before {
            forces,
            correction,
            dt,
        }
    }
}

/// Gn V0 + (2/dt) max(g0, 0), eq. (6.2), of a constraint with its force rows as derivative rows.
pub(super) fn approach(constraint: &Constraint, v0: &[f64], dt: f64) -> f64 {
    constraint.normal_motion(v0) + 2.0 / dt * constraint.start_gap.max(0.0)
}

/// What a change of impulses is measured by.
pub(super) struct Steady<'a> {
    pub problem: &'a StepProblem<'a>,
    /// Largest diagonal entries of (2/dt²) M of every part.
    pub inertia: &'a [f64],
    pub before: &'a Before<'a>,
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

    /// The part of the largest forces by which impulses may differ, and that by which they may where the increment
    /// ends.
    pub fn tolerances(&self) -> [f64; 2] {
        let exact = EXACT * self.problem.settings.tolerance;
        [exact.max(STEADY * self.before.correction), exact]
    }

    /// By which part of the largest forces the impulses of a constraint in a state change with its rows of `now` in
    /// place of those `before`: an impulse that changes the velocity of a node by dV is at most M_ii dV, and the
    /// force 2/dt of that.
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

/// What the rows of `now` in place of those `before` change of the velocity that the impulses of a constraint in a state
/// make: approach and slip rate, as far as they stop them, and the turn of the jump that stops them.
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
        ContactState::SlipPlus | ContactState::SlipMinus => (1.0 + before.mu) * approach[0].abs(),
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
pub(super) mod tests {
    use super::*;
    use crate::contact::{ConstraintKey, ContactTarget, PairTarget};
    use crate::model::Friction;

    /// A node at dofs 0 and 1 over ground that turns by an angle: n = (-sin, cos), t = (cos, sin).
    pub fn turned(angle: f64) -> Constraint {
        let (sin, cos) = angle.sin_cos();
        Constraint {
            key: ConstraintKey {
                slave_index: 0,
                segment: 0,
            },
            dofs: [0, 1].into_iter().collect(),
            slave_dofs: 2,
            force_rows: Rows::new(&[-sin, cos], &[cos, sin]),
            other_derivative_rows: None,
            gap: 0.0,
            start_gap: 0.0,
            slip: 0.0,
            mu: 0.5,
            scale: 1.0,
            source: PairTarget {
                slave_index: 0,
                target: ContactTarget::face(0),
                nodes: [0, 1, 2, 2],
                from: None,
                friction: Friction::constant(0.5),
            },
        }
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
        // along the ground: the approach changes by 3 angles, the jump that turns is that of the slip
        assert!(about(of([3.0, 0.0], slip), 3.0));
        assert!(about(of([3.0, 0.0], stick), 3.0 + 3.0));
        assert!(about(of([3.0, 0.0], open), 3.0));
        // onto the ground: the slip rate changes by 2 angles, and the jump of 2, with its friction, turns
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
