//! Ties: nodes of a slave surface that follow the segments of a master surface at all times, either each node by itself
//! or as a mean over its faces. See docs/theory/contact.md, Ties.

use super::contact::{ContactFormulation, Equation};
use super::side::{Segment, SideNodes};
use crate::vectors::{cross, difference, distance, dot};
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// A slave surface that is tied to a master surface (a row of `*TIE`).
#[derive(Debug, Clone, PartialEq)]
pub struct Tie {
    /// Name of the tie: the name of the card, with the number of the row if the card has several rows.
    pub name: String,
    /// Index of the slave surface.
    pub slave: usize,
    /// Index of the master surface.
    pub master: usize,
    /// Choice of the slave nodes that are tied.
    pub reach: TieReach,
    /// Part of the slave surface that follows: nodes, or means over the points of its faces.
    pub formulation: ContactFormulation,
    /// The tied nodes, in the order of the slave surface.
    pub nodes: Vec<TiedNode>,
    /// Sides of the slave surface that follow as means; empty with node to surface.
    pub sides: Vec<TiedSide>,
}

/// Dependence of a vertex, u = sum (alpha_l I + beta_l J) u_l: alpha_l and beta_l for the nodes l, where J is a
/// rotation by a right angle to the left.
pub type Follows = BTreeMap<usize, [f64; 2]>;

/// A side of a slave surface that follows the master as a mean.
#[derive(Debug, Clone, PartialEq)]
pub struct TiedSide {
    /// Nodes of the side from corner to corner. A mid-side node stands for the vertex x_v of eq. (3.21).
    pub nodes: SideNodes,
    /// The straight lines from each vertex to the next.
    pub lines: SmallVec<[TiedLine; 2]>,
}

/// A straight line of the slave surface, with integrals over the line. The line has one integral for each of its ends
/// j, with the dual functions psi_j.
#[derive(Debug, Clone, PartialEq)]
pub struct TiedLine {
    /// Weights D_j = sum w_q N_j of the ends: lengths, or in bodies of revolution areas divided by 2 pi.
    pub weights: [f64; 2],
    /// Sums of w_q psi_j (alpha_l I + beta_l J) over the points q of the line, with the alpha_l and beta_l of each
    /// point.
    pub follows: [Follows; 2],
}

/// Choice of the nodes of a slave surface that are tied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TieReach {
    /// Nodes whose distance from the master is at most a part (`NEAR`) of the segment that they
    /// face.
    Near,
    /// Nodes whose distance from the master is at most a given length.
    Within(f64),
    /// Nodes of the node set with the given index.
    Nodes(usize),
}

/// Largest distance of a tied node from the segment that it faces, in lengths of the segment, if the deck gives no
/// distance.
pub const NEAR: f64 = 0.05;

/// Difference up to which a coordinate of a tied node, in segment lengths, is set to 0 or 1.
const ROUND_OFF: f64 = 1e-9;

/// Value of a coefficient of a mean below which the coefficient counts as zero.
const NO_PART: f64 = 1e-14;

/// A node that follows a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TiedNode {
    /// The node.
    pub node: usize,
    /// The segment that the node follows, from a to b.
    pub segment: Segment,
    /// Coordinate along the segment, 0 at a and 1 at b.
    pub xi: f64,
    /// Coordinate across the segment, positive to the left, in lengths of the segment.
    pub eta: f64,
}

impl TiedNode {
    /// A tied node with its place at a segment, from the node positions `x`.
    pub fn new(node: usize, segment: Segment, x: &[[f64; 2]]) -> Self {
        let [xi, eta] = beside(x[node], segment.map(|node| x[node]));
        let snapped = |value: f64, to: f64| match (value - to).abs() < ROUND_OFF {
            true => to,
            false => value,
        };
        TiedNode {
            node,
            segment,
            xi: snapped(snapped(xi, 0.0), 1.0),
            eta: snapped(eta, 0.0),
        }
    }

