//! Interior of the bodies: whether a straight line from a segment stays in the elements behind the segment. See
//! docs/theory/geometry.md.
//!
//! The line is followed from element to element through their common sides. The elements on the
//! line tell a node on the far side of a thin body from a node of another part that has penetrated
//! the body, however thin the body is.

use super::projection::{between, project};
use super::tolerances::{INSIDE_ROUND_OFF, NEARER_HALF};
use crate::model::{Element, ElementsAtNodes, Mesh};
use crate::vectors::{difference, dot};

/// The convex parts of the elements of a mesh, here called elements; the segments of their outlines find them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interior {
    /// Nodes around every element, one element after the other; each segment leads from a node to the next, with the
    /// element on its left.
    nodes: Vec<u32>,
    /// Start of every element in `nodes`, and the end of the last.
    starts: Vec<u32>,
    at_nodes: ElementsAtNodes,
}

/// A line and the elements that it goes through.
struct CrossedElements {
    elements: Vec<usize>,
    /// Whether the line stays in the body up to its end.
    stays: bool,
}

impl Interior {
    /// The interior of those elements of a mesh for which `is_of` is true.
    pub fn new(mesh: &Mesh, is_of: impl Fn(&Element) -> bool) -> Self {
        let (mut nodes, mut starts) = (Vec::new(), vec![0]);
        for element in mesh.elements.iter().filter(|element| is_of(element)) {
            for part in element.convex_parts() {
                nodes.extend(part.iter().map(|&node| node as u32));
                starts.push(nodes.len() as u32);
            }
        }
        let of_elements = starts.windows(2).map(|ends| {
            let own = &nodes[ends[0] as usize..ends[1] as usize];
            own.iter().map(|&node| node as usize)
        });
        Interior {
            at_nodes: ElementsAtNodes::of_nodes(of_elements, mesh.node_count()),
            nodes,
            starts,
        }
    }

    /// Segments [a, b] around an element.
    fn sides(&self, element: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        let [start, end] = [element, element + 1].map(|i| self.starts[i] as usize);
        let nodes = &self.nodes[start..end];
        let next = nodes[1..].iter().chain(&nodes[..1]);
        nodes
            .iter()
            .zip(next)
            .map(|(&a, &b)| [a as usize, b as usize])
    }

    /// Element on the left of the side from a to b.
    fn left(&self, side: [usize; 2]) -> Option<usize> {
        let has_side = |&element: &usize| self.sides(element).any(|other| other == side);
        self.at_nodes.of(side[0]).rfind(has_side)
    }

    /// Whether a segment is a side of an element.
    pub fn has_body(&self, segment: [usize; 2]) -> bool {
        self.left(segment).is_some()
    }

    /// Whether a node behind the line of a segment has penetrated the body there through this
    /// segment, at the positions `at`. The node has penetrated the body if it lies in the body,
    /// does not belong to any element on the line, and is nearer to the segment than to the far side. If there is no
    /// element behind the segment, every place behind it counts as inside.
    pub fn takes_in(
        &self,
        segment: [usize; 2],
        node: usize,
        at: impl Fn(usize) -> [f64; 2],
    ) -> bool {
        self.line(segment, node, NEARER_HALF, at)
            .is_none_or(|line| self.is_foreign(&line, node))
    }

    /// Whether the node lies in the body, at any depth: the node may have entered through another segment.
    pub fn contains(
        &self,
        segment: [usize; 2],
        node: usize,
        at: impl Fn(usize) -> [f64; 2],
    ) -> bool {
        self.line(segment, node, 1.0, at)
            .is_none_or(|line| self.is_foreign(&line, node))
    }

    /// Whether a point of a slave face between nodes has penetrated the body through a segment; `xi` and `gap` are its
    /// place and gap at the segment. Place and gap may be relative to the straight line that stands for a curved side.
    /// The mid-side node tells how far the side of the element is from this line.
    pub fn takes_in_point(
        &self,
        segment: [usize; 2],
        ([xi, gap], face): ([f64; 2], [usize; 2]),
        at: impl Fn(usize) -> [f64; 2],
    ) -> bool {
        let [a, b] = segment.map(&at);
        let on_it = between(a, b, xi);
        let normal = project(a, a, b).normal;
        let point = [0, 1].map(|i| on_it[i] + gap * normal[i]);
        self.line_to(segment, point, NEARER_HALF, at)
            .is_none_or(|line| face.iter().all(|&node| self.is_foreign(&line, node)))
    }

