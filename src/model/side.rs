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

/// Shape functions of a side at a Gauss point.
struct Point {
    /// h_a
    values: &'static [f64],
    /// dh_a/dr, -1 <= r <= 1
    derivatives: &'static [f64],
    weight: f64,
}

/// Linear, exact for a straight side.
static LINEAR: [Point; 1] = [Point {
    values: &[0.5, 0.5],
    derivatives: &[-0.5, 0.5],
    weight: 2.0,
}];

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

    fn points(&self) -> &'static [Point] {
        &LINEAR
    }

    /// dx/dr at a point of the side, given the positions of its nodes relative to its first (length).
    fn tangent(&self, point: &Point, from_first: &impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let terms = self.nodes.iter().zip(point.derivatives).skip(1);
        terms.fold([0.0; 2], |[x, y], (&node, h)| {
            let from_first = from_first(node);
            [x + h * from_first[0], y + h * from_first[1]]
        })
    }

    /// int h_a n dl at every node a (length), n being the outward normal: the forces of a unit suction per thickness.
    /// `from_first` has the positions of the nodes relative to the first.
    pub fn normals(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.integrals(move |side, point| {
            // n dl = (e_y, -e_x): on the right of the direction of the side
            let e = side.tangent(point, &from_first);
            [e[1], -e[0]]
        })
    }

    /// int h_a dl at every node a (length), as [`Self::normals`].
    pub fn lengths(
        &self,
        from_first: impl Fn(usize) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, f64)> {
        self.integrals(move |side, point| {
            let e = side.tangent(point, &from_first);
            [e[0].hypot(e[1]), 0.0]
        })
        .map(|(node, [length, _])| (node, length))
    }

    /// int h_a v dr at every node a.
    fn integrals(
        &self,
        v: impl Fn(&Self, &Point) -> [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        let mut sums: SmallVec<[(usize, [f64; 2]); 3]> =
            self.nodes.iter().map(|&node| (node, [0.0; 2])).collect();
        for point in self.points() {
            let v = v(self, point).map(|v| v * point.weight);
            for ((_, sum), h) in sums.iter_mut().zip(point.values) {
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
}
