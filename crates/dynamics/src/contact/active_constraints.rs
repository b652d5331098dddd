//! Active constraints of a subincrement in event-driven integration. See docs/theory/impacts.md,
//! Impacts as events, items 1 and 4.

use super::closed_pairs::ClosedPairs;
use super::constraint::Constraint;
use super::keys::{ConstraintKey, NodeAtSegment, SlaveKey};
use super::positions::Positions;
use super::projection::Projection;
use super::search::{ListedSlave, Search};
use super::target::{Segment, Target};
use super::tolerances::{CLOSED_GAP, FACING_ALIKE_COSINE, INITIAL_DEPTH, PROJECTION_BEYOND_ENDS};

/// Choice of the pairs that are constraints in a subincrement.
#[derive(Clone, Copy)]
pub enum ConstraintSet<'a> {
    /// All pairs are constraints: nodes land within the subincrement.
    All,
    /// Only the active pairs are constraints; nodes of the other pairs land at the end of the
    /// subincrement, at the next impact.
    Active(&'a ActiveConstraints),
}

impl ConstraintSet<'_> {
    /// Keeps the chosen pairs among the constraints and moves all others to `left_out`; `start` are
    /// the positions at the start of the subincrement.
    pub fn split(
        self,
        start: Positions,
        constraints: &mut Vec<Constraint>,
        left_out: &mut Vec<Constraint>,
    ) {
        left_out.clear();
        if let ConstraintSet::Active(active) = self {
            let is_free = |constraint: &mut Constraint| !active.is_held(start, constraint);
            left_out.extend(constraints.extract_if(.., is_free));
        }
    }

    /// Keys of the pairs that touch at the start because the previous subincrement ended at their impact, in increasing
    /// order.
    pub fn touching(self) -> Vec<ConstraintKey> {
        match self {
            ConstraintSet::All => Vec::new(),
            ConstraintSet::Active(active) => {
                let nodes = active.touching.iter().map(|touching| touching.pair.key);
                let means = active.means.iter().filter(|mean| mean.touches);
                let mut keys: Vec<_> = nodes.chain(means.map(|mean| mean.key)).collect();
                keys.sort_unstable();
                keys
            }
        }
    }
}

/// The pairs that are constraints in a subincrement between impacts: the pairs that touch at its start, and the pairs
/// that have become active since.
///
/// There is no impact where a touching node slides on to a segment that faces nearly the same way, or that the node was
/// not in front of. A node that slides into a wall lands on the wall at a later impact. With surface to surface there
/// is no impact where faces come over the end of a run of segments without a gap.
#[derive(Debug, Clone, Default)]
pub struct ActiveConstraints {
    /// The pairs that touch at the start, with increasing keys.
    touching: Vec<Touching>,
    /// Mean gaps at the start (surface to surface), with increasing keys.
    means: Vec<MeanAtStart>,
    /// Slave nodes that have joined the constraints, with all their segments, in increasing order.
    joined: Vec<SlaveKey>,
}

/// A constraint with surface to surface at the start.
#[derive(Debug, Clone, Copy)]
struct MeanAtStart {
    key: ConstraintKey,
    touches: bool,
}

/// A slave node and a segment that touch each other, with the normal of the segment.
#[derive(Debug, Clone, Copy)]
struct Touching {
    pair: NodeAtSegment,
    normal: [f64; 2],
}

impl ActiveConstraints {
    /// Active constraints at the displacements `u0`, which the search covers: the pairs that touch at these
    /// displacements. `means` are the constraints of contact from surface to surface at `u0`, `before` the pairs that
    /// carried forces up to the start. Discs are always active: they land within the subincrement.
    pub fn new(search: &Search, u0: &[f64], means: &[Constraint], before: &ClosedPairs) -> Self {
        let start = Positions::new(search.coordinates(), u0);
        let mean = |c: &Constraint| MeanAtStart {
            key: c.key,
            touches: c.gap <= CLOSED_GAP * c.scale || before.closes(c.key),
        };
        let mut active = ActiveConstraints {
            means: means.iter().map(mean).collect(),
            ..ActiveConstraints::default()
        };
        for listed in search.slaves() {
            if listed.surfaces.disc.is_some() {
                active.join(listed.key);
                continue;
            }
            for candidate in listed.candidates().filter(|_| listed.meets_segments()) {
                let pair = listed.at(candidate.segment);
                if let Some(normal) = touched_normal(start, &listed, pair, before) {
                    active.add(pair, normal);
                }
            }
        }
        active
    }

