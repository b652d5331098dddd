//! `*RIGID BODY`: rigid surfaces, rigid elements and nodes move with their reference nodes. Rigid bodies turn by an
//! angle if the angle is prescribed or the body has mass.

use super::context::Context;
use super::mesh_index::{MeshIndex, PointElement, PointKind, RigidLine};
use super::outline::Outline;
use super::sets::Sets;
use super::surfaces::Surfaces;
use crate::deck::{Card, Text};
use crate::diagnostics::{Code, Span, shown};
use crate::model::{Mesh, RigidPart, SurfaceKind};
use std::collections::BTreeSet;

/// Rigid surfaces, elements and nodes, and the node with which they move.
#[derive(Default)]
pub(crate) struct Rigid {
    /// Surfaces, element sets and node sets that cards make parts of the body; empty for coupled nodes.
    pub(super) parts: Vec<RigidPart>,
    /// Name of the first part of the body.
    pub(super) name: String,
    /// Nodes of the body, in increasing order.
    pub(super) nodes: Vec<usize>,
    /// Elements of the body, in increasing order.
    pub(super) elements: Vec<usize>,
    /// Reference node.
    pub(super) reference: usize,
    /// Number of the reference node in the deck.
    pub(super) label: String,
    /// Masses at nodes of the body.
    pub(super) masses: Vec<(usize, f64)>,
    /// Rotary inertia at nodes of the body.
    pub(super) rotary_inertia: f64,
    /// Whether the body is made of coupled nodes.
    pub(super) is_coupling: bool,
    /// Nodes of the body that belong to deformable elements; their mass counts for the body.
    pub(super) carried: Vec<usize>,
    /// Place of `*RIGID BODY`, or of the card that couples the nodes.
    pub(super) span: Span,
}

impl Rigid {
    /// A body of nodes that move with a reference node.
    pub fn of_coupling(
        name: &str,
        reference: usize,
        nodes: Vec<usize>,
        mesh_index: &MeshIndex,
        span: Span,
    ) -> Self {
        Rigid {
            name: name.to_owned(),
            nodes,
            reference,
            label: mesh_index.node_name(reference),
            is_coupling: true,
            span,
            ..Rigid::default()
        }
    }

    /// Nodes of the body with its reference node.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.iter().copied().chain([self.reference])
    }

    /// Whether a node belongs to the body or is its reference node.
    pub fn has(&self, node: usize) -> bool {
        self.reference == node || self.nodes.binary_search(&node).is_ok()
    }

    /// Adds nodes.
    pub fn add(&mut self, nodes: BTreeSet<usize>) {
        let reference = self.reference;
        self.nodes
            .extend(nodes.into_iter().filter(|&node| node != reference));
        self.nodes.sort_unstable();
        self.nodes.dedup();
    }

    /// Reports that a node of the body has no direction 6: the angle belongs to the reference node.
    pub fn report_angle(&self, span: Span, cx: &mut Context) {
        let (title, label) = (self.title(), &self.label);
        let message = format!(
            "nodes that ride on {title} have no direction 6: it is that of its reference node {label}"
        );
        cx.error(Code::BadDof, span, message)
            .other(title, self.span)
            .help("name the reference node");
    }

    /// Name of the body in the deck.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Place of the body in the deck.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Whether the body is made of coupled nodes.
    pub fn is_coupling(&self) -> bool {
        self.is_coupling
    }

    /// Name of the body in messages, as in `the rigid body TOP`.
    pub fn title(&self) -> String {
        match self.is_coupling {
            true => format!("the coupling {}", self.name),
            false => format!("the rigid body {}", self.name),
        }
    }

    /// Whether the body has mass.
    pub(super) fn has_mass(&self) -> bool {
        !self.elements.is_empty() || !self.masses.is_empty()
    }

    /// Whether the body has a moment of inertia about its centre of mass: elements, rotary inertia, or masses at two
    /// places.
    pub(super) fn has_inertia(&self, mesh: &Mesh) -> bool {
        let masses = self.masses.iter().map(|(node, _)| node);
        let mut places = masses
            .chain(&self.carried)
            .map(|&node| mesh.coordinates[node]);
        let first = places.next();
        let is_elsewhere = |place: [f64; 2]| Some(place) != first;
        !self.elements.is_empty() || self.rotary_inertia > 0.0 || places.any(is_elsewhere)
    }
}

