//! Checks of the mesh: shapes of elements, quantities that overflow or vanish, and nodes at the same place that nothing
//! joins.

use crate::diagnostics::{Code, Span};
use crate::model::{ElementsAtNodes, Equation, Mesh, Model, Plane, sides};
use crate::reader::context::Context;
use crate::reader::materials::MaterialPlaces;
use crate::reader::mesh_index::MeshIndex;
use crate::reader::sections::Properties;
use crate::vectors::{cross, difference, distance, dot};
use std::collections::BTreeSet;

/// Smallest cross product of two sides, relative to the square of the longest side.
const FLAT: f64 = 1e-10;

/// Reports elements that are clockwise, degenerate, not convex or defined twice.
pub(crate) fn mesh(mesh_index: &MeshIndex, at_nodes: &ElementsAtNodes, cx: &mut Context) {
    let mesh = &mesh_index.mesh;
    for index in 0..mesh.elements.len() {
        if !is_convex(index, mesh) {
            shape(index, mesh_index, mesh_index.places[index], cx);
        } else if mesh.elements[index].element_type.is_quadratic() {
            nodes_between_corners(index, mesh_index, cx);
        }
        if let Some(first) = same_nodes(index, mesh, at_nodes) {
            let span = mesh_index.places[index];
            let [element, first] = [index, first].map(|e| mesh_index.element_name(e));
            let message = format!("element {element} has the nodes of element {first}");
            cx.error(Code::RepeatedElement, span, message);
        }
    }
}

/// The last element before element `index` that has the same nodes.
fn same_nodes(index: usize, mesh: &Mesh, at_nodes: &ElementsAtNodes) -> Option<usize> {
    let nodes = mesh.elements[index].nodes.as_slice();
    // most others differ in the sum of their nodes, the first of which is the same
    let sum = |nodes: &[usize]| nodes.iter().sum::<usize>();
    let own = sum(nodes);
    let is_same = |&other: &usize| {
        let others = mesh.elements[other].nodes.as_slice();
        let may_be = others.len() == nodes.len() && sum(others) == own;
        may_be && nodes[1..].iter().all(|node| others.contains(node))
    };
    let before = at_nodes.of(nodes[0]).take_while(|&other| other < index);
    before.filter(is_same).last()
}

/// Whether an element certainly turns left at all of its corners.
fn is_convex(index: usize, mesh: &Mesh) -> bool {
    let at = |node: usize| mesh.coordinates[node];
    match *mesh.elements[index].corners() {
        [a, b, c] => turns_left([a, b, c].map(at)),
        [a, b, c, d] => turns_left([a, b, c, d].map(at)),
        _ => false,
    }
}

fn turns_left<const N: usize>(corners: [[f64; 2]; N]) -> bool {
    let sides: [[f64; 2]; N] =
        std::array::from_fn(|i| difference(corners[i], corners[(i + 1) % N]));
    let square = sides
        .map(|side| dot(side, side))
        .into_iter()
        .fold(0.0, f64::max);
    let turn = |i: usize| cross(sides[i], sides[(i + 1) % N]);
    square.is_normal() && (0..N).all(|i| turn(i) > FLAT * square)
}

