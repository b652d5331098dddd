//! `*BOUNDARY`: prescribed displacements and velocities.

use super::amplitude::Amplitudes;
use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic, Span, closest};
use crate::model::{Amplitude, Support, SupportMotion, TimeBase};
use crate::reader::contact::RigidSurface;
use crate::reader::context::Context;
use crate::reader::mesh::{MeshIndex, Sets};
use std::collections::BTreeMap;

/// Objects of the model that supports and loads refer to.
#[derive(Clone, Copy)]
pub(crate) struct Targets<'a> {
    /// Mesh.
    pub mesh_index: &'a MeshIndex,
    /// Sets.
    pub sets: &'a Sets,
    /// Amplitudes.
    pub amplitudes: &'a Amplitudes,
    /// Rigid surfaces.
    pub rigid_surfaces: &'a [RigidSurface],
}

/// A direction of displacement or rotation that the deck names.
pub(crate) enum Direction {
    /// 0 = x, 1 = y.
    Plane(usize),
    /// A displacement or rotation out of the plane.
    OutOfPlane,
}

/// Prescribed dofs, as they are carried from step to step.
#[derive(Default)]
pub(crate) struct Supports {
    held: BTreeMap<usize, Prescription>,
    /// Duration of the current step.
    period: f64,
    /// Displacements at the end of the last step, of the dofs that it prescribed.
    ends: BTreeMap<usize, f64>,
}

#[derive(Clone, Copy)]
struct Prescription {
    motion: SupportMotion,
    /// The velocity behind the motion, if that is prescribed.
    velocity: Option<f64>,
    /// Step that last prescribed it; 0 for model data.
    step: usize,
}

/// What a card prescribes.
#[derive(Clone, Copy)]
enum Quantity {
    /// Displacements, that follow an amplitude or grow over the step.
    Displacement(Option<usize>),
    /// Constant velocities.
    Velocity,
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

    /// Removes all.
    pub fn clear(&mut self) {
        self.held.clear();
    }

    /// Begins a step of this duration: prescribed velocities go on.
    pub fn begin_step(&mut self, period: f64) {
        self.period = period;
        for (dof, held) in &mut self.held {
            if let Some(velocity) = held.velocity {
                let from = self.ends.get(dof).copied().unwrap_or(0.0);
                let to = from + velocity * period;
                held.motion = SupportMotion::Ramp { to };
            }
        }
    }

    /// Ends a step at the total time `total`: supports that follow an amplitude in step time keep
    /// their last value.
    pub fn end_step(&mut self, total: f64, amplitudes: &[Amplitude]) {
        self.ends.clear();
        for (&dof, held) in &mut self.held {
            let end = match held.motion {
                SupportMotion::Ramp { to } => to,
                SupportMotion::Amplitude { value, amplitude } => {
                    let Some(curve) = amplitudes.get(amplitude) else {
                        continue;
                    };
                    match curve.time {
                        TimeBase::Total => value * curve.at(total),
                        TimeBase::Step => {
                            let to = value * curve.at(self.period);
                            held.motion = SupportMotion::Ramp { to };
                            to
                        }
                    }
                }
            };
            self.ends.insert(dof, end);
        }
    }

    /// Reads a card of step `step`; 0 for model data.
    pub fn card(&mut self, card: &Card, step: usize, targets: Targets, cx: &mut Context) {
        let Ok(amplitude) = targets.amplitudes.of(card, cx) else {
            return;
        };
        let quantity = match card.choice("TYPE") {
            Some("VELOCITY") => Quantity::Velocity,
            _ => Quantity::Displacement(amplitude),
        };
        if let (Quantity::Velocity, Some(_)) = (quantity, amplitude) {
            let span = card.span_of("AMPLITUDE");
            let message = "prescribed velocities cannot follow an amplitude";
            let error = Diagnostic::error(Code::UnsupportedParameter, span, message);
            cx.d.push(error.help("prescribe the displacement, the integral of the velocity"));
            return;
        }
        for row in &card.rows {
            self.row(row, quantity, step, targets, cx);
        }
    }