    /// Equation for the displacement of a tied node in a direction:
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
        let (other, sign) = row_of_j(direction);
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

/// Row of the rotation J, as direction and sign: (J u)_x = -u_y, (J u)_y = u_x.
fn row_of_j(direction: usize) -> (usize, f64) {
    [(1, -1.0), (0, 1.0)][direction]
}

/// The condition for a slave vertex in one direction: D_j u_j is a sum of terms.
#[derive(Default)]
struct Mean {
    weight: f64,
    terms: BTreeMap<usize, f64>,
}

impl Mean {
    fn add(&mut self, dof: usize, c: f64) {
        *self.terms.entry(dof).or_insert(0.0) += c;
    }

    /// Adds the dependence of an end of a line.
    fn follow(&mut self, follows: &Follows, direction: usize) {
        let (other, sign) = row_of_j(direction);
        for (node, [alpha, beta]) in follows {
            self.add(2 * node + direction, *alpha);
            self.add(2 * node + other, sign * beta);
        }
    }
}

impl Tie {
    /// Equations for the displacements of the tied nodes in a direction, in the order of the nodes. A node of a tied
    /// side follows as a mean,
    ///
    /// ```text
    /// u_j = (1/D_j) sum_q w_q psi_j(q) u_q,   D_j = sum_q w_q N_j      eq. (3.34)
    /// ```
    ///
    /// with sums over the points q of the node's sides; all other nodes follow by [`TiedNode::equation`]. Kept nodes,
    /// which do not follow the master, have their own displacement. In the lines of a kept node i the function of the
    /// other end is 1 instead of psi_j:
    ///
    /// ```text
    /// D_j u_j + D_i u_i = sum_q w_q u_q
    /// ```
    ///
    /// With the value 1 the functions still add up to 1, so the tie transmits a uniform traction.
    pub fn equations(&self, direction: usize, is_kept: impl Fn(usize) -> bool) -> Vec<Equation> {
        let mut means: BTreeMap<usize, Mean> = BTreeMap::new();
        let mut corners: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
        for TiedSide { nodes, lines } in &self.sides {
            if let &[a, middle, b] = nodes.as_slice() {
                // a vertex x_v is no unknown of its own
                if is_kept(middle) {
                    continue;
                }
                corners.insert(middle, [a, b]);
            }
            for (ends, line) in nodes.windows(2).zip(lines) {
                for (own, other) in [(0, 1), (1, 0)] {
                    if is_kept(ends[own]) {
                        continue;
                    }
                    let mean = means.entry(ends[own]).or_default();
                    mean.weight += line.weights[own];
                    mean.follow(&line.follows[own], direction);
                    if is_kept(ends[other]) {
                        mean.follow(&line.follows[other], direction);
                        mean.add(2 * ends[other] + direction, -line.weights[other]);
                    }
                }
            }
        }
        let equation = |tied: &TiedNode| {
            let Some(Mean { weight, mut terms }) = means.remove(&tied.node) else {
                return tied.equation(direction);
            };
            let corners = corners.get(&tied.node);
            // u_m = 3/4 u_v + (u_a + u_b)/8
            let part = if corners.is_some() { 0.75 } else { 1.0 };
            terms.values_mut().for_each(|c| *c *= part / weight);
            for corner in corners.into_iter().flatten() {
                *terms.entry(2 * corner + direction).or_insert(0.0) += 0.125;
            }
            terms.retain(|_, c| c.abs() >= NO_PART);
            Equation {
                dof: 2 * tied.node + direction,
                terms: terms.into_iter().collect(),
            }
        };
        self.nodes.iter().map(equation).collect()
    }
}

/// Coordinates of a point along and across a segment from a to b, positive to the left, in lengths of the segment; zero
/// if the segment has no length.
pub fn beside(point: [f64; 2], [a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let (e, r) = (difference(a, b), difference(a, point));
    let square = dot(e, e);
    if square == 0.0 {
        return [0.0; 2];
    }
    [dot(r, e) / square, cross(e, r) / square]
}

/// The point of a segment nearest to a given point: its position, and its distance. The segment may
/// have no length.
pub fn nearest_of(point: [f64; 2], [a, b]: [[f64; 2]; 2]) -> ([f64; 2], f64) {
    let e = difference(a, b);
    let square = dot(e, e);
    let xi = match square == 0.0 {
        true => 0.0,
        false => (dot(difference(a, point), e) / square).clamp(0.0, 1.0),
    };
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
