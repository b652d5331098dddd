//! Active constraints of a subincrement in event-driven integration. Section 6 of docs/theory.md,
//! Impacts as events, items 1 and 4.

use crate::contact::tolerances::{
    CLOSED_GAP, FACING_ALIKE_COSINE, INITIAL_DEPTH, PROJECTION_BEYOND_ENDS,
};
use crate::contact::{
    ClosedPair, ClosedPairs, Constraint, ConstraintKey, ListedSlave, Projection, Search,
};
use crate::dynamics::step::StepProblem;

/// Relative difference of lengths between which subincrements between impacts share the factors of K*.
const SAME_LENGTH: f64 = 1e-3;

/// Which pairs are constraints in a subincrement.
#[derive(Clone, Copy)]
pub(crate) enum ConstraintSet<'a> {
    /// All pairs: nodes land within the subincrement.
    All,
    /// The active ones: nodes of the others land at its end, at the next impact.
    Active(&'a ActiveConstraints),
}

impl ConstraintSet<'_> {
    /// Leaves the constraints that count; writes the others.
    pub fn split(
        self,
        problem: &StepProblem,
        u0: &[f64],
        constraints: &mut Vec<Constraint>,
        left_out: &mut Vec<Constraint>,
    ) {
        left_out.clear();
        if let ConstraintSet::Active(active) = self {
            let is_free = |constraint: &mut Constraint| !active.is_held(problem, u0, constraint);
            left_out.extend(constraints.extract_if(.., is_free));
        }
    }

    /// The pairs that touch at the start because an impact ended the subincrement before.
    pub fn touching(self) -> ClosedPairs {
        match self {
            ConstraintSet::All => ClosedPairs::default(),
            ConstraintSet::Active(active) => active.touching.clone(),
        }
    }

    /// Relative difference of lengths within which factors of K* are kept: the trials for the time of
    /// an impact differ by little.
    pub fn length_tolerance(self) -> f64 {
        match self {
            ConstraintSet::All => 0.0,
            ConstraintSet::Active(_) => SAME_LENGTH,
        }
    }
}

/// A slave node and a segment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NodeAtSegment {
    /// Place of the slave node among all slave nodes of all contacts.
    pub slave_index: usize,
    /// Segment in its contact.
    pub segment: usize,
    /// The slave node and the ends of the segment.
    pub nodes: [usize; 3],
}

impl NodeAtSegment {
    /// A slave node of the search with one of its segments.
    pub fn new(listed: &ListedSlave, segment: usize) -> Self {
        let [a, b] = listed.surfaces.segments[segment];
        NodeAtSegment {
            slave_index: listed.slave_index,
            segment,
            nodes: [listed.node(), a, b],
        }
    }
}

/// The pairs that are constraints in a subincrement between impacts: those that touch at its start,
/// and those that have joined them.
///
/// A node that touches may slide on to other segments that face nearly the same way, or that it was
/// not in front of; that is no impact. One that runs against a wall meets it later.
#[derive(Debug, Clone, Default)]
pub(crate) struct ActiveConstraints {
    /// The pairs of slave nodes and segments that touch at the start.
    touching: ClosedPairs,
    /// Normals of these segments, in the same order.
    normals: Vec<[f64; 2]>,
    /// Slave node and ends of the segment of these pairs; increasing.
    nodes: Vec<[usize; 3]>,
    /// Slave indices that have joined, with all their segments; increasing.
    joined: Vec<usize>,
}

impl ActiveConstraints {
    /// The pairs that touch in the displacements `u0`, which the search covers; `before` are those
    /// that carried forces up to then.
    pub fn new(problem: &StepProblem, search: &Search, u0: &[f64], before: &ClosedPairs) -> Self {
        let mut active = ActiveConstraints::default();
        for listed in search.slaves() {
            for candidate in listed.candidates() {
                let segment = candidate.segment;
                if let Some(normal) = touched_normal(problem, u0, &listed, segment, before) {
                    active.add(NodeAtSegment::new(&listed, segment), normal);
                }
            }
        }
        active
    }

    /// Takes in a slave node that lands soon after the start.
    pub fn join_at_start(&mut self, pair: NodeAtSegment, normal: [f64; 2]) {
        self.add(pair, normal);
        self.join(pair.slave_index);
    }

    /// Takes in a slave node that lands within the subincrement.
    pub fn join(&mut self, slave_index: usize) {
        if let Err(at) = self.joined.binary_search(&slave_index) {
            self.joined.insert(at, slave_index);
        }
    }