/// The mesh with its sets and surfaces, in which names of a card are looked up.
#[derive(Clone, Copy)]
pub(super) struct Lookup<'a> {
    pub mesh_index: &'a MeshIndex,
    pub sets: &'a Sets,
    pub surfaces: &'a Surfaces,
}

/// Reads all rigid bodies: cards with one reference node make one body. Bodies with surfaces come first, in the order
/// of the surfaces.
pub(crate) fn read(outline: &Outline, lookup: Lookup, cx: &mut Context) -> Vec<Rigid> {
    let surfaces = lookup.surfaces;
    let mut all: Vec<Rigid> = Vec::new();
    let mut incomplete = cx.may_lack_cards();
    for card in outline.model_cards("RIGID BODY") {
        let Some(rigid) = rigid(card, lookup, cx) else {
            incomplete = true;
            continue;
        };
        if is_repeated(&rigid, &all, cx) {
            continue;
        }
        let same = |other: &&mut Rigid| other.reference == rigid.reference;
        match all.iter_mut().find(same) {
            Some(body) => body.join(rigid),
            None => all.push(rigid),
        }
    }
    let is_loose = |line: &&RigidLine| {
        !all.iter()
            .any(|body| line.nodes.iter().all(|&n| body.has(n)))
    };
    let mut lines = lookup.mesh_index.rigid_lines.iter();
    if let Some(line) = lines.find(is_loose).filter(|_| !incomplete) {
        let message = format!("element {} belongs to no rigid body", cx.named(line.label));
        cx.error(Code::RigidSurface, line.span, message)
            .help("add *RIGID BODY, ELSET=, REF NODE=");
    }
    let first_surface = |rigid: &Rigid| {
        let of_part = |part: &RigidPart| match part {
            RigidPart::Surface(index) => Some(*index),
            RigidPart::Elements(_) | RigidPart::Nodes(_) => None,
        };
        rigid.parts.iter().find_map(of_part).unwrap_or(usize::MAX)
    };
    all.sort_by_key(first_surface);
    let has_body = |index: usize| {
        let part = RigidPart::Surface(index);
        all.iter().any(|rigid| rigid.parts.contains(&part))
    };
    let lone = |(index, _): &&(usize, Span)| !has_body(*index);
    for &(index, span) in surfaces.rigid.iter().filter(lone) {
        if let Some(surface) = surfaces.all.get(index).filter(|_| !incomplete) {
            let message = format!("the rigid surface {} has no reference node", surface.name);
            cx.error(Code::RigidSurface, span, message)
                .help("add *RIGID BODY, ANALYTICAL SURFACE=, REF NODE=");
        }
    }
    all
}

/// Whether an earlier card has made a body of the same surface or set; such a repetition is reported.
fn is_repeated(rigid: &Rigid, earlier: &[Rigid], cx: &mut Context) -> bool {
    let other = |part: &RigidPart| earlier.iter().find(|other| other.parts.contains(part));
    let Some(other) = rigid.parts.iter().find_map(other) else {
        return false;
    };
    let message = match rigid.reference == other.reference {
        true => format!("{} stands on two cards", rigid.title()),
        false => format!("{} has a reference node already", rigid.name),
    };
    cx.error(Code::RigidSurface, rigid.span, message)
        .other(other.title(), other.span)
        .help("leave out one of the two");
    true
}

