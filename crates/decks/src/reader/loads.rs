//! `*CLOAD`, `*DLOAD` and `*DSLOAD`, and loads as they are carried from step to step.

use super::actions::{Action, Actions};
use super::boundary::{Targets, row_dofs};
use super::context::Context;
use super::mesh_index::PointKind;
use super::surfaces::Surfaces;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::Code;
use crate::model::{
    Amplitude, BodyForce, CentrifugalForce, Face, Load, PointLoad, Pressure, Step, SurfaceKind,
    TimeBase, Traction, Variation,
};
use crate::vectors::{cross, difference, distance, dot};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// All loads, as they are carried from step to step.
#[derive(Default)]
pub(crate) struct LoadHistories {
    points: LoadHistory<usize, PointLoad>,
    /// Weights of point masses, by number of the mass and direction.
    weights: LoadHistory<(u32, usize), PointLoad>,
    bodies: LoadHistory<(u32, Body), BodyForce>,
    turned: LoadHistory<u32, CentrifugalForce>,
    pressures: LoadHistory<(OnFace, Follower), Pressure>,
    tractions: LoadHistory<OnFace, Traction>,
    /// Value of `OP` by the keywords of the cards.
    operations: BTreeMap<&'static str, Operation>,
    /// Forces on nodes without element.
    pub actions: Actions,
}

/// A face, and the surface (index) on which `*DSLOAD` loads it; `None` for `*DLOAD`.
type OnFace = (Option<usize>, Face);

/// Kinds of load on a face; a later step replaces a load of the same kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Follower {
    Pressure,
    /// Component across the face of a traction that turns with the face.
    Across,
    /// Component along the face of a traction that turns with the face, or a shear.
    Along,
}

impl Follower {
    fn of(load: &Pressure) -> Follower {
        match load.is_shear {
            true => Follower::Along,
            false => Follower::Pressure,
        }
    }
}

/// A load on a face.
#[derive(Clone, Copy)]
enum FaceLoad {
    Pressure,
    /// A traction along a fixed direction.
    Dead([f64; 2]),
    /// A traction along a direction that turns with the face.
    Turning([f64; 2]),
    /// A shear along the face, to the side of the given direction.
    Shear([f64; 2]),
}

/// Kinds of body force; a later step replaces a force of the same kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Body {
    Gravity,
    X,
    Y,
}

impl Body {
    fn of(force: &BodyForce) -> Body {
        match (force.per_mass, force.direction[0] != 0.0) {
            (true, _) => Body::Gravity,
            (false, true) => Body::X,
            (false, false) => Body::Y,
        }
    }
}

/// A copy of a step with the loads that it hands on to the next step, given on nodes and elements.
pub(crate) fn carried_loads(step: &Step, amplitudes: &[Amplitude]) -> Step {
    let mut loads = LoadHistories {
        points: LoadHistory::of(&step.point_loads, |at| at.dof),
        weights: LoadHistory::default(),
        bodies: LoadHistory::of(&step.body_forces, |at| (at.element as u32, Body::of(at))),
        turned: LoadHistory::of(&step.centrifugal_forces, |at| at.element as u32),
        pressures: LoadHistory::of(&step.pressures, |at| ((None, at.face), Follower::of(at))),
        tractions: LoadHistory::of(&step.tractions, |at| (None, at.face)),
        operations: BTreeMap::new(),
        actions: Actions::default(),
    };
    loads.end_step(step.increments.period, 0.0, amplitudes);
    let mut carried = step.clone();
    loads.fill(&mut carried, true);
    carried
}

/// A card of loads with the data that its rows share.
#[derive(Clone, Copy)]
struct Source<'a> {
    card: &'a Card,
    amplitude: Option<usize>,
    context: StepContext,
    targets: Targets<'a>,
    surfaces: &'a Surfaces,
}