/// Reports an element that does not turn left at all of its corners.
fn shape(index: usize, mesh_index: &MeshIndex, span: Span, cx: &mut Context) {
    let corners = mesh_index.mesh.corners(&mesh_index.mesh.elements[index]);
    let mut vectors = corners.clone();
    for (vector, [a, b]) in vectors.iter_mut().zip(sides(&corners)) {
        *vector = difference(a, b);
    }
    let square = vectors.iter().map(|&s| dot(s, s)).fold(0.0, f64::max);
    let mut flat = FLAT * square;
    if !square.is_normal() {
        let lengths = vectors.iter().map(|&side| distance([0.0; 2], side));
        let longest = lengths.fold(0.0, f64::max);
        if !longest.is_finite() {
            let name = mesh_index.element_name(index);
            let what = format!("the longest side of element {name}");
            return unusable(&what, longest, span, cx);
        }
        for x in vectors.as_flattened_mut() {
            *x /= longest;
        }
        flat = FLAT;
    }
    let (mut left, mut right) = (0, 0);
    for [s, t] in sides(&vectors) {
        let turn = cross(s, t);
        left += usize::from(turn > flat);
        right += usize::from(turn < -flat);
    }
    let count = corners.len();
    if left == count {
        return;
    }
    let label = mesh_index.element_name(index);
    let (fault, help) = if right == count {
        (
            format!("element {label} is numbered clockwise"),
            "reverse its node order",
        )
    } else if left + right < count {
        (
            format!("element {label} is degenerate: three of its nodes lie on one line"),
            "mend the mesh",
        )
    } else if left == right {
        (
            format!("the sides of element {label} cross"),
            "list its nodes in order around it",
        )
    } else {
        (format!("element {label} is not convex"), "mend the mesh")
    };
    cx.error(Code::BadShape, span, fault).help(help);
}

/// Smallest distance of a node between two corners from either corner, relative to the length of the side. If the node
/// lies at a quarter of a straight side, det(dX/dr) vanishes at the corner.
const NEAR_CORNER: f64 = 0.25;

/// Reports nodes between two corners that are not in the middle half of their side, and sides so curved that det(dX/dr)
/// is not positive at a corner.
fn nodes_between_corners(index: usize, mesh_index: &MeshIndex, cx: &mut Context) {
    let mesh = &mesh_index.mesh;
    let element = &mesh.elements[index];
    let at = |node: usize| mesh.coordinates[node];
    let (name, span) = (mesh_index.element_name(index), mesh_index.places[index]);
    for side in (0..element.side_count()).map(|side| element.side(side)) {
        let [a, b] = side.ends();
        let along = difference(at(a), at(b));
        for &node in side.nodes().iter().filter(|&&node| node != a && node != b) {
            let part = dot(difference(at(a), at(node)), along) / dot(along, along);
            if !(part > NEAR_CORNER && part < 1.0 - NEAR_CORNER) {
                let [node, a, b] = [node, a, b].map(|node| mesh_index.node_name(node));
                let message = format!(
                    "node {node} of element {name} is not between its corners {a} and {b}: it lies at {} of the \
                     way",
                    (part * 1e3).round() / 1e3
                );
                cx.error(Code::BadShape, span, message).help(
                    "nodes are the corners counter-clockwise, then one between each corner and the next, in the \
                     middle half of the side",
                );
                return;
            }
        }
    }
    let count = element.side_count();
    let straight = |i: usize| {
        let corner = [i, (i + 1) % count, (i + count - 1) % count];
        let [p, q, r] = corner.map(|k| at(element.nodes[k]));
        cross(difference(p, q), difference(p, r))
    };
    if let Some(i) = (0..count).find(|&i| element.corner_area(i, at) <= FLAT * straight(i)) {
        let node = mesh_index.node_name(element.nodes[i]);
        let message = format!("element {name} is folded at node {node}: its sides are too curved");
        cx.error(Code::BadShape, span, message)
            .help("mend the mesh");
    }
}

