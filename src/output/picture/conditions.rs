//! Supports, prescribed motions, loads and initial velocities of all steps.

use super::canvas::{Canvas, Pen, Point, Spacing};
use super::legend::{Legend, Symbol, fixed, guided};
use crate::contact::project;
use crate::model::{Bodies, Face, Model, Rate, Step, Support, SupportMotion};
use std::collections::{BTreeMap, HashSet};

const SUPPORT: &str = "#222222";
const REFERENCE: Pen = Pen("#777777", 0.0);
const MOTION: Pen = Pen("#8a1fc9", 2.0);
const LOAD: Pen = Pen("#c81e1e", 1.6);
const GRAVITY: Pen = Pen("#c81e1e", 3.0);
const VELOCITY: Pen = Pen("#15803d", 2.4);

/// Longest arrow, and distance between arrows, in pixels.
const ARROW: f64 = 44.0;
const APART: f64 = 18.0;

/// An arrow at a place of the model along a vector of the model.
type Vector = ([f64; 2], [f64; 2]);

/// Draws supports, motions, loads and velocities.
pub(super) fn draw(model: &Model, canvas: &mut Canvas, legend: &mut Legend) {
    supports(model, canvas, legend);
    let on_faces = |steps: &[Step]| steps.iter().flat_map(|s| face_loads(s, model)).collect();
    let forces = point_loads(model);
    arrows(&forces, LOAD, canvas, legend, "force");
    let loads: Vec<Vector> = on_faces(&model.steps);
    onto_faces(&loads, canvas, legend);
    arrows(&body_forces(model), GRAVITY, canvas, legend, "body force");
    arrows(
        &velocities(model),
        VELOCITY,
        canvas,
        legend,
        "initial velocity",
    );
}

/// Directions of nodes that are prescribed, and how far they move.
fn supports(model: &Model, canvas: &mut Canvas, legend: &mut Legend) {
    let mut held: BTreeMap<usize, [Option<f64>; 2]> = BTreeMap::new();
    for support in model.steps.iter().flat_map(|step| &step.supports) {
        let of_node = &mut held.entry(support.dof / 2).or_default()[support.dof % 2];
        let largest = of_node.unwrap_or(0.0);
        let way = way(support, model);
        *of_node = Some(if way.abs() > f64::abs(largest) {
            way
        } else {
            largest
        });
    }
    reference_nodes(model, canvas, legend);
    let mut spacing = Spacing::new(8.0);
    let mut moving = Vec::new();
    // the nodes of rigid surfaces do as their reference nodes
    let rigid: HashSet<usize> = model.rigid_segments().into_iter().flatten().collect();
    for (node, directions) in held.into_iter().filter(|(node, _)| !rigid.contains(node)) {
        let place = model.mesh.coordinates[node];
        let at = canvas.at(place);
        let way = directions.map(|way| way.unwrap_or(0.0));
        if way != [0.0; 2] {
            moving.push((place, way));
        } else if canvas.shows(place) && spacing.takes(at) {
            let is_held = directions.map(|way| way.is_some());
            mark(at, is_held, canvas, legend);
        }
    }
    arrows(&moving, MOTION, canvas, legend, "prescribed motion");
}

/// The reference nodes of rigid surfaces, with the names of these.
fn reference_nodes(model: &Model, canvas: &mut Canvas, legend: &mut Legend) {
    for body in &model.rigid_bodies {
        let place = model.mesh.coordinates[body.reference];
        if canvas.shows(place) {
            let [x, y] = canvas.at(place);
            canvas.dot([x, y], 5.0, REFERENCE.0);
            let name = &model.surfaces[body.surface].name;
            canvas.label([x + 9.0, y + 16.0], "start", REFERENCE.0, name);
        }
        legend.add(
            Symbol::Dotted(REFERENCE),
            "reference node of a rigid surface",
        );
    }
}

/// Displacement of a support in the first step, the largest of its amplitude's points where it follows one.
fn way(support: &Support, model: &Model) -> f64 {
    match support.motion {
        SupportMotion::Ramp { to } => to,
        SupportMotion::Amplitude { value, amplitude } => {
            let ends = model.steps.iter().map(|step| step.increments.period);
            let amplitude = &model.amplitudes[amplitude];
            let sign = ends
                .map(|t| amplitude.at(t))
                .find(|a| *a != 0.0)
                .unwrap_or(1.0);
            value * sign.signum()
        }
        SupportMotion::Rate {
            rate,
            value,
            amplitude,
        } => {
            let period = model.steps.first().map_or(0.0, |s| s.increments.period);
            let constant = [period, period * period / 2.0];
            let integrals = amplitude.map(|index| model.amplitudes[index].integrals(period));
            let [first, second] = integrals.unwrap_or(constant);
            match rate {
                Rate::Velocity => value * first,
                Rate::Acceleration => value * second,
            }
        }
    }
}

fn mark(at: Point, is_held: [bool; 2], canvas: &mut Canvas, legend: &mut Legend) {
    match is_held {
        [true, true] => {
            fixed(at, canvas, SUPPORT);
            legend.add(Symbol::Fixed(SUPPORT), "fixed in x and y");
        }
        [true, false] => {
            guided(at, 0, canvas, SUPPORT);
            legend.add(Symbol::Guided(SUPPORT), "fixed in x (left) or y (below)");
        }
        _ => {
            guided(at, 1, canvas, SUPPORT);
            legend.add(Symbol::Guided(SUPPORT), "fixed in x (left) or y (below)");
        }
    }
}