    /// `node or set, first[, last[, value]]` or `set, name`
    fn row(
        &mut self,
        row: &Row,
        quantity: Quantity,
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
        if let (Quantity::Displacement(None), true) = (quantity, prescribed.value != 0.0) {
            let message = "a displacement without amplitude grows linearly over the step";
            cx.d.push_once(Diagnostic::note(
                Code::RampedSupport,
                prescribed.span,
                message,
            ));
        }
        for node in nodes.unwrap_or_default() {
            for &direction in &prescribed.directions {
                let dof = 2 * node + direction;
                let Some(held) = self.prescription(dof, quantity, prescribed.value, step) else {
                    return report_free_before(dof, row, targets.mesh_index, cx);
                };
                self.hold(dof, held, row.span(), cx);
            }
        }
    }

    /// The prescription of a dof; `None` for a velocity of a dof that moved freely before.
    fn prescription(
        &self,
        dof: usize,
        quantity: Quantity,
        value: f64,
        step: usize,
    ) -> Option<Prescription> {
        let (motion, velocity) = match quantity {
            Quantity::Displacement(Some(amplitude)) => {
                (SupportMotion::Amplitude { value, amplitude }, None)
            }
            Quantity::Displacement(None) => (SupportMotion::Ramp { to: value }, None),
            Quantity::Velocity => {
                let from = match step {
                    0 | 1 => 0.0,
                    _ => *self.ends.get(&dof)?,
                };
                let to = from + value * self.period;
                (SupportMotion::Ramp { to }, Some(value))
            }
        };
        Some(Prescription {
            motion,
            velocity,
            step,
        })
    }

    fn hold(&mut self, dof: usize, now: Prescription, span: Span, cx: &mut Context) {
        let earlier = self.held.insert(dof, now);
        if earlier.is_some_and(|held| held.step == now.step && held.motion != now.motion) {
            let message = "another displacement is prescribed here than before in this step";
            let warning = Diagnostic::warning(Code::ConflictingSupport, span, message);
            cx.d.push(warning.help("the later one holds"));
        }
    }
}

fn report_free_before(dof: usize, row: &Row, mesh_index: &MeshIndex, cx: &mut Context) {
    let message = format!(
        "node {} moved freely in direction {} in the step before",
        mesh_index.node_name(dof / 2),
        dof % 2 + 1
    );
    let error = Diagnostic::error(Code::UnsupportedParameter, row.span(), message);
    cx.d.push(error.help(
        "velocities can be prescribed from the first step on, or after a prescribed displacement",
    ));
}

/// Directions and value of a row of `*BOUNDARY`.
struct Prescribed {
    directions: Vec<usize>,
    value: f64,
    span: Span,
}

fn prescribed(row: &Row, cx: &mut Context) -> Option<Prescribed> {
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
    let span = row.get(3).map_or(row.span(), |field| field.span);
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
    let error = Diagnostic::error(Code::BadDof, name.span, message);
    let list = names.clone().collect::<Vec<_>>().join(", ");
    let help = format!("directions are numbers; the named supports are {list}");
    cx.d.push(error.suggest(closest(&key, names)).help(help));
    None
}

/// A direction number, 1 to 6.
fn dof_number(field: Text, cx: &mut Context) -> Option<usize> {
    let number = field.integer(cx.d)?;
    if (1..=6).contains(&number) {
        return usize::try_from(number).ok();
    }
    let message = format!("plane elements have no degree of freedom {number}");
    let error = Diagnostic::error(Code::BadDof, field.span, message);
    cx.d.push(error.help("1 is x, 2 is y; 3 to 6 are accepted with the value zero"));
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
pub(crate) fn row_direction(row: &Row, value: f64, cx: &mut Context) -> Option<usize> {
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