/// Masses of point elements.
pub(super) struct PointMasses {
    /// Masses of the point elements, 0 for elements without a mass (mass).
    pub all: Vec<f64>,
    /// Masses at nodes of no rigid body (index of the node, mass).
    pub free: Vec<(usize, f64)>,
}

/// Gives the masses and inertia of `*MASS` and `*ROTARY INERTIA` to the bodies, and other masses to nodes that move
/// (`moves`).
pub(super) fn point_masses(
    all: &mut [Rigid],
    moves: &[bool],
    outline: &Outline,
    lookup: Lookup,
    cx: &mut Context,
) -> PointMasses {
    let points = &lookup.mesh_index.points;
    let mut values: Vec<Option<f64>> = vec![None; points.len()];
    for (keyword, kind, column, what) in [
        ("MASS", PointKind::Mass, 0, "the mass"),
        (
            "ROTARY INERTIA",
            PointKind::RotaryInertia,
            2,
            "the third moment of inertia",
        ),
    ] {
        for card in outline.model_cards(keyword) {
            let field = card.required("ELSET", cx.d);
            let members =
                field.map(|field| (field, lookup.sets.points_of(field, lookup.mesh_index, cx)));
            let Some(row) = card.rows.first() else {
                continue;
            };
            row.at_most(column + 1, cx.d);
            let value = row.real(column, what, cx.d);
            if let Some(value) = value.filter(|value| *value <= 0.0) {
                let message = format!("{what} must be positive, found {}", shown(value));
                cx.error(Code::BadValue, row.span_at(column), message);
            }
            let (Some((field, members)), Some(value)) = (members, value) else {
                continue;
            };
            let own: Vec<usize> = members
                .into_iter()
                .filter(|&m| points[m].kind == kind)
                .collect();
            if own.is_empty() && !cx.may_lack_cards() {
                let element_type = if kind == PointKind::Mass {
                    "MASS"
                } else {
                    "ROTARYI"
                };
                let message = format!("{} holds no element of TYPE={element_type}", field.text);
                cx.error(Code::RigidSurface, field.span, message);
            }
            let before = own.iter().map(|&point| values[point].replace(value));
            if before.flatten().count() > 0 {
                let message = format!("elements of {} have {what} already", field.text);
                cx.error(Code::RepeatedCard, card.span, message)
                    .help("give it once for each element");
            }
        }
    }
    let mut free = Vec::new();
    for (point, &value) in points.iter().zip(&values) {
        let owner = all.iter_mut().find(|rigid| rigid.has(point.node));
        let fault = match (owner, value, point.kind) {
            (Some(rigid), Some(value), PointKind::Mass) => {
                rigid.masses.push((point.node, value));
                continue;
            }
            (Some(rigid), Some(value), PointKind::RotaryInertia) => {
                rigid.rotary_inertia += value;
                continue;
            }
            (None, Some(value), PointKind::Mass) if moves[point.node] => {
                free.push((point.node, value));
                continue;
            }
            (None, Some(_), PointKind::RotaryInertia) if moves[point.node] => {
                let message = "this rotary inertia has no effect: its node has no rotation";
                cx.d.warning_once(Code::IgnoredParameter, point.span, message)
                    .help("nodes of rigid bodies turn: name one of them");
                continue;
            }
            _ if cx.may_lack_cards() => continue,
            (None, ..) if !moves[point.node] => {
                "the node of this point element belongs to no element, spring or rigid body"
            }
            (_, _, PointKind::Mass) => "this element has no *MASS",
            (_, _, PointKind::RotaryInertia) => "this element has no *ROTARY INERTIA",
        };
        cx.error(Code::RigidSurface, point.span, fault)
            .help("give *MASS or *ROTARY INERTIA to an element at a node of a body, a spring or a *RIGID BODY");
    }
    let mass = |(point, value): (&PointElement, Option<f64>)| match point.kind {
        PointKind::Mass => value.unwrap_or(0.0),
        PointKind::RotaryInertia => 0.0,
    };
    PointMasses {
        all: points.iter().zip(values).map(mass).collect(),
        free,
    }
}

