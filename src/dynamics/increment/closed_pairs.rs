//! Closed contact pairs with their states and forces: the warm start of the next pass or
//! increment.

use super::contact_forces::ContactForces;
use crate::contact::PairSite;
use crate::lcp::ContactState;

/// The pairs that carry forces, increasing by slot and segment.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Touching(Vec<Touch>);

/// A pair that carries a force.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Touch {
    /// Slot and segment.
    key: [usize; 2],
    state: ContactState,
    /// Pn and Pt.
    force: [f64; 2],
}

impl Touching {
    /// The pairs in contact.
    pub fn new(forces: &ContactForces) -> Self {
        let closed = (0..forces.pairs.len()).filter(|&k| forces.is_closed(k));
        Touching(
            closed
                .map(|k| Touch {
                    key: forces.pairs[k].at.key(),
                    state: forces.state[k],
                    force: [forces.normal[k], forces.tangential[k]],
                })
                .collect(),
        )
    }

    /// Slots and segments of the pairs.
    pub fn keys(&self) -> Vec<[usize; 2]> {
        self.0.iter().map(|touch| touch.key).collect()
    }

    /// Whether a pair of the slot carries a force.
    pub fn holds(&self, slot: usize) -> bool {
        !self.of_slot(slot).is_empty()
    }

    /// Whether this very pair carries a force.
    pub fn closes(&self, at: &PairSite) -> bool {
        self.find(at).is_some()
    }

    /// Normal and tangential force of this very pair.
    pub fn force(&self, at: &PairSite) -> [f64; 2] {
        self.find(at).map_or([0.0; 2], |touch| touch.force)
    }

    /// State of a pair; a node that has come to another segment keeps the one it had.
    pub fn state(&self, at: &PairSite) -> ContactState {
        self.find(at)
            .or(self.of_slot(at.slot).first())
            .map_or(ContactState::Open, |touch| touch.state)
    }

    fn find(&self, at: &PairSite) -> Option<&Touch> {
        self.of_slot(at.slot)
            .iter()
            .find(|touch| touch.key == at.key())
    }

    fn of_slot(&self, slot: usize) -> &[Touch] {
        let from = self.0.partition_point(|touch| touch.key[0] < slot);
        let to = self.0.partition_point(|touch| touch.key[0] <= slot);
        &self.0[from..to]
    }
}