/// Reports materials in use and elements whose wave speed, area, stiffness or mass overflows or vanishes, because
/// nothing can be computed with such values.
pub(crate) fn magnitudes(mesh_index: &MeshIndex, properties: &Properties, cx: &mut Context) {
    if cx.d.has_errors() {
        return;
    }
    let materials = properties.materials.iter().zip(&properties.places);
    for (index, (material, &MaterialPlaces { material: span, .. })) in materials.enumerate() {
        let is_used = properties.sections.iter().any(|s| s.material == index);
        let speed = material.wave_speed(Plane::Strain);
        if is_used && !speed.is_normal() {
            let what = format!("the wave speed of material {}", material.name);
            unusable(&what, speed, span, cx);
        }
    }
    let mut total = 0.0;
    // density, and stiffness
    let of_sections = properties.sections.iter().map(|section| {
        let material = &properties.materials[section.material];
        let stiffness = material.law.small_strain().young * section.thickness;
        (material.density, stiffness)
    });
    let of_sections: Vec<(f64, f64)> = of_sections.collect();
    for (index, element) in mesh_index.mesh.elements.iter().enumerate() {
        let Some(&(density, stiffness)) = of_sections.get(element.section) else {
            continue;
        };
        let area = mesh_index.mesh.area(element);
        let section = &properties.sections[element.section];
        let mass = density * mesh_index.mesh.volume(element, section.thickness);
        total += mass;
        if [area, stiffness, mass, total]
            .iter()
            .all(|value| value.is_normal())
        {
            continue;
        }
        let magnitudes = [
            ("area of", area),
            ("stiffness E t of", stiffness),
            ("mass of", mass),
            ("mass of all elements up to", total),
        ];
        if let Some((what, value)) = magnitudes.iter().find(|(_, value)| !value.is_normal()) {
            let what = format!("the {what} element {}", mesh_index.element_name(index));
            return unusable(&what, *value, mesh_index.places[index], cx);
        }
    }
}

/// Reports a quantity that is not a normal number.
pub(super) fn unusable(what: &str, value: f64, span: Span, cx: &mut Context) {
    let message = format!("{what} is {value:e}: it cannot be computed with");
    cx.error(Code::Magnitude, span, message)
        .help("choose units in which the numbers of the deck are not so extreme");
}

/// Distance, relative to the shortest element side, below which two nodes lie at the same place; the value corresponds
/// to the number of digits that mesh generators write.
const SAME_PLACE: f64 = 1e-6;

/// Largest absolute value up to which a whole number keeps its value as an integer.
const MOST_WHOLE: f64 = (1_u64 << 52) as f64;

/// Number of cells along the side of a square of cells.
const SQUARE: u64 = 8;

/// Warns about nodes of elements that lie at the same place although nothing acts between
/// them; `shortest` is the length of the shortest side of an element.
pub(crate) fn coincident_nodes(model: &Model, shortest: f64, places: &[Span], cx: &mut Context) {
    let mut pairs = coincident(&model.mesh, shortest);
    if pairs.is_empty() {
        return;
    }
    let joined = Joined::new(model);
    pairs.retain(|&pair| !joined.contains(pair));
    let Some(&[p, q]) = pairs.first() else {
        return;
    };
    let mut elements = model.mesh.elements.iter();
    let Some(element) = elements.position(|element| element.nodes.contains(&q)) else {
        return;
    };
    let [a, b] = [p, q].map(|node| model.node_name(node));
    let message = match pairs.len() {
        1 => format!("node {b} lies where node {a} is, and nothing joins them"),
        n => format!(
            "{n} pairs of nodes lie at the same place and nothing joins them, the first are {a} and {b}"
        ),
    };
    cx.warning(Code::CoincidentNodes, places[element], message)
        .help("the elements part there: merge the nodes, or define contact between the surfaces");
}

/// The largest whole number that is at most x. The processors for which the program is built have no instruction that
/// rounds down, only an instruction that cuts off the digits behind the point.
fn floor(x: f64) -> f64 {
    if x.abs() > MOST_WHOLE {
        return x.floor();
    }
    let cut = x as i64 as f64;
    if cut > x { cut - 1.0 } else { cut }
}

/// Pairs of node sets whose nodes are joined: slave and master of a contact; for equations, a hinge or a rigid body,
/// the set of their nodes paired with itself.
struct Joined(Vec<[BTreeSet<usize>; 2]>);

impl Joined {
    fn new(model: &Model) -> Joined {
        let of_contact = model.contacts.iter().map(|contact| {
            [contact.slave, contact.master].map(|side| {
                let nodes = model.surfaces[side].nodes(&model.mesh);
                nodes.into_iter().collect()
            })
        });
        let dofs = model.equations.iter().flat_map(Equation::dofs);
        let of_equations: BTreeSet<usize> = dofs.map(|dof| dof / 2).collect();
        let of_hinges = model.hinges.iter().map(|hinge| hinge.nodes.into());
        let bodies = model.rigid_bodies.iter();
        let of_bodies =
            bodies.map(|body| body.nodes.iter().copied().chain([body.reference]).collect());
        let alike = [of_equations].into_iter().chain(of_hinges).chain(of_bodies);
        let alike = alike.map(|set: BTreeSet<usize>| [set.clone(), set]);
        Joined(of_contact.chain(alike).collect())
    }

