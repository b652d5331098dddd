//! Active constraints of a subincrement in event-driven integration. Section 6 of docs/theory.md,
//! Impacts as events, items 1 and 4.

use super::closed_pairs::ClosedPairs;
use crate::contact::tolerances::{
    CLOSED_GAP, FACING_ALIKE_COSINE, INITIAL_DEPTH, PROJECTION_BEYOND_ENDS,
};
use crate::contact::{Pair, Projection, Search};
use crate::dynamics::step::StepProblem;

/// The pairs that are constraints in a piece of an increment between impacts: those that touch at
/// its start, and those that have joined them.
///
/// A node that touches may slide on to other segments that face nearly the same way, or that it was
/// not in front of; that is no impact. One that runs against a wall meets it later.
#[derive(Debug, Clone, Default)]
pub(crate) struct ActiveConstraints {
    /// Slots and segments that touch at the start, increasing, with the normals of the segments.
    touching: Vec<([usize; 2], [f64; 2])>,
    /// Slots that have joined, with all their segments; increasing.
    joined: Vec<usize>,
}

impl ActiveConstraints {
    /// The pairs that touch in the displacements `u0`, which the search covers; `before` are those
    /// that carried forces up to then.
    pub fn new(problem: &StepProblem, search: &Search, u0: &[f64], before: &ClosedPairs) -> Self {
        let (mut touching, before) = (Vec::new(), before.keys());
        let mut slave_index = 0;
        for territory in search.territories() {
            let surfaces = territory.surfaces();
            for (k, &slave) in surfaces.slaves.iter().enumerate() {
                for candidate in territory.candidates(k) {
                    let [a, b] = surfaces.segments[candidate.segment];
                    if slave == a || slave == b {
                        continue;
                    }
                    let key = [slave_index, candidate.segment];
                    let p = problem.place(u0, [slave, a, b]);
                    let is_inside = || {
                        let at = |node: usize| problem.position(u0, node);
                        p.gap >= -CLOSED_GAP * p.length
                            || surfaces.interior.takes_in([a, b], slave, at)
                    };
                    if (touches(&p) && is_inside()) || before.binary_search(&key).is_ok() {
                        touching.push((key, p.normal));
                    }
                }
                slave_index += 1;
            }
        }
        ActiveConstraints {
            touching,
            joined: Vec::new(),
        }
    }

    /// Takes in a slave_index that lands soon after the start.
    pub fn join_at_start(&mut self, slave_index: usize, segment: usize, normal: [f64; 2]) {
        let key = [slave_index, segment];
        if let Err(at) = self.touching.binary_search_by_key(&key, |(key, _)| *key) {
            self.touching.insert(at, (key, normal));
        }
        self.join(slave_index);
    }

    /// Takes in a slave_index that lands within the piece.
    pub fn join(&mut self, slave_index: usize) {
        if let Err(at) = self.joined.binary_search(&slave_index) {
            self.joined.insert(at, slave_index);
        }
    }

    /// Slots and segments that touch at the start.
    pub fn keys(&self) -> Vec<[usize; 2]> {
        self.touching.iter().map(|(key, _)| *key).collect()
    }

    /// Whether a slave_index is kept out of a segment that has the place `start` relative to its node at
    /// the start.
    pub fn holds(&self, slave_index: usize, start: &Projection) -> bool {
        if self.joined.binary_search(&slave_index).is_ok() {
            return true;
        }
        let from = self
            .touching
            .partition_point(|(key, _)| key[0] < slave_index);
        let mut own = self.touching[from..]
            .iter()
            .take_while(|(key, _)| key[0] == slave_index)
            .peekable();
        let is_behind = start.gap <= CLOSED_GAP * start.length;
        let faces_alike =
            |n: &[f64; 2]| n[0] * start.normal[0] + n[1] * start.normal[1] >= FACING_ALIKE_COSINE;
        own.peek().is_some() && (is_behind || own.any(|(_, normal)| faces_alike(normal)))
    }

    /// The pairs that are constraints, and the others.
    pub fn split(&self, problem: &StepProblem, u0: &[f64], pairs: Vec<Pair>) -> [Vec<Pair>; 2] {
        let (held, free) = pairs.into_iter().partition(|pair| {
            let [s, a, b, c] = pair.target.nodes;
            let is_held = |nodes| self.holds(pair.target.slave_index, &problem.place(u0, nodes));
            is_held([s, a, b]) || (pair.target.target.corner.is_some() && is_held([s, b, c]))
        });
        [held, free]
    }
}

fn touches(p: &Projection) -> bool {
    (-PROJECTION_BEYOND_ENDS..=1.0 + PROJECTION_BEYOND_ENDS).contains(&p.xi)
        && (-INITIAL_DEPTH * p.length..=CLOSED_GAP * p.length).contains(&p.gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a node that touches a segment is held by another, which it is in front of, turned from
    /// the first by an angle.
    fn is_held(direction: f64, turn: f64) -> bool {
        let normal = |angle: f64| [angle.cos(), angle.sin()];
        let active = ActiveConstraints {
            touching: vec![([3, 7], normal(direction))],
            joined: Vec::new(),
        };
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
            for turn in [-0.01, 0.0, 0.01] {
                assert!(is_held(direction, turn), "{direction} {turn}");
            }
            for turn in [-1.5, -0.1, -0.02, 0.02, 0.1, 1.5] {
                assert!(!is_held(direction, turn), "{direction} {turn}");
            }
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
            let active = ActiveConstraints {
                touching: vec![([3, 7], [1.0, 0.0])],
                joined: Vec::new(),
            };
            for (part, is_held) in [(-0.1, true), (5e-10, true), (2e-9, false)] {
                assert_eq!(active.holds(3, &at(part)), is_held, "{part:e} {length:e}");
            }
        }
    }
}
