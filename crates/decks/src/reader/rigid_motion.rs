//! Motion of rigid bodies in the steps of a model: their supports and velocities, which bodies turn, and checks of
//! equations and moments at their nodes. See docs/theory/bodies.md, Rigid bodies that turn.

use super::boundary::{InitialVelocity, Supports};
use super::context::Context;
use super::mesh_index::MeshIndex;
use super::owners::Owner;
use super::rigid_bodies::{Rigid, angle_dof};
use crate::diagnostics::{Code, Span};
use crate::model::{
    ContactMass, Equation, LandingRule, Mesh, Model, Procedure, Rate, RigidBody, Step, Support,
    SupportMotion,
};
use crate::vectors::difference;
use std::collections::{BTreeMap, BTreeSet};

/// Adds the motion of the rigid bodies to the steps; returns the bodies of the model. Nodes of bodies that do not turn
/// get the supports of their reference nodes, until [`leave_to_bodies`] removes them. `supports` and the velocities
/// contain the places of their rows in the deck, for messages.
pub(crate) fn complete(
    rigid_bodies: &[Rigid],
    (mesh_index, supports): (&MeshIndex, &Supports),
    steps: &mut [Step],
    InitialVelocity {
        values: velocity,
        places,
        ..
    }: &InitialVelocity,
    cx: &mut Context,
) -> Vec<RigidBody> {
    let mesh = &mesh_index.mesh;
    let all = rigid_bodies.iter().enumerate();
    let turn: Vec<bool> = all
        .clone()
        .map(|(number, rigid)| turns(rigid, angle_dof(number, mesh), steps, velocity))
        .collect();
    for ((number, rigid), turns) in all.clone().zip(&turn) {
        let angle = angle_dof(number, mesh);
        if *turns {
            complete_turning(rigid, angle, (mesh_index, supports), steps, cx);
            report_own_velocities(rigid, angle, mesh_index, (velocity, places), cx);
        } else {
            report_moments(rigid, angle, steps, cx);
        }
    }
    let held = all.zip(&turn).filter(|(_, turns)| !**turns);
    let held: Vec<(usize, &Rigid)> = held.map(|(body, _)| body).collect();
    for (index, step) in steps.iter_mut().enumerate() {
        follow(&held, (mesh_index, supports), (index + 1, step), cx);
    }
    let body = |((number, rigid), turns): ((usize, &Rigid), bool)| RigidBody {
        number,
        name: rigid.name.clone(),
        parts: rigid.parts.clone(),
        reference: rigid.reference,
        nodes: rigid.nodes.clone(),
        elements: rigid.elements.clone(),
        is_coupling: rigid.is_coupling,
        masses: rigid.masses.clone(),
        rotary_inertia: rigid.rotary_inertia,
        turns,
    };
    let all = rigid_bodies.iter().enumerate();
    all.zip(turn).map(body).collect()
}

/// Removes the supports that nodes of rigid bodies have from their reference nodes, because the bodies move these
/// nodes.
pub(crate) fn leave_to_bodies(model: &mut Model) {
    let nodes = model.rigid_bodies.iter().flat_map(|body| &body.nodes);
    let nodes: BTreeSet<usize> = nodes.copied().collect();
    for step in &mut model.steps {
        (step.supports).retain(|support| !nodes.contains(&(support.dof / 2)));
    }
}