impl LoadHistories {
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
        let keyword = card.keyword.name;
        let operation = self.operations.entry(keyword).or_default();
        if !operation.starts_anew(card, context.step, cx) {
            return;
        }
        if keyword == "CLOAD" {
            return self.points.clear(context, |_| true);
        }
        let on_surfaces = keyword == "DSLOAD";
        if !on_surfaces {
            self.weights.clear(context, |_| true);
            self.bodies.clear(context, |_| true);
            self.turned.clear(context, |_| true);
        }
        let is_meant = |(surface, _): &OnFace| surface.is_some() == on_surfaces;
        self.pressures.clear(context, |(on, _)| is_meant(on));
        self.tractions.clear(context, is_meant);
    }

    /// Reads a row `node or set, direction, force`.
    fn point_row(&mut self, row: Line, source: Source, cx: &mut Context) -> Option<()> {
        row.at_most(3, cx.d);
        let Targets {
            mesh_index, sets, ..
        } = source.targets;
        let target = row.required(0, "a node or node set", cx.d);
        let nodes = target.map(|field| sets.nodes_of(field, mesh_index, cx));
        let force = row.real(2, "the force", cx.d);
        let dofs = row_dofs(row, &nodes?, force.unwrap_or(0.0), source.targets, cx);
        let (dofs, force) = (dofs?, force?);
        for dof in dofs {
            let at = PointLoad { dof };
            if force != 0.0 {
                let span = row.span();
                (self.actions).enter(dof, Action::Load, span, source.targets.has_element);
            }
            self.points
                .add(dof, at, force, source.amplitude, source.context);
        }
        Some(())
    }

    /// Reads a row `element or set, kind, magnitude[, dx, dy[, dz]]`; an empty first field means all elements.
    fn element_row(&mut self, row: Line, source: Source, cx: &mut Context) -> Option<()> {
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
            "BR" if mesh_index.mesh.is_axisymmetric() => Some(Body::X),
            "BZ" if mesh_index.mesh.is_axisymmetric() => Some(Body::Y),
            _ => None,
        };
        if let Some(body) = body {
            return self.body_row(row, body, &elements, source, cx);
        }
        if key == "CENTRIF" {
            warn_of_masses(row, source.targets, cx);
            return self.centrifugal_row(row, &elements, source, cx);
        }
        let Some((name, side)) = loaded_side(&key) else {
            let known = "GRAV, BX, BY, CENTRIF, P1 to P4, TRVEC1 to TRVEC4 and TRSHR1 to TRSHR4";
            return unknown_kind(kind, known, cx);
        };
        let load = face_load(name, row, source.card, cx)?;
        self.face_row(row, (side, load), &elements, source, cx)
    }

    fn body_row(
        &mut self,
        row: Line,
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
        let is_axisymmetric = source.targets.mesh_index.mesh.is_axisymmetric();
        if is_axisymmetric && body == Body::Gravity && direction[0] != 0.0 {
            let message = "this gravity points across the axis of revolution";
            cx.error(Code::BadDirection, row.span_at(3), message)
                .help("it acts along the axis: its direction is 0, 1 or 0, -1");
            return None;
        }
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
        if body == Body::Gravity {
            for point in masses_of(row, source.targets, cx) {
                self.add_weight(point, magnitude, direction, source);
            }
        }
        Some(())
    }

    /// Adds the weight of a point mass as a force in each direction; both forces replace weights from earlier steps.
    fn add_weight(&mut self, point: usize, magnitude: f64, direction: [f64; 2], source: Source) {
        let Targets {
            mesh_index, masses, ..
        } = source.targets;
        let (node, mass) = (mesh_index.points[point].node, masses[point]);
        for (i, component) in direction.into_iter().enumerate() {
            let at = PointLoad { dof: 2 * node + i };
            let (weight, key) = (mass * magnitude * component, (point as u32, i));
            (self.weights).add(key, at, weight, source.amplitude, source.context);
        }
    }

    /// Reads `element or set, CENTRIF, omega^2, x, y, z, ax, ay, az`, with a point of the axis and its direction.
    fn centrifugal_row(
        &mut self,
        row: Line,
        elements: &[usize],
        source: Source,
        cx: &mut Context,
    ) -> Option<()> {
        row.at_most(9, cx.d);
        let square = row.real(2, "the square of the angular velocity", cx.d)?;
        if square < 0.0 {
            let message = "the square of the angular velocity is negative";
            cx.error(Code::BadDirection, row.span_at(2), message);
            return None;
        }
        let is_ring = source.targets.mesh_index.mesh.is_axisymmetric();
        let along = if is_ring {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        let place = [3, 4, 5].map(|i| row.real_or(i, 0.0, cx.d));
        let [x, y, _] = [place[0]?, place[1]?, place[2]?];
        let has_direction = (6..9).any(|i| row.get(i).is_some_and(|field| !field.text.is_empty()));
        let direction = match has_direction {
            true => [6, 7, 8].map(|i| row.real_or(i, 0.0, cx.d)),
            false => along.map(Some),
        };
        let direction = [direction[0]?, direction[1]?, direction[2]?];
        let across = (0..3).filter(|&i| along[i] == 0.0 && direction[i] != 0.0);
        let lengths = direction.iter().zip(&along).map(|(d, a)| d * a);
        if across.count() > 0 || lengths.sum::<f64>() == 0.0 || (is_ring && x != 0.0) {
            let (message, help) = match is_ring {
                true => (
                    "bodies of revolution turn around their axis alone",
                    "write 0, 0, 0, 0, 1, 0 for the axis x = 0",
                ),
                false => (
                    "the axis is not perpendicular to the plane",
                    "its direction is 0, 0, 1",
                ),
            };
            cx.error(Code::BadDirection, row.span_at(3), message)
                .help(help);
            return None;
        }
        let axis = if is_ring { [0.0; 2] } else { [x, y] };
        for &element in elements {
            let at = CentrifugalForce { element, axis };
            let (amplitude, context) = (source.amplitude, source.context);
            self.turned
                .add(element as u32, at, square, amplitude, context);
        }
        Some(())
    }

    /// Adds a load on one side of each element.
    fn face_row(
        &mut self,
        row: Line,
        (side, load): (usize, FaceLoad),
        elements: &[usize],
        source: Source,
        cx: &mut Context,
    ) -> Option<()> {
        let magnitude = row.real(2, "the magnitude", cx.d)?;
        let mesh_index = source.targets.mesh_index;
        let has_none = |&&element: &&usize| mesh_index.side(element, side).is_none();
        if let Some(&bad) = elements.iter().find(has_none) {
            let label = source.targets.mesh_index.element_name(bad);
            let message = format!("element {label} has no face {}", side + 1);
            cx.error(Code::NoSuchFace, row.span(), message);
            return None;
        }
        for &element in elements {
            let Some(side) = mesh_index.side(element, side) else {
                continue;
            };
            let face = Face { element, side };
            self.add_to_face((None, face), (load, magnitude), row, source, cx)?;
        }
        Some(())
    }

    /// Reads `surface, P, p`, or `surface, TRVEC or TRSHR, t, dx, dy[, dz]`.
    fn surface_row(&mut self, row: Line, source: Source, cx: &mut Context) -> Option<()> {
        let field = row.required(0, "a surface", cx.d);
        let surface = field.and_then(|field| source.surfaces.find(field, cx));
        let kind = row.required(1, "the kind of load", cx.d)?;
        let magnitude = row.real(2, "the magnitude", cx.d)?;
        let key = kind.name_key();
        if !["P", "TRVEC", "TRSHR"].contains(&key.as_str()) {
            return unknown_kind(kind, "P, TRVEC and TRSHR", cx);
        }
        let load = face_load(&key, row, source.card, cx)?;
        let (index, surface, span) = surface?;
        let SurfaceKind::Faces(faces) = &surface.kind else {
            let message = format!("surface {} has no element faces", surface.name);
            cx.error(Code::SurfaceUse, span, message);
            return None;
        };
        for &face in faces {
            self.add_to_face((Some(index), face), (load, magnitude), row, source, cx)?;
        }
        Some(())
    }

    fn add_to_face(
        &mut self,
        key: OnFace,
        (load, magnitude): (FaceLoad, f64),
        row: Line,
        source: Source,
        cx: &mut Context,
    ) -> Option<()> {
        let (amplitude, context, face) = (source.amplitude, source.context, key.1);
        let mut follow = |follower: Follower, size: f64| {
            let is_shear = follower == Follower::Along;
            let at = Pressure { face, is_shear };
            (self.pressures).add((key, follower), at, size, amplitude, context);
        };
        match load {
            FaceLoad::Pressure => follow(Follower::Pressure, magnitude),
            FaceLoad::Dead(direction) => {
                let at = Traction { face, direction };
                self.tractions.add(key, at, magnitude, amplitude, context);
            }
            FaceLoad::Turning(direction) => {
                let along = straight(face, row, source.targets, cx)?;
                follow(Follower::Along, magnitude * dot(direction, along));
                follow(Follower::Across, magnitude * cross(along, direction));
            }
            FaceLoad::Shear(direction) => {
                let part = dot(direction, chord(face, source.targets));
                if part.abs() < ACROSS {
                    let message = "the direction of this shear points across the face";
                    cx.error(Code::BadDirection, row.span(), message)
                        .help("a shear acts along the face, to the side of its direction");
                    return None;
                }
                follow(Follower::Along, magnitude * part.signum());
            }
        }
        Some(())
    }

    /// Writes the loads of the current step; after the last step nothing is carried over.
    pub fn fill(&mut self, step: &mut Step, is_last: bool) {
        step.point_loads = self.points.list(is_last);
        let acts = |load: &Load<PointLoad>| match load.ends() {
            Some(ends) => ends != [0.0; 2],
            None => load.magnitude != 0.0,
        };
        (step.point_loads).extend(self.weights.list(is_last).into_iter().filter(acts));
        (step.point_loads).sort_by_key(|load| load.at.dof);
        step.body_forces = self.bodies.list(is_last);
        step.centrifugal_forces = self.turned.list(is_last);
        step.pressures = joined(self.pressures.list(is_last), |load| {
            (load.at.face, load.at.is_shear)
        });
        step.tractions = joined(self.tractions.list(is_last), |load| load.at.face);
    }

    /// Ends a step of duration `period` at total time `total`.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        self.points.end_step(period, total, amplitudes);
        self.weights.end_step(period, total, amplitudes);
        self.bodies.end_step(period, total, amplitudes);
        self.turned.end_step(period, total, amplitudes);
        self.pressures.end_step(period, total, amplitudes);
        self.tractions.end_step(period, total, amplitudes);
    }
}

