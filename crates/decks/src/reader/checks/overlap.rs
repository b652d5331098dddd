//! Finds elements that lie over each other, within one body or of two bodies. See docs/theory/geometry.md, Overlap of
//! elements.
//!
//! Where elements lie over each other, the boundary of a body meets the boundary of another body or itself, or one body
//! lies completely inside another. Where two boundaries meet, an element with an exterior side at this place overlaps
//! an element with an exterior node. A loop of the boundary that meets no other loop lies inside as many elements as
//! other loops make turns around this loop.

use crate::diagnostics::{Code, Span};
use crate::model::{ALL_EXTERIOR, Contact, ElementsAtNodes, Face, Mesh, Model};
use crate::reader::context::Context;
use crate::vectors::{Circle, CircleTree, cross, difference, distance, dot, extents};
use std::collections::{BTreeMap, BTreeSet};

/// Width of the common part of two elements, relative to the narrower element in every direction, above which they lie
/// over each other. Smaller overlaps come from meshing curved surfaces.
const OVERLAP: f64 = 0.05;

/// Reports elements that lie over each other. Overlap within one body is an error; overlap of two bodies is an error in
/// general contact, else a warning, because the deck may intend it. Contact that moves nodes before the start resolves
/// the overlap of its bodies.
pub(crate) fn overlap(model: &Model, places: &[Span], cx: &mut Context) {
    let mesh = &model.mesh;
    let mut pairs = overlapping(mesh);
    if pairs.is_empty() {
        return;
    }
    let bodies = mesh.bodies();
    let body = |element: usize| bodies[mesh.elements[element].nodes[0]];
    let within: Vec<[usize; 2]> = (pairs.iter().copied())
        .filter(|pair| body(pair[0]) == body(pair[1]))
        .collect();
    if let Some(&pair) = within.first() {
        let message = format!(
            "{} lie over each other",
            elements(model, pair, within.len())
        );
        cx.error(Code::OverlappingElements, places[pair[1]], message)
            .help("remove one of them, or mend the nodes");
        return;
    }
    let acting = Acting::new(model, &bodies);
    pairs.retain(|pair| !acting.resolves(pair.map(body)));
    if let Some(&pair) = pairs.first() {
        let message = format!(
            "two bodies overlap: {} lie over each other",
            elements(model, pair, pairs.len())
        );
        let (code, at) = (Code::OverlappingBodies, places[pair[1]]);
        match acting.is_general {
            true => cx
                .error(code, at, message)
                .help("move the bodies apart: contact keeps apart what starts apart"),
            false => cx
                .warning(code, at, message)
                .help("contact keeps apart what starts apart: move the bodies unless it is meant"),
        };
    }
}

/// Names a pair of elements for a message, `the elements 3 and 8`, as the first of `count` pairs.
fn elements(model: &Model, pair: [usize; 2], count: usize) -> String {
    let [a, b] = pair.map(|element| model.element_name(element));
    match count {
        1 => format!("the elements {a} and {b}"),
        _ => format!("the elements {a} and {b}, the first of {count} pairs,"),
    }
}

/// The contacts of the model, as far as these act on overlapping bodies.
struct Acting {
    /// Whether the model has general contact.
    is_general: bool,
    /// For each contact that moves nodes before the start, the bodies of these nodes.
    moved: Vec<BTreeSet<usize>>,
}

impl Acting {
    fn new(model: &Model, bodies: &[usize]) -> Self {
        let of_contact = |contact: &Contact| {
            let sides = [contact.slave, contact.master].map(|side| &model.surfaces[side]);
            let nodes = sides.iter().flat_map(|side| side.nodes(&model.mesh));
            nodes.map(|node| bodies[node]).collect()
        };
        let moves =
            |(i, contact): &(usize, &Contact)| contact.adjust.is_some() || model.is_fitted(*i);
        let is_general = |contact: &Contact| model.surfaces[contact.slave].name == ALL_EXTERIOR;
        Acting {
            is_general: model.contacts.iter().any(is_general),
            moved: model
                .contacts
                .iter()
                .enumerate()
                .filter(moves)
                .map(|(_, contact)| of_contact(contact))
                .collect(),
        }
    }

    /// Whether a contact moves nodes between two bodies before the start.
    fn resolves(&self, pair: [usize; 2]) -> bool {
        let acts = |bodies: &BTreeSet<usize>| pair.iter().all(|body| bodies.contains(body));
        self.moved.iter().any(acts)
    }
}