    fn contains(&self, [p, q]: [usize; 2]) -> bool {
        let holds = |[a, b]: &[BTreeSet<usize>; 2]| {
            (a.contains(&p) && b.contains(&q)) || (a.contains(&q) && b.contains(&p))
        };
        self.0.iter().any(holds)
    }
}

/// Pairs of nodes of elements at the same place, with the smaller index first; `cell` is the length of the shortest
/// element side.
fn coincident(mesh: &Mesh, cell: f64) -> Vec<[usize; 2]> {
    let mut used = vec![false; mesh.node_count()];
    for &node in mesh.elements.iter().flat_map(|element| &element.nodes) {
        used[node] = true;
    }
    let mut grid = Grid::new(cell, used.len());
    let mut pairs = Vec::new();
    for q in (0..used.len()).filter(|&node| used[node]) {
        let at = mesh.coordinates[q];
        let cells = at.map(|x| grid.cells(x));
        grid.visit(cells, |p| {
            if distance(mesh.coordinates[p], at) <= SAME_PLACE * cell {
                pairs.push([p, q]);
            }
        });
        grid.add(q, cells);
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Nodes, sorted into the cells of a grid.
struct Grid {
    /// Length of the side of a cell.
    cell: f64,
    /// Last node in the cells of every key; several cells may share a key.
    last: Vec<u32>,
    /// For every node, the node that was added before this node under the same key.
    before: Vec<u32>,
}

impl Grid {
    /// No node.
    const NONE: u32 = u32::MAX;

    /// An empty grid for `count` nodes.
    fn new(cell: f64, count: usize) -> Grid {
        Grid {
            cell,
            last: vec![Grid::NONE; count.next_power_of_two()],
            before: vec![Grid::NONE; count],
        }
    }

    /// Adds a node to the cell with the first of the given columns and rows.
    fn add(&mut self, node: usize, [[i, _], [j, _]]: [[u64; 2]; 2]) {
        let key = self.key(i, j);
        self.before[node] = std::mem::replace(&mut self.last[key], node as u32);
    }

    /// Visits the nodes in the cells with the given columns and rows.
    fn visit(&self, [columns, rows]: [[u64; 2]; 2], mut visit: impl FnMut(usize)) {
        let count = |[first, other]: [u64; 2]| if first == other { 1 } else { 2 };
        for &i in &columns[..count(columns)] {
            for &j in &rows[..count(rows)] {
                let mut node = self.last[self.key(i, j)];
                while node != Grid::NONE {
                    visit(node as usize);
                    node = self.before[node as usize];
                }
            }
        }
    }

    /// Numbers of the column or row of cells that holds a coordinate, and of the neighbouring column or row if the line
    /// between the two columns or rows is near.
    fn cells(&self, x: f64) -> [u64; 2] {
        // The grid is shifted so that the nodes of regular meshes lie off its lines.
        let at = x / self.cell + 0.37;
        let own = floor(at);
        let part = at - own;
        let other = match part {
            part if part < SAME_PLACE => own - 1.0,
            part if part > 1.0 - SAME_PLACE => own + 1.0,
            _ => own,
        };
        [own, other].map(|number| number as i64 as u64)
    }

    fn key(&self, i: u64, j: u64) -> usize {
        // squares of cells lie together, as do the nodes that follow each other in most decks; the
        // odd factor of the golden ratio spreads the squares over the keys
        let square = (i / SQUARE).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (j / SQUARE);
        let cell = i % SQUARE * SQUARE + j % SQUARE;
        let key = square.wrapping_mul(SQUARE * SQUARE) | cell;
        key as usize & (self.last.len() - 1)
    }
}
