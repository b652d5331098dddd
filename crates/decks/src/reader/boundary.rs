//! `*BOUNDARY`: prescribed displacements, velocities and accelerations; `*INITIAL CONDITIONS,
//! TYPE=VELOCITY`.

use super::actions::{Action, Actions};
use super::amplitudes::Amplitudes;
use super::context::Context;
use super::mesh_index::MeshIndex;
use super::outline::Outline;
use super::rigid_bodies::{self, Rigid};
use super::sets::Sets;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span, closest};
use crate::model::{Amplitude, Procedure, Rate, Step, Support, SupportMotion};
use std::collections::BTreeMap;

/// Objects of the model that supports and loads refer to.
#[derive(Clone, Copy)]
pub(crate) struct Targets<'a> {
    /// The mesh with the numbers of the deck.
    pub mesh_index: &'a MeshIndex,
    /// All sets of nodes and elements.
    pub sets: &'a Sets,
    /// All amplitudes with their names.
    pub amplitudes: &'a Amplitudes,
    /// Masses of the point elements, 0 for elements without a mass (mass).
    pub masses: &'a [f64],
    /// The rigid bodies, whose nodes move with their reference nodes.
    pub rigid_bodies: &'a [Rigid],
    /// Whether each node belongs to a plane element.
    pub has_element: &'a [bool],
}

impl Targets<'_> {
    /// Dof of the angle of the rigid body whose reference node is `node`.
    pub fn angle_at(&self, node: usize) -> Option<usize> {
        rigid_bodies::angle_at(node, self.rigid_bodies, &self.mesh_index.mesh)
    }
}

/// A direction of displacement or rotation that the deck names.
pub(crate) enum Direction {
    /// A direction in the plane, 0 for x and 1 for y.
    Plane(usize),
    /// The rotation in the plane.
    Rotation,
    /// A displacement or rotation out of the plane.
    OutOfPlane,
}

/// Prescribed dofs, as they are carried from step to step.
#[derive(Default)]
pub(crate) struct Supports {
    held: BTreeMap<usize, Prescription>,
    /// Dofs whose supports have been removed by steps, with the places of the cards.
    removed: BTreeMap<usize, Span>,
    /// Prescribed motions of nodes without element.
    pub actions: Actions,
}

#[derive(Clone, Copy)]
struct Prescription {
    motion: SupportMotion,
    /// Number of the step that prescribed the dof last; 0 for model data.
    step: usize,
    /// Place of the row that prescribes the dof.
    span: Span,
}

/// Kind of motion that a card prescribes.
#[derive(Clone, Copy)]
enum CardMotion {
    /// Displacements that follow an amplitude or grow over the step.
    Displacement(Option<usize>),
    /// Velocities or accelerations, constant or with an amplitude.
    Rate(Rate, Option<usize>),
    /// The displacements at the start of the step, which are held.
    Fixed,
}

impl CardMotion {
    /// The motion that a row with the given value prescribes.
    fn motion(self, value: f64) -> SupportMotion {
        match self {
            CardMotion::Displacement(Some(amplitude)) => {
                SupportMotion::Amplitude { value, amplitude }
            }
            CardMotion::Displacement(None) => SupportMotion::Ramp { to: value },
            CardMotion::Rate(rate, amplitude) => SupportMotion::Rate {
                rate,
                value,
                amplitude,
            },
            CardMotion::Fixed => SupportMotion::Rate {
                rate: Rate::Velocity,
                value: 0.0,
                amplitude: None,
            },
        }
    }
}

impl Supports {
    /// Supports of the current step.
    pub fn list(&self) -> Vec<Support> {
        let held = self.held.iter();
        held.map(|(&dof, held)| Support {
            dof,
            motion: held.motion,
        })
        .collect()
    }

    /// Removes all supports.
    pub fn clear(&mut self) {
        let removed = std::mem::take(&mut self.held).into_iter();
        self.removed
            .extend(removed.map(|(dof, held)| (dof, held.span)));
    }

