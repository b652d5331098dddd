//! `*COUPLING`, `*KINEMATIC COUPLING` and `*MPC`: nodes that move with a reference node as a rigid body, reference
//! nodes that follow the mean of other nodes, and nodes joined to each other. See docs/theory/contact.md and
//! docs/theory/bodies.md.

use super::boundary::{Direction, direction};
use super::context::Context;
use super::outline::{CardBlock, Outline};
use super::rigid_bodies::{Lookup, Rigid};
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span};
use crate::model::Hinge;
use crate::vectors::distance;
use std::collections::BTreeSet;

/// Largest distance of two nodes that a pin joins, one node on a rigid body, relative to the distance to the farthest
/// node of the body.
const AT_ONE_PLACE: f64 = 1e-6;

/// A connection of nodes without a rigid body.
pub(crate) enum Link {
    /// Both displacements of a node equal the displacements of another node.
    Joined { node: usize, to: usize, span: Span },
    /// A hinge: two nodes at one place that belong to different rigid bodies.
    Hinge { nodes: [usize; 2], span: Span },
    /// Both displacements of a node are the means of the displacements of other nodes.
    Mean {
        name: String,
        node: usize,
        of: Vec<usize>,
        span: Span,
    },
}

impl Link {
    /// Name of the link in messages, as in `the coupling C`.
    pub fn title(&self) -> String {
        match self {
            Link::Joined { .. } | Link::Hinge { .. } => "an *MPC".to_owned(),
            Link::Mean { name, .. } => format!("the coupling {name}"),
        }
    }

    /// Place of the link in the deck.
    pub fn span(&self) -> Span {
        match self {
            Link::Joined { span, .. } | Link::Hinge { span, .. } | Link::Mean { span, .. } => *span,
        }
    }

    /// All nodes of the link.
    pub fn nodes(&self) -> Vec<usize> {
        match self {
            Link::Joined { node, to, .. } => vec![*node, *to],
            Link::Hinge { nodes, .. } => nodes.to_vec(),
            Link::Mean { node, of, .. } => of.iter().copied().chain([*node]).collect(),
        }
    }
}

/// Adds the rigid bodies of all couplings and constraints to `bodies`; returns the links that need no rigid body.
pub(super) fn read(
    outline: &Outline,
    lookup: Lookup,
    bodies: &mut Vec<Rigid>,
    cx: &mut Context,
) -> Vec<Link> {
    let mut links = Vec::new();
    for block in outline.blocks("COUPLING") {
        coupling(block, lookup, (bodies, &mut links), cx);
    }
    for card in outline.model_cards("KINEMATIC COUPLING") {
        let Some(reference) = reference(card, lookup, cx) else {
            continue;
        };
        let mut nodes = BTreeSet::new();
        for row in card.rows.iter() {
            row.at_most(3, cx.d);
            if let Some(field) = row.required(0, "a node or node set", cx.d) {
                nodes.extend(lookup.sets.nodes_of(field, lookup.mesh_index, cx));
            }
            takes_both([row.get(1), row.get(2)], row, cx);
        }
        let named = card.value("NAME").and_then(|field| name(field, cx));
        let label = lookup.mesh_index.node_name(reference);
        let name = named.unwrap_or_else(|| format!("COUPLING-{label}"));
        ride(&name, reference, nodes, card.span, lookup, bodies, cx);
    }
    for card in outline.model_cards("MPC") {
        for row in card.rows.iter() {
            mpc(row, lookup, (bodies, &mut links), cx);
        }
    }
    links
}

/// The name of a coupling.
fn name(field: Text, cx: &mut Context) -> Option<String> {
    let name = field.name(cx.d)?;
    Some(cx.of_instance(name, field.span).typed)
}

fn reference(card: &Card, lookup: Lookup, cx: &mut Context) -> Option<usize> {
    let field = card.required("REF NODE", cx.d)?;
    let other = (Code::Coupling, "nodes are coupled to one node");
    lookup.sets.single_node(field, lookup.mesh_index, other, cx)
}

