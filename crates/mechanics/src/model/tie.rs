//! Ties: nodes of a slave surface that follow the segments of a master surface at all times. Section 3 of
//! docs/theory.md, Ties.

use super::contact::Equation;
use super::side::Segment;
use crate::vectors::{cross, difference, distance, dot};

/// A slave surface that is tied to a master surface (a row of `*TIE`).
#[derive(Debug, Clone, PartialEq)]
pub struct Tie {
    /// Its name: that of the card, with the number of the row where there are several.
    pub name: String,
    /// Index of the slave surface.
    pub slave: usize,
    /// Index of the master surface.
    pub master: usize,
    /// Which slave nodes are tied.
    pub reach: TieReach,
    /// The tied nodes, in the order of the slave surface.
    pub nodes: Vec<TiedNode>,
}

/// Which nodes of a slave surface are tied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TieReach {
    /// Those no farther from the master than a part of the segment that they face (`NEAR`).
    Near,
    /// Those no farther from the master (length).
    Within(f64),
    /// Those of the node set with this index.
    Nodes(usize),
}

/// Largest distance of a tied node from the segment that it faces, in lengths of it, where the deck gives none.
pub const NEAR: f64 = 0.05;

/// Coordinates of a tied node beside its segment, in lengths of it, that count as 0 or 1.
const ROUND_OFF: f64 = 1e-9;

/// A node that follows a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TiedNode {
    /// The node.
    pub node: usize,
    /// The segment from a to b.
    pub segment: Segment,
    /// Coordinate along the segment, 0 at a and 1 at b.
    pub xi: f64,
    /// Coordinate across it, positive to the left, in lengths of the segment.
    pub eta: f64,
}

impl TiedNode {
    /// A node as it lies beside a segment at these places.
    pub fn new(node: usize, segment: Segment, x: &[[f64; 2]]) -> Self {
        let [a, b] = segment.map(|node| x[node]);
        let (e, r) = (difference(a, b), difference(a, x[node]));
        let square = dot(e, e);
        let snapped = |value: f64, to: f64| match (value - to).abs() < ROUND_OFF {
            true => to,
            false => value,
        };
        TiedNode {
            node,
            segment,
            xi: snapped(snapped(dot(r, e) / square, 0.0), 1.0),
            eta: snapped(cross(e, r) / square, 0.0),
        }
    }

    /// What its displacement in a direction follows:
    ///
    /// ```text
    /// u_s = ((1 - xi) I - eta J) u_a + (xi I + eta J) u_b,  J = [0 -1; 1 0]      eq. (3.11)
    /// ```
    pub fn equation(&self, direction: usize) -> Equation {
        let TiedNode {
            node,
            segment: [a, b],
            xi,
            eta,
        } = *self;
        // row of J: (J u)_x = -u_y, (J u)_y = u_x
        let (other, sign) = [(1, -1.0), (0, 1.0)][direction];
        let terms = [
            (2 * a + direction, 1.0 - xi),
            (2 * b + direction, xi),
            (2 * a + other, -sign * eta),
            (2 * b + other, sign * eta),
        ];
        Equation {
            dof: 2 * node + direction,
            terms: terms.into_iter().filter(|(_, c)| *c != 0.0).collect(),
        }
    }
}

/// The part of a segment nearest to a point: coordinate along it, clamped to the segment, and distance.
pub fn nearest_of(point: [f64; 2], [a, b]: [[f64; 2]; 2]) -> ([f64; 2], f64) {
    let e = difference(a, b);
    let xi = (dot(difference(a, point), e) / dot(e, e)).clamp(0.0, 1.0);
    let foot = [0, 1].map(|i| a[i] + xi * (b[i] - a[i]));
    (foot, distance(point, foot))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tied_node_turns_with_its_segment() {
        let x = [[1.0, 2.0], [3.0, 2.5], [1.7, 2.9]];
        let tied = TiedNode::new(2, [0, 1], &x);
        let (sin, cos) = 2.1_f64.sin_cos();
        let turned = x.map(|[x, y]| [cos * x - sin * y + 0.3, sin * x + cos * y - 4.0]);
        let u: Vec<f64> = (0..6)
            .map(|dof| turned[dof / 2][dof % 2] - x[dof / 2][dof % 2])
            .collect();
        for direction in 0..2 {
            let Equation { dof, terms } = tied.equation(direction);
            let follows: f64 = terms.iter().map(|&(to, c)| c * u[to]).sum();
            assert!((follows - u[dof]).abs() < 1e-14);
        }
    }

    #[test]
    fn a_node_on_a_node_follows_it_alone() {
        let x = [[0.0, 0.0], [0.3, 0.1], [0.3, 0.1 + 1e-12]];
        let tied = TiedNode::new(2, [0, 1], &x);
        assert_eq!(tied.equation(0).terms, [(2, 1.0)]);
        assert_eq!(tied.equation(1).terms, [(3, 1.0)]);
    }
}
