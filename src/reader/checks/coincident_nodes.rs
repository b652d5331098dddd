//! Nodes at the same place that nothing joins.

use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Equation, Mesh, Model};
use crate::reader::context::Context;
use crate::reader::mesh::Places;
use crate::vectors::distance;
use std::collections::BTreeSet;

/// Distance below which nodes lie at the same place, in lengths of the shortest element side: the
/// digits that mesh generators write.
const SAME_PLACE: f64 = 1e-6;

/// Numbers up to which whole ones keep their value as integers.
const MOST_WHOLE: f64 = (1_u64 << 52) as f64;

/// Cells along a square of cells.
const SQUARE: u64 = 8;

/// Warns about nodes of elements that lie at the same place although neither contact nor an
/// equation acts between them; `shortest` is the length of the shortest side of an element.
pub(crate) fn coincident_nodes(model: &Model, shortest: f64, places: &Places, cx: &mut Context) {
    if cx.d.has_errors() {
        return;
    }
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
    let warning = Diagnostic::warning(Code::CoincidentNodes, places.get(element), message);
    cx.d.push(
        warning.help(
            "the elements part there: merge the nodes, or define contact between the surfaces",
        ),
    );
}

/// The largest whole number up to x. The processors that the program is built for have no
/// instruction for it, but one that cuts off what stands behind the point.
fn floor(x: f64) -> f64 {
    if x.abs() > MOST_WHOLE {
        return x.floor();
    }
    let cut = x as i64 as f64;
    if cut > x { cut - 1.0 } else { cut }
}

/// Sets of nodes that contacts and equations act on.
struct Joined(Vec<BTreeSet<usize>>);

impl Joined {
    fn new(model: &Model) -> Joined {
        let of_contact = model.contacts.iter().map(|contact| {
            let sides = [contact.slave, contact.master].map(|side| &model.surfaces[side]);
            sides
                .iter()
                .flat_map(|side| side.nodes(&model.mesh))
                .collect()
        });
        let dofs = model.equations.iter().flat_map(Equation::dofs);
        let of_equations: BTreeSet<usize> = dofs.map(|dof| dof / 2).collect();
        Joined(of_contact.chain([of_equations]).collect())
    }

    fn contains(&self, pair: [usize; 2]) -> bool {
        let holds = |set: &BTreeSet<usize>| pair.iter().all(|node| set.contains(node));
        self.0.iter().any(holds)
    }
}

/// Pairs of nodes of elements at the same place, the smaller index first; `cell` is the length of the
/// shortest side.
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

/// Nodes in the cells of a grid.
struct Grid {
    /// Length of a cell's side.
    cell: f64,
    /// Last node in the cells of every key; cells may share one.
    last: Vec<u32>,
    /// For every node the one before it in its cell.
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

    /// Adds a node to the first of these cells.
    fn add(&mut self, node: usize, [[i, _], [j, _]]: [[u64; 2]; 2]) {
        let key = self.key(i, j);
        self.before[node] = std::mem::replace(&mut self.last[key], node as u32);
    }

    /// Visits the nodes in cells of these columns and rows.
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

    /// Numbers of the column or row of cells that holds a coordinate, and of the one beside it where
    /// the line between them is near.
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
