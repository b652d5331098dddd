//! Pairing: the contact targets of all slave nodes at an iterate, from the candidates of the
//! search and the pairs of the pass before. Section 10 of docs/theory.md, Contact targets.

use smallvec::SmallVec;

use super::geometry::Positions;
use super::search::{ListedSlave, Search};
use super::targets::{ContactTarget, SlaveNode, Targets};
use super::tolerances::KEPT_BEYOND_ENDS;
use crate::model::Friction;

/// Which slave node meets which segment, or which corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairTarget {
    /// Place of the slave node among all slave nodes of all contacts.
    pub slave_index: usize,
    /// Segment in its contact, or corner.
    pub target: ContactTarget,
    /// Nodes: slave s, segment ends a and b, and c, the end of the next segment behind a corner;
    /// without corner it is b again.
    pub nodes: [usize; 4],
    /// Ends of the segment that held the node at the start, where it has slid on from there.
    pub from: Option<[usize; 2]>,
    /// Coulomb friction.
    pub friction: Friction,
}

impl PairTarget {
    /// Ends of its segment; at a corner, of that whose normal has the larger weight.
    pub fn nearer_segment(&self) -> [usize; 2] {
        let [_, a, b, c] = self.nodes;
        match self.target.corner {
            Some(corner) if corner.weight > 0.5 => [b, c],
            _ => [a, b],
        }
    }
}

/// Writes the pairs of all contacts between the displacements `u0` of the start of an increment and `u`
/// of an iterate, which the search covers; increasing by slave index and segment, as those `before`,
/// of the last pass. `held` are slave index and segment of the pairs closed at the start, increasing.
/// With `kept`, targets are kept up to this overrun beyond their ends (segment lengths) even if others hold the
/// node now: passes that go to and fro across a corner come to rest with it.
///
/// A node that has just left its segment by a little and finds no other keeps it: whether it has
/// slid off is decided by the end of the increment, not by one of its passes.
pub fn find_targets<'p>(
    search: &Search,
    [u0, u]: [&[f64]; 2],
    before: impl IntoIterator<Item = &'p PairTarget>,
    (held, kept): (&[[usize; 2]], Option<f64>),
    pairs: &mut Vec<PairTarget>,
) {
    let [start, now] = [u0, u].map(|u| Positions::new(search.coordinates(), u));
    let (mut before, mut held) = (before.into_iter().peekable(), held);
    pairs.clear();
    for listed in search.slaves() {
        let index = listed.slave_index;
        let others = |[slave, _]: &[usize; 2]| *slave > index;
        let (held_by, rest) = held.split_at(held.iter().position(others).unwrap_or(held.len()));
        held = rest;
        let node = SlaveNode {
            surfaces: listed.surfaces,
            start,
            now,
            slave: listed.slave,
            held_by,
        };
        let found = node.targets(listed.candidates());
        let mut own = Targets::new();
        while let Some(pair) = before.next_if(|pair| pair.slave_index <= index) {
            own.push(pair.target);
        }
        let keeps = !own.is_empty() && (kept.is_some() || found.is_empty());
        if keeps {
            keep(&node, &found, kept.unwrap_or(KEPT_BEYOND_ENDS), &mut own);
        }
        for &target in if keeps { &own } else { &found } {
            pairs.push(pair_target(&listed, target));
        }
    }
    remove_twins(pairs);
}

/// Leaves those of the targets that a slave node had in the pass before which it keeps, corners with the
/// weights of the iterate, and adds what is found beside them.
fn keep(node: &SlaveNode, found: &Targets, beyond: f64, targets: &mut Targets) {
    targets.retain(|target| node.is_over(target, beyond));
    let kept = targets.len();
    for target in found {
        let mut old = targets[..kept].iter_mut();
        match old.find(|old| node.is_same_face(old, target)) {
            None => targets.push(*target),
            Some(old) => old.take_weight(target),
        }
    }
    targets.sort_by_key(|target| target.segment);
}

fn pair_target(listed: &ListedSlave, target: ContactTarget) -> PairTarget {
    let surfaces = listed.surfaces;
    let [a, b] = surfaces.segments[target.segment];
    let c = target.corner.map_or(b, |v| surfaces.segments[v.next][1]);
    PairTarget {
        slave_index: listed.slave_index,
        target,
        nodes: [listed.node(), a, b, c],
        from: target.from.map(|i| surfaces.segments[i]),
        friction: surfaces.friction,
    }
}

/// Two nodes that are each other's corner are one pair.
fn remove_twins(pairs: &mut Vec<PairTarget>) {
    let with_corner = pairs.iter().filter(|pair| pair.target.corner.is_some());
    let corners = with_corner.map(|pair| [pair.nodes[0], pair.nodes[2]]);
    let corners: SmallVec<[[usize; 2]; 8]> = corners.collect();
    pairs.retain(|pair| {
        let [s, _, v, _] = pair.nodes;
        pair.target.corner.is_none() || s < v || !corners.contains(&[v, s])
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::targets::Corner;

    #[test]
    fn the_nearer_segment_at_a_corner_is_that_of_the_larger_weight() {
        let at = |corner: Option<f64>| PairTarget {
            slave_index: 0,
            target: ContactTarget {
                corner: corner.map(|weight| Corner { next: 1, weight }),
                ..ContactTarget::face(0)
            },
            nodes: [9, 1, 2, 3],
            from: None,
            friction: Friction::default(),
        };
        assert_eq!(at(None).nearer_segment(), [1, 2]);
        assert_eq!(at(Some(0.3)).nearer_segment(), [1, 2]);
        assert_eq!(at(Some(0.7)).nearer_segment(), [2, 3]);
    }

    #[test]
    fn a_corner_that_is_kept_takes_the_weight_of_the_iterate() {
        let corner = |segment, next, weight| ContactTarget {
            corner: Some(Corner { next, weight }),
            ..ContactTarget::face(segment)
        };
        let weight_after = |other: ContactTarget| {
            let mut kept = corner(4, 5, 0.2);
            kept.take_weight(&other);
            kept.corner.map(|corner| corner.weight)
        };
        assert_eq!(weight_after(corner(4, 5, 0.6)), Some(0.6));
        assert_eq!(weight_after(corner(5, 6, 0.6)), Some(0.2));
        assert_eq!(weight_after(ContactTarget::face(4)), Some(0.2));
    }
}
