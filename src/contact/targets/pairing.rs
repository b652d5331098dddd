//! Pairing: the contact targets of all slave nodes at an iterate, from the candidates of the
//! search and the pairs of the pass before. Section 10 of docs/theory.md, Targets.

use super::slave_node::SlaveNode;
use super::target_selection::{ContactTarget, Targets};
use crate::contact::geometry::position;
use crate::contact::search::{ListedSlave, Search};
use crate::contact::tolerances::{KEPT_BEYOND_ENDS, KEPT_WHEN_SETTLED};
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

/// The pairs of all contacts between the displacements `u0` of the start of an increment and `u` of
/// an iterate, which the search covers; increasing by slave index and segment, as those `before`,
/// of the last pass. `held` are slave index and segment of the pairs closed at the start, increasing.
/// Where the passes have `settled`, targets are kept even if others hold the node
/// now: passes that go to and fro across a corner come to rest with it.
///
/// A node that has just left its segment by a little and finds no other keeps it: whether it has
/// slid off is decided by the end of the increment, not by one of its passes.
pub fn find_targets(
    search: &Search,
    [u0, u]: [&[f64]; 2],
    before: &[PairTarget],
    held: &[[usize; 2]],
    settled: bool,
) -> Vec<PairTarget> {
    let x = search.coordinates();
    let positions =
        |u: &[f64]| -> Vec<[f64; 2]> { (0..x.len()).map(|n| position(x, u, n)).collect() };
    let (start, now) = (positions(u0), positions(u));
    let mut pairs: Vec<PairTarget> = Vec::new();
    let (mut old, mut held) = (before, held);
    for listed in search.slaves() {
        let of_node = |[slave, _]: &[usize; 2]| *slave <= listed.slave_index;
        let (held_by, rest) = held.split_at(held.partition_point(of_node));
        held = rest;
        let node = SlaveNode {
            surfaces: listed.surfaces,
            start: &start,
            now: &now,
            slave: listed.slave,
            held_by,
        };
        let is_own = |pair: &PairTarget| pair.slave_index <= listed.slave_index;
        let (own, rest) = old.split_at(old.partition_point(is_own));
        old = rest;
        let found = node.targets(listed.candidates());
        let targets = with_kept(&node, found, own, settled);
        pairs.extend(targets.iter().map(|&target| pair_target(&listed, target)));
    }
    without_twins(pairs)
}

/// Targets of a slave node, of which some of the pass before are kept.
fn with_kept(node: &SlaveNode, found: Targets, before: &[PairTarget], settled: bool) -> Targets {
    if before.is_empty() || (!settled && !found.is_empty()) {
        return found;
    }
    let mut targets: Targets = before.iter().map(|pair| pair.target).collect();
    let beyond = if settled {
        KEPT_WHEN_SETTLED
    } else {
        KEPT_BEYOND_ENDS
    };
    targets.retain(|target| node.is_over(target, beyond));
    let kept = targets.len();
    for target in found {
        if !targets[..kept]
            .iter()
            .any(|old| node.is_same_face(old, &target))
        {
            targets.push(target);
        }
    }
    targets.sort_by_key(|target| target.segment);
    targets
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
fn without_twins(mut pairs: Vec<PairTarget>) -> Vec<PairTarget> {
    let corners: Vec<[usize; 2]> = pairs
        .iter()
        .filter(|pair| pair.target.corner.is_some())
        .map(|pair| [pair.nodes[0], pair.nodes[2]])
        .collect();
    pairs.retain(|pair| {
        let [s, _, v, _] = pair.nodes;
        pair.target.corner.is_none() || s < v || !corners.contains(&[v, s])
    });
    pairs
}
