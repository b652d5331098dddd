//! `*CLOAD`, `*DLOAD` and `*DSLOAD`.

use super::boundary::{Targets, row_direction};
use super::load_history::{LoadHistory, Operation, StepContext, joined};
use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Amplitude, BodyForce, Face, PointLoad, Pressure, Step, SurfaceKind, Traction};
use crate::reader::context::Context;
use crate::reader::mesh::{Surfaces, side_count, surface};
use std::borrow::Cow;

/// All loads, as they are carried from step to step.
#[derive(Default)]
pub(crate) struct Loads {
    points: LoadHistory<usize, PointLoad>,
    bodies: LoadHistory<(u32, Body), BodyForce>,
    pressures: LoadHistory<Face, Pressure>,
    face_tractions: LoadHistory<Face, Traction>,
    surface_pressures: LoadHistory<(usize, Face), Pressure>,
    tractions: LoadHistory<(usize, Face), Traction>,
    point_operation: Operation,
    element_operation: Operation,
    surface_operation: Operation,
}

/// Kinds of body force; a later step replaces a force of the same kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Body {
    Gravity,
    X,
    Y,
}

/// A card of loads with what its rows have in common.
#[derive(Clone, Copy)]
struct Source<'a> {
    card: &'a Card,
    amplitude: Option<usize>,
    context: StepContext,
    targets: Targets<'a>,
    surfaces: &'a Surfaces,
}

impl Loads {
    /// Reads a card of loads.
    pub fn card(
        &mut self,
        card: &Card,
        context: StepContext,
        targets: Targets,
        surfaces: &Surfaces,
        cx: &mut Context,
    ) {
        self.operation(card, context, cx);
        let Ok(amplitude) = targets.amplitudes.of(card, cx) else {
            return;
        };
        let source = Source {
            card,
            amplitude,
            context,
            targets,
            surfaces,
        };
        for row in card.rows.iter() {
            match card.keyword.name {
                "CLOAD" => self.point_row(row, source, cx),
                "DLOAD" => self.element_row(row, source, cx),
                _ => self.surface_row(row, source, cx),
            };
        }
    }

    fn operation(&mut self, card: &Card, context: StepContext, cx: &mut Context) {
        let operation = match card.keyword.name {
            "CLOAD" => &mut self.point_operation,
            "DLOAD" => &mut self.element_operation,
            _ => &mut self.surface_operation,
        };
        if !operation.starts_anew(card, context.step, cx) {
            return;
        }
        match card.keyword.name {
            "CLOAD" => self.points.clear(context),
            "DLOAD" => {
                self.bodies.clear(context);
                self.pressures.clear(context);
                self.face_tractions.clear(context);
            }
            _ => {
                self.surface_pressures.clear(context);
                self.tractions.clear(context);
            }
        }
    }

    /// `node or set, direction, force`
    fn point_row(&mut self, row: Row, source: Source, cx: &mut Context) -> Option<()> {
        row.at_most(3, cx.d);
        let Targets {
            mesh_index, sets, ..
        } = source.targets;
        let target = row.required(0, "a node or node set", cx.d);
        let nodes = target.map(|field| sets.nodes_of(field, mesh_index, cx));
        let force = row.real(2, "the force", cx.d);
        let direction = row_direction(row, force.unwrap_or(0.0), cx);
        let (direction, force) = (direction?, force?);
        for node in nodes? {
            let dof = 2 * node + direction;
            let at = PointLoad { dof };
            self.points
                .add(dof, at, force, source.amplitude, source.context);
        }
        Some(())
    }

    /// `element or set, kind, magnitude[, dx, dy[, dz]]`; no set is all elements
    fn element_row(&mut self, row: Row, source: Source, cx: &mut Context) -> Option<()> {
        let Targets {
            mesh_index, sets, ..
        } = source.targets;
        let elements = match row.get(0) {
            Some(field) => sets.elements_of(field, mesh_index, cx),
            None => Cow::Owned((0..mesh_index.mesh.elements.len()).collect()),
        };
        let kind = row.required(1, "the kind of load", cx.d)?;
        let key = kind.name_key();
        let body = match key.as_str() {
            "GRAV" => Some(Body::Gravity),
            "BX" => Some(Body::X),
            "BY" => Some(Body::Y),
            _ => None,
        };
        if let Some(body) = body {
            return self.body_row(row, body, &elements, source, cx);
        }
        let Some((side, is_traction)) = loaded_side(&key) else {
            let known = "GRAV, BX, BY, P1 to P4 and TRVEC1 to TRVEC4";
            return unknown_kind(kind, known, cx);
        };
        let direction = match is_traction {
            true => Some(dead_direction(kind, row, source.card, cx)?),
            false => None,
        };
        self.face_row(row, (side, direction), &elements, source, cx)
    }