/// `*COUPLING` with `*KINEMATIC` or `*DISTRIBUTING` under it.
fn coupling(
    block: &CardBlock,
    lookup: Lookup,
    (bodies, links): (&mut Vec<Rigid>, &mut Vec<Link>),
    cx: &mut Context,
) {
    let card = block.head;
    let reference = reference(card, lookup, cx);
    let nodes = card.required("SURFACE", cx.d).and_then(|field| {
        let (_, surface, _) = lookup.surfaces.find(field, cx)?;
        Some(surface.nodes(&lookup.mesh_index.mesh))
    });
    let name = card
        .required("CONSTRAINT NAME", cx.d)
        .and_then(|field| name(field, cx));
    let [kind] = block.parts[..] else {
        if !card.faulty && !cx.may_lack_cards() {
            let message = "*COUPLING has one card under it: *KINEMATIC or *DISTRIBUTING";
            cx.error(Code::Coupling, card.span, message);
        }
        return;
    };
    for row in kind.rows.iter() {
        row.at_most(2, cx.d);
        takes_both([row.get(0), row.get(1)], row, cx);
    }
    let (Some(reference), Some(nodes), Some(name)) = (reference, nodes, name) else {
        return;
    };
    let nodes: BTreeSet<usize> = nodes.into_iter().collect();
    match kind.keyword.name {
        "DISTRIBUTING" => {
            if nodes.contains(&reference) {
                let message =
                    "the reference node is one of the nodes that its loads are distributed to";
                cx.error(Code::Coupling, card.span, message)
                    .help("take a node of its own");
                return;
            }
            links.push(Link::Mean {
                name,
                node: reference,
                of: nodes.into_iter().collect(),
                span: card.span,
            });
        }
        _ => ride(&name, reference, nodes, card.span, lookup, bodies, cx),
    }
}

/// Checks that `first[, last]` name both directions of the plane; empty fields name both.
fn takes_both([first, last]: [Option<Text>; 2], row: Line, cx: &mut Context) {
    let Some(first) = first.or(last) else { return };
    let mut number = |field: Text| match direction(field, cx)? {
        Direction::Plane(axis) => Some(axis + 1),
        Direction::OutOfPlane => Some(3),
        Direction::Rotation => Some(6),
    };
    let Some(from) = number(first) else { return };
    let Some(to) = last.map_or(Some(from), number) else {
        return;
    };
    if from > 1 || to < 2 {
        let message = "nodes are coupled in directions 1 and 2 together";
        cx.error(Code::Coupling, row.span(), message)
            .help("couple a single direction with *EQUATION");
    }
}

/// Makes nodes move with a reference node: adds them to the rigid body of this node, which is made if needed.
fn ride(
    name: &str,
    reference: usize,
    mut nodes: BTreeSet<usize>,
    span: Span,
    lookup: Lookup,
    bodies: &mut Vec<Rigid>,
    cx: &mut Context,
) {
    nodes.remove(&reference);
    if nodes.is_empty() {
        if cx.errors() == 0 && !cx.may_lack_cards() {
            cx.error(
                Code::Coupling,
                span,
                "no node is coupled to the reference node",
            );
        }
        return;
    }
    match bodies.iter_mut().find(|body| body.has(reference)) {
        Some(body) => body.add(nodes),
        None => bodies.push(Rigid::of_coupling(
            name,
            reference,
            nodes.into_iter().collect(),
            lookup.mesh_index,
            span,
        )),
    }
}

/// Reads a row `type, n1, n2`.
fn mpc(
    row: Line,
    lookup: Lookup,
    (bodies, links): (&mut Vec<Rigid>, &mut Vec<Link>),
    cx: &mut Context,
) {
    row.at_most(3, cx.d);
    let Some(kind) = row.required(0, "the type of the constraint", cx.d) else {
        return;
    };
    let key = kind.name_key();
    if !["BEAM", "PIN", "TIE"].contains(&key.as_str()) {
        let message = format!("constraints of the type {} cannot be used", kind.text);
        cx.error(Code::Coupling, kind.span, message)
            .help("types are BEAM, PIN and TIE; linear constraints are *EQUATION");
        return;
    }
    let mut nodes = |index: usize| {
        let field = row.required(index, "a node or node set", cx.d)?;
        let nodes = lookup.sets.nodes_of(field, lookup.mesh_index, cx);
        (!nodes.is_empty()).then_some(nodes)
    };
    let (Some(first), Some(second)) = (nodes(1), nodes(2)) else {
        return;
    };
    if second.len() != 1 && second.len() != first.len() {
        let message = format!(
            "{} nodes are joined to {}: sets are of one length, or the second is one node",
            first.len(),
            second.len()
        );
        cx.error(Code::Coupling, row.span(), message);
        return;
    }
    for (k, &node) in first.iter().enumerate() {
        let to = second[if second.len() == 1 { 0 } else { k }];
        match key.as_str() {
            "BEAM" => {
                let label = lookup.mesh_index.node_name(to);
                let name = format!("BEAM-{label}");
                ride(
                    &name,
                    to,
                    BTreeSet::from([node]),
                    row.span(),
                    lookup,
                    bodies,
                    cx,
                );
            }
            _ => join(&key, [node, to], row.span(), lookup, (bodies, links), cx),
        }
    }
}