/// Reports equations at nodes of bodies that turn; warns that landing return and redistributed mass do not apply to
/// bodies that turn. In a model of revolution, rigid bodies may only move along the axis.
pub(crate) fn check(
    rigid_bodies: &[Rigid],
    bodies: &[RigidBody],
    mesh: &Mesh,
    (steps, equations): (&[Step], &[(Equation, Owner)]),
    cx: &mut Context,
) {
    let all = rigid_bodies.iter().zip(bodies);
    for (rigid, body) in all.filter(|(_, body)| body.turns) {
        let has =
            |dof: usize| dof / 2 == body.reference || body.nodes.binary_search(&(dof / 2)).is_ok();
        if let Some((_, owner)) = equations.iter().find(|(e, _)| e.dofs().any(has)) {
            let own = match owner {
                Owner::Equation(_) => "this equation".to_owned(),
                owner => owner.title(),
            };
            let message = format!("{own} has a node of {}, which moves freely", rigid.title());
            owner.contradicts(Owner::Body(rigid), message, cx).help(
                "equations are linear: join the node to the body by TIE NSET= of *RIGID BODY or by *MPC, or prescribe \
                 directions 1, 2 and 6 of the reference node",
            );
        }
        let angle = angle_dof(body.number, mesh);
        let is_held = |step: &&Step| step.motion_of(angle).is_some_and(SupportMotion::is_still);
        if mesh.is_axisymmetric() {
            let is_driven = |step: &Step| step.motion_of(2 * body.reference).is_some();
            let fault = match steps.iter().all(|step| is_held(&step)) {
                false => Some(("turns", "its rotation, direction 6")),
                true if !steps.iter().all(is_driven) => {
                    Some(("moves freely across the axis", "direction 1"))
                }
                true => None,
            };
            if let Some((fault, what)) = fault {
                let message = format!("{} {fault} in a model of bodies of revolution", rigid.name);
                cx.error(Code::Revolution, rigid.span, message)
                    .help(format!("hold {what} of its reference node"));
            }
        }
        let returns = |step: &&Step| step.settings.landing == LandingRule::Return;
        let turns = !steps.iter().filter(returns).all(|step| is_held(&step));
        let redistributes =
            (steps.iter()).any(|step| step.settings.contact_mass == ContactMass::Redistributed);
        let options = [
            (turns, "turns, and LANDING=RETURN"),
            (redistributes, "is rigid, and CONTACT MASS=REDISTRIBUTED"),
        ];
        for (_, option) in options.into_iter().filter(|(is_asked, _)| *is_asked) {
            let message = format!("{} {option} leaves it out", rigid.name);
            cx.warning(Code::RigidSurface, rigid.span, message)
                .help("it holds for contacts between bodies that deform");
        }
    }
}

impl Rigid {
    /// Whether the body moves in directions that are not prescribed in a step: this needs mass of the body or of its
    /// nodes, except in a static step.
    fn moves_freely(&self, step: &Step) -> bool {
        let is_free = |direction: &usize| step.motion_of(2 * self.reference + direction).is_none();
        self.has_mass()
            || self.is_coupling
            || !self.carried.is_empty()
            || (step.procedure == Procedure::Static && [0, 1].iter().any(is_free))
    }
}

/// Whether a body turns: its angle is prescribed to move or has an initial velocity, or the body moves freely in some
/// direction in some step.
fn turns(rigid: &Rigid, angle: usize, steps: &[Step], velocity: &[f64]) -> bool {
    let translations = [0, 1].map(|i| 2 * rigid.reference + i);
    velocity.get(angle).is_some_and(|omega| *omega != 0.0)
        || steps.iter().any(|step| match step.motion_of(angle) {
            Some(motion) if !motion.is_still() => true,
            of_angle => {
                let is_free = |dof: &usize| step.motion_of(*dof).is_none();
                rigid.moves_freely(step) && (of_angle.is_none() || translations.iter().any(is_free))
            }
        })
}

/// Reports a moment on a body that does not turn.
fn report_moments(rigid: &Rigid, angle: usize, steps: &[Step], cx: &mut Context) {
    let mut loads = steps.iter().flat_map(|step| &step.point_loads);
    if loads.any(|load| load.at.dof == angle) {
        let message = format!("{} takes a moment and does not turn", rigid.name);
        cx.error(Code::RigidSurface, rigid.span, message).help(
            "a body turns by a moment if it has mass and direction 6 of its reference node is free",
        );
    }
}

/// Largest difference between the velocity of a node and the velocity of its body at this place, relative to the
/// largest velocity.
const SAME_VELOCITY: f64 = 1e-9;

/// Reports velocities of nodes of a body that differ from the motion of its reference node and angle.
fn report_own_velocities(
    rigid: &Rigid,
    angle: usize,
    mesh_index: &MeshIndex,
    (velocity, places): (&[f64], &BTreeMap<usize, Span>),
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
        let place = (0..2).find_map(|i| places.get(&(2 * node + i)));
        let mut error = cx.error(Code::RigidSurface, rigid.span, message);
        if let Some(&place) = place {
            error = error.other("the row of *INITIAL CONDITIONS", place);
        }
        error.help(
            "*INITIAL CONDITIONS gives the velocity of a rigid body at its reference node, directions 1, 2 and 6",
        );
    }
}

