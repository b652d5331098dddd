//! Sides of elements: their nodes, their shape functions, and the forces on sides. See docs/theory/elements.md.
//!
//! A side is not a contact segment: a segment is a straight line between two neighbouring nodes, and a side has one or
//! two segments.

use std::f64::consts::{PI, TAU};

use smallvec::SmallVec;

use super::Thickness;

/// A straight line from a node to the next, with the body on the left; contact uses sides in the form of segments.
pub type Segment = [usize; 2];

/// Nodes of a side from corner to corner, with the element on the left.
pub type SideNodes = SmallVec<[usize; 3]>;

/// A side of an element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Side {
    nodes: SideNodes,
}

/// Shape functions h_a and dh_a/dr of a side at a place -1 <= r <= 1: the functions of Lagrange with evenly spaced
/// nodes:
///
/// ```text
/// h_a = prod (r - r_b)/(r_a - r_b) over b != a,   r_a = 2 a/(n - 1) - 1
/// ```
fn shape_functions(n: usize, r: f64) -> SmallVec<[[f64; 2]; 3]> {
    let at = |a: usize| 2.0 * a as f64 / (n - 1) as f64 - 1.0;
    let of_node = |a: usize| {
        let others = (0..n).filter(|&b| b != a);
        others.fold([1.0, 0.0], |[value, derivative], b| {
            let length = at(a) - at(b);
            let factor = (r - at(b)) / length;
            [value * factor, derivative * factor + value / length]
        })
    };
    (0..n).map(of_node).collect()
}

/// Gauss points r and their weights, exact for polynomials of degree 1, 3 and 5.
const GAUSS: [&[[f64; 2]]; 3] = [
    &[[0.0, 2.0]],
    &[
        [-0.577_350_269_189_625_8, 1.0],
        [0.577_350_269_189_625_8, 1.0],
    ],
    &[
        [-0.774_596_669_241_483_4, 5.0 / 9.0],
        [0.0, 8.0 / 9.0],
        [0.774_596_669_241_483_4, 5.0 / 9.0],
    ],
];

impl Side {
    /// The side between the given nodes.
    pub fn new(nodes: SideNodes) -> Self {
        Side { nodes }
    }

    /// Nodes of the side from corner to corner.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Converts the side into its nodes.
    pub fn into_nodes(self) -> SideNodes {
        self.nodes
    }

    /// The corners at the start and at the end of the side.
    pub fn ends(&self) -> [usize; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }

    /// The contact segments made from the side, in order.
    pub fn segments(&self) -> impl DoubleEndedIterator<Item = Segment> + '_ {
        self.nodes.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// Forces int h_a n dl of a unit suction, per thickness, at every node a (length), where n is the outward normal.
    /// `from_first` are the positions of the nodes relative to the first node.
    pub fn normals(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        // n dl = (e_y, -e_x): on the right of the direction of the side
        self.integrals(from_first, None, |e| [e[1], -e[0]])
    }

    /// Forces int h_a n t dl at every node a (length^2), like [`Self::normals`] with the thickness t; `radius` is the
    /// distance of the first node from the axis.
    pub fn thrusts(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
        (thickness, radius): (Thickness, f64),
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        let (factor, around) = thickness.parts(radius);
        let integrals = self.integrals(from_first, around, |e| [e[1], -e[0]]);
        integrals.map(move |(node, normal)| (node, normal.map(|n| n * factor)))
    }

    /// Integrals int h_a t dl at every node a (length^2), with the arguments of [`Self::thrusts`].
    pub fn areas(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
        (thickness, radius): (Thickness, f64),
    ) -> impl Iterator<Item = (usize, f64)> {
        let (factor, around) = thickness.parts(radius);
        let lengths = self.integrals(from_first, around, |e| [e[0].hypot(e[1]), 0.0]);
        lengths.map(move |(node, [length, _])| (node, length * factor))
    }

    /// Integral int pi R² n_x dl over a side with nodes at `x` (length^3).
    pub(super) fn swept_volume(&self, x: &[[f64; 2]]) -> f64 {
        let points = GAUSS[self.nodes.len() - 1].iter();
        let terms = points.map(|&[r, weight]| {
            let functions = shape_functions(self.nodes.len(), r);
            let of = |i: usize, k: usize| -> f64 {
                let terms = x.iter().zip(&functions);
                terms.map(|(x, h)| x[i] * h[k]).sum()
            };
            of(0, 0).powi(2) * of(1, 1) * weight
        });
        PI * terms.sum::<f64>()
    }

