//! Nodes at the same place that nothing joins.

use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Equation, Mesh, Model};
use crate::reader::context::Context;
use std::collections::BTreeSet;

/// Distance below which nodes lie at the same place, in lengths of the shortest element side: the
/// digits that mesh generators write.
const SAME_PLACE: f64 = 1e-6;

/// Warns about nodes of elements that lie at the same place although neither contact nor an
/// equation acts between them; `spans` are the places of the elements.
pub(crate) fn coincident_nodes(model: &Model, spans: &[Span], cx: &mut Context) {
    if cx.d.has_errors() {
        return;
    }
    let mut pairs = coincident(&model.mesh);
    if pairs.is_empty() {
        return;
    }
    let joined = Joined::new(model);
    pairs.retain(|&pair| !joined.contains(pair));
    let Some(&[p, q]) = pairs.first() else {
        return;
    };
    let mut places = model.mesh.elements.iter().zip(spans);
    let Some((_, &span)) = places.find(|(element, _)| element.nodes.contains(&q)) else {
        return;
    };
    let [a, b] = [p, q].map(|node| model.node_name(node));
    let message = match pairs.len() {
        1 => format!("node {b} lies where node {a} is, and nothing joins them"),
        n => format!(
            "{n} pairs of nodes lie at the same place and nothing joins them, the first are {a} and {b}"
        ),
    };
    let warning = Diagnostic::warning(Code::CoincidentNodes, span, message);
    cx.d.push(
        warning.help(
            "the elements part there: merge the nodes, or define contact between the surfaces",
        ),
    );
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

/// Pairs of nodes of elements at the same place, the smaller index first.
fn coincident(mesh: &Mesh) -> Vec<[usize; 2]> {
    let sides = mesh.elements.iter().flat_map(|element| element.sides());
    let lengths = sides.map(|[a, b]| distance(mesh, a, b));
    let cell = lengths.fold(f64::INFINITY, f64::min);
    let mut used = vec![false; mesh.node_count()];
    for &node in mesh.elements.iter().flat_map(|element| &element.nodes) {
        used[node] = true;
    }
    let nodes = (0..used.len()).filter(|&node| used[node]);
    let mut entries: Vec<(u64, usize)> = nodes
        .flat_map(|node| cells(mesh.coordinates[node], cell).map(move |key| (key, node)))
        .collect();
    entries.sort_unstable();
    let mut pairs = BTreeSet::new();
    for group in entries.chunk_by(|a, b| a.0 == b.0) {
        for (i, &(_, p)) in group.iter().enumerate() {
            let others = group[i + 1..].iter().map(|&(_, q)| q);
            let close = |&q: &usize| p < q && distance(mesh, p, q) <= SAME_PLACE * cell;
            pairs.extend(others.filter(close).map(|q| [p, q]));
        }
    }
    pairs.into_iter().collect()
}

/// Keys of the cells of a grid that hold the place: beside the line between two cells it belongs to
/// both. Other cells may share a key.
fn cells(at: [f64; 2], cell: f64) -> impl Iterator<Item = u64> {
    // The grid is shifted so that the nodes of regular meshes lie off its lines.
    let numbers = at.map(|x| {
        let x = x / cell + 0.37;
        [x - SAME_PLACE, x + SAME_PLACE].map(|x| x.floor() as i64 as u64)
    });
    let several = |[low, high]: [u64; 2]| [low].into_iter().chain((low != high).then_some(high));
    several(numbers[0]).flat_map(move |i| {
        // odd factor of the golden ratio: spreads the columns over the keys
        let column = i.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        several(numbers[1]).map(move |j| column ^ j)
    })
}

fn distance(mesh: &Mesh, a: usize, b: usize) -> f64 {
    let (a, b) = (mesh.coordinates[a], mesh.coordinates[b]);
    (b[0] - a[0]).hypot(b[1] - a[1])
}