fn unknown_kind(kind: Text, known: &str, cx: &mut Context) -> Option<()> {
    let message = format!("load {} cannot be used", kind.text);
    cx.error(Code::UnsupportedParameter, kind.span, message)
        .help(format!("the loads here are {known}"));
    None
}

/// Splits P1 to P4, TRVEC1 to TRVEC4 and TRSHR1 to TRSHR4 into the kind of load and the side of the element, from 0.
fn loaded_side(kind: &str) -> Option<(&'static str, usize)> {
    let kinds = ["TRVEC", "TRSHR", "P"].into_iter();
    let (name, number) = kinds
        .filter_map(|name| Some((name, kind.strip_prefix(name)?)))
        .next()?;
    let side = ["1", "2", "3", "4"]
        .iter()
        .position(|side| *side == number)?;
    Some((name, side))
}

/// Smallest cosine of the angle between a face and the direction of a shear: below this cosine the sense of the shear
/// along the face is undecided.
const ACROSS: f64 = 1e-3;

/// Largest distance of a node of a straight side from the chord of the side, relative to the length of the chord.
const STRAIGHT: f64 = 1e-9;

/// The unit vector along a face in the mesh, from its first corner to its last.
fn chord(face: Face, targets: Targets) -> [f64; 2] {
    let mesh = &targets.mesh_index.mesh;
    let [a, b] = face.ends(mesh).map(|node| mesh.coordinates[node]);
    let length = distance(a, b);
    difference(a, b).map(|x| x / length)
}