    fn body_row(
        &mut self,
        row: Row,
        body: Body,
        elements: &[usize],
        source: Source,
        cx: &mut Context,
    ) -> Option<()> {
        let magnitude = row.real(2, "the magnitude", cx.d)?;
        let direction = match body {
            Body::Gravity => gravity_direction(row, magnitude, cx)?,
            Body::X => [1.0, 0.0],
            Body::Y => [0.0, 1.0],
        };
        row.at_most(if body == Body::Gravity { 6 } else { 3 }, cx.d);
        let (amplitude, context) = (source.amplitude, source.context);
        self.bodies.reserve(elements.len());
        for &element in elements {
            let at = BodyForce {
                element,
                direction,
                per_mass: body == Body::Gravity,
            };
            let key = (element as u32, body);
            self.bodies.add(key, at, magnitude, amplitude, context);
        }
        Some(())
    }

    /// A pressure, or a traction with its direction, on one side of each element.
    fn face_row(
        &mut self,
        row: Row,
        (side, direction): (usize, Option<[f64; 2]>),
        elements: &[usize],
        source: Source,
        cx: &mut Context,
    ) -> Option<()> {
        if direction.is_none() {
            row.at_most(3, cx.d);
        }
        let magnitude = row.real(2, "the magnitude", cx.d)?;
        let mesh = &source.targets.mesh_index.mesh;
        if let Some(&bad) = elements.iter().find(|&&e| side >= side_count(mesh, e)) {
            let label = source.targets.mesh_index.element_name(bad);
            let message = format!("element {label} has no face {}", side + 1);
            cx.error(Code::NoSuchFace, row.span(), message);
            return None;
        }
        let (amplitude, context) = (source.amplitude, source.context);
        for &element in elements {
            let face = Face { element, side };
            match direction {
                None => {
                    let at = Pressure { face };
                    self.pressures.add(face, at, magnitude, amplitude, context);
                }
                Some(direction) => {
                    let at = Traction { face, direction };
                    self.face_tractions
                        .add(face, at, magnitude, amplitude, context);
                }
            }
        }
        Some(())
    }

    /// `surface, P, p` or `surface, TRVEC, t, dx, dy[, dz]`
    fn surface_row(&mut self, row: Row, source: Source, cx: &mut Context) -> Option<()> {
        let field = row.required(0, "a surface", cx.d);
        let surface = field.and_then(|field| surface::find(source.surfaces, field, cx));
        let kind = row.required(1, "the kind of load", cx.d)?;
        let magnitude = row.real(2, "the magnitude", cx.d)?;
        let direction = match kind.name_key().as_str() {
            "P" => {
                row.at_most(3, cx.d);
                warn_that_pressure_follows(source.card, cx);
                None
            }
            "TRVEC" => Some(dead_direction(kind, row, source.card, cx)?),
            _ => return unknown_kind(kind, "P and TRVEC", cx),
        };
        let (index, surface, span) = surface?;
        let SurfaceKind::Faces(faces) = &surface.kind else {
            let message = format!("surface {} has no element faces", surface.name);
            cx.error(Code::SurfaceUse, span, message);
            return None;
        };
        for &face in faces {
            self.add_to_face((index, face), direction, magnitude, source);
        }
        Some(())
    }

    fn add_to_face(
        &mut self,
        key: (usize, Face),
        direction: Option<[f64; 2]>,
        magnitude: f64,
        source: Source,
    ) {
        let (amplitude, context, face) = (source.amplitude, source.context, key.1);
        match direction {
            None => {
                let at = Pressure { face };
                self.surface_pressures
                    .add(key, at, magnitude, amplitude, context);
            }
            Some(direction) => {
                let at = Traction { face, direction };
                self.tractions.add(key, at, magnitude, amplitude, context);
            }
        }
    }

    /// Writes the loads of the current step; those of the last one are not carried further.
    pub fn fill(&mut self, step: &mut Step, is_last: bool) {
        step.point_loads = self.points.list(is_last);
        step.body_forces = self.bodies.list(is_last);
        let mut pressures = self.pressures.list(is_last);
        pressures.extend(self.surface_pressures.list(is_last));
        step.pressures = joined(pressures, |load| load.at.face);
        let mut tractions = self.face_tractions.list(is_last);
        tractions.extend(self.tractions.list(is_last));
        step.tractions = joined(tractions, |load| load.at.face);
    }