    /// Integrals int h_a v(dx/dr) dr at every node a; if the distance of the first node from the axis is given, int 2
    /// pi R h_a v(dx/dr) dr.
    fn integrals(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
        around: Option<f64>,
        v: impl Fn([f64; 2]) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        let n = self.nodes.len();
        let mut sums: SmallVec<[(usize, [f64; 2]); 3]> =
            self.nodes.iter().map(|&node| (node, [0.0; 2])).collect();
        // the integrands are products of a shape function and a derivative, in a ring also with the
        // radius
        let points = GAUSS[if around.is_some() { n - 1 } else { n - 2 }];
        for &[r, weight] in points {
            let functions = shape_functions(n, r);
            let terms = || self.nodes.iter().zip(&functions).skip(1);
            let tangent = terms().fold([0.0; 2], |[x, y], (&node, [_, derivative])| {
                let from_first = from_first(node);
                [
                    x + derivative * from_first[0],
                    y + derivative * from_first[1],
                ]
            });
            let circumference = around.map_or(1.0, |radius| {
                let off = terms().map(|(&node, [h, _])| h * from_first(node)[0]);
                TAU * (radius + off.sum::<f64>())
            });
            let v = v(tangent).map(|v| v * (weight * circumference));
            for ((_, sum), [h, _]) in sums.iter_mut().zip(&functions) {
                *sum = [sum[0] + h * v[0], sum[1] + h * v[1]];
            }
        }
        sums.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_side_takes_half_at_either_end() {
        let x = [[1.0, 2.0], [4.0, 6.0]];
        let side = Side::new(SideNodes::from_slice(&[0, 1]));
        let from_first = |node: usize| [x[node][0] - x[0][0], x[node][1] - x[0][1]];
        let normals: Vec<_> = side.normals(from_first).collect();
        assert_eq!(normals, [(0, [2.0, -1.5]), (1, [2.0, -1.5])]);
        let areas: Vec<_> = side.areas(from_first, (Thickness::Of(3.0), 1.0)).collect();
        assert_eq!(areas, [(0, 7.5), (1, 7.5)]);
        assert_eq!(side.segments().collect::<Vec<_>>(), [side.ends()]);
    }

    #[test]
    fn a_straight_side_with_a_node_in_the_middle_takes_sixths() {
        let side = Side::new(SideNodes::from_slice(&[4, 2, 7]));
        let from_first = |node: usize| match node {
            4 => [0.0, 0.0],
            2 => [1.5, 2.0],
            _ => [3.0, 4.0],
        };
        for ((_, [x, y]), part) in side.normals(from_first).zip([1.0, 4.0, 1.0]) {
            assert!((x - 4.0 * part / 6.0).abs() < 1e-14 && (y + 3.0 * part / 6.0).abs() < 1e-14);
        }
        let areas = side.areas(from_first, (Thickness::Of(1.0), 0.0));
        for ((_, area), part) in areas.zip([1.0, 4.0, 1.0]) {
            assert!((area - 5.0 * part / 6.0).abs() < 1e-14);
        }
        assert_eq!(side.segments().collect::<Vec<_>>(), [[4, 2], [2, 7]]);
        assert_eq!(side.ends(), [4, 7]);
    }

    #[test]
    fn around_the_axis_a_side_has_the_area_and_the_thrust_of_a_cone() {
        // from R = 1 to R = 4, slant 5: pi (1 + 4) 5, pi (4² - 1²) along the axis
        for nodes in [vec![0, 1], vec![0, 2, 1]] {
            let side = Side::new(nodes.into_iter().collect());
            let from_first = |node: usize| [[0.0, 0.0], [3.0, 4.0], [1.5, 2.0]][node];
            let around = (Thickness::Around, 1.0);
            let area: f64 = side.areas(from_first, around).map(|(_, a)| a).sum();
            assert!((area - 25.0 * PI).abs() < 1e-13);
            let along: f64 = side.thrusts(from_first, around).map(|(_, n)| n[1]).sum();
            assert!((along + 15.0 * PI).abs() < 1e-13);
            // node 0 has (2 R_0 + R_1)/6 of the slant on a side of two nodes, R_0/6 on one of three
            let (_, first) = side.areas(from_first, around).next().expect("a node");
            let part = if side.nodes().len() == 2 {
                1.0
            } else {
                1.0 / 6.0
            };
            assert!((first - TAU * 5.0 * part).abs() < 1e-13);
        }
    }

    #[test]
    fn the_normals_of_a_curved_side_sum_up_to_that_of_its_chord() {
        let side = Side::new(SideNodes::from_slice(&[0, 1, 2]));
        let from_first = |node: usize| [[0.0, 0.0], [1.0, 0.7], [3.0, 4.0]][node];
        let sum = side
            .normals(from_first)
            .fold([0.0; 2], |s, (_, n)| [s[0] + n[0], s[1] + n[1]]);
        assert!((sum[0] - 4.0).abs() < 1e-14 && (sum[1] + 3.0).abs() < 1e-14);
    }
}
