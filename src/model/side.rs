//! Sides of elements: their nodes, their shape functions, and what acts on them. Section 2 of docs/theory.md.
//!
//! A side is not a contact segment: a segment is a straight line between two neighbouring nodes, of which a side has one
//! or more.

use smallvec::SmallVec;

/// A straight line from a node to the next, with the body on the left: what contact knows of a side.
pub type Segment = [usize; 2];

/// Nodes of a side from corner to corner, with the element on the left.
pub type SideNodes = SmallVec<[usize; 3]>;

/// A side of an element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Side {
    nodes: SideNodes,
}

/// Shape functions h_a and dh_a/dr of a side at a place -1 <= r <= 1, those of Lagrange with evenly spaced nodes:
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

/// Gauss points r and their weight on a side with 2 nodes, and with 3: exact for products of a shape function and a
/// derivative of one.
const GAUSS: [(&[f64], f64); 2] = [
    (&[0.0], 2.0),
    (&[-0.577_350_269_189_625_8, 0.577_350_269_189_625_8], 1.0),
];

impl Side {
    /// The side with these nodes.
    pub fn new(nodes: SideNodes) -> Self {
        Side { nodes }
    }

    /// Its nodes from corner to corner.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Its nodes, without itself.
    pub fn into_nodes(self) -> SideNodes {
        self.nodes
    }

    /// The corners where it begins and ends.
    pub fn ends(&self) -> [usize; 2] {
        [self.nodes[0], self.nodes[self.nodes.len() - 1]]
    }

    /// The contact segments made from it, in order.
    pub fn segments(&self) -> impl DoubleEndedIterator<Item = Segment> + '_ {
        self.nodes.windows(2).map(|pair| [pair[0], pair[1]])
    }

    /// int h_a n dl at every node a (length), n being the outward normal: the forces of a unit suction per thickness.
    /// `from_first` has the positions of the nodes relative to the first.
    pub fn normals(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        // n dl = (e_y, -e_x): on the right of the direction of the side
        self.integrals(from_first, |e| [e[1], -e[0]])
    }

    /// int h_a dl at every node a (length), as [`Self::normals`].
    pub fn lengths(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, f64)> {
        let lengths = self.integrals(from_first, |e| [e[0].hypot(e[1]), 0.0]);
        lengths.map(|(node, [length, _])| (node, length))
    }

    /// int h_a v(dx/dr) dr at every node a.
    fn integrals(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
        v: impl Fn([f64; 2]) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        let n = self.nodes.len();
        let mut sums: SmallVec<[(usize, [f64; 2]); 3]> =
            self.nodes.iter().map(|&node| (node, [0.0; 2])).collect();
        let (points, weight) = GAUSS[n - 2];
        for &r in points {
            let functions = shape_functions(n, r);
            let terms = self.nodes.iter().zip(&functions).skip(1);
            let tangent = terms.fold([0.0; 2], |[x, y], (&node, [_, derivative])| {
                let from_first = from_first(node);
                [
                    x + derivative * from_first[0],
                    y + derivative * from_first[1],
                ]
            });
            let v = v(tangent).map(|v| v * weight);
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
        let lengths: Vec<_> = side.lengths(from_first).collect();
        assert_eq!(lengths, [(0, 2.5), (1, 2.5)]);
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
        for ((_, length), part) in side.lengths(from_first).zip([1.0, 4.0, 1.0]) {
            assert!((length - 5.0 * part / 6.0).abs() < 1e-14);
        }
        assert_eq!(side.segments().collect::<Vec<_>>(), [[4, 2], [2, 7]]);
        assert_eq!(side.ends(), [4, 7]);
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