/// The unit vector along a straight face; a curved face is reported, because it has no single such vector.
fn straight(face: Face, row: Line, targets: Targets, cx: &mut Context) -> Option<[f64; 2]> {
    let (mesh, along) = (&targets.mesh_index.mesh, chord(face, targets));
    let [first, last] = face.ends(mesh).map(|node| mesh.coordinates[node]);
    let nodes = face.nodes(mesh).into_iter();
    let off = nodes.map(|node| cross(along, difference(first, mesh.coordinates[node])).abs());
    if off.fold(0.0, f64::max) > STRAIGHT * distance(first, last) {
        let name = targets.mesh_index.element_name(face.element);
        let message = format!(
            "face S{} of element {name} is curved: no direction turns with it",
            face.side + 1
        );
        cx.error(Code::BadDirection, row.span(), message)
            .help("write FOLLOWER=NO for a direction that stays, P and TRSHR for parts across and along the face");
        return None;
    }
    Some(along)
}

/// The point masses among the elements of a row.
fn masses_of(row: Line, targets: Targets, cx: &mut Context) -> Vec<usize> {
    let Targets {
        mesh_index, sets, ..
    } = targets;
    let all = || (0..mesh_index.points.len()).collect();
    let mut points = row
        .get(0)
        .map_or_else(all, |field| sets.points_of(field, mesh_index, cx));
    points.retain(|&point| mesh_index.points[point].kind == PointKind::Mass);
    points
}

