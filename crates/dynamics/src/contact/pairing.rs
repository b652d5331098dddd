//! Pairing: the contact targets of all slave nodes at an iterate, from the candidates of the
//! search and the pairs of the pass before. See docs/theory/geometry.md, Contact targets.

use smallvec::SmallVec;

use super::closed_pairs::ClosedPairs;
use super::constraint::{Constraint, RowForm};
use super::disc;
use super::positions::Positions;
use super::search::{ListedSlave, Search};
use super::slave_node::SlaveNode;
use super::surface_to_surface::find_points;
use super::target::{
    ContactTarget, ContactTargets, Corner, CornerContact, Pair, PairTarget, Segment,
    SegmentContact, Target,
};
use super::tolerances::{CLOSED_GAP, KEPT_BEYOND_ENDS};

/// Choice of the slave nodes whose pairs are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlaveChoice {
    /// All slave nodes.
    #[default]
    All,
    /// The slave nodes that may touch a segment after the next correction, and all slave nodes with a mean gap (surface
    /// to surface) or a disc.
    Near,
    /// The others.
    Far,
}

impl SlaveChoice {
    /// Whether a slave node is chosen at the given positions. A node with a pair counts as near, since the pair may
    /// have brought it deep into a body.
    fn takes(self, listed: &ListedSlave, now: Positions, has_pair: bool) -> bool {
        let is_far = || !has_pair && listed.is_far(now);
        match self {
            SlaveChoice::All => true,
            SlaveChoice::Near => !is_far(),
            SlaveChoice::Far => is_far(),
        }
    }
}

/// Writes the pairs of the chosen slave nodes of all contacts, with increasing keys, between the displacements `u0` of
/// the start and `u` of an iterate, which the search covers. `before` are the constraints of the last pass, also with
/// increasing keys. `closed_at_start` are the pairs closed at the start. Nodes keep targets up to the overrun `kept`
/// beyond the ends (segment lengths), even if they are at other targets, so that passes converge that go to and fro
/// across a corner.
///
/// Pairs of contact from surface to surface are points of slave faces, whose rows have the given form.
///
/// A node that has just left its segment by a little and finds no other target keeps this segment. The end of the
/// increment decides whether the node has slid off, not one of the passes.
pub fn find_targets(
    search: &Search,
    [u0, u]: [&[f64]; 2],
    before: &[Constraint],
    (closed_at_start, kept): (&ClosedPairs, Option<f64>),
    (form, choice): (RowForm, SlaveChoice),
    pairs: &mut Vec<PairTarget>,
) {
    let [start, now] = [u0, u].map(|u| Positions::new(search.coordinates(), u));
    let mut before = before
        .iter()
        .map(|constraint| &constraint.source)
        .peekable();
    pairs.clear();
    let mut corners = Corners::new();
    for listed in search.slaves() {
        let closed_on = closed_at_start.of_slave(listed.key);
        while (before.next_if(|source| source.pair.key.slave < listed.key)).is_some() {}
        let is_own = |source: &&PairTarget| source.pair.key.slave == listed.key;
        let has_pair = before.peek().is_some_and(is_own);
        let is_chosen = choice.takes(&listed, now, has_pair || !closed_on.is_empty());
        if listed.surfaces.slave_segments.is_some() {
            if listed.number == 0 && is_chosen {
                find_points(listed.territory(), [start, now], form, pairs);
            }
            continue;
        }
        if !is_chosen {
            continue;
        }
        if listed.surfaces.disc.is_some() {
            disc::find_targets(&listed, [start, now], pairs);
            continue;
        }
        let selected = |source: &PairTarget| source.target.selected();
        let closed_on: ContactTargets = (closed_on.iter())
            .filter_map(|pair| selected(&pair.source))
            .collect();
        let node = SlaveNode {
            surfaces: listed.surfaces,
            start,
            now,
            slave: listed.number,
            closed_on: &closed_on,
            allowed: listed.allowed(),
        };
        let found = node.targets(listed.candidates());
        let mut own = ContactTargets::new();
        while let Some(source) = before.next_if(is_own) {
            own.extend(selected(source));
        }
        let keeps = !own.is_empty() && (kept.is_some() || found.is_empty());
        if keeps {
            keep(&node, &found, kept.unwrap_or(KEPT_BEYOND_ENDS), &mut own);
        }
        for &target in if keeps { &own } else { &found } {
            let pair = pair_target(&listed, target, (start, form), closed_at_start);
            if node.meets_corner(&target) {
                corners.extend(pair.at_corner());
            }
            pairs.push(pair);
        }
    }
    remove_twins(&corners, pairs);
}

