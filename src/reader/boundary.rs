//! `*BOUNDARY`: prescribed displacements, velocities and accelerations; `*INITIAL CONDITIONS,
//! TYPE=VELOCITY`.

use super::amplitudes::Amplitudes;
use super::context::Context;
use super::mesh_index::MeshIndex;
use super::outline::Outline;
use super::rigid_bodies::Rigid;
use super::sets::Sets;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span, closest};
use crate::model::{Amplitude, Rate, Support, SupportMotion};
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
    /// Rigid bodies, whose nodes move with reference nodes.
    pub rigid_bodies: &'a [Rigid],
}

/// A direction of displacement or rotation that the deck names.
pub(crate) enum Direction {
    /// A direction in the plane: 0 is x, 1 is y.
    Plane(usize),
    /// A displacement or rotation out of the plane.
    OutOfPlane,
}

/// Prescribed dofs, as they are carried from step to step.
#[derive(Default)]
pub(crate) struct Supports {
    held: BTreeMap<usize, Prescription>,
}

#[derive(Clone, Copy)]
struct Prescription {
    motion: SupportMotion,
    /// Step that last prescribed it; 0 for model data.
    step: usize,
}

/// What a card prescribes.
#[derive(Clone, Copy)]
enum CardMotion {
    /// Displacements, that follow an amplitude or grow over the step.
    Displacement(Option<usize>),
    /// Velocities or accelerations, constant or with an amplitude.
    Rate(Rate, Option<usize>),
    /// The displacements of the start of the step.
    Fixed,
}

impl CardMotion {
    /// The motion with the value of a row.
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
        self.held.clear();
    }

    /// Ends a step of this duration: what follows an amplitude in step time keeps its last value.
    pub fn end_step(&mut self, period: f64, amplitudes: &[Amplitude]) {
        for held in self.held.values_mut() {
            held.motion = held.motion.after_step(period, amplitudes);
        }
    }

    /// Reads a card of step `step`; 0 for model data.
    pub fn card(&mut self, card: &Card, step: usize, targets: Targets, cx: &mut Context) {
        let Ok(amplitude) = targets.amplitudes.of(card, cx) else {
            return;
        };
        let quantity = match card.choice("TYPE") {
            _ if card.has("FIXED") => CardMotion::Fixed,
            Some("VELOCITY") => CardMotion::Rate(Rate::Velocity, amplitude),
            Some("ACCELERATION") => CardMotion::Rate(Rate::Acceleration, amplitude),
            _ => CardMotion::Displacement(amplitude),
        };
        for row in card.rows.iter() {
            self.row(row, quantity, step, targets, cx);
        }
    }

    /// `node or set, first[, last[, value]]` or `set, name`
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
            for &direction in &prescribed.directions {
                let held = Prescription { motion, step };
                self.hold(2 * node + direction, held, row.span(), cx);
            }
        }
    }

    fn hold(&mut self, dof: usize, now: Prescription, span: Span, cx: &mut Context) {
        let earlier = self.held.insert(dof, now);
        if earlier.is_some_and(|held| held.step == now.step && held.motion != now.motion) {
            let message = "another motion is prescribed here than before in this step";
            cx.warning(Code::ConflictingSupport, span, message)
                .help("the later one holds");
        }
    }
}

/// Directions and value of a row of `*BOUNDARY`.
struct Prescribed {
    directions: Vec<usize>,
    value: f64,
    span: Span,
}