/// Forces by node, of all steps.
fn point_loads(model: &Model) -> Vec<Vector> {
    let mut forces: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    for load in model.steps.iter().flat_map(|step| &step.point_loads) {
        forces.entry(load.at.dof / 2).or_default()[load.at.dof % 2] = load.magnitude;
    }
    let vectors = forces
        .into_iter()
        .map(|(node, force)| (model.mesh.coordinates[node], force));
    vectors.collect()
}

/// Pressures and tractions at the middles of their faces.
fn face_loads(step: &Step, model: &Model) -> Vec<Vector> {
    let x = &model.mesh.coordinates;
    let middle = |face: &Face| {
        let [a, b] = face.ends(&model.mesh).map(|node| x[node]);
        let normal = project(a, a, b).normal;
        ([0, 1].map(|i| a[i] / 2.0 + b[i] / 2.0), normal)
    };
    let pressures = step.pressures.iter().map(|load| {
        let (at, normal) = middle(&load.at.face);
        (at, normal.map(|n| -load.magnitude * n))
    });
    let tractions = step.tractions.iter().map(|load| {
        let (at, _) = middle(&load.at.face);
        (at, load.at.direction.map(|n| load.magnitude * n))
    });
    pressures
        .chain(tractions)
        .filter(|(_, v)| *v != [0.0; 2])
        .collect()
}

/// Arrows of one length that end on the faces, or begin there where they pull.
fn onto_faces(loads: &[Vector], canvas: &mut Canvas, legend: &mut Legend) {
    let mut spacing = Spacing::new(APART);
    for (place, load) in loads {
        let at = canvas.at(*place);
        let size = load[0].hypot(load[1]);
        if canvas.shows(*place) && spacing.takes(at) {
            let way = [load[0] / size, -load[1] / size].map(|e| 0.5 * ARROW * e);
            canvas.arrow([at[0] - way[0], at[1] - way[1]], way, LOAD);
        }
        legend.add(Symbol::Arrow(LOAD), "pressure or traction");
    }
}

/// One arrow in the middle of every body for each direction of its body forces.
fn body_forces(model: &Model) -> Vec<Vector> {
    let bodies = Bodies::new(&model.mesh);
    let middles = middles(&bodies, model);
    let mut vectors: Vec<Vector> = Vec::new();
    for load in model.steps.iter().flat_map(|step| &step.body_forces) {
        let direction = load.at.direction.map(|e| e * load.magnitude.signum());
        let vector = (middles[bodies.of_element[load.at.element]], direction);
        if load.magnitude != 0.0 && vectors.last() != Some(&vector) && !vectors.contains(&vector) {
            vectors.push(vector);
        }
    }
    vectors
}

/// Mean place of the nodes of every body.
fn middles(bodies: &Bodies, model: &Model) -> Vec<[f64; 2]> {
    let mut counts = vec![0.0_f64; bodies.count];
    for body in bodies.of_node.iter().flatten() {
        counts[*body] += 1.0;
    }
    let mut middles = vec![[0.0; 2]; bodies.count];
    for (body, x) in bodies.of_node.iter().zip(&model.mesh.coordinates) {
        if let Some(body) = *body {
            for i in 0..2 {
                middles[body][i] += x[i] / counts[body];
            }
        }
    }
    middles
}

/// One arrow for a body that moves without turning, else arrows at its nodes.
fn velocities(model: &Model) -> Vec<Vector> {
    let bodies = Bodies::new(&model.mesh);
    let middles = middles(&bodies, model);
    let of_node = |node: usize| [0, 1].map(|i| model.initial_velocity[2 * node + i]);
    let mut first: Vec<Option<[f64; 2]>> = vec![None; bodies.count];
    let mut is_uniform = vec![true; bodies.count];
    let nodes = || {
        bodies
            .of_node
            .iter()
            .enumerate()
            .filter_map(|(n, body)| Some((n, (*body)?)))
    };
    for (node, body) in nodes() {
        let velocity = of_node(node);
        is_uniform[body] &= *first[body].get_or_insert(velocity) == velocity;
    }
    let uniform = middles.into_iter().zip(&first).zip(&is_uniform);
    let uniform = uniform.filter(|(_, is_uniform)| **is_uniform);
    let mut vectors: Vec<Vector> = uniform.filter_map(|((x, v), _)| Some((x, (*v)?))).collect();
    for (node, _) in nodes().filter(|(_, body)| !is_uniform[*body]) {
        vectors.push((model.mesh.coordinates[node], of_node(node)));
    }
    vectors.retain(|(_, v)| *v != [0.0; 2]);
    vectors
}

/// Arrows at their places, the largest of full length and none below a third of it.
fn arrows(vectors: &[Vector], pen: Pen, canvas: &mut Canvas, legend: &mut Legend, text: &str) {
    let size = |v: &[f64; 2]| v[0].hypot(v[1]);
    let largest = vectors.iter().map(|(_, v)| size(v)).fold(0.0, f64::max);
    let mut spacing = Spacing::new(APART);
    for (place, vector) in vectors {
        let at = canvas.at(*place);
        let is_drawn = size(vector) > 0.0 && largest.is_finite() && canvas.shows(*place);
        if !(is_drawn && spacing.takes(at)) {
            continue;
        }
        let length = ARROW * (size(vector) / largest).max(0.35);
        let [ex, ey] = [vector[0], -vector[1]].map(|e| e / size(vector));
        // body forces stand beside velocities
        let beside = if pen.1 == GRAVITY.1 { 2.0 * pen.1 } else { 0.0 };
        let from = [at[0] + beside * ey, at[1] - beside * ex];
        canvas.arrow(from, [length * ex, length * ey], pen);
        legend.add(Symbol::Arrow(pen), text);
    }
}
