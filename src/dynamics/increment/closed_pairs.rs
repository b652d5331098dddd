//! Closed contact pairs with their states and forces: the warm start of the next pass or
//! increment.

use super::contact_forces::ContactForces;
use crate::contact::PairTarget;
use crate::lcp::ContactState;

/// The pairs that carry forces, increasing by slave_index and segment.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ClosedPairs(Vec<ClosedPair>);

/// A pair that carries a force.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ClosedPair {
    /// Slot and segment.
    key: [usize; 2],
    state: ContactState,
    /// Pn and Pt.
    force: [f64; 2],
}

impl ClosedPairs {
    /// The pairs in contact.
    pub fn new(forces: &ContactForces) -> Self {
        let closed = (0..forces.pairs.len()).filter(|&k| forces.is_closed(k));
        ClosedPairs(
            closed
                .map(|k| ClosedPair {
                    key: forces.pairs[k].target.key(),
                    state: forces.state[k],
                    force: [forces.normal[k], forces.tangential[k]],
                })
                .collect(),
        )
    }

    /// Slots and segments of the pairs.
    pub fn keys(&self) -> Vec<[usize; 2]> {
        self.0.iter().map(|pair| pair.key).collect()
    }

    /// Whether a pair of the slave_index carries a force.
    pub fn holds(&self, slave_index: usize) -> bool {
        !self.of_slave(slave_index).is_empty()
    }

    /// Whether this very pair carries a force.
    pub fn closes(&self, at: &PairTarget) -> bool {
        self.find(at).is_some()
    }

    /// Normal and tangential force of this very pair.
    pub fn force(&self, at: &PairTarget) -> [f64; 2] {
        self.find(at).map_or([0.0; 2], |pair| pair.force)
    }

    /// State of a pair; a node that has come to another segment keeps the one it had.
    pub fn state(&self, at: &PairTarget) -> ContactState {
        self.find(at)
            .or(self.of_slave(at.slave_index).first())
            .map_or(ContactState::Open, |pair| pair.state)
    }

    fn find(&self, at: &PairTarget) -> Option<&ClosedPair> {
        self.of_slave(at.slave_index)
            .iter()
            .find(|pair| pair.key == at.key())
    }

    fn of_slave(&self, slave_index: usize) -> &[ClosedPair] {
        let from = self.0.partition_point(|pair| pair.key[0] < slave_index);
        let to = self.0.partition_point(|pair| pair.key[0] <= slave_index);
        &self.0[from..to]
    }
}
