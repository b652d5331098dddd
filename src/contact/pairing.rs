//! Pairing: the contact targets of all slave nodes at an iterate, from the candidates of the
//! search and the pairs of the pass before. Section 10 of docs/theory.md, Contact targets; what far nodes that keep theirs
//! gain stands in docs/numerics.md.

use smallvec::SmallVec;

use super::closed_pairs::ClosedPairs;
use super::constraint::{Constraint, RowForm};
use super::disc;
use super::geometry::Positions;
use super::keys::{NodeAtSegment, SlaveKey};
use super::search::{ListedSlave, Search};
use super::surface_to_surface::find_points;
use super::targets::{ContactTarget, PairTarget, SlaveNode, Targets};
use super::tolerances::{FAR, KEEPING_MOTION, KEPT_BEYOND_ENDS};
use crate::linear::{larger, largest};
use crate::vectors::{difference, dot};

/// The pairs of all contacts from pass to pass of an increment. A slave node that is far from all that it may touch,
/// beside what has moved since its targets were found, keeps them.
#[derive(Default)]
pub struct Pairing {
    /// Pairs of the last iterate, with increasing keys.
    pub pairs: Vec<PairTarget>,
    /// Those of the iterate before.
    last: Vec<PairTarget>,
    /// The last iterate U (length).
    u: Vec<f64>,
    /// Way of the nodes over all iterates, the sum of their largest motions from one to the next (length).
    way: f64,
    /// What every slave node had around it when its targets were found.
    clearances: Vec<Clearance>,
    /// Overrun up to which targets were kept in the last iterate (segment lengths).
    kept: Option<f64>,
}

/// Distance of a slave node from all that it may touch.
#[derive(Clone, Copy)]
struct Clearance {
    /// The distance when it was found (length).
    distance: f64,
    /// The way until then (length).
    way: f64,
    /// Whether it is no small part of an element.
    is_far: bool,
}

impl Clearance {
    /// That of a node of which nothing is known.
    const NONE: Self = Clearance {
        distance: 0.0,
        way: 0.0,
        is_far: false,
    };

    /// Whether the node may keep its targets.
    fn keeps(self, way: f64) -> bool {
        self.is_far && way - self.way < KEEPING_MOTION * self.distance
    }
}

impl Pairing {
    /// Begins an increment, in which all targets are found anew.
    pub fn begin(&mut self) {
        self.u.clear();
        self.clearances.clear();
        self.way = 0.0;
    }

    /// Finds the pairs of all contacts between the displacements `u0` of the start of an increment and `u`
    /// of an iterate, which the search covers, with increasing keys, as the constraints `before`,
    /// of the last pass. `held` are the pairs closed at the start.
    /// With `kept`, targets are kept up to this overrun beyond their ends (segment lengths) even if others hold the
    /// node now: passes that go to and fro across a corner come to rest with it.
    ///
    /// Of contacts from surface to surface the pairs are the points of slave faces, whose rows have the given form.
    ///
    /// A node that has just left its segment by a little and finds no other keeps it: whether it has
    /// slid off is decided by the end of the increment, not by one of its passes.
    pub fn find(
        &mut self,
        search: &Search,
        [u0, u]: [&[f64]; 2],
        before: &[Constraint],
        (held, kept): (&ClosedPairs, Option<f64>),
        form: RowForm,
    ) {
        let [start, now] = [u0, u].map(|u| Positions::new(search.coordinates(), u));
        self.advance(u);
        self.kept = kept;
        let Pairing {
            pairs,
            last,
            way,
            clearances,
            ..
        } = self;
        std::mem::swap(pairs, last);
        pairs.clear();
        let mut last = last.drain(..).peekable();
        let mut before = before
            .iter()
            .map(|constraint| &constraint.source)
            .peekable();
        for (k, listed) in search.slaves().enumerate() {
            if clearances.len() == k {
                clearances.push(Clearance::NONE);
            }
            let is_of_points = listed.surfaces.slave_segments.is_some();
            let is_disc = listed.surfaces.disc.is_some();
            let is_far = clearances[k].keeps(*way);
            if is_of_points || is_disc || is_far {
                if is_of_points && listed.number == 0 {
                    find_points(listed.territory(), [start, now], form, pairs);
                } else if is_disc {
                    disc::find_targets(&listed, [start, now], pairs);
                }
                while let Some(pair) = last.next_if(|pair| pair.key.slave <= listed.key) {
                    if is_far && pair.key.slave == listed.key {
                        pairs.push(pair);
                    }
                }
                while before
                    .next_if(|pair| pair.key.slave <= listed.key)
                    .is_some()
                {}
                continue;
            }
            let held_by = holding(&listed, held);
            let node = slave_node(&listed, [start, now], &held_by);
            let found = node.targets(listed.candidates());
            let reach = listed.least_reach();
            let distance = node.distance(listed.candidates()).min(reach) - largest(&node.allowed);
            clearances[k] = Clearance {
                distance,
                way: *way,
                is_far: distance >= FAR * reach,
            };
            let mut own = Targets::new();
            while let Some(pair) = before.next_if(|pair| pair.key.slave <= listed.key) {
                own.push(pair.target);
            }
            while last.next_if(|pair| pair.key.slave <= listed.key).is_some() {}
            let targets = with_kept(&node, found, own, kept);
            pairs.extend(targets.iter().map(|target| pair_target(&listed, *target)));
        }
        drop(last);
        remove_twins(pairs);
    }

