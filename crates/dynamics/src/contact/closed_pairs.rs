//! Closed contact pairs with their forces and states, which a pass or an increment hands on to the next pass or
//! increment. The closed pairs start the next complementarity problem, choose the pairs of impulses, and tell the
//! tunnelling check and the landings which nodes are in contact. See docs/theory/complementarity.md and
//! docs/theory/impacts.md.

use super::constraint::{Configurations, Constraint};
use super::keys::{ConstraintKey, NodeAtSegment, SlaveKey};
use super::target::PairTarget;
use crate::lcp::ContactState;

/// A pair in contact.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClosedPair {
    /// Its constraint.
    pub key: ConstraintKey,
    /// The pair and target from which its constraint is made.
    pub(super) source: PairTarget,
    /// Pn and Pt (force), or the impulses Phi and Psi.
    pub force: [f64; 2],
    /// Coefficient of friction mu of the pair.
    pub mu: f64,
    /// Whether the pair sticks or slides in the solution of the complementarity problem. The tangential force of a
    /// sliding pair is at the friction limit, though the pair need not have moved.
    pub state: ContactState,
    /// Whether the pair has slipped.
    pub slips: bool,
}

impl ClosedPair {
    /// Closed pair of a constraint, with its force and state.
    pub fn new(constraint: &Constraint, force: [f64; 2], state: ContactState) -> Self {
        ClosedPair {
            key: constraint.key,
            source: constraint.source.clone().at_end(),
            force,
            mu: constraint.mu,
            state,
            slips: state != ContactState::Stick,
        }
    }

    /// Tangential force beyond the friction limit of a coefficient mu (force), eq. (3.6). Where the pair slips, the
    /// result is the distance of the tangential force from the limit, whichever of the two is larger.
    ///
    /// ```text
    /// |Pt| - mu Pn,   of a pair that slips ||Pt| - mu Pn|
    /// ```
    pub fn out_of_cone(&self, mu: f64) -> f64 {
        let [pn, pt] = self.force;
        let excess = pt.abs() - mu * pn;
        if self.slips { excess.abs() } else { excess }
    }

    /// The constraint of the pair between other configurations, with the same target at their start.
    pub fn constraint(&self, at: &Configurations) -> Constraint {
        Constraint {
            mu: self.mu,
            ..Constraint::new(self.source.clone(), at)
        }
    }

    /// The slave node and its segment; at a corner the segment before the corner.
    pub fn pair(&self) -> NodeAtSegment {
        self.source.named()
    }
}