    /// Place of the row that prescribes a dof in some step.
    pub fn place(&self, dof: usize) -> Option<Span> {
        let held = self.held.get(&dof).map(|held| held.span);
        held.or_else(|| self.removed.get(&dof).copied())
    }

    /// Ends a step of a given duration: displacements that follow an amplitude in step time keep their last value.
    pub fn end_step(&mut self, period: f64, amplitudes: &[Amplitude]) {
        for held in self.held.values_mut() {
            held.motion = held.motion.after_step(period, amplitudes);
        }
    }

    /// Reads a card of step `step`; 0 for model data.
    pub fn card(&mut self, card: &Card, step: usize, targets: Targets, cx: &mut Context) {
        let Some(quantity) = card_motion(card, targets, cx) else {
            return;
        };
        for row in card.rows.iter() {
            self.row(row, quantity, step, targets, cx);
        }
    }

    /// Reads a row `node or set, first[, last[, value]]` or `set, name`.
    fn row(
        &mut self,
        row: Line,
        quantity: CardMotion,
        step: usize,
        targets: Targets,
        cx: &mut Context,
    ) {
        row.at_most(4, cx.d);
        let target = row.required(0, "a node or node set", cx.d);
        let nodes = target.map(|field| targets.sets.nodes_of(field, targets.mesh_index, cx));
        let Some(prescribed) = prescribed(row, cx) else {
            return;
        };
        if step == 0 && prescribed.value != 0.0 {
            let message = "a motion other than zero can be prescribed in a step only";
            cx.error(Code::ValueOutsideStep, prescribed.span, message);
            return;
        }
        if let (CardMotion::Displacement(None), true) = (quantity, prescribed.value != 0.0) {
            let message = "a displacement without amplitude grows linearly over the step";
            cx.d.note_once(Code::RampedSupport, prescribed.span, message);
        }
        if let (CardMotion::Fixed, true) = (quantity, prescribed.value != 0.0) {
            let help = "FIXED keeps the displacement of the start of the step";
            row.without_effect(3, "this value has no effect", help, cx.d);
        }
        let motion = quantity.motion(prescribed.value);
        for node in nodes.unwrap_or_default() {
            let span = row.span();
            let held = Prescription { motion, step, span };
            for &direction in &prescribed.directions {
                let dof = 2 * node + direction;
                self.hold(dof, held, cx);
                if !motion.is_still() {
                    self.actions
                        .enter(dof, Action::Motion, span, targets.has_element);
                }
            }
            if prescribed.turns {
                match targets.angle_at(node) {
                    Some(angle) => self.hold(angle, held, cx),
                    None if prescribed.value != 0.0 => {
                        let carrier = rigid_bodies::carrier(&[node], targets.rigid_bodies);
                        return match carrier {
                            Some(body) => body.report_angle(prescribed.span, cx),
                            None => report_no_angle(prescribed.span, cx),
                        };
                    }
                    None => {}
                }
            }
        }
    }

    fn hold(&mut self, dof: usize, now: Prescription, cx: &mut Context) {
        let (earlier, span) = (self.held.insert(dof, now), now.span);
        if earlier.is_some_and(|held| held.step == now.step && held.motion != now.motion) {
            let message = "another motion is prescribed here than before in this step";
            cx.warning(Code::ConflictingSupport, span, message)
                .help("the later one holds");
        }
    }
}

/// Kind of motion that a card prescribes; with FIXED, amplitude and type have no effect.
fn card_motion(card: &Card, targets: Targets, cx: &mut Context) -> Option<CardMotion> {
    if card.has("FIXED") {
        return Some(CardMotion::Fixed);
    }
    let amplitude = targets.amplitudes.of(card, cx).ok()?;
    Some(match card.choice("TYPE") {
        Some("VELOCITY") => CardMotion::Rate(Rate::Velocity, amplitude),
        Some("ACCELERATION") => CardMotion::Rate(Rate::Acceleration, amplitude),
        _ => CardMotion::Displacement(amplitude),
    })
}

