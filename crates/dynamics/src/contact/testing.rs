//! Contact constraints for tests.

use super::bulge::Bulge;
use super::closed_pairs::{ClosedPair, ClosedPairs};
use super::constraint::{Configurations, Constraint, RowForm, Rows};
use super::keys::{ConstraintKey, SlaveKey};
use super::target::{CornerContact, Pair, PairTarget, Segment, SegmentContact, Target};
use crate::lcp::ContactState;

/// Key of slave node number `slave` of the first contact at a segment.
pub(crate) fn key(slave: usize, segment: usize) -> ConstraintKey {
    let slave = SlaveKey { contact: 0, slave };
    ConstraintKey { slave, segment }
}

/// A slave node at a target, with the given key.
pub(crate) fn pair(key: ConstraintKey, slave: usize, target: Target) -> PairTarget {
    let pair = Pair {
        key,
        slave,
        allowed: [0.0; 2],
        is_of_master: false,
    };
    PairTarget { pair, target }
}

/// A straight segment as a target.
pub(crate) fn segment(number: usize, ends: [usize; 2]) -> Segment {
    Segment {
        number,
        ends,
        bulge: Bulge::FLAT,
    }
}

/// Node 0 at a segment on which it has been closed since the start.
pub(crate) fn at_segment(segment: Segment) -> PairTarget {
    let contact = SegmentContact::new(segment);
    pair(key(0, segment.number), 0, Target::Segment(contact))
}

/// Node 0 at the segment from node 1 to node 2.
pub(crate) fn face() -> PairTarget {
    at_segment(segment(0, [1, 2]))
}

/// Node 0 at the corner between the segments from a to b and from b to c.
pub(crate) fn corner([a, b, c]: [usize; 3], weight: f64) -> PairTarget {
    let contact = CornerContact {
        before: segment(0, [a, b]),
        behind: segment(1, [b, c]),
        weight,
    };
    pair(key(0, 0), 0, Target::Corner(contact))
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

/// A constraint of some dofs whose force rows and derivative rows are `rows`. The constraint has no gap, no slip, mu =
/// 0.5 and the length 1; its slave node is the first node.
pub(crate) fn made_up(dofs: &[usize], rows: Rows) -> Constraint {
    let source = face();
    Constraint {
        key: source.pair.key,
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
        source: pair(
            key,
            0,
            Target::Segment(SegmentContact::new(self::segment(segment, [1, 2]))),
        ),
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
