//! Slave nodes whose contact goes to and fro from pass to pass: what keeps the passes from converging
//! where the forces of contact do not come to rest.

use std::collections::VecDeque;

use super::forces::ContactForces;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::results::Alternation;
use crate::lcp::ContactState;

/// Passes in which a slave node must have left a state and come back to it.
const PASSES: usize = 6;
/// Last passes, among those, in which its state must have changed.
const RECENT: usize = 3;

/// A closed pair after a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Touch {
    slave_index: usize,
    /// Slave, segment ends a and b.
    nodes: [usize; 3],
    state: ContactState,
}

/// Closed pairs after each of the last passes.
#[derive(Debug, Default)]
pub(super) struct ContactHistory {
    /// Those of one pass after the other.
    touches: Vec<Touch>,
    /// Their number in every pass.
    counts: VecDeque<usize>,
}

impl ContactHistory {
    /// Forgets the passes so far.
    pub fn clear(&mut self) {
        self.touches.clear();
        self.counts.clear();
    }

    /// Takes in the pairs after a pass.
    pub fn add(&mut self, contact: &ContactForces) {
        let touch = |(constraint, pair): (&Constraint, &ClosedPair)| {
            let [s, a, b, _] = constraint.source.nodes;
            Touch {
                slave_index: pair.key.slave_index,
                nodes: [s, a, b],
                // without friction it is all the same whether a pair slides
                state: match constraint.mu {
                    0.0 => ContactState::Stick,
                    _ => pair.state,
                },
            }
        };
        self.push(contact.acting().map(touch));
    }

    fn push(&mut self, touches: impl Iterator<Item = Touch>) {
        if self.counts.len() == PASSES
            && let Some(oldest) = self.counts.pop_front()
        {
            self.touches.drain(..oldest);
        }
        let before = self.touches.len();
        self.touches.extend(touches);
        self.counts.push_back(self.touches.len() - before);
        self.make_room();
    }

    /// Room for as many pairs in all passes as in the last.
    fn make_room(&mut self) {
        let of_pass = self.counts.back().copied().unwrap_or(0);
        let passes = PASSES - self.counts.len();
        self.touches.reserve(of_pass * passes);
        self.counts.reserve(passes);
    }

    /// Pairs of one pass after the other.
    fn passes(&self) -> impl Iterator<Item = &[Touch]> {
        let mut rest = self.touches.as_slice();
        self.counts.iter().map(move |&count| {
            let (pass, others) = rest.split_at(count);
            rest = others;
            pass
        })
    }

    /// The slave nodes that went to and fro, with increasing slave indices.
    pub fn alternations(&self) -> Vec<Alternation> {
        let all = self.touches.iter().map(|touch| touch.slave_index);
        let mut slaves: Vec<usize> = all.collect();
        slaves.sort_unstable();
        slaves.dedup();
        slaves
            .into_iter()
            .filter_map(|s| self.of_slave(s))
            .collect()
    }

    /// The two states between which a slave node went to and fro, if it did.
    fn of_slave(&self, slave_index: usize) -> Option<Alternation> {
        let own = |touches: &[Touch]| -> Vec<Touch> {
            let is_own = |touch: &&Touch| touch.slave_index == slave_index;
            touches.iter().filter(is_own).copied().collect()
        };
        let states: Vec<Vec<Touch>> = self.passes().map(own).collect();
        let recent = &states[states.len().saturating_sub(RECENT)..];
        if recent.windows(2).all(|pair| pair[0] == pair[1]) {
            return None;
        }
        // the latest pass with another state than the last, and whether the last state was there before it
        let last = states.last()?;
        let other = states.iter().rposition(|state| state != last)?;
        let came_back = |state: &[Vec<Touch>], at: usize| state[..at].contains(last);
        came_back(&states, other).then(|| alternation(&states[other], last))?
    }
}

/// What differs between two states of a slave node; none if nothing does.
fn alternation(p: &[Touch], q: &[Touch]) -> Option<Alternation> {
    let without = |p: &[Touch], q: &[Touch]| {
        let is_other = |touch: &&Touch| q.iter().all(|other| other.nodes != touch.nodes);
        p.iter().find(is_other).map(|touch| touch.nodes)
    };
    match (without(p, q), without(q, p)) {
        (Some([slave, a, b]), Some([_, c, d])) => Some(Alternation::Changing {
            slave,
            segments: [[a, b], [c, d]],
        }),
        (Some(nodes), None) | (None, Some(nodes)) => Some(Alternation::Closing(nodes)),
        (None, None) => {
            let slides = |touch: &&Touch| q.iter().all(|other| other != *touch);
            let pair = p.iter().find(slides)?;
            Some(Alternation::Sliding(pair.nodes))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ContactState::{SlipPlus, Stick};

    /// A node on segment number `segment`, of nodes `segment` and `segment + 1`.
    fn touch(slave_index: usize, segment: usize, state: ContactState) -> Touch {
        Touch {
            slave_index,
            nodes: [100 + slave_index, segment, segment + 1],
            state,
        }
    }

    fn alternations(passes: &[&[Touch]]) -> Vec<Alternation> {
        let mut history = ContactHistory::default();
        passes
            .iter()
            .for_each(|touches| history.push(touches.iter().copied()));
        history.alternations()
    }

    #[test]
    fn what_goes_to_and_fro_is_named() {
        let (a, b, slides) = (
            touch(1, 3, Stick),
            touch(1, 5, Stick),
            touch(1, 3, SlipPlus),
        );
        let rests = touch(4, 7, Stick);
        let nodes = [101, 3, 4];
        assert_eq!(
            alternations(&[&[a, rests], &[b, rests], &[a, rests]]),
            [Alternation::Changing {
                slave: 101,
                segments: [[5, 6], [3, 4]]
            }]
        );
        let closing = [Alternation::Closing(nodes)];
        assert_eq!(alternations(&[&[a], &[], &[a], &[]]), closing);
        assert_eq!(
            alternations(&[&[b], &[a, b], &[b]]),
            closing,
            "of two pairs"
        );
        assert_eq!(alternations(&[&[], &[], &[a], &[a], &[]]), closing);
        assert_eq!(
            alternations(&[&[a], &[slides], &[a]]),
            [Alternation::Sliding(nodes)]
        );
        let two = [
            Alternation::Closing(nodes),
            Alternation::Closing([104, 7, 8]),
        ];
        assert_eq!(alternations(&[&[a], &[rests], &[a]]), two);
    }

    #[test]
    fn what_comes_to_rest_is_not() {
        let (a, b) = (touch(1, 3, Stick), touch(1, 5, Stick));
        assert_eq!(alternations(&[]), []);
        assert_eq!(alternations(&[&[a], &[b], &[b]]), [], "it has slid on");
        assert_eq!(
            alternations(&[&[a], &[b], &[a], &[a], &[a]]),
            [],
            "at rest again"
        );
        let long_ago: [&[Touch]; 8] = [&[b], &[a], &[a], &[a], &[a], &[a], &[a], &[b]];
        assert_eq!(alternations(&long_ago), [], "six passes ago");
    }
}