/// Reports direction 6 at a node other than the reference node of a rigid body: only reference nodes have an angle.
fn report_no_angle(span: Span, cx: &mut Context) {
    let message =
        "only directions 1 and 2 can move, and direction 6 of the reference node of a rigid body";
    cx.error(Code::BadDof, span, message);
}

/// Directions and value of a row of `*BOUNDARY`.
struct Prescribed {
    directions: Vec<usize>,
    /// Whether the row prescribes direction 6, the angle of a rigid body.
    turns: bool,
    value: f64,
    span: Span,
}

fn prescribed(row: Line, cx: &mut Context) -> Option<Prescribed> {
    let first = row.required(1, "the first direction", cx.d)?;
    if first.text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        let (directions, turns) = named_directions(first, cx)?;
        row.at_most(2, cx.d);
        return Some(Prescribed {
            directions,
            turns,
            value: 0.0,
            span: first.span,
        });
    }
    let last = row.get(2).unwrap_or(first);
    let (low, high) = (dof_number(first, cx)?, dof_number(last, cx)?);
    let value = row.real_or(3, 0.0, cx.d)?;
    let span = row.span_at(3);
    if high < low {
        let message = format!("directions run from {low} to {high}");
        cx.error(Code::BadDof, last.span, message);
        return None;
    }
    if value != 0.0 && high > 2 && [low, high] != [6; 2] {
        report_no_angle(last.span, cx);
        return None;
    }
    Some(Prescribed {
        directions: (low..=high.min(2)).map(|dof| dof - 1).collect(),
        turns: high == 6,
        value,
        span,
    })
}

/// Names of supports with the directions that each name fixes in the plane, and whether it fixes direction 6 (Abaqus
/// Keywords Reference, *BOUNDARY).
const NAMED: [(&str, &[usize], bool); 8] = [
    ("XSYMM", &[0], true),
    ("YSYMM", &[1], true),
    ("ZSYMM", &[], false),
    ("XASYMM", &[1], false),
    ("YASYMM", &[0], false),
    ("ZASYMM", &[0, 1], true),
    ("PINNED", &[0, 1], false),
    ("ENCASTRE", &[0, 1], true),
];

/// Directions that a named support fixes; any other name is reported.
fn named_directions(name: Text, cx: &mut Context) -> Option<(Vec<usize>, bool)> {
    let key = name.name_key();
    if let Some((_, directions, turns)) = NAMED.iter().find(|named| named.0 == key) {
        return Some((directions.to_vec(), *turns));
    }
    let names = NAMED.iter().map(|named| named.0);
    let message = format!("{} is neither a direction nor a named support", name.text);
    let list = names.clone().collect::<Vec<_>>().join(", ");
    let help = format!("directions are numbers; the named supports are {list}");
    cx.error(Code::BadDof, name.span, message)
        .suggest(closest(&key, names))
        .help(help);
    None
}

/// A direction number, 1 to 6.
fn dof_number(field: Text, cx: &mut Context) -> Option<usize> {
    let number = field.integer(cx.d)?;
    if (1..=6).contains(&number) {
        return usize::try_from(number).ok();
    }
    let message = format!("plane elements have no degree of freedom {number}");
    cx.error(Code::BadDof, field.span, message).help(
        "1 is x, 2 is y, 6 the angle of a rigid body; others are accepted with the value zero",
    );
    None
}

/// The direction of the plane, rotation or direction out of the plane that a field names.
pub(crate) fn direction(field: Text, cx: &mut Context) -> Option<Direction> {
    Some(match dof_number(field, cx)? {
        number @ 1..=2 => Direction::Plane(number - 1),
        6 => Direction::Rotation,
        _ => Direction::OutOfPlane,
    })
}

