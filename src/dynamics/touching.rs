use super::contact_forces::ContactForces;
use crate::contact::PairSite;
use crate::lcp::ContactState;

/// The pairs that carry forces with their states, increasing by slot and segment.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Touching(Vec<([usize; 2], ContactState)>);

impl Touching {
    /// The pairs in contact.
    pub fn new(forces: &ContactForces) -> Self {
        let closed = (0..forces.pairs.len()).filter(|&k| forces.is_closed(k));
        Touching(
            closed
                .map(|k| (forces.pairs[k].at.key(), forces.state[k]))
                .collect(),
        )
    }

    /// Slots and segments of the pairs.
    pub fn keys(&self) -> Vec<[usize; 2]> {
        self.0.iter().map(|(key, _)| *key).collect()
    }

    /// Whether a pair of the slot carries a force.
    pub fn holds(&self, slot: usize) -> bool {
        !self.of_slot(slot).is_empty()
    }

    /// Whether this very pair carries a force.
    pub fn closes(&self, at: &PairSite) -> bool {
        self.closes_key(at.key())
    }

    /// Whether the pair of a slot and a segment carries a force.
    pub fn closes_key(&self, key: [usize; 2]) -> bool {
        self.0.binary_search_by_key(&key, |(key, _)| *key).is_ok()
    }

    /// State of a pair; a node that has come to another segment keeps the one it had.
    pub fn state(&self, at: &PairSite) -> ContactState {
        let own = self.of_slot(at.slot);
        let same = own.iter().find(|(key, _)| *key == at.key());
        same.or(own.first())
            .map_or(ContactState::Open, |(_, state)| *state)
    }

    fn of_slot(&self, slot: usize) -> &[([usize; 2], ContactState)] {
        let from = self.0.partition_point(|(key, _)| key[0] < slot);
        let to = self.0.partition_point(|(key, _)| key[0] <= slot);
        &self.0[from..to]
    }
}