/// Pairs of elements that lie over each other, with the smaller index first: all pairs at places where boundaries of
/// bodies meet or, without such places, one pair for a body inside another body.
fn overlapping(mesh: &Mesh) -> Vec<[usize; 2]> {
    let at_nodes = ElementsAtNodes::new(mesh);
    let (exterior, mut pairs) = exterior(mesh, &at_nodes);
    pairs.extend(at_boundaries(mesh, &exterior));
    if pairs.is_empty() {
        pairs.extend(inside(mesh, &exterior));
    }
    pairs.iter_mut().for_each(|pair| pair.sort_unstable());
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Faces without an element on their other side, and pairs of elements on the same side of a face.
fn exterior(mesh: &Mesh, at_nodes: &ElementsAtNodes) -> (Vec<Face>, Vec<[usize; 2]>) {
    let (mut exterior, mut pairs) = (Vec::new(), Vec::new());
    // at a node: elements, the number of the node in each, the nodes before it and behind it
    let mut corners: Vec<(usize, usize, usize, usize)> = Vec::new();
    for node in 0..mesh.node_count() {
        corners.clear();
        for element in at_nodes.of(node) {
            let nodes = mesh.elements[element].corners();
            let Some(at) = nodes.iter().position(|&n| n == node) else {
                continue;
            };
            let [before, behind] = [at + nodes.len() - 1, at + 1].map(|i| nodes[i % nodes.len()]);
            corners.push((element, at, before, behind));
        }
        for (i, &(element, side, _, behind)) in corners.iter().enumerate() {
            if corners.iter().all(|&(_, _, before, _)| before != behind) {
                exterior.push(Face { element, side });
            }
            let others = corners[..i].iter().filter(|other| other.3 == behind);
            pairs.extend(others.map(|other| [other.0, element]));
        }
    }
    (exterior, pairs)
}

/// Pairs of an element with an exterior face and an element with an exterior node that have a common part.
fn at_boundaries(mesh: &Mesh, exterior: &[Face]) -> Vec<[usize; 2]> {
    let mut is_rim = vec![false; mesh.node_count()];
    for node in exterior.iter().flat_map(|face| face.nodes(mesh)) {
        is_rim[node] = true;
    }
    let has_rim = |&element: &usize| mesh.elements[element].nodes.iter().any(|&n| is_rim[n]);
    let rim: Vec<usize> = (0..mesh.elements.len()).filter(has_rim).collect();
    let of_face = |face: &Face| {
        let nodes = face.nodes(mesh).into_iter();
        about(&nodes.map(|node| mesh.coordinates[node]).collect::<Vec<_>>())
    };
    let of_element = |&element: &usize| about(&mesh.corners(&mesh.elements[element]));
    let mut near = Vec::new();
    let faces = CircleTree::new(exterior.iter().map(of_face));
    faces.overlaps(&CircleTree::new(rim.iter().map(of_element)), &mut near);
    let pairs = near
        .into_iter()
        .map(|[face, element]| [exterior[face as usize].element, rim[element as usize]]);
    let have_common_part = |&[e, f]: &[usize; 2]| {
        let [p, q] = [e, f].map(|element| mesh.corners(&mesh.elements[element]));
        e != f && have_common_part(&p, &q)
    };
    pairs.filter(have_common_part).collect()
}

/// Whether two convex polygons have a common part that is wide in every direction: no side of either polygon separates
/// the two (separating axes).
fn have_common_part(p: &[[f64; 2]], q: &[[f64; 2]]) -> bool {
    let extent = |polygon: &[[f64; 2]], along: [f64; 2]| {
        let places = polygon.iter().map(|&x| dot(x, along));
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    };
    let parts = |polygon: &[[f64; 2]]| {
        (0..polygon.len()).any(|i| {
            let [a, b] = [polygon[i], polygon[(i + 1) % polygon.len()]];
            let length = distance(a, b);
            let normal = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
            let relative = |x: &[f64; 2]| difference(a, *x);
            let [p, q] = [p, q].map(|x| x.iter().map(relative).collect::<Vec<_>>());
            let ((p0, p1), (q0, q1)) = (extent(&p, normal), extent(&q, normal));
            p1.min(q1) - p0.max(q0) <= OVERLAP * f64::min(p1 - p0, q1 - q0)
        })
    };
    !parts(p) && !parts(q)
}

/// A loop of the boundary of a body, or several loops that meet at nodes.
struct Loop {
    /// Faces of the loop.
    faces: Vec<Face>,
    /// Circle around the loop.
    circle: Circle,
    /// A place inside the element of the first face of the loop.
    place: [f64; 2],
}

/// Pairs of an element at a loop of a boundary and an element in which the loop lies, for loops that meet no other
/// loop.
fn inside(mesh: &Mesh, exterior: &[Face]) -> Vec<[usize; 2]> {
    let loops = loops(mesh, exterior);
    if loops.len() < 2 {
        return Vec::new();
    }
    let bodies = mesh.bodies();
    let body = |at: usize| bodies[mesh.elements[loops[at].faces[0].element].nodes[0]];
    let places = loops.iter().map(|l| Circle {
        centre: l.place,
        radius: 0.0,
    });
    let mut near = Vec::new();
    let circles = CircleTree::new(loops.iter().map(|l| l.circle));
    CircleTree::new(places).overlaps(&circles, &mut near);
    // how often the loops of each body go around the place of a loop
    let mut turns: BTreeMap<[usize; 2], i64> = BTreeMap::new();
    for [at, around] in near {
        let (at, around) = (at as usize, around as usize);
        let turns_about = turns_about(mesh, &loops[around].faces, loops[at].place);
        *turns.entry([at, body(around)]).or_default() += turns_about;
    }
    let covered = turns.into_iter().filter_map(|([at, holder], turns)| {
        let own = i64::from(body(at) == holder);
        (turns > own).then_some((at, holder))
    });
    let holder = |(at, body): (usize, usize)| {
        let own = loops[at].faces[0].element;
        let holds = |&element: &usize| {
            let nodes = &mesh.elements[element].nodes;
            element != own && bodies[nodes[0]] == body && holds(mesh, element, loops[at].place)
        };
        Some([own, (0..mesh.elements.len()).find(holds)?])
    };
    covered.take(1).filter_map(holder).collect()
}

/// The loops of the boundaries; loops that meet at a node count as one.
fn loops(mesh: &Mesh, exterior: &[Face]) -> Vec<Loop> {
    let mut joined: Vec<usize> = (0..mesh.node_count()).collect();
    let root = |joined: &mut Vec<usize>, mut node: usize| {
        while joined[node] != node {
            joined[node] = joined[joined[node]];
            node = joined[node];
        }
        node
    };
    for face in exterior {
        let [a, b] = face.ends(mesh).map(|node| root(&mut joined, node));
        joined[a.max(b)] = a.min(b);
    }
    let mut all: BTreeMap<usize, Vec<Face>> = BTreeMap::new();
    for &face in exterior {
        let first = root(&mut joined, face.ends(mesh)[0]);
        all.entry(first).or_default().push(face);
    }
    let of_faces = |faces: Vec<Face>| {
        let nodes = faces.iter().flat_map(|face| face.nodes(mesh));
        let corners = mesh.corners(&mesh.elements[faces[0].element]);
        let count = corners.len() as f64;
        Loop {
            circle: about(&nodes.map(|node| mesh.coordinates[node]).collect::<Vec<_>>()),
            place: [0, 1].map(|i| corners.iter().map(|x| x[i] / count).sum()),
            faces,
        }
    };
    all.into_values().map(of_faces).collect()
}

/// Number of turns of the faces of a loop around a place, positive to the left, counted as crossings of the ray to the
/// right.
fn turns_about(mesh: &Mesh, faces: &[Face], place: [f64; 2]) -> i64 {
    let crossing = |segment: [usize; 2]| {
        let [a, b] = segment.map(|node| difference(place, mesh.coordinates[node]));
        match (a[1] <= 0.0, b[1] <= 0.0) {
            (true, false) if cross(a, b) > 0.0 => 1,
            (false, true) if cross(a, b) < 0.0 => -1,
            _ => 0,
        }
    };
    let segments = faces.iter().flat_map(|face| face.segments(mesh));
    segments.map(crossing).sum()
}

/// Whether a place lies in an element.
fn holds(mesh: &Mesh, element: usize, place: [f64; 2]) -> bool {
    mesh.elements[element].segments().all(|segment| {
        let [a, b] = segment.map(|node| mesh.coordinates[node]);
        cross(difference(a, b), difference(a, place)) >= 0.0
    })
}

/// A circle around some places.
fn about(places: &[[f64; 2]]) -> Circle {
    let [low, high] = extents(places.iter().copied());
    let centre = [0, 1].map(|i| low[i] + (high[i] - low[i]) / 2.0);
    let radius = places
        .iter()
        .map(|&x| distance(centre, x))
        .fold(0.0, f64::max);
    Circle { centre, radius }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Element, ElementType};

    /// A mesh of elements, each given by its corners; corners at the same place are one node if `joins` is true.
    fn mesh(elements: &[&[[f64; 2]]], joins: bool) -> Mesh {
        let mut mesh = Mesh::default();
        for corners in elements {
            let nodes = corners.iter().map(|corner| {
                let known = mesh.coordinates.iter().position(|x| x == corner);
                known.filter(|_| joins).unwrap_or_else(|| {
                    mesh.coordinates.push(*corner);
                    mesh.coordinates.len() - 1
                })
            });
            let nodes = nodes.collect();
            let element_type = match corners.len() {
                3 => ElementType::CPS3,
                _ => ElementType::CPS4,
            };
            mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes,
                section: 0,
            });
        }
        mesh
    }

    fn found(elements: &[&[[f64; 2]]], joins: bool) -> Vec<[usize; 2]> {
        overlapping(&mesh(elements, joins))
    }

    /// A rectangle.
    fn at([x, y]: [f64; 2], [w, h]: [f64; 2]) -> [[f64; 2]; 4] {
        [[x, y], [x + w, y], [x + w, y + h], [x, y + h]]
    }

    #[test]
    fn elements_over_each_other_are_found() {
        let square = at([0.0, 0.0], [1.0, 1.0]);
        let half = [square[0], square[1], square[2]];
        assert_eq!(
            found(&[&square, &half], true),
            [[0, 1]],
            "on the same side of two faces"
        );
        let tip = [[0.0, 0.0], [1.0, -1.0], [1.0, 0.5]];
        assert_eq!(
            found(&[&square, &tip], true),
            [[0, 1]],
            "from a common node"
        );
        let right = at([1.0, 0.0], [1.0, 1.0]);
        let folded = at([0.5, 0.0], [0.5, 1.0]);
        assert_eq!(
            found(&[&square, &right, &folded], true),
            [[0, 2]],
            "folded back"
        );
        for unit in [1e-6, 1.0, 1e6] {
            let other = at([0.9, 0.9], [1.0, 1.0]).map(|x| x.map(|x| unit * x));
            let square = square.map(|x| x.map(|x| unit * x));
            assert_eq!(found(&[&square, &other], false), [[0, 1]], "two bodies");
        }
        assert_eq!(
            found(&[&square, &square], false),
            [[0, 1]],
            "twice at the same place"
        );
    }

    #[test]
    fn a_body_inside_another_is_found_and_one_in_a_hole_is_not() {
        let small = at([1.4, 1.4], [0.2, 0.2]);
        let grid: Vec<[[f64; 2]; 4]> = (0..9)
            .map(|i| at([f64::from(i % 3), f64::from(i / 3)], [1.0, 1.0]))
            .collect();
        let with = |left_out: usize| -> Vec<&[[f64; 2]]> {
            let kept = grid.iter().enumerate().filter(|(i, _)| *i != left_out);
            kept.map(|(_, e)| &e[..]).chain([&small[..]]).collect()
        };
        assert_eq!(found(&with(9), true), [[4, 9]]);
        assert_eq!(found(&with(4), true), Vec::<[usize; 2]>::new());
    }

    #[test]
    fn neighbours_are_not_over_each_other() {
        let square = at([0.0, 0.0], [1.0, 1.0]);
        let none = Vec::<[usize; 2]>::new();
        let right = at([1.0, 0.0], [1.0, 1.0]);
        let above = at([0.5, 1.0], [1.0, 1.0]);
        let corner = at([1.0, 1.0], [1.0, 1.0]);
        let near = at([1.0 - 1e-9, 0.25], [1.0, 0.5]);
        let shallow = at([0.97, 0.0], [1.0, 1.0]);
        for joins in [true, false] {
            assert_eq!(found(&[&square, &right], joins), none);
            assert_eq!(found(&[&square, &above], joins), none, "half an edge each");
            assert_eq!(found(&[&square, &corner], joins), none, "a corner");
            assert_eq!(found(&[&square, &near], joins), none, "round-off");
            assert_eq!(
                found(&[&square, &shallow], joins),
                none,
                "a curved surface as meshed"
            );
            let fan: Vec<[[f64; 2]; 3]> = (0..12)
                .map(|i| [i, i + 1].map(|i| f64::from(i) * std::f64::consts::TAU / 12.0))
                .map(|[a, b]| [[0.0; 2], [a.cos(), a.sin()], [b.cos(), b.sin()]])
                .collect();
            let fan: Vec<&[[f64; 2]]> = fan.iter().map(|e| &e[..]).collect();
            assert_eq!(found(&fan, joins), none, "around a node");
        }
    }
}