    /// The nodes that kept their targets in the last iterate U, and carry no force, with the pairs that they have in it.
    pub fn renewed(
        &self,
        search: &Search,
        u0: &[f64],
        [held, closed]: [&ClosedPairs; 2],
    ) -> (Vec<SlaveKey>, Vec<PairTarget>) {
        let [start, now] = [u0, &self.u].map(|u| Positions::new(search.coordinates(), u));
        let (mut slaves, mut pairs) = (Vec::new(), Vec::new());
        let mut last = self.pairs.iter().peekable();
        for (listed, clearance) in search.slaves().zip(&self.clearances) {
            let mut own = Targets::new();
            while let Some(pair) = last.next_if(|pair| pair.key.slave <= listed.key) {
                own.push(pair.target);
            }
            let has_kept = clearance.way < self.way && clearance.keeps(self.way);
            if has_kept && closed.of_slave(listed.key).is_empty() {
                let held_by = holding(&listed, held);
                let node = slave_node(&listed, [start, now], &held_by);
                let found = node.targets(listed.candidates());
                let targets = with_kept(&node, found, own, self.kept);
                slaves.push(listed.key);
                pairs.extend(targets.iter().map(|target| pair_target(&listed, *target)));
            }
        }
        remove_twins(&mut pairs);
        (slaves, pairs)
    }

    /// Takes the next iterate, by whose largest motion the way grows.
    fn advance(&mut self, u: &[f64]) {
        self.way += largest_motion([&self.u, u], [0.0; 2]);
        self.u.clear();
        self.u.extend_from_slice(u);
    }

    /// Which slave nodes, by their place in the search, have no segment near their paths from `u0` to `u1`: nearer than
    /// twice the way of node and segment on them.
    pub(super) fn free_paths(&self, [u0, u1]: [&[f64]; 2]) -> impl Fn(usize) -> bool {
        let nodes = u0.len() / 2;
        let mean = [0, 1].map(|i| {
            let components = (0..nodes).map(|node| u1[2 * node + i] - u0[2 * node + i]);
            components.sum::<f64>() / nodes.max(1) as f64
        });
        let path = largest_motion([u0, u1], mean);
        let since = largest_motion([&self.u, u1], [0.0; 2]);
        move |slave| {
            let clearance = self.clearances.get(slave).unwrap_or(&Clearance::NONE);
            let left = clearance.distance - 2.0 * (self.way - clearance.way + since);
            left > 4.0 * path
        }
    }
}

/// Segments of the pairs of a slave node that were closed at the start.
fn holding(listed: &ListedSlave, held: &ClosedPairs) -> SmallVec<[usize; 4]> {
    let pairs = held.of_slave(listed.key).iter();
    pairs.map(|pair| pair.source.target.segment).collect()
}

