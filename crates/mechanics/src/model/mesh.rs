//! The mesh: nodes, elements with their sides, sets; exterior faces, and the bodies that connected elements form.

use smallvec::SmallVec;

use super::ElementType;
use super::side::{Segment, Side, SideNodes};
use crate::vectors::{cross, difference, distance, dot, polygon_area};

/// Smallest ratio of an element's area to its area before its nodes are moved.
const SMALLEST_AREA: f64 = 0.5;

/// Nodes and elements of a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Node numbers in the deck, `N` entries.
    pub node_labels: Vec<u64>,
    /// Reference coordinates, `N` entries (length).
    pub coordinates: Vec<[f64; 2]>,
    /// Elements in the order of the deck.
    pub elements: Vec<Element>,
}

impl Mesh {
    /// Number of nodes N.
    pub fn node_count(&self) -> usize {
        self.coordinates.len()
    }

    /// Number of degrees of freedom 2 N.
    pub fn dof_count(&self) -> usize {
        2 * self.coordinates.len()
    }

    /// Body of every node; a body is numbered by the smallest index of the nodes that elements
    /// connect.
    pub fn bodies(&self) -> Vec<usize> {
        let mut parent: Vec<usize> = (0..self.node_count()).collect();
        for element in &self.elements {
            let Some((&first, others)) = element.nodes.split_first() else {
                continue;
            };
            let mut p = root(&mut parent, first);
            for &other in others {
                let q = root(&mut parent, other);
                parent[p.max(q)] = p.min(q);
                p = p.min(q);
            }
        }
        // no parent has a larger index than its child
        for node in 0..parent.len() {
            parent[node] = parent[parent[node]];
        }
        parent
    }

    /// Whether the bodies are bodies of revolution around the axis x = 0; either all elements are rings, or no element
    /// is a ring.
    pub fn is_axisymmetric(&self) -> bool {
        let first = self.elements.first();
        first.is_some_and(|element| element.element_type.is_ring())
    }

    /// Faces that belong to only one element, in the order of the elements.
    pub fn outline(&self) -> Vec<Face> {
        let at_nodes = ElementsAtNodes::new(self);
        let faces = self.faces();
        faces.filter(|&face| !at_nodes.share(face, self)).collect()
    }

    /// Faces of the outline that something can touch: in bodies of revolution, the faces that are not on the axis.
    pub fn exterior_faces(&self) -> Vec<Face> {
        let faces = self.outline().into_iter();
        faces.filter(|&face| !self.is_on_axis(face)).collect()
    }

    /// Whether a face lies on the axis of a body of revolution.
    pub fn is_on_axis(&self, face: Face) -> bool {
        let is_ring = self.elements[face.element].element_type.is_ring();
        is_ring
            && face
                .ends(self)
                .iter()
                .all(|&node| self.coordinates[node][0] == 0.0)
    }

    /// Length of the shortest side in each of `count` groups of elements, to which `group` assigns
    /// them; infinite for an empty group.
    pub(super) fn shortest_sides(
        &self,
        count: usize,
        group: impl Fn(&Element) -> usize,
    ) -> Vec<f64> {
        let (mut squares, mut lengths) = (vec![f64::INFINITY; count], vec![f64::INFINITY; count]);
        for element in &self.elements {
            let group = group(element);
            let square = self.shortest_square(element);
            match square.is_normal() {
                true => squares[group] = squares[group].min(square),
                false => lengths[group] = lengths[group].min(self.shortest_side(element)),
            }
        }
        let sides = squares.iter().zip(lengths);
        sides
            .map(|(square, length)| square.sqrt().min(length))
            .collect()
    }

    /// Square of the length of the shortest side of an element.
    fn shortest_square(&self, element: &Element) -> f64 {
        let at = |node: usize| self.coordinates[node];
        match *element.corners() {
            [a, b, c] => shortest_square(&[a, b, c].map(at)),
            [a, b, c, d] => shortest_square(&[a, b, c, d].map(at)),
            ref nodes => shortest_square(&nodes.iter().map(|&node| at(node)).collect::<Vec<_>>()),
        }
    }