    /// Whether a slave node has joined with all its segments.
    pub fn has_joined(&self, slave_index: usize) -> bool {
        self.joined.binary_search(&slave_index).is_ok()
    }

    /// Whether a slave node is kept out of a segment that has the place `start` relative to it at the
    /// start.
    pub fn holds(&self, slave_index: usize, start: &Projection) -> bool {
        if self.has_joined(slave_index) {
            return true;
        }
        let own = &self.normals[self.touching.range_of_slave(slave_index)];
        let is_behind = start.gap <= CLOSED_GAP * start.length;
        let faces_alike =
            |n: &[f64; 2]| n[0] * start.normal[0] + n[1] * start.normal[1] >= FACING_ALIKE_COSINE;
        !own.is_empty() && (is_behind || own.iter().any(faces_alike))
    }

    /// Whether the slave node of a constraint is kept out of its segment, or of one of those at its corner,
    /// or the node of the corner out of a segment of the slave node: two nodes that are each other's corner
    /// are one constraint.
    pub fn is_held(&self, problem: &StepProblem, u0: &[f64], constraint: &Constraint) -> bool {
        let source = &constraint.source;
        let [s, a, b, c] = source.nodes;
        let is_held = |nodes| self.holds(source.slave_index, &problem.place(u0, nodes));
        is_held([s, a, b])
            || (source.target.corner.is_some() && (is_held([s, b, c]) || self.touches_end(b, s)))
    }

    /// Whether a slave node touches a segment that ends at another node.
    fn touches_end(&self, slave: usize, end: usize) -> bool {
        let from = self.nodes.partition_point(|[s, _, _]| *s < slave);
        let own = self.nodes[from..]
            .iter()
            .take_while(|[s, _, _]| *s == slave);
        own.into_iter().any(|[_, a, b]| [*a, *b].contains(&end))
    }

    /// Adds a pair that touches with the given normal.
    fn add(&mut self, at: NodeAtSegment, normal: [f64; 2]) {
        let pair = ClosedPair::touching(at.slave_index, at.segment);
        if let Err(place) = self.touching.position(pair.key) {
            self.touching.insert(pair);
            self.normals.insert(place, normal);
        }
        if let Err(place) = self.nodes.binary_search(&at.nodes) {
            self.nodes.insert(place, at.nodes);
        }
    }
}

/// Normal of a segment that a slave node touches at the displacements `u0`, or touched `before`.
fn touched_normal(
    problem: &StepProblem,
    u0: &[f64],
    listed: &ListedSlave,
    segment: usize,
    before: &ClosedPairs,
) -> Option<[f64; 2]> {
    let (surfaces, slave) = (listed.surfaces, listed.node());
    let [a, b] = surfaces.segments[segment];
    if slave == a || slave == b {
        return None;
    }
    let p = problem.place(u0, [slave, a, b]);
    let is_inside = || {
        let at = |node: usize| problem.position(u0, node);
        p.gap >= -CLOSED_GAP * p.length || surfaces.interior.takes_in([a, b], slave, at)
    };
    let key = ConstraintKey {
        slave_index: listed.slave_index,
        segment,
    };
    ((touches(&p) && is_inside()) || before.closes(key)).then_some(p.normal)
}

fn touches(p: &Projection) -> bool {
    (-PROJECTION_BEYOND_ENDS..=1.0 + PROJECTION_BEYOND_ENDS).contains(&p.xi)
        && (-INITIAL_DEPTH * p.length..=CLOSED_GAP * p.length).contains(&p.gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: NodeAtSegment = NodeAtSegment {
        slave_index: 3,
        segment: 7,
        nodes: [0, 1, 2],
    };

    /// Whether a node that touches a segment is held by another, which it is in front of, turned from
    /// the first by an angle.
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
        assert!(!active.holds(2, &start), "a node that touches nothing");
        active.holds(3, &start)
    }

    #[test]
    fn a_node_slides_round_a_bend_but_runs_against_a_wall() {
        for i in 0..16 {
            let direction = 0.3 + f64::from(i) * std::f64::consts::FRAC_PI_8;
            // 0.0175 is the turn of a circle in chords of a degree
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
            // a wall that a node was not in front of stops it as any other segment that it touches
            let mut active = ActiveConstraints::default();
            active.add(AT, [1.0, 0.0]);
            for (part, is_held) in [(-0.1, true), (5e-10, true), (2e-9, false)] {
                assert_eq!(active.holds(3, &at(part)), is_held, "{part:e} {length:e}");
            }
        }
    }
}
