//! `*RIGID BODY`: rigid surfaces, rigid elements and nodes move with their reference nodes, and turn by an angle
//! where it is prescribed or they have mass.

use super::context::Context;
use super::mesh_index::{MeshIndex, PointElement, PointKind};
use super::outline::Outline;
use super::sets::Sets;
use super::surfaces::Surfaces;
use crate::deck::{Card, Text};
use crate::diagnostics::{Code, Span, shown};
use crate::model::{
    ContactMass, Equation, LandingRule, Mesh, Procedure, Rate, RigidBody, Step, Support,
    SupportMotion, SurfaceKind, TurningInertia,
};
use crate::vectors::difference;
use std::collections::{BTreeMap, BTreeSet};

/// A rigid surface, or a set of rigid elements, and the node that it moves with.
#[derive(Default)]
pub(crate) struct Rigid {
    /// Index of the surface; none of elements.
    surface: Option<usize>,
    /// Name of the surface or set.
    name: String,
    /// Its nodes, increasing.
    nodes: Vec<usize>,
    /// Its elements, increasing.
    elements: Vec<usize>,
    /// Reference node.
    reference: usize,
    /// Number of the reference node in the deck.
    label: String,
    /// Masses at its nodes.
    masses: Vec<(usize, f64)>,
    /// Rotary inertia at its nodes.
    rotary_inertia: f64,
    /// Whether it is made of coupled nodes: it moves freely where nothing is prescribed, with the mass of its nodes.
    is_coupling: bool,
    /// Place of `*RIGID BODY`, or of what couples its nodes.
    span: Span,
}

impl Rigid {
    /// Nodes that ride on a reference node.
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

    /// Its nodes with the reference node.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.iter().copied().chain([self.reference])
    }

    /// Whether a node is one of them.
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

    /// Name in the deck.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Place in the deck.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Whether it is made of coupled nodes.
    pub fn is_coupling(&self) -> bool {
        self.is_coupling
    }

    /// Whether it moves where nothing is prescribed: it has mass, its own or that of its nodes.
    fn moves_freely(&self) -> bool {
        self.has_mass() || self.is_coupling
    }

    /// Whether it has mass.
    fn has_mass(&self) -> bool {
        !self.elements.is_empty() || !self.masses.is_empty()
    }

    /// Whether it has a moment of inertia about its centre of mass.
    fn has_inertia(&self) -> bool {
        let mut nodes = self.masses.iter().map(|(node, _)| node);
        let first = nodes.next();
        !self.elements.is_empty() || self.rotary_inertia > 0.0 || nodes.any(|n| Some(n) != first)
    }
}

/// The mesh, its sets and surfaces, among which a card names.
#[derive(Clone, Copy)]
pub(super) struct Lookup<'a> {
    pub mesh_index: &'a MeshIndex,
    pub sets: &'a Sets,
    pub surfaces: &'a Surfaces,
}

/// Reads all rigid surfaces with their reference nodes, by the index of the surface, and all sets of
/// rigid elements.
pub(crate) fn read(outline: &Outline, lookup: Lookup, cx: &mut Context) -> Vec<Rigid> {
    let surfaces = lookup.surfaces;
    let mut of_surfaces = BTreeMap::new();
    let mut of_elements = Vec::new();
    let mut incomplete = cx.may_lack_cards();
    for card in outline.model_cards("RIGID BODY") {
        let Some(rigid) = rigid(card, lookup, cx) else {
            incomplete = true;
            continue;
        };
        let Some(index) = rigid.surface else {
            of_elements.push(rigid);
            continue;
        };
        if of_surfaces.contains_key(&index) {
            let message = format!("surface {} has a reference node already", rigid.name);
            cx.error(Code::RigidSurface, card.span, message);
        }
        of_surfaces.insert(index, rigid);
    }
    let all: Vec<Rigid> = of_surfaces.into_values().chain(of_elements).collect();
    let has_body = |index: usize| all.iter().any(|rigid| rigid.surface == Some(index));
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

/// Gives the bodies the masses and inertia of `*MASS` and `*ROTARY INERTIA`; the masses by the point elements, 0 of
/// others.
pub(super) fn point_masses(
    all: &mut [Rigid],
    outline: &Outline,
    lookup: Lookup,
    cx: &mut Context,
) -> Vec<f64> {
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
            own.into_iter()
                .for_each(|point| values[point] = Some(value));
        }
    }
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
            _ if cx.may_lack_cards() => continue,
            (None, ..) => "this point element belongs to no rigid body",
            (_, None, PointKind::Mass) => "this element has no *MASS",
            (_, None, PointKind::RotaryInertia) => "this element has no *ROTARY INERTIA",
        };
        cx.error(Code::RigidSurface, point.span, fault)
            .help("its node is the reference node, or another one, of a *RIGID BODY");
    }
    let mass = |(point, value): (&PointElement, Option<f64>)| match point.kind {
        PointKind::Mass => value.unwrap_or(0.0),
        PointKind::RotaryInertia => 0.0,
    };
    points.iter().zip(values).map(mass).collect()
}