    /// Length of the shortest side of an element.
    pub fn shortest_side(&self, element: &Element) -> f64 {
        let square = self.shortest_square(element);
        if square.is_normal() {
            return square.sqrt();
        }
        let corners = self.corners(element);
        let lengths = sides(&corners).map(|[a, b]| distance(a, b));
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Reference coordinates of the corners of an element (length).
    pub fn corners(&self, element: &Element) -> Corners {
        let at = |node: usize| self.coordinates[node];
        match *element.corners() {
            [a, b, c, d] => SmallVec::from_buf([a, b, c, d].map(at)),
            ref nodes => nodes.iter().map(|&node| at(node)).collect(),
        }
    }

    /// Whether each node belongs to an element.
    pub fn has_element(&self) -> Vec<bool> {
        let mut has_element = vec![false; self.node_count()];
        let nodes = self.elements.iter().flat_map(|element| &element.nodes);
        nodes.for_each(|&node| has_element[node] = true);
        has_element
    }

    /// Area of an undeformed element (length^2). On a side with a mid-side node, the area between the chord and the
    /// straight lines through the nodes is half of the parallelogram over the chord, whereas the area under the
    /// parabola is two thirds.
    pub fn area(&self, element: &Element) -> f64 {
        let of_corners = polygon_area(self.corners(element));
        if !element.element_type.is_quadratic() {
            return of_corners;
        }
        let outline = element.segments().map(|[node, _]| self.coordinates[node]);
        of_corners + 4.0 / 3.0 * (polygon_area(outline) - of_corners)
    }

    /// Volume of an undeformed element (length^3): t A, or around the axis 2 pi int R dA from the integral over its
    /// sides, where n is the outward normal:
    ///
    /// ```text
    /// 2 pi int R dA = int pi R² n_x dl
    /// ```
    pub fn volume(&self, element: &Element, thickness: f64) -> f64 {
        if !element.element_type.is_ring() {
            return thickness * self.area(element);
        }
        let of_side = |side: Side| {
            let x = side.nodes().iter().map(|&node| self.coordinates[node]);
            side.swept_volume(&x.collect::<SmallVec<[[f64; 2]; 3]>>())
        };
        let sides = (0..element.side_count()).map(|side| element.side(side));
        sides.map(of_side).sum()
    }

    /// All sides of all elements.
    fn faces(&self) -> impl Iterator<Item = Face> + '_ {
        let elements = self.elements.iter().enumerate();
        elements
            .flat_map(|(element, e)| (0..e.side_count()).map(move |side| Face { element, side }))
    }
}

#[inline]
fn shortest_square(corners: &[[f64; 2]]) -> f64 {
    let squares = sides(corners).map(|[a, b]| {
        let side = difference(a, b);
        dot(side, side)
    });
    squares.fold(f64::INFINITY, f64::min)
}

/// Sides [a, b] of a polygon; the side that ends at the first corner comes first.
pub fn sides(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    let mut last = corners.last().copied().unwrap_or_default();
    corners
        .iter()
        .map(move |&corner| [std::mem::replace(&mut last, corner), corner])
}

/// The elements at every node of a mesh, in the order of the deck.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ElementsAtNodes {
    /// Index in `elements` at which the elements of each node start; `N + 1` entries.
    starts: Vec<u32>,
    elements: Vec<u32>,
}

impl ElementsAtNodes {
    /// Finds the elements of every node.
    pub fn new(mesh: &Mesh) -> Self {
        let elements = mesh.elements.iter();
        let nodes = elements.map(|element| element.nodes.iter().copied());
        ElementsAtNodes::of_nodes(nodes, mesh.node_count())
    }