/// Writes only the pairs with a mean gap (surface to surface), between the displacements `u0` and `u`, with increasing
/// keys.
pub fn find_means(
    search: &Search,
    [u0, u]: [&[f64]; 2],
    form: RowForm,
    pairs: &mut Vec<PairTarget>,
) {
    let positions = [u0, u].map(|u| Positions::new(search.coordinates(), u));
    pairs.clear();
    for territory in search.territories() {
        find_points(territory, positions, form, pairs);
    }
}

/// Keeps the targets of the last pass that the node is still over, and adds the found targets that are beyond these.
/// Corners get the weights of the iterate; the vertex of a hollow that the node has left becomes its two segments.
fn keep(node: &SlaveNode, found: &ContactTargets, beyond: f64, targets: &mut ContactTargets) {
    targets.retain(|target| node.is_over(target, beyond));
    for place in 0..targets.len() {
        let target = targets[place];
        if let Some(corner) = target.corner
            && node.has_left_hollow(&target, found)
        {
            targets[place].corner = None;
            targets.push(ContactTarget::face(corner.next));
        }
    }
    let kept = targets.len();
    for target in found {
        let mut old = targets[..kept].iter_mut();
        match old.find(|old| node.is_same_face(old, target)) {
            None => targets.push(*target),
            Some(old) => old.take_weight(target),
        }
    }
    targets.sort_by_key(|target| target.segment);
    targets.dedup_by_key(|target| target.segment);
}

/// The pair of a slave node and a target. With surface to surface a corner may keep its overlap at the start, as a mean
/// gap may: a_j = max(-g_j0, 0), eq. (7.9). A corner that has slid on past a convex vertex lay behind the line of its
/// new segment at the start. The allowed overlap of such a corner is its overlap with the segment on which it was
/// closed.
fn pair_target(
    listed: &ListedSlave,
    target: ContactTarget,
    (start, form): (Positions, RowForm),
    closed_at_start: &ClosedPairs,
) -> PairTarget {
    let surfaces = listed.surfaces;
    let segment = |number: usize| Segment {
        number,
        ends: surfaces.segments[number],
        bulge: surfaces.bulges[number],
    };
    let before = segment(target.segment);
    let mut allowed = listed.allowed();
    if listed.is_corner() && form == RowForm::DiscreteGradient {
        allowed = listed.allowed_where(|node| closed_at_start.means_have(node));
        let closed_on = target.from.unwrap_or(target.segment);
        let place = surfaces.bulges[closed_on]
            .below(start.place(listed.at(closed_on).nodes))
            .raised(allowed[0]);
        if place.gap < -CLOSED_GAP * place.length {
            allowed = allowed.map(|overlap| overlap - place.gap);
        }
    }
    let pair = Pair {
        key: listed.at(target.segment).key,
        slave: listed.node(),
        allowed,
        is_of_master: listed.is_of_master(),
    };
    let target = match target.corner {
        None => Target::Segment(SegmentContact {
            segment: before,
            from: target.from.map(segment),
        }),
        Some(Corner { next, weight }) => {
            let ([_, tip], [_, c]) = (before.ends, surfaces.segments[next]);
            // at joined nodes the next segment begins with another node at the same place
            let behind = Segment {
                ends: [tip, c],
                ..segment(next)
            };
            Target::Corner(CornerContact {
                before,
                behind,
                weight,
            })
        }
    };
    PairTarget { pair, target }
}

/// Slave nodes with the corners that they meet; usually few nodes meet corners.
type Corners = SmallVec<[[usize; 2]; 8]>;