/// Warns that a centrifugal force does not act on point masses if a row names point masses.
fn warn_of_masses(row: Line, targets: Targets, cx: &mut Context) {
    if !masses_of(row, targets, cx).is_empty() {
        let message = "CENTRIF does not act on elements of the type MASS";
        cx.d.warning_once(Code::IgnoredParameter, row.span(), message)
            .help("give their force with *CLOAD at the nodes");
    }
}

fn gravity_direction(row: Line, magnitude: f64, cx: &mut Context) -> Option<[f64; 2]> {
    let direction = unit_direction(row, cx)?;
    warn_unless_unit(row, cx);
    if magnitude != 0.0 {
        hint_at_units(row, magnitude, cx);
    }
    Some(direction)
}

/// Notes a gravity whose value hints at mixed units.
fn hint_at_units(row: Line, magnitude: f64, cx: &mut Context) {
    let usual = [9.81, 981.0, 9810.0, 32.2, 386.0];
    let near = |g: &f64| (magnitude.abs() / g - 1.0).abs() < 0.02;
    if let (false, Some(field)) = (usual.iter().any(near), row.get(2)) {
        let text = field.text;
        let message = format!("{text} is not the gravity of the earth in common units");
        cx.d.note_once(Code::UnitsHint, field.span, message)
            .help("9.81 m/s^2 = 981 cm/s^2 = 9810 mm/s^2 = 386 in/s^2");
    }
}