fn rigid(card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Rigid> {
    let reference = card.required("REF NODE", cx.d);
    let reference = reference.and_then(|field| {
        let other = (Code::RigidSurface, "a rigid surface moves with one node");
        lookup.sets.single_node(field, lookup.mesh_index, other, cx)
    });
    let set = ["NSET", "PIN NSET", "TIE NSET"]
        .iter()
        .find_map(|name| card.value(name));
    let mut rigid = match (card.value("ELSET"), set) {
        (Some(field), _) => of_elements(field, card, lookup, cx)?,
        (None, Some(field)) => Rigid {
            name: field.text.to_string(),
            nodes: lookup.sets.nodes_of(field, lookup.mesh_index, cx),
            ..Rigid::default()
        },
        (None, None) => of_surface(card, lookup, cx)?,
    };
    let reference = reference?;
    rigid.nodes.retain(|&node| node != reference);
    rigid.nodes.sort_unstable();
    Some(Rigid {
        reference,
        label: lookup.mesh_index.node_name(reference),
        span: card.span,
        ..rigid
    })
}

/// The body of a rigid surface, without its reference node.
fn of_surface(card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Rigid> {
    let field = card.required("ANALYTICAL SURFACE", cx.d)?;
    let (index, surface, span) = lookup.surfaces.find(field, cx)?;
    let SurfaceKind::Rigid(_) = surface.kind else {
        let message = format!("surface {} is no rigid surface", surface.name);
        cx.error(Code::RigidSurface, span, message)
            .help("define it with *SURFACE, TYPE=SEGMENTS");
        return None;
    };
    Some(Rigid {
        surface: Some(index),
        name: surface.name.clone(),
        nodes: surface.nodes(&lookup.mesh_index.mesh),
        ..Rigid::default()
    })
}

/// Those of the elements of a set, without surface.
fn of_elements(field: Text, card: &Card, lookup: Lookup, cx: &mut Context) -> Option<Rigid> {
    if card.has("ANALYTICAL SURFACE") {
        let span = card.span_of("ANALYTICAL SURFACE");
        cx.error(Code::RigidSurface, span, "a rigid body of two kinds")
            .help("give the surface and the elements a *RIGID BODY each");
        return None;
    }
    let elements = lookup.sets.elements_of(field, lookup.mesh_index, cx);
    let mesh = &lookup.mesh_index.mesh;
    let mut elements: Vec<usize> = elements.to_vec();
    elements.retain(|&e| e < mesh.elements.len());
    elements.sort_unstable();
    let nodes = elements.iter().flat_map(|&e| &mesh.elements[e].nodes);
    let nodes: BTreeSet<usize> = nodes.copied().collect();
    Some(Rigid {
        name: field.text.to_string(),
        nodes: nodes.into_iter().collect(),
        elements,
        ..Rigid::default()
    })
}

/// Dof of the angle of the rigid body with this number, among all, in a mesh.
fn angle_dof(number: usize, mesh: &Mesh) -> usize {
    2 * (mesh.node_count() + 2 * number + 1)
}

/// Dof of the angle of the rigid body whose reference node this is.
pub(crate) fn angle_at(node: usize, rigid_bodies: &[Rigid], mesh: &Mesh) -> Option<usize> {
    let number = rigid_bodies
        .iter()
        .position(|rigid| rigid.reference == node)?;
    Some(angle_dof(number, mesh))
}

/// The dof in the words of the deck.
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

/// How a rigid body moves in all steps.
#[derive(Clone, Copy, PartialEq)]
enum BodyMotion {
    /// By the supports of its nodes, which are those of the reference node.
    Translates,
    /// It has an angle of its own, with this number.
    Turns(usize),
}

/// Gives steps and initial velocities the motion of the rigid bodies; the bodies as the model holds them.
pub(crate) fn complete(
    rigid_bodies: &[Rigid],
    mesh_index: &MeshIndex,
    steps: &mut [Step],
    velocity: &mut Vec<f64>,
    cx: &mut Context,
) -> Vec<RigidBody> {
    let mesh = &mesh_index.mesh;
    let mut count = 0;
    let motions = rigid_bodies.iter().enumerate().map(|(number, rigid)| {
        let turns = turns(rigid, angle_dof(number, mesh), steps, velocity);
        count += usize::from(turns);
        match turns {
            true => BodyMotion::Turns(count - 1),
            false => BodyMotion::Translates,
        }
    });
    let motions: Vec<BodyMotion> = motions.collect();
    let all = rigid_bodies.iter().zip(&motions).enumerate();
    for (number, (rigid, motion)) in all {
        let angle = angle_dof(number, mesh);
        match motion {
            BodyMotion::Translates => report_moments(rigid, angle, steps, cx),
            BodyMotion::Turns(_) => {
                complete_turning(rigid, angle, mesh_index, steps, cx);
                report_own_velocities(rigid, angle, mesh_index, velocity, cx);
            }
        }
    }
    for (index, step) in steps.iter_mut().enumerate() {
        follow(
            rigid_bodies,
            &motions,
            mesh_index,
            index + 1,
            &mut step.supports,
            cx,
        );
        let renumbered = |dof: usize| renumbered(dof, &motions, mesh);
        let supports = step.supports.iter().filter_map(|support| {
            let dof = renumbered(support.dof)?;
            Some(Support { dof, ..*support })
        });
        step.supports = supports.collect();
        for load in &mut step.point_loads {
            load.at.dof = renumbered(load.at.dof).unwrap_or(load.at.dof);
        }
    }
    let nodes = mesh.dof_count();
    let angles = velocity.split_off(nodes.min(velocity.len()));
    for (number, motion) in motions.iter().enumerate() {
        if let BodyMotion::Turns(_) = motion {
            let omega = angles.get(angle_dof(number, mesh) - nodes);
            velocity.extend([0.0, 0.0, omega.copied().unwrap_or(0.0), 0.0]);
        }
    }
    let body = |(rigid, motion): (&Rigid, &BodyMotion)| RigidBody {
        name: rigid.name.clone(),
        surface: rigid.surface,
        reference: rigid.reference,
        nodes: rigid.nodes.clone(),
        elements: rigid.elements.clone(),
        is_coupling: rigid.is_coupling,
        turning: match *motion {
            BodyMotion::Translates => None,
            BodyMotion::Turns(number) => Some(TurningInertia {
                number,
                masses: rigid.masses.clone(),
                rotary_inertia: rigid.rotary_inertia,
            }),
        },
    };
    rigid_bodies.iter().zip(&motions).map(body).collect()
}

/// Reports equations at nodes of bodies that turn, and that landing return and redistributed mass leave these bodies
/// out; bodies of revolution cannot turn at all.
pub(crate) fn check(
    rigid_bodies: &[Rigid],
    bodies: &[RigidBody],
    is_axisymmetric: bool,
    (steps, equations): (&[Step], &[(Equation, Span)]),
    cx: &mut Context,
) {
    let turning = rigid_bodies
        .iter()
        .zip(bodies)
        .filter(|(_, body)| body.turning.is_some());
    for (rigid, body) in turning {
        let has =
            |dof: usize| dof / 2 == body.reference || body.nodes.binary_search(&(dof / 2)).is_ok();
        if let Some((_, span)) = equations.iter().find(|(e, _)| e.dofs().any(has)) {
            let message = format!("this equation has a node of {}, which turns", rigid.name);
            cx.error(Code::RigidSurface, *span, message)
                .help("equations are linear: hold the rotation of the body, direction 6 of its reference node");
        }
        let returns = (steps.iter()).any(|step| step.settings.landing == LandingRule::Return);
        let redistributes =
            (steps.iter()).any(|step| step.settings.contact_mass == ContactMass::Redistributed);
        if is_axisymmetric {
            let message = format!("{} turns in a model of bodies of revolution", rigid.name);
            cx.error(Code::Revolution, rigid.span, message)
                .help("hold its rotation, direction 6 of its reference node");
        }
        let options = [
            (returns, "LANDING=RETURN"),
            (redistributes, "CONTACT MASS=REDISTRIBUTED"),
        ];
        for (_, option) in options.into_iter().filter(|(is_asked, _)| *is_asked) {
            let message = format!("{} turns, and {option} leaves it out", rigid.name);
            cx.warning(Code::RigidSurface, rigid.span, message)
                .help("it holds for contacts between bodies that deform");
        }
    }
}

/// The dof with the number that the angle of a body has among those that turn; none of a body that does not.
fn renumbered(dof: usize, motions: &[BodyMotion], mesh: &Mesh) -> Option<usize> {
    match dof.checked_sub(angle_dof(0, mesh)) {
        None => Some(dof),
        Some(number) => match motions.get(number / 4)? {
            BodyMotion::Turns(number) => Some(angle_dof(*number, mesh)),
            BodyMotion::Translates => None,
        },
    }
}

/// Whether a motion is none.
fn is_still(motion: SupportMotion) -> bool {
    match motion {
        SupportMotion::Ramp { to } => to == 0.0,
        SupportMotion::Amplitude { value, .. } | SupportMotion::Rate { value, .. } => value == 0.0,
    }
}

/// The motion of a dof in a step, if it is prescribed.
fn motion_of(step: &Step, dof: usize) -> Option<SupportMotion> {
    let found = step
        .supports
        .binary_search_by_key(&dof, |support| support.dof);
    found.ok().map(|index| step.supports[index].motion)
}

/// Whether a body turns: its angle moves in some step, or a body with mass is free in some direction of some step.
fn turns(rigid: &Rigid, angle: usize, steps: &[Step], velocity: &[f64]) -> bool {
    let moves_freely = rigid.moves_freely();
    let translations = [0, 1].map(|i| 2 * rigid.reference + i);
    velocity.get(angle).is_some_and(|omega| *omega != 0.0)
        || steps.iter().any(|step| match motion_of(step, angle) {
            Some(motion) if !is_still(motion) => true,
            of_angle => {
                let is_free = |dof: &usize| motion_of(step, *dof).is_none();
                moves_freely && (of_angle.is_none() || translations.iter().any(is_free))
            }
        })
}

/// Reports moments on a body that does not turn.
fn report_moments(rigid: &Rigid, angle: usize, steps: &[Step], cx: &mut Context) {
    let mut loads = steps.iter().flat_map(|step| &step.point_loads);
    if loads.any(|load| load.at.dof == angle) {
        let message = format!("{} takes a moment and does not turn", rigid.name);
        cx.error(Code::RigidSurface, rigid.span, message).help(
            "a body turns by a moment if it has mass and direction 6 of its reference node is free",
        );
    }
}

/// Largest difference of a node's velocity from that of its body, beside the largest velocity.
const SAME_VELOCITY: f64 = 1e-9;

/// Reports velocities of nodes of a body that are not those of its reference node and angle.
fn report_own_velocities(
    rigid: &Rigid,
    angle: usize,
    mesh_index: &MeshIndex,
    velocity: &[f64],
    cx: &mut Context,
) {
    let x = &mesh_index.mesh.coordinates;
    let of = |dof: usize| velocity.get(dof).copied().unwrap_or(0.0);
    let (reference, omega) = (rigid.reference, of(angle));
    let largest = velocity.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let differs = |node: &&usize| {
        let [rx, ry] = difference(x[reference], x[**node]);
        let turn = [-omega * ry, omega * rx];
        (0..2).any(|i| {
            let own = of(2 * **node + i);
            let expected = of(2 * reference + i) + turn[i];
            own != 0.0 && (own - expected).abs() > SAME_VELOCITY * largest
        })
    };
    if let Some(&node) = rigid.nodes.iter().find(differs) {
        let message = format!(
            "node {} of {} starts with another velocity than the body",
            mesh_index.node_name(node),
            rigid.name
        );
        cx.error(Code::RigidSurface, rigid.span, message).help(
            "*INITIAL CONDITIONS gives the velocity of a rigid body at its reference node, directions 1, 2 and 6",
        );
    }
}

/// Completes the supports of a body that turns: without mass it is held where nothing is said.
fn complete_turning(
    rigid: &Rigid,
    angle: usize,
    mesh_index: &MeshIndex,
    steps: &mut [Step],
    cx: &mut Context,
) {
    let has_mass = rigid.has_mass();
    let own: BTreeSet<usize> = rigid.nodes.iter().copied().collect();
    if rigid.is_coupling && !report_empty_coupling(rigid, &own, mesh_index, cx) {
        return;
    }
    for (index, step) in steps.iter_mut().enumerate() {
        if let Some(held) = step.supports.iter().find(|s| own.contains(&(s.dof / 2))) {
            return report_other_motion(rigid, &mesh_index.node_name(held.dof / 2), cx);
        }
        let turns_freely = motion_of(step, angle).is_none();
        let needs_inertia = has_mass && !rigid.is_coupling && step.procedure != Procedure::Static;
        if needs_inertia && turns_freely && !rigid.has_inertia() {
            let message = format!("{} may turn and has no rotary inertia", rigid.name);
            cx.error(Code::RigidSurface, rigid.span, message).help(
                "add *ELEMENT, TYPE=ROTARYI and *ROTARY INERTIA, or hold direction 6 of its reference node",
            );
            return;
        }
        if rigid.moves_freely() {
            continue;
        }
        for direction in 0..2 {
            if motion_of(step, 2 * rigid.reference + direction).is_none() {
                return report_free(rigid, direction, index + 1, cx);
            }
        }
        if let Err(at) = step
            .supports
            .binary_search_by_key(&angle, |support| support.dof)
        {
            let motion = SupportMotion::Rate {
                rate: Rate::Velocity,
                value: 0.0,
                amplitude: None,
            };
            step.supports.insert(at, Support { dof: angle, motion });
        }
    }
}

/// Whether a coupling can move freely: reports one without a node of an element, or without an arm.
fn report_empty_coupling(
    rigid: &Rigid,
    own: &BTreeSet<usize>,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) -> bool {
    let mesh = &mesh_index.mesh;
    let x = &mesh.coordinates;
    let mut of_elements = mesh.elements.iter().flat_map(|element| &element.nodes);
    let (message, help) = if !of_elements.any(|node| own.contains(node)) {
        (
            format!("no node of {} belongs to an element", rigid.name),
            "couple nodes of a body",
        )
    } else if own.iter().all(|&node| x[node] == x[rigid.reference]) {
        (
            format!(
                "all nodes of {} are at the place of its reference node",
                rigid.name
            ),
            "join two nodes at one place by *MPC of the type PIN",
        )
    } else {
        return true;
    };
    cx.error(Code::Coupling, rigid.span, message).help(help);
    false
}

/// Adds the supports of the nodes of rigid bodies that do not turn to those of a step: they move as their reference
/// nodes.
fn follow(
    rigid_bodies: &[Rigid],
    of_bodies: &[BodyMotion],
    mesh_index: &MeshIndex,
    step: usize,
    supports: &mut Vec<Support>,
    cx: &mut Context,
) {
    let mut motions: BTreeMap<usize, SupportMotion> = BTreeMap::new();
    motions.extend(supports.iter().map(|support| (support.dof, support.motion)));
    let all = rigid_bodies.iter().zip(of_bodies);
    for (rigid, _) in all.filter(|(_, motion)| **motion == BodyMotion::Translates) {
        for direction in 0..2 {
            let Some(&motion) = motions.get(&(2 * rigid.reference + direction)) else {
                report_free(rigid, direction, step, cx);
                continue;
            };
            for &node in &rigid.nodes {
                let other = motions.insert(2 * node + direction, motion);
                if other.is_some_and(|other| other != motion) {
                    return report_other_motion(rigid, &mesh_index.node_name(node), cx);
                }
            }
        }
    }
    let all = motions.into_iter();
    *supports = all.map(|(dof, motion)| Support { dof, motion }).collect();
}

fn report_other_motion(rigid: &Rigid, node: &str, cx: &mut Context) {
    let message = format!(
        "node {node} of {} is prescribed otherwise than the reference node {}",
        rigid.name, rigid.label
    );
    cx.error(Code::RigidSurface, rigid.span, message)
        .help("a rigid body moves as its reference node, which *BOUNDARY prescribes");
}

fn report_free(rigid: &Rigid, direction: usize, step: usize, cx: &mut Context) {
    let message = format!(
        "the reference node {} of {} is free in direction {} in step {step}",
        rigid.label,
        rigid.name,
        direction + 1
    );
    cx.error(Code::RigidSurface, rigid.span, message)
        .help("prescribe its directions 1 and 2 with *BOUNDARY, or give the body mass");
}