    /// Finds the elements of `count` nodes from the nodes of each element.
    pub fn of_nodes<N: IntoIterator<Item = usize>>(
        elements: impl DoubleEndedIterator<Item = N> + ExactSizeIterator + Clone,
        count: usize,
    ) -> Self {
        let mut starts = vec![0; count + 1];
        for node in elements.clone().flatten() {
            starts[node] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        // filling backwards moves each end to its start
        let mut at_nodes = vec![0; end as usize];
        for (index, nodes) in elements.enumerate().rev() {
            for node in nodes {
                starts[node] -= 1;
                at_nodes[starts[node] as usize] = index as u32;
            }
        }
        ElementsAtNodes {
            starts,
            elements: at_nodes,
        }
    }

    /// The elements at a node; empty for a node that the mesh does not have.
    pub fn of(&self, node: usize) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let ends = [node, node + 1].map(|i| self.starts.get(i).map(|&start| start as usize));
        let elements = match ends {
            [Some(start), Some(end)] => &self.elements[start..end],
            _ => &[],
        };
        elements.iter().map(|&element| element as usize)
    }

    /// Whether two elements share a face.
    pub fn share(&self, face: Face, mesh: &Mesh) -> bool {
        let [a, b] = face.ends(mesh);
        let joins = |side: [usize; 2]| side == [a, b] || side == [b, a];
        let has_side = |&element: &usize| mesh.elements[element].side_ends().any(joins);
        self.of(a).filter(has_side).nth(1).is_some()
    }
}

fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

/// Node indices of an element, in place.
pub type Nodes = SmallVec<[usize; 4]>;

/// Positions of the corners of an element, in place (length).
pub type Corners = SmallVec<[[f64; 2]; 4]>;

/// One element.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    /// Element number in the deck.
    pub label: u64,
    /// Shape, formulation, and plane stress or plane strain.
    pub element_type: ElementType,
    /// Node indices, as many as the type has: the corners counter-clockwise, then the mid-side nodes.
    pub nodes: Nodes,
    /// Index into `Model::sections`; [`NO_SECTION`] until the section is known.
    pub section: usize,
}

/// Section index of an element that has no section yet.
pub const NO_SECTION: usize = usize::MAX;

impl Element {
    /// Number of sides, which is also the number of corners.
    pub fn side_count(&self) -> usize {
        self.element_type.topology().sides.len()
    }

    /// Nodes at the corners, counter-clockwise.
    pub fn corners(&self) -> &[usize] {
        &self.nodes[..self.side_count()]
    }

    /// Whether moving the nodes has made the element concave or has removed half its area.
    pub fn is_spoiled(&self, before: &[[f64; 2]], after: &[[f64; 2]]) -> bool {
        if self.nodes.iter().all(|&n| before[n] == after[n]) {
            return false;
        }
        let area = |x: &[[f64; 2]]| polygon_area(self.segments().map(|[n, _]| x[n]));
        let small = area(after) < SMALLEST_AREA * area(before);
        small || (0..self.side_count()).any(|i| self.corner_area(i, |n| after[n]) <= 0.0)
    }

    /// Cross product of the directions a, b in which the sides leave corner `i`, with the nodes at `x` (length^2). If
    /// mid-side nodes are at the middle of straight sides, the product is twice the area of the triangle of the corner
    /// and its neighbours. The product is proportional to det(dX/dr) at the corner.
    ///
    /// ```text
    /// a x b;  a = x_next - x_i,  or 4 x_between - 3 x_i - x_next where there is a node between them
    /// ```
    pub fn corner_area(&self, i: usize, x: impl Fn(usize) -> [f64; 2]) -> f64 {
        let count = self.side_count();
        let leave = |nodes: &mut dyn Iterator<Item = usize>| {
            let nodes: SideNodes = nodes.collect();
            let to = |node: usize| difference(x(nodes[0]), x(node));
            match nodes[..] {
                [_, between, end] => {
                    let (between, end) = (to(between), to(end));
                    [0, 1].map(|k| 4.0 * between[k] - end[k])
                }
                _ => to(nodes[nodes.len() - 1]),
            }
        };
        let [out, back] = [i, (i + count - 1) % count].map(|k| self.side(k).into_nodes());
        cross(
            leave(&mut out.into_iter()),
            leave(&mut back.into_iter().rev()),
        )
    }

    /// The side number `side`, from 0: side 0 is S1/P1.
    pub fn side(&self, side: usize) -> Side {
        let local = self.element_type.topology().sides[side].iter();
        Side::new(local.map(|&local| self.nodes[local]).collect())
    }