/// Reads fields 3 to 5, dx, dy, dz with dz = 0, and makes a unit vector from these.
fn unit_direction(row: Line, cx: &mut Context) -> Option<[f64; 2]> {
    let components = [3, 4, 5].map(|i| row.real_or(i, 0.0, cx.d));
    let [Some(x), Some(y), Some(z)] = components else {
        return None;
    };
    let span = row.span_at(3);
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

/// Warns if the direction of an acceleration is no unit vector: CalculiX multiplies the acceleration by the length of
/// the vector.
fn warn_unless_unit(row: Line, cx: &mut Context) {
    let component = |i: usize| row.get(i).and_then(|field| field.as_real());
    let length = component(3)
        .unwrap_or(0.0)
        .hypot(component(4).unwrap_or(0.0));
    if (length - 1.0).abs() > 1e-6 {
        let span = row.span_at(3);
        let message = format!("the direction has the length {length}, not 1");
        cx.d.warning_once(Code::BadDirection, span, message)
            .help("only its direction is taken, the magnitude stays as given");
    }
}

fn warn_that_it_follows(what: &str, card: &Card, cx: &mut Context) {
    if card.choice("FOLLOWER") == Some("NO") {
        let message = format!("FOLLOWER=NO has no effect on {what} always follows its face");
        let span = card.span_of("FOLLOWER");
        cx.d.warning_once(Code::IgnoredParameter, span, message);
    }
}

/// The load on a face that a row of P, TRVEC or TRSHR gives.
fn face_load(name: &str, row: Line, card: &Card, cx: &mut Context) -> Option<FaceLoad> {
    if name == "P" {
        row.at_most(3, cx.d);
        warn_that_it_follows("P: a pressure", card, cx);
        return Some(FaceLoad::Pressure);
    }
    row.at_most(6, cx.d);
    let direction = unit_direction(row, cx)?;
    if card.choice("CONSTANT RESULTANT") == Some("YES") && card.choice("FOLLOWER") != Some("NO") {
        let span = card.span_of("CONSTANT RESULTANT");
        cx.error(
            Code::UnsupportedParameter,
            span,
            "CONSTANT RESULTANT=YES is for TRVEC with FOLLOWER=NO",
        )
        .help("a traction that follows its face acts on its area as it is then");
        return None;
    }
    Some(match (name, card.choice("FOLLOWER")) {
        ("TRSHR", _) => {
            warn_that_it_follows("TRSHR: a shear", card, cx);
            FaceLoad::Shear(direction)
        }
        (_, Some("NO")) => FaceLoad::Dead(direction),
        _ => FaceLoad::Turning(direction),
    })
}

/// Course by which a load without amplitude reaches its magnitude, and the step that gives the load.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepContext {
    /// Number of the step, from 1; 0 for model data.
    pub step: usize,
    /// Whether loads without amplitude grow linearly (`*STEP, AMPLITUDE=RAMP`).
    pub ramp: bool,
}

/// Whether a step keeps the loads of earlier steps (`OP`); the first card of its kind decides.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Operation {
    step: usize,
    new: bool,
}

impl Operation {
    /// Enters a card; returns whether the card removes all loads of earlier steps.
    pub fn starts_anew(&mut self, card: &Card, step: usize, cx: &mut Context) -> bool {
        let typed = card.choice("OP");
        let new = typed == Some("NEW");
        if self.step == step {
            if typed.is_some() && new != self.new {
                let message = format!("OP of the first {} in this step holds", card.title());
                let span = card.span_of("OP");
                cx.warning(Code::MixedOperation, span, message);
            }
            return false;
        }
        *self = Operation { step, new };
        new
    }
}

/// The loads of one kind by their keys.
pub(crate) struct LoadHistory<K, T> {
    /// The first `sorted` loads are in the order of their keys; later loads follow in any order.
    parts: Vec<(K, CarriedLoad<T>)>,
    sorted: usize,
}

/// A load with its magnitude at the end of the step before.
#[derive(Clone, Copy)]
pub(super) struct CarriedLoad<T> {
    load: Load<T>,
    /// Magnitude at the end of the step before.
    end: f64,
    /// Number of the step that gave the load.
    step: u32,
    /// Whether another load has replaced the load.
    replaced: bool,
}

impl<K, T> Default for LoadHistory<K, T> {
    fn default() -> Self {
        LoadHistory {
            parts: Vec::new(),
            sorted: 0,
        }
    }
}

impl<K: Ord + Copy, T: Copy + PartialEq> LoadHistory<K, T> {
    /// The loads of a step, by keys made from the places they act on.
    fn of(loads: &[Load<T>], key: impl Fn(&T) -> K) -> LoadHistory<K, T> {
        LoadHistory {
            parts: loads
                .iter()
                .map(|load| (key(&load.at), CarriedLoad::of(load)))
                .collect(),
            sorted: 0,
        }
    }

    /// All loads of the current step, in the order of their keys; after the last step the list is emptied.
    pub fn list(&mut self, is_last: bool) -> Vec<Load<T>> {
        self.sort();
        match is_last {
            // within the same memory
            true => {
                let parts = std::mem::take(self).parts.into_iter();
                parts.map(|(_, part)| part.simple()).collect()
            }
            false => self.parts.iter().map(|(_, part)| part.simple()).collect(),
        }
    }