    /// Makes a constraint active whose mean gap closes soon after the start (surface to surface).
    pub fn join_mean_at_start(&mut self, key: ConstraintKey) {
        let joined = MeanAtStart { key, touches: true };
        match self.means.binary_search_by_key(&key, |mean| mean.key) {
            Ok(place) => self.means[place] = joined,
            Err(place) => self.means.insert(place, joined),
        }
        self.join(key.slave);
    }

    /// Makes a slave node active that lands soon after the start.
    pub fn join_at_start(&mut self, pair: NodeAtSegment, normal: [f64; 2]) {
        self.add(pair, normal);
        self.join(pair.key.slave);
    }

    /// Makes a slave node active, with all its segments, that lands within the subincrement.
    pub fn join(&mut self, slave: SlaveKey) {
        if let Err(at) = self.joined.binary_search(&slave) {
            self.joined.insert(at, slave);
        }
    }

    /// Whether a slave node has joined with all its segments.
    pub fn has_joined(&self, slave: SlaveKey) -> bool {
        self.joined.binary_search(&slave).is_ok()
    }

    /// Whether a slave node is kept out of a segment; `start` is its projection on the segment at the start.
    pub fn holds(&self, slave: SlaveKey, start: &Projection) -> bool {
        if self.has_joined(slave) {
            return true;
        }
        let from = (self.touching).partition_point(|touching| touching.pair.key.slave < slave);
        let is_own = |touching: &&Touching| touching.pair.key.slave == slave;
        let mut own = self.touching[from..].iter().take_while(is_own).peekable();
        let is_behind = start.gap <= CLOSED_GAP * start.length;
        let faces_alike = |Touching { normal: n, .. }: &Touching| {
            n[0] * start.normal[0] + n[1] * start.normal[1] >= FACING_ALIKE_COSINE
        };
        own.peek().is_some() && (is_behind || own.any(faces_alike))
    }

    /// Whether a constraint is active: its slave node is kept out of its segment or of a segment at its corner, or the
    /// node of the corner is kept out of a segment of the slave node. Two nodes that are each other's corner are one
    /// constraint. A constraint with surface to surface is active if its mean gap is closed, or if its faces have come
    /// over the end of the master without a gap. A disc is always active.
    pub fn is_held(&self, start: Positions, constraint: &Constraint) -> bool {
        let (slave, pair) = (constraint.key.slave, &constraint.source.pair);
        let is_held = |Segment {
                           ends: [a, b],
                           bulge,
                           ..
                       }: &Segment| {
            let place = start.place([pair.slave, *a, *b]);
            self.holds(slave, &bulge.below(place).raised(pair.allowed[0]))
        };
        match &constraint.source.target {
            Target::Segment(contact) => is_held(&contact.segment),
            Target::Corner(corner) => {
                is_held(&corner.before)
                    || is_held(&corner.behind)
                    || self.touches_end(corner.tip(), pair.slave)
            }
            Target::Mean(_) => self.touches_mean(constraint) || self.has_joined(slave),
            Target::Disc(_) => self.has_joined(slave),
        }
    }

    /// Whether the mean gap of a constraint is closed, or its faces have come over the end of the master without a gap.
    fn touches_mean(&self, constraint: &Constraint) -> bool {
        let before = (self.means).binary_search_by_key(&constraint.key, |mean| mean.key);
        match before {
            Ok(place) => self.means[place].touches,
            Err(_) => constraint.start_gap <= CLOSED_GAP * constraint.scale,
        }
    }

    /// Whether a slave node touches a segment that ends at another node.
    fn touches_end(&self, slave: usize, end: usize) -> bool {
        let mut pairs = self.touching.iter().map(|touching| touching.pair.nodes);
        pairs.any(|[s, a, b]| s == slave && [a, b].contains(&end))
    }

    /// Adds a pair that touches with the given normal.
    fn add(&mut self, pair: NodeAtSegment, normal: [f64; 2]) {
        let place = (self.touching).binary_search_by_key(&pair.key, |touching| touching.pair.key);
        if let Err(place) = place {
            self.touching.insert(place, Touching { pair, normal });
        }
    }
}