/// Joins two nodes by equations, by adding one node to the rigid body of the other, or by a hinge between two rigid
/// bodies.
fn join(
    kind: &str,
    [node, to]: [usize; 2],
    span: Span,
    lookup: Lookup,
    (bodies, links): (&mut [Rigid], &mut Vec<Link>),
    cx: &mut Context,
) {
    let body_of = |node: usize| bodies.iter().position(|body| body.has(node));
    let (body, rider) = match [node, to].map(body_of) {
        [None, None] => {
            links.push(Link::Joined { node, to, span });
            return;
        }
        [Some(body), None] => (body, to),
        [None, Some(body)] => (body, node),
        [Some(first), Some(second)] if first == second => {
            let message = format!("both nodes belong to {}", bodies[first].name());
            cx.error(Code::Coupling, span, message)
                .help("a hinge joins two bodies");
            return;
        }
        [Some(_), Some(_)] if kind == "TIE" => {
            let message = "both nodes belong to rigid bodies, which a tie would make one";
            cx.error(Code::Coupling, span, message).help(
                "PIN lets them turn about the node; make one rigid body of both if they shall not",
            );
            return;
        }
        [Some(body), Some(_)] => {
            if is_at_one_place([node, to], &bodies[body], span, lookup, cx) {
                let nodes = [node, to];
                links.push(Link::Hinge { nodes, span });
            }
            return;
        }
    };
    if is_at_one_place([node, to], &bodies[body], span, lookup, cx) {
        bodies[body].add(BTreeSet::from([rider]));
    }
}

/// Whether two nodes, one of which belongs to a rigid body, are at one place; a distance between the nodes is reported.
fn is_at_one_place(
    [node, to]: [usize; 2],
    body: &Rigid,
    span: Span,
    lookup: Lookup,
    cx: &mut Context,
) -> bool {
    let x = &lookup.mesh_index.mesh.coordinates;
    let size = body.nodes().map(|n| distance(x[n], x[node]));
    let is_near = distance(x[node], x[to]) <= AT_ONE_PLACE * size.fold(0.0, f64::max);
    if !is_near {
        let message = "a node joined to a rigid body must be at the place of the other node";
        cx.error(Code::Coupling, span, message)
            .help("MPC of the type BEAM joins nodes over a distance");
    }
    is_near
}

/// For each node, whether it belongs to an element, a spring or a dashpot, or is joined to another node.
pub(super) fn moving_nodes(links: &[Link], lookup: Lookup) -> Vec<bool> {
    let mut moves = lookup.mesh_index.mesh.has_element();
    let connectors = lookup.mesh_index.connectors.iter();
    let of_connectors = connectors.flat_map(|element| element.nodes.iter().copied());
    for node in of_connectors.chain(links.iter().flat_map(Link::nodes)) {
        moves[node] = true;
    }
    moves
}

/// The hinges among links, and their places.
pub(super) fn hinges(links: &[Link], cx: &mut Context) -> (Vec<Hinge>, Vec<Span>) {
    let (mut all, mut spans): (Vec<Hinge>, Vec<Span>) = Default::default();
    for link in links {
        let Link::Hinge { nodes, span } = *link else {
            continue;
        };
        let [a, b] = nodes;
        if all
            .iter()
            .any(|hinge| hinge.nodes == nodes || hinge.nodes == [b, a])
        {
            let message = "these nodes are joined by a hinge already";
            cx.error(Code::Coupling, span, message)
                .help("leave this row out");
        }
        all.push(Hinge { nodes });
        spans.push(span);
    }
    (all, spans)
}