    /// Whether a node behind the line of a segment belongs to the body behind the segment, so it is a node of the far
    /// side.
    pub fn joins(&self, segment: [usize; 2], node: usize, at: impl Fn(usize) -> [f64; 2]) -> bool {
        let line = self.line(segment, node, 1.0, at);
        line.is_some_and(|line| line.stays && self.has_node(&line, node))
    }

    /// The line from the projection of a node on a segment through the node, `depths` times its
    /// depth long; `None` if there is no element behind the segment.
    fn line(
        &self,
        segment: [usize; 2],
        node: usize,
        depths: f64,
        at: impl Fn(usize) -> [f64; 2],
    ) -> Option<CrossedElements> {
        let s = at(node);
        self.line_to(segment, s, depths, at)
    }

    /// The line from a segment to any point.
    fn line_to(
        &self,
        segment: [usize; 2],
        s: [f64; 2],
        depths: f64,
        at: impl Fn(usize) -> [f64; 2],
    ) -> Option<CrossedElements> {
        let first = self.left(segment)?;
        let [a, b] = segment.map(&at);
        let p = project(s, a, b);
        let xi = p.xi.clamp(0.0, 1.0);
        let from = [0, 1].map(|i| a[i] + xi * (b[i] - a[i]));
        let to = [0, 1].map(|i| s[i] + (depths - 1.0) * p.gap * p.normal[i]);
        let mut line = CrossedElements {
            elements: Vec::new(),
            stays: false,
        };
        let mut parts = vec![(first, self.part(first, from, to, &at)?)];
        while let Some((element, [_, end])) = parts.pop() {
            line.elements.push(element);
            line.stays |= end >= 1.0;
            for [p, q] in self.sides(element) {
                if let Some(next) = self.left([q, p])
                    && !line.elements.contains(&next)
                    && parts.iter().all(|(listed, _)| *listed != next)
                    && let Some(part) = self.part(next, from, to, &at)
                    && part[0] <= end + INSIDE_ROUND_OFF
                {
                    parts.push((next, part));
                }
            }
        }
        Some(line)
    }

    /// The part of the line within an element, as an interval of [0, 1].
    fn part(
        &self,
        element: usize,
        from: [f64; 2],
        to: [f64; 2],
        at: impl Fn(usize) -> [f64; 2],
    ) -> Option<[f64; 2]> {
        let [mut start, mut end] = [0.0_f64, 1.0_f64];
        for side in self.sides(element) {
            let side = project(from, at(side[0]), at(side[1]));
            // distances of both ends of the line from the side, positive outside the element
            let along = dot(difference(from, to), side.normal);
            let (outside, most) = (side.gap, INSIDE_ROUND_OFF * side.length);
            if outside > most && outside + along > most {
                return None;
            }
            let meets = (most - outside) / along;
            if outside > most {
                start = start.max(meets);
            } else if outside + along > most {
                end = end.min(meets);
            }
        }
        (start <= end).then_some([start, end])
    }

    /// Whether a line stays in the body and the node does not belong to any element on the line.
    fn is_foreign(&self, line: &CrossedElements, node: usize) -> bool {
        line.stays && !self.has_node(line, node)
    }