    /// Removes the loads whose keys fulfil `is_meant`; if loads ramp, the removed loads fade out over the step.
    pub fn clear(&mut self, context: StepContext, is_meant: impl Fn(&K) -> bool) {
        if !context.ramp {
            self.parts.retain(|(key, _)| !is_meant(key));
        }
        for (_, part) in self.parts.iter_mut().filter(|(key, _)| is_meant(key)) {
            part.fade();
        }
        self.sort();
    }

    /// Makes room for `count` more loads.
    pub fn reserve(&mut self, count: usize) {
        self.parts.reserve(count);
    }

    /// Adds a load, which replaces the loads of earlier steps under the same key.
    pub fn add(
        &mut self,
        key: K,
        at: T,
        magnitude: f64,
        amplitude: Option<usize>,
        context: StepContext,
    ) {
        let mut from = 0.0;
        let ramps = context.ramp && amplitude.is_none();
        for part in self.earlier(key, context) {
            if ramps && part.load.at != at {
                part.fade();
            } else {
                from += part.end;
                part.replaced = true;
            }
        }
        let part = CarriedLoad::new(at, magnitude, amplitude, context);
        self.parts.push((key, part.rising_from(from)));
    }

    /// Adds a load that falls from a magnitude to zero over the step. The new load replaces the loads of earlier steps
    /// under the same key.
    pub fn add_falling(&mut self, key: K, at: T, from: f64, step: usize) {
        let context = StepContext { step, ramp: true };
        (self.earlier(key, context)).for_each(|part| part.replaced = true);
        let part = CarriedLoad::new(at, 0.0, None, context);
        self.parts.push((key, part.rising_from(from)));
    }

    /// Removes the loads that a step has added under a key, and restores the loads that these had replaced.
    pub fn take_back(&mut self, key: K, step: usize) {
        (self.parts).retain(|(known, part)| *known != key || part.step as usize != step);
        let own = self.parts.iter_mut().filter(|(known, _)| *known == key);
        own.for_each(|(_, part)| part.replaced = false);
    }

    /// Magnitude that the step before has left under a key.
    pub fn left(&mut self, key: K, step: usize) -> f64 {
        let context = StepContext { step, ramp: true };
        self.earlier(key, context).map(|part| part.end).sum()
    }

    /// Loads of earlier steps under a key.
    fn earlier(
        &mut self,
        key: K,
        context: StepContext,
    ) -> impl Iterator<Item = &mut CarriedLoad<T>> {
        let sorted = self.parts.get(..self.sorted).unwrap_or_default();
        let first = sorted.partition_point(|(known, _)| *known < key);
        let parts = self.parts.iter_mut().skip(first);
        parts
            .take_while(move |(known, _)| *known == key)
            .map(|(_, part)| part)
            .filter(move |part| (part.step as usize) < context.step && !part.replaced)
    }

    /// Drops replaced loads and sorts the other loads by their keys.
    fn sort(&mut self) {
        self.parts.retain(|(_, part)| !part.replaced);
        if !self.parts.is_sorted_by_key(|(key, _)| *key) {
            self.parts.sort_by_key(|(key, _)| *key);
        }
        self.sorted = self.parts.len();
    }

    /// Ends a step: loads keep the magnitude that they have reached, unless they follow an amplitude in total time.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        self.sort();
        for (_, part) in &mut self.parts {
            part.end_step(period, total, amplitudes);
        }
        for parts in self.parts.chunk_by_mut(|(a, _), (b, _)| a == b) {
            add_up(parts);
        }
        let acts = |part: &CarriedLoad<T>| !part.replaced && part.load.magnitude != 0.0;
        self.parts.retain(|(_, part)| acts(part));
        self.sorted = self.parts.len();
    }
}