/// The dofs of some nodes in the direction of a row. The value of the row must be zero for a direction out of the
/// plane, and for direction 6 of a node other than the reference node of a rigid body.
pub(crate) fn row_dofs(
    row: Line,
    nodes: &[usize],
    value: f64,
    targets: Targets,
    cx: &mut Context,
) -> Option<Vec<usize>> {
    let field = row.required(1, "the direction", cx.d)?;
    let direction = direction(field, cx)?;
    let dofs: Option<Vec<usize>> = match direction {
        Direction::Plane(direction) => {
            Some(nodes.iter().map(|node| 2 * node + direction).collect())
        }
        Direction::Rotation => nodes.iter().map(|&node| targets.angle_at(node)).collect(),
        Direction::OutOfPlane => None,
    };
    if dofs.is_none() && value != 0.0 {
        if let Direction::Rotation = direction
            && let Some(body) = rigid_bodies::carrier(nodes, targets.rigid_bodies)
        {
            body.report_angle(field.span, cx);
            return None;
        }
        let message = "only directions 1 and 2 lie in the plane, and direction 6 at the reference node \
                       of a rigid body";
        cx.error(Code::BadDof, field.span, message);
    }
    dofs
}

/// Initial velocities of a deck.
pub(crate) struct InitialVelocity {
    /// Initial velocities: `2 N` values for the nodes, then the values for the angles of the rigid bodies.
    pub values: Vec<f64>,
    /// Places of the rows that give initial velocities, by dof.
    pub places: BTreeMap<usize, Span>,
    /// Initial velocities of nodes without element.
    pub actions: Actions,
}

/// Reads initial velocities; `at_start` holds the supports of the first step, and `supports` the places of these.
pub(crate) fn initial_velocity(
    outline: &Outline,
    targets: Targets,
    (at_start, supports): (&[Support], &Supports),
    cx: &mut Context,
) -> InitialVelocity {
    let dofs = targets.mesh_index.mesh.dof_count() + 4 * targets.rigid_bodies.len();
    let mut velocity = vec![0.0; dofs];
    let (mut places, mut actions) = (BTreeMap::new(), Actions::default());
    for card in outline.model_cards("INITIAL CONDITIONS") {
        card.required("TYPE", cx.d);
        let rows: Vec<(Span, Vec<(usize, f64)>)> = match card.choice("TYPE") {
            Some("VELOCITY") => (card.rows.iter())
                .map(|row| (row.span(), velocity_row(row, targets, cx)))
                .collect(),
            Some("ROTATING VELOCITY") => {
                let found = rotating_velocity(card, targets, cx);
                found.into_iter().collect()
            }
            _ => continue,
        };
        for (span, values) in rows {
            for (dof, value) in values {
                if let Some(entry) = velocity.get_mut(dof) {
                    *entry = value;
                    places.insert(dof, span);
                    if value != 0.0 {
                        actions.enter(dof, Action::Velocity, span, targets.has_element);
                    }
                }
            }
        }
    }
    report_supported((&velocity, &places), (at_start, supports), targets, cx);
    InitialVelocity {
        values: velocity,
        places,
        actions,
    }
}

/// Warns about initial velocities if the first step is static: the bodies of such a step are at rest.
pub(crate) fn check_start(outline: &Outline, first: Option<&Step>, cx: &mut Context) {
    let cards = outline.model_cards("INITIAL CONDITIONS");
    let is_velocity =
        |card: &&&Card| matches!(card.choice("TYPE"), Some("VELOCITY" | "ROTATING VELOCITY"));
    if let (Some(card), Some(Procedure::Static)) =
        (cards.iter().find(is_velocity), first.map(|s| s.procedure))
    {
        let message = "these velocities have no effect: the first step is static";
        cx.d.warning_once(Code::IgnoredParameter, card.span, message)
            .help("give them to a model whose first step is dynamic");
    }
}

/// Whether a support prescribes the velocity at the start of the step; a prescribed acceleration does not.
fn is_given(support: &Support) -> bool {
    let SupportMotion::Rate { rate, .. } = support.motion else {
        return true;
    };
    rate == Rate::Velocity
}