    /// The corners where every side begins and ends.
    pub fn side_ends(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let sides = self.element_type.topology().sides.iter();
        sides.map(|side| [side[0], side[side.len() - 1]].map(|local| self.nodes[local]))
    }

    /// Nodes of the convex polygons into which the outline of an element is divided; the outline itself need not be
    /// convex. With mid-side nodes the convex polygons of an element are a triangle at each corner and the polygon
    /// between the triangles.
    pub fn convex_parts(&self) -> SmallVec<[Nodes; 1]> {
        if !self.element_type.is_quadratic() {
            return [self.nodes.clone()].into_iter().collect();
        }
        let count = self.side_count();
        let (corners, between) = self.nodes.split_at(count);
        let at_corner = |i: usize| {
            let nodes = [between[(i + count - 1) % count], corners[i], between[i]];
            Nodes::from_slice(&nodes)
        };
        let parts = (0..count).map(at_corner);
        parts.chain([Nodes::from_slice(between)]).collect()
    }

    /// The straight lines of the outline, counter-clockwise.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let sides = self.element_type.topology().sides.iter();
        let pairs = sides.flat_map(|side| side.windows(2));
        pairs.map(|pair| [self.nodes[pair[0]], self.nodes[pair[1]]])
    }
}

/// One side of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Face {
    /// Element index.
    pub element: usize,
    /// Number of the side, from 0: side 0 is S1.
    pub side: usize,
}

impl Face {
    /// The side of the element.
    pub fn of(&self, mesh: &Mesh) -> Side {
        mesh.elements[self.element].side(self.side)
    }

    /// The corners [a, b] at the start and end of the face; the body lies on the left of the direction from a to b.
    pub fn ends(&self, mesh: &Mesh) -> [usize; 2] {
        self.of(mesh).ends()
    }

    /// Nodes of the face from corner to corner.
    pub fn nodes(&self, mesh: &Mesh) -> SideNodes {
        self.of(mesh).into_nodes()
    }

    /// The contact segments made from the face, in order.
    pub fn segments(&self, mesh: &Mesh) -> SmallVec<[Segment; 2]> {
        self.of(mesh).segments().collect()
    }
}

/// A named set of node or element indices.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Set {
    /// Name as first typed in the deck.
    pub name: String,
    /// Member indices, sorted, without duplicates.
    pub members: Vec<usize>,
}

/// The bodies of a mesh, in the order of their first nodes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bodies {
    /// Number of bodies B.
    pub count: usize,
    /// Body of every node, `N` entries; `None` for nodes without elements.
    pub of_node: Vec<Option<usize>>,
    /// Body of every element.
    pub of_element: Vec<usize>,
}

impl Bodies {
    /// The bodies of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let first = mesh.bodies();
        let mut number = vec![None; mesh.node_count()];
        for element in &mesh.elements {
            number[first[element.nodes[0]]] = Some(0);
        }
        let mut count = 0;
        for number in number.iter_mut().flatten() {
            *number = count;
            count += 1;
        }
        let of_node: Vec<Option<usize>> = first.iter().map(|&node| number[node]).collect();
        let of_element = (mesh.elements.iter())
            .filter_map(|element| of_node[element.nodes[0]])
            .collect();
        Bodies {
            count,
            of_node,
            of_element,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Element, ElementType};

    #[test]
    fn bodies_are_numbered_by_their_first_nodes() {
        let element = |nodes: [usize; 3]| Element {
            label: 1,
            element_type: ElementType::CPS3,
            nodes: nodes[..].into(),
            section: 0,
        };
        let mesh = Mesh {
            node_labels: (1..=9).collect(),
            coordinates: vec![[0.0; 2]; 9],
            elements: vec![element([6, 7, 8]), element([5, 2, 1]), element([2, 5, 4])],
        };
        let bodies = Bodies::new(&mesh);
        let (a, b) = (Some(0), Some(1));
        assert_eq!(bodies.count, 2);
        assert_eq!(bodies.of_node, [None, a, a, None, a, a, b, b, b]);
        assert_eq!(bodies.of_element, [1, 0, 0]);
    }
}