/// Loads on faces in the order of their places. At each place loads without amplitude come first; such loads in the
/// same direction are joined to one load.
pub(super) fn joined<T: Copy + PartialEq, K: Ord>(
    mut loads: Vec<Load<T>>,
    place: fn(&Load<T>) -> K,
) -> Vec<Load<T>> {
    loads.sort_by_key(|load| (place(load), load.ends().is_none()));
    let mut all: Vec<Load<T>> = Vec::with_capacity(loads.len());
    for load in loads {
        let before = all.iter_mut().rev();
        let mut on_face = before.take_while(|known| place(known) == place(&load));
        let same = on_face.find(|known| known.at == load.at && known.ends().is_some());
        match same.and_then(|known| Some((known.ends()?, load.ends()?, known))) {
            Some(([from, to], [more, end], known)) => {
                *known = known.between([from + more, to + end]);
            }
            None => all.push(load),
        }
    }
    all
}

/// Joins constant loads at the same place and in the same direction.
fn add_up<K, T: Copy + PartialEq>(parts: &mut [(K, CarriedLoad<T>)]) {
    for index in 1..parts.len() {
        let (before, after) = parts.split_at_mut(index);
        let Some((_, part)) = after.first_mut() else {
            return;
        };
        let joins = |sum: &CarriedLoad<T>| {
            let both = [sum.load.variation, part.load.variation];
            sum.load.at == part.load.at && both == [Variation::Constant; 2]
        };
        let mut sums = before.iter_mut().map(|(_, sum)| sum);
        if let Some(sum) = sums.find(|sum| !sum.replaced && joins(sum)) {
            sum.load.magnitude += part.load.magnitude;
            sum.end += part.end;
            part.replaced = true;
        }
    }
}

impl<T: Copy> CarriedLoad<T> {
    /// A load of one step, without earlier steps.
    pub fn of(load: &Load<T>) -> Self {
        CarriedLoad {
            load: *load,
            end: 0.0,
            step: 0,
            replaced: false,
        }
    }

    /// The load, as a constant load if its ramp does not change the magnitude.
    pub fn simple(&self) -> Load<T> {
        let load = self.load;
        load.ends().map_or(load, |ends| load.between(ends))
    }

    /// Magnitude at the end of the step before, from which a replacing load ramps.
    pub fn reached(&self, context: StepContext) -> f64 {
        match (self.step as usize == context.step, self.load.variation) {
            (true, Variation::Ramp { from }) => from,
            _ => self.end,
        }
    }
}

impl<T> CarriedLoad<T> {
    /// A new load; if loads ramp, the load grows from zero to its magnitude.
    pub fn new(
        at: T,
        magnitude: f64,
        amplitude: Option<usize>,
        context: StepContext,
    ) -> CarriedLoad<T> {
        let variation = match amplitude {
            Some(index) => Variation::Amplitude(index),
            None if context.ramp => Variation::Ramp { from: 0.0 },
            None => Variation::Constant,
        };
        let load = Load {
            at,
            magnitude,
            variation,
        };
        CarriedLoad {
            load,
            end: 0.0,
            step: context.step as u32,
            replaced: false,
        }
    }

    /// The same load; a load that ramps grows from the given magnitude.
    pub fn rising_from(mut self, from: f64) -> CarriedLoad<T> {
        if let Variation::Ramp { .. } = self.load.variation {
            self.load.variation = Variation::Ramp { from };
        }
        self
    }

    fn fade(&mut self) {
        self.load.magnitude = 0.0;
        self.load.variation = Variation::Ramp { from: self.end };
    }

    /// Ends a step: the load keeps the magnitude that it has reached, unless it follows an amplitude in total time.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        let load = &mut self.load;
        let curve = match load.variation {
            Variation::Amplitude(index) => amplitudes.get(index),
            Variation::Constant | Variation::Ramp { .. } => None,
        };
        match curve {
            Some(curve) if curve.time == TimeBase::Total => {
                self.end = load.magnitude * curve.at(total);
                return;
            }
            Some(curve) => load.magnitude *= curve.at(period),
            None => {}
        }
        load.variation = Variation::Constant;
        self.end = load.magnitude;
    }
}
