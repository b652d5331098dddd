//! Closed contact pairs with their forces and states: what a pass or an increment hands on of
//! contact. It starts the next complementarity problem, chooses the pairs of impulses, and tells the
//! tunnelling check and the landings which nodes are in contact. Sections 5 and 6 of docs/theory.md.

use std::ops::Range;

use super::constraint::{Constraint, ConstraintKey};
use super::targets::ContactTarget;
use crate::lcp::ContactState;

/// A pair in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedPair {
    /// Its constraint.
    pub key: ConstraintKey,
    /// What its slave node touches.
    pub target: ContactTarget,
    /// Pn and Pt (force), or the impulses Phi and Psi.
    pub force: [f64; 2],
    /// Whether it sticks or slides.
    pub state: ContactState,
}

impl ClosedPair {
    /// A constraint that carries a force.
    pub fn new(constraint: &Constraint, force: [f64; 2], state: ContactState) -> Self {
        ClosedPair {
            key: constraint.key,
            target: constraint.source.target,
            force,
            state,
        }
    }

    /// A pair of a slave node and a segment that touch, as yet without force.
    pub fn touching(slave_index: usize, segment: usize) -> Self {
        ClosedPair {
            key: ConstraintKey {
                slave_index,
                segment,
            },
            target: ContactTarget::face(segment),
            force: [0.0; 2],
            state: ContactState::Stick,
        }
    }
}

/// The pairs in contact, with increasing keys: those that carry a force, or, at an impact, those
/// that touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClosedPairs(Vec<ClosedPair>);

/// The pairs must come with increasing keys.
impl FromIterator<ClosedPair> for ClosedPairs {
    fn from_iter<T: IntoIterator<Item = ClosedPair>>(pairs: T) -> Self {
        let mut all = ClosedPairs::default();
        all.set(pairs.into_iter());
        all
    }
}

impl ClosedPairs {
    /// Takes over other pairs, with increasing keys.
    pub fn set(&mut self, pairs: impl Iterator<Item = ClosedPair>) {
        self.0.clear();
        self.0.extend(pairs);
        debug_assert!(self.0.is_sorted_by(|p, q| p.key < q.key), "increasing keys");
    }

    /// Removes all pairs.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The pairs with increasing keys.
    pub fn iter(&self) -> impl Iterator<Item = &ClosedPair> + Clone {
        self.0.iter()
    }

    /// Slave index and segment of all pairs.
    pub fn segments(&self) -> Vec<[usize; 2]> {
        let of_pair = |pair: &ClosedPair| [pair.key.slave_index, pair.key.segment];
        self.0.iter().map(of_pair).collect()
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether no pair is closed.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of pairs that stick.
    pub fn sticking(&self) -> usize {
        let sticks = |pair: &&ClosedPair| pair.state == ContactState::Stick;
        self.0.iter().filter(sticks).count()
    }

    /// Place of a pair among the others, or the place where it would stand.
    pub fn position(&self, key: ConstraintKey) -> Result<usize, usize> {
        self.0.binary_search_by_key(&key, |pair| pair.key)
    }

    /// Whether a constraint is closed.
    pub fn closes(&self, key: ConstraintKey) -> bool {
        self.position(key).is_ok()
    }

    /// Normal and tangential force of a constraint; zero of an open one.
    pub fn force(&self, key: ConstraintKey) -> [f64; 2] {
        self.find(key).map_or([0.0; 2], |pair| pair.force)
    }

    /// State of a constraint; a node that has come to another segment keeps the one it had.
    pub fn state(&self, key: ConstraintKey) -> ContactState {
        self.find(key)
            .or(self.of_slave(key.slave_index).first())
            .map_or(ContactState::Open, |pair| pair.state)
    }

    /// Whether one of the segments of a constraint is that of a closed pair of its slave node.
    pub fn has_segment_of(&self, constraint: &Constraint) -> bool {
        let slave_index = constraint.key.slave_index;
        let mut segments = constraint.source.target.segments();
        segments.any(|segment| {
            self.closes(ConstraintKey {
                slave_index,
                segment,
            })
        })
    }

    /// The pairs of a slave node.
    pub fn of_slave(&self, slave_index: usize) -> &[ClosedPair] {
        &self.0[self.range_of_slave(slave_index)]
    }

    /// Places of the pairs of a slave node.
    pub fn range_of_slave(&self, slave_index: usize) -> Range<usize> {
        let is_before = |pair: &ClosedPair| pair.key.slave_index < slave_index;
        let from = self.0.partition_point(is_before);
        let is_own = |pair: &&ClosedPair| pair.key.slave_index == slave_index;
        from..from + self.0[from..].iter().take_while(is_own).count()
    }

    /// Adds a pair at its place unless it is there.
    pub fn insert(&mut self, pair: ClosedPair) {
        if let Err(place) = self.position(pair.key) {
            self.0.insert(place, pair);
        }
    }

    fn find(&self, key: ConstraintKey) -> Option<&ClosedPair> {
        self.position(key).ok().map(|place| &self.0[place])
    }
}