    /// Ends a step of duration `period` at total time `total`.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        self.points.end_step(period, total, amplitudes);
        self.bodies.end_step(period, total, amplitudes);
        self.pressures.end_step(period, total, amplitudes);
        self.face_tractions.end_step(period, total, amplitudes);
        self.surface_pressures.end_step(period, total, amplitudes);
        self.tractions.end_step(period, total, amplitudes);
    }
}

fn unknown_kind(kind: Text, known: &str, cx: &mut Context) -> Option<()> {
    let message = format!("load {} cannot be used", kind.text);
    let error = Diagnostic::error(Code::UnsupportedParameter, kind.span, message);
    cx.d.push(error.help(format!("the loads here are {known}")));
    None
}

/// Side, from 0, of P1 to P4 and of TRVEC1 to TRVEC4, and whether it is a traction.
fn loaded_side(kind: &str) -> Option<(usize, bool)> {
    let (number, is_traction) = match kind.strip_prefix("TRVEC") {
        Some(number) => (number, true),
        None => (kind.strip_prefix('P')?, false),
    };
    let side = ["1", "2", "3", "4"]
        .iter()
        .position(|side| *side == number)?;
    Some((side, is_traction))
}

fn gravity_direction(row: Row, magnitude: f64, cx: &mut Context) -> Option<[f64; 2]> {
    let direction = unit_direction(row, cx)?;
    warn_unless_unit(row, cx);
    if magnitude != 0.0 {
        hint_at_units(row, magnitude, cx);
    }
    Some(direction)
}

/// Notes a gravity that hints at mixed units.
fn hint_at_units(row: Row, magnitude: f64, cx: &mut Context) {
    let usual = [9.81, 981.0, 9810.0, 32.2, 386.0];
    let near = |g: &f64| (magnitude.abs() / g - 1.0).abs() < 0.02;
    if let (false, Some(field)) = (usual.iter().any(near), row.get(2)) {
        let text = field.text;
        let message = format!("{text} is not the gravity of the earth in common units");
        let note = Diagnostic::note(Code::UnitsHint, field.span, message);
        cx.d.push_once(note.help("9.81 m/s^2 = 981 cm/s^2 = 9810 mm/s^2 = 386 in/s^2"));
    }
}

/// Fields 3 to 5: dx, dy, dz with dz = 0, made a unit vector.
fn unit_direction(row: Row, cx: &mut Context) -> Option<[f64; 2]> {
    let components = [3, 4, 5].map(|i| row.real_or(i, 0.0, cx.d));
    let [Some(x), Some(y), Some(z)] = components else {
        return None;
    };
    let span = row.get(3).map_or(row.span(), |field| field.span);
    let length = match x.hypot(y) {
        // a unit vector to round-off stays as it is given
        length if (length - 1.0).abs() <= 2.0 * f64::EPSILON => 1.0,
        length => length,
    };
    if z != 0.0 {
        cx.error(Code::BadDirection, span, "the direction leaves the plane");
        return None;
    }
    if length == 0.0 || !length.is_finite() {
        cx.error(Code::BadDirection, span, "the direction is zero");
        return None;
    }
    Some([x / length, y / length])
}

/// CalculiX multiplies an acceleration by the length of its direction.
fn warn_unless_unit(row: Row, cx: &mut Context) {
    let component = |i: usize| row.get(i).and_then(|field| field.as_real());
    let length = component(3)
        .unwrap_or(0.0)
        .hypot(component(4).unwrap_or(0.0));
    if (length - 1.0).abs() > 1e-6 {
        let span = row.get(3).map_or(row.span(), |field| field.span);
        let message = format!("the direction has the length {length}, not 1");
        let warning = Diagnostic::warning(Code::BadDirection, span, message);
        cx.d.push_once(warning.help("only its direction is taken, the magnitude stays as given"));
    }
}

fn warn_that_pressure_follows(card: &Card, cx: &mut Context) {
    if card.choice("FOLLOWER") == Some("NO") {
        let message = "FOLLOWER=NO has no effect on P: a pressure always follows its face";
        let span = card.span_of("FOLLOWER");
        cx.d.push_once(Diagnostic::warning(Code::IgnoredParameter, span, message));
    }
}

/// Direction of a TRVEC, which must not follow the face.
fn dead_direction(kind: Text, row: Row, card: &Card, cx: &mut Context) -> Option<[f64; 2]> {
    row.at_most(6, cx.d);
    if card.choice("FOLLOWER") != Some("NO") {
        let span: Span = kind.span;
        let message = "TRVEC needs FOLLOWER=NO: tractions that turn with the face cannot be used";
        cx.error(Code::UnsupportedParameter, span, message);
        return None;
    }
    unit_direction(row, cx)
}