/// The pairs in contact, with increasing keys: the pairs that carry a force or, at an impact, the pairs that touch.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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
    /// Replaces the pairs by other pairs, which come with increasing keys.
    pub fn set(&mut self, pairs: impl Iterator<Item = ClosedPair>) {
        self.0.clear();
        self.0.extend(pairs);
        assert!(self.0.is_sorted_by(|p, q| p.key < q.key), "increasing keys");
    }

    /// Marks which of the pairs at their friction limits have slipped. Without friction a pair
    /// always slips.
    pub fn mark_slips(&mut self, has_moved: impl Fn(ConstraintKey) -> bool) {
        for pair in &mut self.0 {
            pair.slips =
                pair.state != ContactState::Stick && (pair.mu == 0.0 || has_moved(pair.key));
        }
    }

    /// Keeps the pairs for which a condition holds.
    pub fn retain(&mut self, holds: impl Fn(&ClosedPair) -> bool) {
        self.0.retain(holds);
    }

    /// Removes all pairs.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The closed pairs, in the order of increasing keys.
    pub fn iter(&self) -> impl Iterator<Item = &ClosedPair> + Clone {
        self.0.iter()
    }

    /// Whether a node belongs to a constraint whose mean gap is closed (surface to surface).
    pub(super) fn means_have(&self, node: usize) -> bool {
        let mut means = self.0.iter().filter_map(|pair| pair.source.target.mean());
        means.any(|mean| mean.has(node))
    }

    /// Keys of the closed pairs, increasing.
    pub fn keys(&self) -> impl Iterator<Item = ConstraintKey> {
        self.0.iter().map(|pair| pair.key)
    }

    /// Number of closed pairs.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether no pair is closed.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of closed pairs that do not slip.
    pub fn sticking(&self) -> usize {
        self.0.iter().filter(|pair| !pair.slips).count()
    }

    /// Whether the constraint with this key is closed.
    pub fn closes(&self, key: ConstraintKey) -> bool {
        self.find(key).is_some()
    }

    /// Normal and tangential force of a constraint; zero for an open one.
    pub fn force(&self, key: ConstraintKey) -> [f64; 2] {
        self.find(key).map_or([0.0; 2], |pair| pair.force)
    }

    /// State of a constraint among the closed pairs.
    pub fn own_state(&self, key: ConstraintKey) -> ContactState {
        self.find(key).map_or(ContactState::Open, |pair| pair.state)
    }

    /// State of a constraint; for a node that has come to another segment, its state at the segment
    /// before.
    pub fn state(&self, key: ConstraintKey) -> ContactState {
        (self.last_of(key)).map_or(ContactState::Open, |pair| pair.state)
    }

    /// The closed pair of a constraint; for a node that has come to another segment, its pair at
    /// the segment before.
    pub fn last_of(&self, key: ConstraintKey) -> Option<&ClosedPair> {
        self.find(key).or(self.of_slave(key.slave).first())
    }

    /// States from which the complementarity problem of constraints with the given, increasing keys starts. A
    /// constraint starts as open if it was open and its slave node still has a closed pair among `keys`. Only a node
    /// that has come to another segment hands its state on.
    pub fn states_among(&self, keys: &[ConstraintKey]) -> impl Iterator<Item = ContactState> {
        let is_left = |pair: &ClosedPair| keys.binary_search(&pair.key).is_err();
        keys.iter().map(move |&key| match self.find(key) {
            Some(pair) => pair.state,
            None if self.of_slave(key.slave).iter().all(is_left) => self.state(key),
            None => ContactState::Open,
        })
    }

    /// The closed pairs of a slave node.
    pub fn of_slave(&self, slave: SlaveKey) -> &[ClosedPair] {
        let from = self.0.partition_point(|pair| pair.key.slave < slave);
        let is_own = |pair: &&ClosedPair| pair.key.slave == slave;
        let count = self.0[from..].iter().take_while(is_own).count();
        &self.0[from..from + count]
    }

    fn find(&self, key: ConstraintKey) -> Option<&ClosedPair> {
        let place = self.0.binary_search_by_key(&key, |pair| pair.key).ok()?;
        Some(&self.0[place])
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::*;

    fn pair(state: ContactState, slips: bool, pt: f64) -> ClosedPair {
        ClosedPair {
            force: [2.0, pt],
            mu: 0.5,
            state,
            slips,
            ..testing::closed_pair(0, 0)
        }
    }

    #[test]
    fn too_little_friction_is_out_of_the_cone_where_a_pair_slips() {
        let out = |slips, pt| pair(ContactState::SlipPlus, slips, pt).out_of_cone(0.5);
        assert_eq!([1.25, -1.25].map(|pt| out(false, pt)), [0.25; 2]);
        assert_eq!([1.25, -0.75].map(|pt| out(true, pt)), [0.25; 2]);
        assert_eq!(out(false, 0.75), -0.25);
    }

    #[test]
    fn only_a_pair_at_its_limit_slips_and_one_without_friction_always() {
        let slips = |state, mu, has_moved| {
            let mut closed = ClosedPairs(vec![ClosedPair {
                mu,
                ..pair(state, true, 1.0)
            }]);
            closed.mark_slips(|_| has_moved);
            assert_eq!(closed.sticking(), usize::from(!closed.0[0].slips));
            closed.0[0].slips
        };
        assert!(!slips(ContactState::Stick, 0.5, true));
        assert!(slips(ContactState::SlipMinus, 0.5, true));
        assert!(!slips(ContactState::SlipMinus, 0.5, false));
        assert!(slips(ContactState::SlipMinus, 0.0, false));
    }

    use crate::contact::testing::{closed_pair, key};

    #[test]
    fn a_node_hands_its_state_on_only_to_a_segment_that_it_has_come_to() {
        let before: ClosedPairs = [closed_pair(0, 0), closed_pair(1, 0)].into_iter().collect();
        // node 0 still has its closed pair, node 1 has left it
        let keys = [key(0, 0), key(0, 1), key(1, 1), key(2, 0)];
        let states: Vec<ContactState> = before.states_among(&keys).collect();
        let [open, stick] = [ContactState::Open, ContactState::Stick];
        assert_eq!(states, [stick, open, stick, open]);
        assert_eq!(before.own_state(key(1, 1)), open);
        assert_eq!(before.state(key(1, 1)), stick);
    }
}