/// Reads `node or set, angular velocity, vx, vy, vz` and the axis, `xa, ya, za, xb, yb, zb`.
fn rotating_velocity(
    card: &Card,
    targets: Targets,
    cx: &mut Context,
) -> Option<(Span, Vec<(usize, f64)>)> {
    let mut rows = card.rows.iter();
    let row = rows.next()?;
    row.at_most(5, cx.d);
    let target = row.required(0, "a node or node set", cx.d);
    let nodes = target.map(|field| targets.sets.nodes_of(field, targets.mesh_index, cx));
    let omega = row.real(1, "the angular velocity", cx.d);
    let v = [2, 3, 4].map(|i| row.real_or(i, 0.0, cx.d));
    let Some(axis) = rows.next() else {
        let message = "the axis is missing: x, y, z of a point on it, and of another";
        cx.error(Code::MissingData, row.span(), message);
        return None;
    };
    axis.at_most(6, cx.d);
    if let Some(extra) = rows.next() {
        let message = "a card has one set with its axis";
        cx.error(Code::StrayData, extra.span(), message)
            .help("give a card for each set");
    }
    let [x, y, z] = [0, 1, 2].map(|i| axis.real_or(i, 0.0, cx.d));
    let a = [x?, y?, z?];
    let mut sign = 1.0;
    if axis.get(3).is_some() {
        let b = [3, 4, 5].map(|i| axis.real_or(i, 0.0, cx.d));
        let b = [b[0]?, b[1]?, b[2]?];
        if a[..2] != b[..2] || a[2] == b[2] {
            let message = "the axis is not normal to the plane";
            cx.error(Code::BadValue, axis.span(), message);
            return None;
        }
        sign = (b[2] - a[2]).signum();
    }
    let [vx, vy, vz] = v;
    if vz? != 0.0 {
        let message = "only x and y lie in the plane";
        cx.error(Code::BadDof, row.span_at(4), message);
        return None;
    }
    let (nodes, omega, own) = (nodes?, sign * omega?, [vx?, vy?]);
    let coordinates = &targets.mesh_index.mesh.coordinates;
    let of_node = |node: usize| {
        let [x, y] = coordinates[node];
        let angle = targets.angle_at(node).map(|dof| (dof, omega));
        let v = [own[0] - omega * (y - a[1]), own[1] + omega * (x - a[0])];
        [(2 * node, v[0]), (2 * node + 1, v[1])]
            .into_iter()
            .chain(angle)
    };
    Some((row.span(), nodes.into_iter().flat_map(of_node).collect()))
}

/// Reads a row `node or set, direction, velocity`.
fn velocity_row(row: Line, targets: Targets, cx: &mut Context) -> Vec<(usize, f64)> {
    row.at_most(3, cx.d);
    let target = row.required(0, "a node or node set", cx.d);
    let nodes = target.map(|field| targets.sets.nodes_of(field, targets.mesh_index, cx));
    let value = row.real(2, "the velocity", cx.d);
    let nodes = nodes.unwrap_or_default();
    let dofs = row_dofs(row, &nodes, value.unwrap_or(0.0), targets, cx);
    let both = dofs.zip(value);
    both.map_or(Vec::new(), |(dofs, value)| {
        dofs.into_iter().map(|dof| (dof, value)).collect()
    })
}

/// Reports initial velocities of supported dofs: a support prescribes the velocity from the start.
fn report_supported(
    (velocity, places): (&[f64], &BTreeMap<usize, Span>),
    (at_start, supports): (&[Support], &Supports),
    targets: Targets,
    cx: &mut Context,
) {
    let mut rows: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for dof in at_start
        .iter()
        .filter(|s| is_given(s))
        .map(|support| support.dof)
    {
        if let (Some(&value), Some(&span)) = (velocity.get(dof), places.get(&dof))
            && value != 0.0
        {
            rows.entry(span).or_default().push(dof);
        }
    }
    for (span, dofs) in rows {
        let Some(first) = dofs.first() else { continue };
        let name = rigid_bodies::dof_name(*first, targets.rigid_bodies, targets.mesh_index);
        let message = format!(
            "{} degrees of freedom with this velocity are prescribed, the first is {name}",
            dofs.len(),
        );
        let mut error = cx.error(Code::VelocityOnSupport, span, message);
        if let Some(place) = supports.place(*first) {
            error = error.other("the row of *BOUNDARY", place);
        }
        error.help("give the velocity to free nodes only");
    }
}