fn rigid(card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Rigid> {
    let reference = card.required("REF NODE", cx.d);
    let reference = reference.and_then(|field| {
        let other = (Code::RigidSurface, "a rigid surface moves with one node");
        lookup.sets.single_node(field, lookup.mesh_index, other, cx)
    });
    let mut rigid = Rigid {
        span: card.span,
        ..Rigid::default()
    };
    if let Some(field) = card.value("ELSET") {
        let lines = lookup.sets.rigid_lines_of(field, lookup.mesh_index, cx);
        match lines.is_empty() {
            true => rigid.add_elements(field, lookup, cx),
            false => rigid.add_lines(field, &lines, lookup, cx)?,
        }
    }
    for field in ["NSET", "PIN NSET", "TIE NSET"].map(|name| card.value(name)) {
        let Some(field) = field else { continue };
        let nodes = lookup.sets.nodes_of(field, lookup.mesh_index, cx);
        let name = lookup.sets.node_names.full_name(field, cx);
        rigid.add_part(RigidPart::Nodes(name.clone()), &name, nodes);
    }
    if card.has("ANALYTICAL SURFACE") || rigid.parts.is_empty() {
        rigid.add_surface(card, lookup, cx)?;
    }
    let reference = reference?;
    rigid.nodes.retain(|&node| node != reference);
    Some(Rigid {
        reference,
        label: lookup.mesh_index.node_name(reference),
        ..rigid
    })
}

impl Rigid {
    /// Adds the elements of a set, which become rigid, with their nodes.
    fn add_elements(&mut self, field: Text, lookup: Lookup, cx: &mut Context) {
        let elements = lookup.sets.elements_of(field, lookup.mesh_index, cx);
        let mesh = &lookup.mesh_index.mesh;
        let own = elements.iter().copied();
        self.elements = own.filter(|&e| e < mesh.elements.len()).collect();
        self.elements.sort_unstable();
        let nodes = self.elements.iter().flat_map(|&e| &mesh.elements[e].nodes);
        let nodes = nodes.copied().collect();
        let name = lookup.sets.element_names.full_name(field, cx);
        self.add_part(RigidPart::Elements(name.clone()), &name, nodes);
    }

    /// Adds rigid lines with their nodes, and the surfaces that are made of rigid lines.
    fn add_lines(
        &mut self,
        field: Text,
        lines: &[usize],
        lookup: Lookup,
        cx: &mut Context,
    ) -> Option<()> {
        let name = lookup.sets.element_names.full_name(field, cx);
        if !lookup
            .sets
            .elements_of(field, lookup.mesh_index, cx)
            .is_empty()
        {
            let message = format!("{name} holds rigid lines and other elements");
            cx.error(Code::RigidSurface, field.span, message)
                .help("give each of them a set and a *RIGID BODY");
            return None;
        }
        let is_meant = |(_, of_surface): &&(usize, Vec<usize>)| {
            of_surface.iter().all(|line| lines.contains(line))
        };
        let surfaces = lookup.surfaces.of_lines.iter().filter(is_meant);
        for &(index, _) in surfaces {
            let surface = &lookup.surfaces.all[index];
            let nodes = surface.nodes(&lookup.mesh_index.mesh);
            self.add_part(RigidPart::Surface(index), &surface.name, nodes);
        }
        if self.parts.is_empty() {
            let message = format!("the rigid lines of {name} make no surface");
            cx.error(Code::RigidSurface, field.span, message)
                .help("make one of them: *SURFACE with the row set, SPOS or set, SNEG");
            return None;
        }
        let own = lines
            .iter()
            .map(|&line| lookup.mesh_index.rigid_lines[line]);
        self.add(own.flat_map(|line| line.nodes).collect());
        Some(())
    }

    /// Adds the rigid surface of a card.
    fn add_surface(&mut self, card: &Card, lookup: Lookup, cx: &mut Context) -> Option<()> {
        let field = card.required("ANALYTICAL SURFACE", cx.d)?;
        let (index, surface, span) = lookup.surfaces.find(field, cx)?;
        let SurfaceKind::Rigid(_) = surface.kind else {
            let message = format!("surface {} is no rigid surface", surface.name);
            cx.error(Code::RigidSurface, span, message)
                .help("define it with *SURFACE, TYPE=SEGMENTS");
            return None;
        };
        let nodes = surface.nodes(&lookup.mesh_index.mesh);
        self.add_part(RigidPart::Surface(index), &surface.name, nodes);
        Some(())
    }

    /// Adds a part with its nodes; the first part gives the body its name.
    fn add_part(&mut self, part: RigidPart, name: &str, nodes: Vec<usize>) {
        if self.parts.is_empty() {
            name.clone_into(&mut self.name);
        }
        self.parts.push(part);
        self.nodes.extend(nodes);
        self.nodes.sort_unstable();
        self.nodes.dedup();
    }

    /// Adds the parts of another card with the same reference node.
    fn join(&mut self, other: Rigid) {
        self.parts.extend(other.parts);
        self.add(other.nodes.into_iter().collect());
        self.elements.extend(other.elements);
        self.elements.sort_unstable();
        self.elements.dedup();
    }
}

/// The first body with which one of the given nodes moves.
pub(crate) fn carrier<'a>(nodes: &[usize], rigid_bodies: &'a [Rigid]) -> Option<&'a Rigid> {
    let rides = |rigid: &&Rigid| {
        nodes
            .iter()
            .any(|node| rigid.nodes.binary_search(node).is_ok())
    };
    rigid_bodies.iter().find(rides)
}