/// Removes one of the two pairs of nodes that are each other's corner.
fn remove_twins(corners: &Corners, pairs: &mut Vec<PairTarget>) {
    let is_twin =
        |[s, v]: [usize; 2]| s > v && corners.contains(&[s, v]) && corners.contains(&[v, s]);
    pairs.retain(|pair| !pair.at_corner().is_some_and(is_twin));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Configurations, ContactSurfaces, testing};

    #[test]
    fn slave_nodes_are_near_by_distance_by_motion_or_by_their_pair() {
        // a segment with its body below, and four nodes above it; those at 1/8 at most are near
        let heights = [0.0, 0.1, 0.2, 0.4];
        let mut x = vec![[1.0, 0.0], [0.0, 0.0]];
        x.extend(heights.map(|height| [0.5, height]));
        let contacts = [ContactSurfaces::new(vec![2, 3, 4, 5], &[], vec![[0, 1]])];
        let (u, form) = ([0.0; 12], RowForm::DiscreteGradient);
        let mut search = Search::new(&contacts, &x);
        search.cover(&u);
        let closed_at_start = (&ClosedPairs::default(), None);
        let pairs_of = |search: &Search, before: &[Constraint], choice: SlaveChoice| {
            let mut pairs = Vec::new();
            find_targets(
                search,
                [&u, &u],
                before,
                closed_at_start,
                (form, choice),
                &mut pairs,
            );
            pairs
        };
        let slaves = |search: &Search, before: &[Constraint], choice: SlaveChoice| {
            let pairs = pairs_of(search, before, choice).into_iter();
            pairs.map(|source| source.pair.slave).collect::<Vec<_>>()
        };
        assert_eq!(slaves(&search, &[], SlaveChoice::All), [2, 3, 4, 5]);
        assert_eq!(slaves(&search, &[], SlaveChoice::Near), [2, 3]);
        assert_eq!(slaves(&search, &[], SlaveChoice::Far), [4, 5]);

        let at = Configurations {
            form,
            x: &x,
            u0: &u,
            u: &u,
        };
        let last = pairs_of(&search, &[], SlaveChoice::Far).pop();
        let before = [Constraint::new(last.expect("a pair"), &at)];
        assert_eq!(slaves(&search, &before, SlaveChoice::Near), [2, 3, 5]);
        assert_eq!(slaves(&search, &before, SlaveChoice::Far), [4]);

        let mut v = [0.0; 12];
        v[9] = -0.12;
        search.start(&v, 1.0);
        search.cover(&u);
        assert_eq!(slaves(&search, &[], SlaveChoice::Near), [2, 3, 4]);
        assert_eq!(slaves(&search, &[], SlaveChoice::Far), [5]);
    }

    #[test]
    fn two_nodes_at_each_others_corner_are_one_pair_and_at_the_vertex_of_a_face_two() {
        // faces of two bodies, from right to left below and from left to right above, that touch in their middle nodes
        let pairs_of = |rise: f64| {
            let lower = [[2.0, -rise], [1.0, 0.0], [0.0, -rise]];
            let upper = [[0.0, rise], [1.0, 0.0], [2.0, rise]];
            let x = [lower, upper].concat();
            let faces = [[[0, 1], [1, 2]], [[3, 4], [4, 5]]];
            let contact = |slave: usize, own: usize| {
                ContactSurfaces::new(vec![slave], &faces[own], faces[1 - own].to_vec())
            };
            let contacts = [contact(1, 0), contact(4, 1)];
            let u = [0.0; 12];
            let mut search = Search::new(&contacts, &x);
            search.cover(&u);
            let closed_at_start = (&ClosedPairs::default(), None);
            let how = (RowForm::End, SlaveChoice::All);
            let mut pairs = Vec::new();
            find_targets(&search, [&u, &u], &[], closed_at_start, how, &mut pairs);
            pairs
        };
        for (rise, count) in [(0.0, 2), (4e-4, 2), (4e-3, 1), (0.5, 1)] {
            let pairs = pairs_of(rise);
            assert_eq!(pairs.len(), count, "{rise}");
            assert!(pairs.iter().all(|pair| pair.at_corner().is_some()));
        }
    }

    #[test]
    fn the_nearer_segment_at_a_corner_is_that_of_the_larger_weight() {
        let x = [[-1.0, 0.0], [0.0, 1.0], [0.0; 2], [1.0, 0.0]];
        let at = Configurations {
            form: RowForm::End,
            x: &x,
            u0: &[0.0; 8],
            u: &[0.0; 8],
        };
        let nearer = |source: PairTarget| Constraint::new(source, &at).nearer_pair().nodes;
        assert_eq!(nearer(testing::face()), [0, 1, 2]);
        assert_eq!(nearer(testing::corner([1, 2, 3], 0.3)), [0, 1, 2]);
        assert_eq!(nearer(testing::corner([1, 2, 3], 0.7)), [0, 2, 3]);
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