/// Normal of a segment that a slave node touches at the start, or touched `before`.
fn touched_normal(
    start: Positions,
    listed: &ListedSlave,
    pair: NodeAtSegment,
    before: &ClosedPairs,
) -> Option<[f64; 2]> {
    let [slave, a, b] = pair.nodes;
    if slave == a || slave == b {
        return None;
    }
    let bulge = &listed.surfaces.bulges[pair.key.segment];
    let p = bulge
        .below(start.place(pair.nodes))
        .raised(listed.allowed_where(|node| before.means_have(node))[0]);
    let is_inside = || {
        let at = |node: usize| start.of(node);
        let is_outside_chord = || p.gap + bulge.at(p.xi) >= 0.0;
        p.gap >= -CLOSED_GAP * p.length
            || is_outside_chord()
            || listed.surfaces.interior.takes_in([a, b], slave, at)
    };
    ((touches(&p) && is_inside()) || before.closes(pair.key)).then_some(p.normal)
}

fn touches(p: &Projection) -> bool {
    (-PROJECTION_BEYOND_ENDS..=1.0 + PROJECTION_BEYOND_ENDS).contains(&p.xi)
        && (-INITIAL_DEPTH * p.length..=CLOSED_GAP * p.length).contains(&p.gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLAVE: SlaveKey = SlaveKey {
        contact: 0,
        slave: 3,
    };
    const AT: NodeAtSegment = NodeAtSegment {
        key: ConstraintKey {
            slave: SLAVE,
            segment: 7,
        },
        nodes: [0, 1, 2],
    };

    /// Whether a node that touches a segment is kept out of a second segment in front of it. The normal of the first
    /// segment has the angle `direction`; the normal of the second is turned from it by the angle `turn`.
    fn is_held(direction: f64, turn: f64) -> bool {
        let normal = |angle: f64| [angle.cos(), angle.sin()];
        let mut active = ActiveConstraints::default();
        active.add(AT, normal(direction));
        let [x, y] = normal(direction + turn);
        let start = Projection {
            xi: -0.5,
            gap: 0.01,
            length: 1.0,
            tangent: [-y, x],
            normal: [x, y],
        };
        let other = SlaveKey { slave: 2, ..SLAVE };
        assert!(!active.holds(other, &start), "a node that touches nothing");
        active.holds(SLAVE, &start)
    }

    #[test]
    fn a_node_slides_round_a_bend_but_runs_against_a_wall() {
        for i in 0..16 {
            let direction = 0.3 + f64::from(i) * std::f64::consts::FRAC_PI_8;
            // a circle of chords of one degree turns by 0.0175 from chord to chord
            for turn in [-0.0175, -0.01, 0.0, 0.01, 0.0175] {
                assert!(is_held(direction, turn), "{direction} {turn}");
            }
            for turn in [-1.5, -0.1, -0.021, 0.021, 0.1, 1.5] {
                assert!(!is_held(direction, turn), "{direction} {turn}");
            }
        }
    }

    #[test]
    fn a_corner_is_held_by_either_of_its_nodes() {
        let mut active = ActiveConstraints::default();
        active.add(AT, [1.0, 0.0]);
        // node 0 touches the segment from 1 to 2
        for (slave, end, is_held) in [(0, 1, true), (0, 2, true), (0, 3, false), (1, 0, false)] {
            assert_eq!(active.touches_end(slave, end), is_held, "{slave} {end}");
        }
    }

    #[test]
    fn what_touches_is_told_by_parts_of_the_length_of_the_segment() {
        for length in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            let at = |part: f64| Projection {
                xi: 0.5,
                gap: part * length,
                length,
                tangent: [-1.0, 0.0],
                normal: [0.0, 1.0],
            };
            for (part, is_touched) in [(5e-10, true), (2e-9, false), (-1e-3, true), (-3e-3, false)]
            {
                assert_eq!(touches(&at(part)), is_touched, "{part:e} {length:e}");
            }
            // a wall that a node was not in front of stops the node like any other segment that it
            // touches
            let mut active = ActiveConstraints::default();
            active.add(AT, [1.0, 0.0]);
            for (part, is_held) in [(-0.1, true), (5e-10, true), (2e-9, false)] {
                assert_eq!(
                    active.holds(SLAVE, &at(part)),
                    is_held,
                    "{part:e} {length:e}"
                );
            }
        }
    }
}