/// Dof of the angle of the rigid body with a given number among all bodies of a mesh.
pub(super) fn angle_dof(number: usize, mesh: &Mesh) -> usize {
    2 * (mesh.node_count() + 2 * number + 1)
}

/// Dof of the angle of the rigid body with the given reference node.
pub(crate) fn angle_at(node: usize, rigid_bodies: &[Rigid], mesh: &Mesh) -> Option<usize> {
    let number = rigid_bodies
        .iter()
        .position(|rigid| rigid.reference == node)?;
    Some(angle_dof(number, mesh))
}

/// Name of a dof in the words of the deck.
pub(crate) fn dof_name(dof: usize, rigid_bodies: &[Rigid], mesh_index: &MeshIndex) -> String {
    let Some(number) = dof.checked_sub(angle_dof(0, &mesh_index.mesh)) else {
        let name = mesh_index.node_name(dof / 2);
        return format!("direction {} of node {name}", dof % 2 + 1);
    };
    let label = rigid_bodies
        .get(number / 4)
        .map_or("", |rigid| &rigid.label);
    format!("direction 6 of node {label}")
}

/// Finds the nodes of bodies that belong to deformable elements.
pub(super) fn find_carried(all: &mut [Rigid], mesh: &Mesh) {
    let mut is_rigid = vec![false; mesh.elements.len()];
    for &element in all.iter().flat_map(|rigid| &rigid.elements) {
        is_rigid[element] = true;
    }
    let mut deforms = vec![false; mesh.node_count()];
    let elements = mesh.elements.iter().zip(&is_rigid);
    for (element, _) in elements.filter(|(_, is_rigid)| !**is_rigid) {
        element.nodes.iter().for_each(|&node| deforms[node] = true);
    }
    for rigid in all {
        rigid.carried = rigid.nodes.clone();
        rigid.carried.retain(|&node| deforms[node]);
        if !rigid.carried.is_empty() && deforms[rigid.reference] {
            rigid.carried.push(rigid.reference);
        }
    }
}