fn prescribed(row: Line, cx: &mut Context) -> Option<Prescribed> {
    let first = row.required(1, "the first direction", cx.d)?;
    if first.text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        let directions = named_directions(first, cx)?;
        row.at_most(2, cx.d);
        return Some(Prescribed {
            directions,
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
    if high > 2 && value != 0.0 {
        let message = "only directions 1 and 2 can move";
        cx.error(Code::BadDof, last.span, message);
        return None;
    }
    Some(Prescribed {
        directions: (low..=high.min(2)).map(|dof| dof - 1).collect(),
        value,
        span,
    })
}

/// Names of supports and the directions that they fix in the plane; Abaqus Keywords Reference,
/// *BOUNDARY.
const NAMED: [(&str, &[usize]); 8] = [
    ("XSYMM", &[0]),
    ("YSYMM", &[1]),
    ("ZSYMM", &[]),
    ("XASYMM", &[1]),
    ("YASYMM", &[0]),
    ("ZASYMM", &[0, 1]),
    ("PINNED", &[0, 1]),
    ("ENCASTRE", &[0, 1]),
];

/// Directions that a named support fixes; reports other names.
fn named_directions(name: Text, cx: &mut Context) -> Option<Vec<usize>> {
    let key = name.name_key();
    if let Some((_, directions)) = NAMED.iter().find(|(known, _)| *known == key) {
        return Some(directions.to_vec());
    }
    let names = NAMED.iter().map(|&(known, _)| known);
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
    cx.error(Code::BadDof, field.span, message)
        .help("1 is x, 2 is y; 3 to 6 are accepted with the value zero");
    None
}

/// The direction that a field names, in the plane or out of it.
pub(crate) fn direction(field: Text, cx: &mut Context) -> Option<Direction> {
    Some(match dof_number(field, cx)? {
        number @ 1..=2 => Direction::Plane(number - 1),
        _ => Direction::OutOfPlane,
    })
}

/// The direction of a row whose value acts there; out of the plane it must be zero.
pub(crate) fn row_direction(row: Line, value: f64, cx: &mut Context) -> Option<usize> {
    let field = row.required(1, "the direction", cx.d)?;
    match direction(field, cx)? {
        Direction::Plane(direction) => Some(direction),
        Direction::OutOfPlane if value == 0.0 => None,
        Direction::OutOfPlane => {
            cx.error(
                Code::BadDof,
                field.span,
                "only directions 1 and 2 lie in the plane",
            );
            None
        }
    }
}

/// Reads initial velocities, `2 N` entries; `supports` hold at the start.
pub(crate) fn initial_velocity(
    outline: &Outline,
    targets: Targets,
    supports: &[Support],
    cx: &mut Context,
) -> Vec<f64> {
    let mut velocity = vec![0.0; targets.mesh_index.mesh.dof_count()];
    let mut places = BTreeMap::new();
    for card in outline.model_cards("INITIAL CONDITIONS") {
        card.required("TYPE", cx.d);
        if card.choice("TYPE") != Some("VELOCITY") {
            continue;
        }
        for row in card.rows.iter() {
            for (dof, value) in velocity_row(row, targets, cx) {
                if let Some(entry) = velocity.get_mut(dof) {
                    *entry = value;
                    places.insert(dof, row.span());
                }
            }
        }
    }
    report_supported(&velocity, &places, supports, targets.mesh_index, cx);
    velocity
}

/// Whether a support has its velocity at the start from what is prescribed; an acceleration leaves it.
fn is_given(support: &Support) -> bool {
    let SupportMotion::Rate { rate, .. } = support.motion else {
        return true;
    };
    rate == Rate::Velocity
}

/// `node or set, direction, velocity`
fn velocity_row(row: Line, targets: Targets, cx: &mut Context) -> Vec<(usize, f64)> {
    row.at_most(3, cx.d);
    let target = row.required(0, "a node or node set", cx.d);
    let nodes = target.map(|field| targets.sets.nodes_of(field, targets.mesh_index, cx));
    let value = row.real(2, "the velocity", cx.d);
    let direction = row_direction(row, value.unwrap_or(0.0), cx);
    match (nodes, direction, value) {
        (Some(nodes), Some(direction), Some(value)) => nodes
            .into_iter()
            .map(|node| (2 * node + direction, value))
            .collect(),
        _ => Vec::new(),
    }
}

/// Reports initial velocities of supported dofs, which move as prescribed from the start.
fn report_supported(
    velocity: &[f64],
    places: &BTreeMap<usize, Span>,
    supports: &[Support],
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    let mut rows: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for dof in supports
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
        let label = mesh_index.node_name(first / 2);
        let message = format!(
            "{} degrees of freedom with this velocity are prescribed, the first is node {label} \
             direction {}",
            dofs.len(),
            first % 2 + 1
        );
        cx.error(Code::VelocityOnSupport, span, message)
            .help("give the velocity to free nodes only");
    }
}
