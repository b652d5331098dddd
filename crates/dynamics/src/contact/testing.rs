//! Contact constraints for tests.

use super::bulge::Bulge;
use super::closed_pairs::{ClosedPair, ClosedPairs};
use super::constraint::{Configurations, Constraint, RowForm, Rows};
use super::keys::{ConstraintKey, SlaveKey};
use super::lists::Recycled;
use super::targets::ContactTarget;
use super::targets::PairTarget;
use crate::lcp::ContactState;

/// Key of slave node number `slave` of the first contact at a segment.
pub(crate) fn key(slave: usize, segment: usize) -> ConstraintKey {
    let slave = SlaveKey { contact: 0, slave };
    ConstraintKey { slave, segment }
}

/// A slave node at a target of nodes a, b and c.
pub(crate) fn pair(target: ContactTarget, nodes: [usize; 4]) -> PairTarget {
    PairTarget {
        key: key(0, target.segment),
        target,
        nodes,
        bulges: [Bulge::FLAT; 2],
        from: None,
        allowed: [0.0; 2],
        points: Recycled::default(),
        is_of_master: false,
        round: None,
    }
}

/// Node 0 at the segment from node 1 to node 2.
pub(crate) fn face() -> PairTarget {
    pair(ContactTarget::face(0), [0, 1, 2, 2])
}

/// The constraint of [`face`] with the given gap and slip: the node starts at 1/4 of a segment of length 2.
pub(crate) fn at_face([gap, slip]: [f64; 2]) -> Constraint {
    let at = Configurations {
        form: RowForm::End,
        x: &[[-0.5, 0.0], [0.0, 0.0], [-2.0, 0.0]],
        u0: &[0.0; 6],
        // the tangent of the segment from 0 to -2 is -x
        u: &[-slip, gap, 0.0, 0.0, 0.0, 0.0],
    };
    Constraint::new(face(), &at)
}

/// A constraint of some dofs with the given rows as force rows and derivative rows: no gap, no slip, mu = 0.5, the
/// length 1; the first node is its slave node.
pub(crate) fn made_up(dofs: &[usize], rows: Rows) -> Constraint {
    let source = face();
    Constraint {
        key: source.key,
        dofs: dofs.iter().copied().collect(),
        slave_dofs: 2,
        force_rows: rows,
        other_derivative_rows: None,
        gap: 0.0,
        start_gap: 0.0,
        slip: 0.0,
        mu: 0.5,
        mu_varies: false,
        stretch: 1.0,
        shrinkage: 0.0,
        scale: 1.0,
        source,
    }
}

/// A slave node that sticks to a segment without force.
pub(crate) fn closed_pair(slave: usize, segment: usize) -> ClosedPair {
    let key = key(slave, segment);
    ClosedPair {
        key,
        source: PairTarget {
            key,
            ..pair(ContactTarget::face(segment), [0, 1, 2, 2])
        },
        force: [0.0; 2],
        mu: 0.0,
        state: ContactState::Stick,
        slips: false,
    }
}

/// Slave nodes that stick to segment 0.
pub(crate) fn closed_pairs<const N: usize>(slaves: [usize; N]) -> ClosedPairs {
    slaves
        .map(|slave| closed_pair(slave, 0))
        .into_iter()
        .collect()
}