/// A slave node in the positions of the start and of the iterate.
fn slave_node<'a>(
    listed: &ListedSlave<'_, 'a>,
    [start, now]: [Positions<'a>; 2],
    held_by: &'a [usize],
) -> SlaveNode<'a> {
    SlaveNode {
        surfaces: listed.surfaces,
        start,
        now,
        slave: listed.number,
        held_by,
        allowed: listed.allowed(),
    }
}

/// Largest motion of a node from some displacements to others, beside a common one (length).
fn largest_motion([from, to]: [&[f64]; 2], common: [f64; 2]) -> f64 {
    let nodes = from.as_chunks().0.iter().zip(to.as_chunks().0);
    let squares = nodes.map(|(from, to)| {
        let d = difference(common, difference(*from, *to));
        dot(d, d)
    });
    squares.fold(0.0, larger).sqrt()
}

/// The targets found, with those among the `own` ones of the pass before that the node keeps.
fn with_kept(node: &SlaveNode, found: Targets, mut own: Targets, kept: Option<f64>) -> Targets {
    if own.is_empty() || (kept.is_none() && !found.is_empty()) {
        return found;
    }
    keep(node, &found, kept.unwrap_or(KEPT_BEYOND_ENDS), &mut own);
    own
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
    let NodeAtSegment {
        key,
        nodes: [s, a, b],
    } = listed.at(target.segment);
    let c = target.corner.map_or(b, |v| surfaces.segments[v.next][1]);
    PairTarget {
        key,
        target,
        nodes: [s, a, b, c],
        from: target.from.map(|i| surfaces.segments[i]),
        allowed: listed.allowed(),
        points: Vec::new(),
        is_of_master: listed.is_of_master(),
        round: None,
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
    use crate::contact::{ContactSurfaces, Rows, targets::Corner, testing};

    #[test]
    fn a_node_keeps_its_targets_while_it_is_far_from_everything_beside_its_motion() {
        // two segments of a floor, from right to left, and a node 1 above
        let x = [[2.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.1, 1.0]];
        let contacts = [ContactSurfaces::new(vec![3], &[], vec![[0, 1], [1, 2]])];
        let (u0, none) = ([0.0; 8], ClosedPairs::default());
        let moved = |by: f64| {
            let mut u = u0;
            u[6] = -by;
            u
        };
        let mut search = Search::new(&contacts, &x);
        let mut pairing = Pairing::default();
        let mut found = |u: &[f64; 8], begins: bool| {
            search.cover(u);
            if begins {
                pairing.begin();
            }
            let form = RowForm::DiscreteGradient;
            pairing.find(&search, [&u0, u], &[], (&none, None), form);
            let segments = |pairs: &[PairTarget]| -> Vec<usize> {
                pairs.iter().map(|pair| pair.target.segment).collect()
            };
            let (slaves, renewed) = pairing.renewed(&search, &u0, [&none; 2]);
            let is_free = pairing.free_paths([&u0, u])(0);
            (
                segments(&pairing.pairs),
                slaves.len(),
                segments(&renewed),
                is_free,
            )
        };
        assert_eq!(found(&u0, true), (vec![0], 0, vec![], true));
        // within a quarter of the distance, over the next segment
        assert_eq!(found(&moved(0.22), false), (vec![0], 1, vec![1], false));
        // on by 0.08, and back by 0.3: each time the way is more than a quarter
        assert_eq!(found(&moved(0.3), false).0, [1]);
        assert_eq!(found(&u0, false).0, [0]);
        assert_eq!(found(&moved(0.22), false).0, [0]);
        assert_eq!(found(&moved(0.22), true).0, [1]);
    }

    #[test]
    fn the_nearer_segment_at_a_corner_is_that_of_the_larger_weight() {
        let nearer = |corner: Option<f64>| {
            let mut constraint = testing::made_up(&[0; 8], Rows::new(&[0.0; 8], &[0.0; 8]));
            constraint.source.nodes = [9, 1, 2, 3];
            constraint.source.target.corner = corner.map(|weight| Corner { next: 1, weight });
            constraint.nearer_pair().nodes
        };
        assert_eq!(nearer(None), [9, 1, 2]);
        assert_eq!(nearer(Some(0.3)), [9, 1, 2]);
        assert_eq!(nearer(Some(0.7)), [9, 2, 3]);
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