/// Completes the supports of a body that turns: if the body has no mass, its angle is held unless the deck prescribes
/// the angle.
fn complete_turning(
    rigid: &Rigid,
    angle: usize,
    (mesh_index, supports): (&MeshIndex, &Supports),
    steps: &mut [Step],
    cx: &mut Context,
) {
    let reference = rigid.reference;
    // a mass beside a held reference node, or a spring there, resists the rotation of coupled nodes
    let is_sprung = || (mesh_index.connectors.iter()).any(|own| own.nodes.contains(&reference));
    let is_free = |step: &Step| (0..2).all(|i| step.motion_of(2 * reference + i).is_none());
    let rides = |step: &Step| !rigid.carried.is_empty() && is_free(step) && !is_sprung();
    let own: BTreeSet<usize> = rigid.nodes.iter().copied().collect();
    if rigid.is_coupling && !report_empty_coupling(rigid, &own, mesh_index, cx) {
        return;
    }
    for (index, step) in steps.iter_mut().enumerate() {
        if let Some(held) = step.supports.iter().find(|s| own.contains(&(s.dof / 2))) {
            return report_other_motion(rigid, held.dof, (mesh_index, supports), cx);
        }
        let turns_freely = step.motion_of(angle).is_none();
        let has_mass = match rigid.carried.is_empty() {
            true => rigid.has_mass(),
            false => rides(step),
        };
        let needs_inertia = has_mass && step.procedure != Procedure::Static;
        if needs_inertia && turns_freely && !rigid.has_inertia(&mesh_index.mesh) {
            let message = format!("{} may turn and has no rotary inertia", rigid.name);
            cx.error(Code::RigidSurface, rigid.span, message).help(
                "add *ELEMENT, TYPE=ROTARYI and *ROTARY INERTIA, or hold direction 6 of its reference node",
            );
            return;
        }
        if rigid.moves_freely(step) {
            continue;
        }
        for direction in 0..2 {
            if step.motion_of(2 * rigid.reference + direction).is_none() {
                return report_free(rigid, direction, index + 1, cx);
            }
        }
        let place = (step.supports).binary_search_by_key(&angle, |support| support.dof);
        if let Err(at) = place {
            let (dof, motion) = (angle, STILL);
            step.supports.insert(at, Support { dof, motion });
        }
    }
}

/// Whether a coupling can move freely; a coupling with no node of an element, or with all nodes at one place, is
/// reported.
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

/// The prescribed motion of an angle that stays constant.
const STILL: SupportMotion = SupportMotion::Rate {
    rate: Rate::Velocity,
    value: 0.0,
    amplitude: None,
};

/// Adds supports to a step for rigid bodies that do not turn: their nodes move like the reference nodes, and their
/// angles stay. Step and bodies are given with their numbers.
fn follow(
    held: &[(usize, &Rigid)],
    (mesh_index, places): (&MeshIndex, &Supports),
    (step_number, step): (usize, &mut Step),
    cx: &mut Context,
) {
    let supports = step.supports.iter();
    let mut motions: BTreeMap<usize, SupportMotion> = supports
        .map(|support| (support.dof, support.motion))
        .collect();
    for &(number, rigid) in held {
        (motions.entry(angle_dof(number, &mesh_index.mesh))).or_insert(STILL);
        for direction in 0..2 {
            let Some(&motion) = motions.get(&(2 * rigid.reference + direction)) else {
                report_free(rigid, direction, step_number, cx);
                continue;
            };
            for &node in &rigid.nodes {
                let dof = 2 * node + direction;
                let other = motions.insert(dof, motion);
                if other.is_some_and(|other| other != motion) {
                    return report_other_motion(rigid, dof, (mesh_index, places), cx);
                }
            }
        }
    }
    let all = motions.into_iter();
    step.supports = all.map(|(dof, motion)| Support { dof, motion }).collect();
}

fn report_other_motion(
    rigid: &Rigid,
    dof: usize,
    (mesh_index, supports): (&MeshIndex, &Supports),
    cx: &mut Context,
) {
    let node = mesh_index.node_name(dof / 2);
    let message = format!(
        "node {node} of {} is prescribed otherwise than the reference node {}",
        rigid.name, rigid.label
    );
    let mut error = cx.error(Code::RigidSurface, rigid.span, message);
    if let Some(place) = supports.place(dof) {
        error = error.other("the row of *BOUNDARY", place);
    }
    error.help("a rigid body moves as its reference node, which *BOUNDARY prescribes");
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