    fn has_node(&self, line: &CrossedElements, node: usize) -> bool {
        let has = |&element: &usize| self.sides(element).any(|[a, _]| a == node);
        line.elements.iter().any(has)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ElementType;

    /// A strip of length 1 and thickness `t` with two layers of elements, as triangles or
    /// quadrilaterals; its nodes are 0 to 8, row by row. Node 9 lies outside the elements.
    fn strip(t: f64, triangles: bool) -> Mesh {
        let mut mesh = Mesh::default();
        for j in 0..3 {
            mesh.coordinates
                .extend((0..3).map(|i| [f64::from(i) / 2.0, t * f64::from(j) / 2.0]));
        }
        mesh.coordinates.push([0.0, 0.0]);
        let mut add = |element_type, nodes: &[usize]| {
            mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes: nodes.into(),
                section: 0,
            });
        };
        for k in [0, 1, 3, 4] {
            let [a, b, c, d] = [k, k + 1, k + 4, k + 3];
            if triangles {
                add(ElementType::CPS3, &[a, b, c]);
                add(ElementType::CPS3, &[a, c, d]);
            } else {
                add(ElementType::CPS4, &[a, b, c, d]);
            }
        }
        mesh
    }

    #[test]
    fn the_far_side_of_a_strip_is_part_of_it_however_thin() {
        for t in [1.0, 1e-2, 1e-3, 1e-5] {
            for triangles in [false, true] {
                let mesh = strip(t, triangles);
                let inside = Interior::new(&mesh, |_| true);
                let at = |n: usize| mesh.coordinates[n];
                for node in [3, 5, 6, 7, 8] {
                    for segment in [[0, 1], [1, 2]] {
                        let beyond = !(-1e-6..=1.0 + 1e-6)
                            .contains(&project(at(node), at(segment[0]), at(segment[1])).xi);
                        assert!(
                            beyond || inside.joins(segment, node, at),
                            "{t} {triangles} {node} {segment:?}"
                        );
                        assert!(beyond || !inside.contains(segment, node, at));
                        assert!(!inside.takes_in(segment, node, at), "{t} {node}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_node_of_another_part_is_taken_in_by_the_nearer_side() {
        let t = 1e-3;
        for triangles in [false, true] {
            let mut mesh = strip(t, triangles);
            let mut place = |depth: f64| {
                mesh.coordinates[9] = [0.3, t * depth];
                let inside = Interior::new(&mesh, |_| true);
                let at = |n: usize| mesh.coordinates[n];
                assert!(!inside.joins([0, 1], 9, at));
                let takes = inside.takes_in([0, 1], 9, at);
                (takes, inside.contains([0, 1], 9, at))
            };
            assert_eq!(place(0.1), (true, true));
            assert_eq!(place(0.45), (true, true));
            assert_eq!(place(0.6), (false, true));
            assert_eq!(place(1.0 + 1e-6), (false, false), "beyond the far side");
        }
    }

    #[test]
    fn a_line_that_leaves_the_body_does_not_come_back() {
        // an arm above the strip, which has no node in common with the strip
        let mut mesh = strip(0.1, false);
        let first = mesh.coordinates.len();
        for y in [0.2, 0.3] {
            mesh.coordinates.extend([[0.0, y], [1.0, y]]);
        }
        mesh.elements.push(Element {
            label: 1,
            element_type: ElementType::CPS4,
            nodes: vec![first, first + 1, first + 3, first + 2].into(),
            section: 0,
        });
        mesh.coordinates[9] = [0.3, 0.25];
        let inside = Interior::new(&mesh, |_| true);
        let at = |n: usize| mesh.coordinates[n];
        assert!(!inside.contains([0, 1], 9, at) && !inside.joins([0, 1], first, at));
        assert!(inside.contains([first, first + 1], 9, at));
    }

    #[test]
    fn a_body_whose_inner_sides_are_curved_does_not_take_in_its_own_nodes() {
        // two triangles with six nodes each, the node in the middle of their common side to one side or the other
        for bow in [-0.2, 0.2] {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let middle = [0.5 + bow, 0.5 - bow];
            let between = [[0.5, 0.0], [1.0, 0.5], middle, [0.5, 1.0], [0.0, 0.5]];
            let mut mesh = Mesh {
                coordinates: [&corners[..], &between, &[[0.3, 0.3]]].concat(),
                ..Mesh::default()
            };
            for nodes in [[0, 1, 2, 4, 5, 6], [0, 2, 3, 6, 7, 8]] {
                mesh.elements.push(Element {
                    label: 1,
                    element_type: ElementType::CPS6,
                    nodes: nodes.as_slice().into(),
                    section: 0,
                });
            }
            let inside = Interior::new(&mesh, |_| true);
            let at = |n: usize| mesh.coordinates[n];
            let skin = [0, 4, 1, 5, 2, 7, 3, 8, 0];
            for segment in skin.windows(2) {
                let segment = [segment[0], segment[1]];
                for node in skin {
                    assert!(
                        !inside.takes_in(segment, node, at),
                        "{bow} {segment:?} {node}"
                    );
                    assert!(!inside.contains(segment, node, at));
                }
                assert!(inside.contains(segment, 9, at), "{bow} {segment:?}");
            }
            assert!(inside.takes_in([0, 4], 9, at) && !inside.takes_in([2, 7], 9, at));
        }
    }

    #[test]
    fn all_is_behind_a_segment_without_an_element() {
        let at = |n: usize| [[1.0, 0.0], [-1.0, 0.0], [0.0, -0.5]][n];
        let inside = Interior::default();
        assert!(inside.takes_in([0, 1], 2, at) && inside.contains([0, 1], 2, at));
        assert!(!inside.joins([0, 1], 2, at));
    }
}
