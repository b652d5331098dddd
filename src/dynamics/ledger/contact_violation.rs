//! How far the pairs at the end of a converged increment are from the contact law. Section 5 of
//! docs/theory.md.

use crate::contact::{Constraint, Search, crossed_edges};
use crate::dynamics::increment::Solved;
use crate::dynamics::results::{ContactViolation, State};
use crate::dynamics::step::StepProblem;
use crate::lcp::ContactState;
use crate::linear::larger;

/// The largest violations at the end of an increment that began with `start`, with lists of candidates that
/// hold there.
pub(crate) fn contact_violation(
    problem: &StepProblem,
    search: &Search,
    start: &State,
    solved: &Solved,
) -> ContactViolation {
    let at = problem.configurations(&start.u, &solved.end.u);
    let of_pair =
        |constraint: &Constraint, state| violation_of_pair(&constraint.relinearized(&at), state);
    let pairs = solved.forces.iter();
    let largest = pairs
        .map(|(constraint, pair)| of_pair(constraint, pair.map(|pair| pair.state)))
        .fold(ContactViolation::default(), ContactViolation::larger);
    ContactViolation {
        penetration: larger(largest.overlap, crossed_edges(search, &solved.end.u)),
        ..largest
    }
}

/// An open pair must not overlap (`state` none), a closed one has no gap, one that sticks no slip.
fn violation_of_pair(constraint: &Constraint, state: Option<ContactState>) -> ContactViolation {
    let part = |length: f64| length / constraint.scale;
    let Some(state) = state else {
        return ContactViolation {
            overlap: part((-constraint.gap).max(0.0)),
            ..ContactViolation::default()
        };
    };
    let sticks = state == ContactState::Stick && constraint.mu > 0.0;
    ContactViolation {
        overlap: 0.0,
        gap: part(constraint.gap.abs()),
        slip: if sticks {
            part(constraint.slip.abs())
        } else {
            0.0
        },
        ..ContactViolation::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Configurations, ContactTarget, PairTarget, RowForm};
    use crate::model::Friction;

    /// Violation of a node at 1/4 of a segment of length 2, with the given gap and slip.
    fn violation([gap, slip]: [f64; 2], mu: f64, state: Option<ContactState>) -> ContactViolation {
        let source = PairTarget {
            slave_index: 0,
            target: ContactTarget::face(0),
            nodes: [0, 1, 2, 2],
            from: None,
            friction: Friction::constant(mu),
        };
        let mut u = [0.0; 6];
        (u[0], u[1]) = (slip, gap);
        let at = Configurations {
            form: RowForm::End,
            x: &[[-0.5, 0.0], [0.0, 0.0], [-2.0, 0.0]],
            u0: &[0.0; 6],
            u: &u,
        };
        violation_of_pair(&Constraint::new(source, &at), state)
    }

    #[test]
    fn overlaps_gaps_and_slips_count_where_the_law_forbids_them() {
        let near = |found: ContactViolation, overlap: f64, gap: f64, slip: f64| {
            let expected = [overlap, gap, slip];
            for (found, expected) in [found.overlap, found.gap, found.slip].iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{found:?} {expected}");
            }
        };
        let [stick, slides] = [Some(ContactState::Stick), Some(ContactState::SlipPlus)];
        near(violation([4e-3, 2e-3], 0.5, None), 0.0, 0.0, 0.0);
        near(violation([-4e-3, 2e-3], 0.5, None), 2e-3, 0.0, 0.0);
        near(violation([-4e-3, 2e-3], 0.5, stick), 0.0, 2e-3, 1e-3);
        near(violation([4e-3, -2e-3], 0.5, stick), 0.0, 2e-3, 1e-3);
        near(violation([4e-3, 2e-3], 0.5, slides), 0.0, 2e-3, 0.0);
        near(violation([4e-3, 2e-3], 0.0, stick), 0.0, 2e-3, 0.0);
    }
}
