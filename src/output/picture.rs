//! The model in one picture, as SVG: bodies by material, supports, motions, loads, velocities,
//! surfaces with their normals, contacts, and a legend.

use std::collections::{BTreeMap, HashSet};

use super::canvas::{Canvas, Pen, Pixels, Spacing, Symbol, Window};
use crate::contact::project;
use crate::model::{
    Bodies, Element, Face, Model, Rate, Support, SupportMotion, Surface, SurfaceKind,
};
use crate::vectors::{difference, extents};

/// Fills of the materials, in turn.
const FILLS: [&str; 6] = [
    "#cdd9e8", "#eddfc0", "#d3e6cc", "#ead0da", "#dbd3ec", "#cfe6e6",
];
const OUTLINE: Pen = Pen("#5b6675", 1.2);
const SIDES: Pen = Pen("#9aa6b5", 0.4);
const SLAVE: Pen = Pen("#1d5fd1", 2.2);
const MASTER: Pen = Pen("#d9660f", 2.2);
const BOTH: Pen = Pen("#8a3fb0", 2.2);
const OTHER: Pen = Pen("#0b8c8c", 1.4);
const RIGID: Pen = Pen("#333333", 3.2);
const SUPPORT: &str = "#222222";
const REFERENCE: Pen = Pen("#777777", 0.0);
const MOTION: Pen = Pen("#8a1fc9", 2.0);
const LOAD: Pen = Pen("#c81e1e", 1.6);
const GRAVITY: Pen = Pen("#c81e1e", 3.0);
const VELOCITY: Pen = Pen("#15803d", 2.4);

/// Mean size of elements (pixels) below which their sides are not drawn.
const SMALLEST: f64 = 5.0;
/// Length of a normal (pixels); the smallest and largest distance between two normals follow.
const NORMAL: f64 = 9.0;
const NORMALS_APART: f64 = 16.0;
const NORMALS_FAR: f64 = 80.0;
/// Length of the longest arrow (pixels); the distance between arrows follows.
const ARROW: f64 = 44.0;
const ARROWS_APART: f64 = 18.0;

/// A place of the model (length).
type Location = [f64; 2];
/// A line between two places.
type Stroke = [Location; 2];
/// An arrow at a place of the model along a vector of the model.
type Vector = (Location, [f64; 2]);

/// Draws a model as text of an SVG file: a part of the plane, or the deformable bodies and their surroundings.
pub fn picture(model: &Model, window: Option<Window>) -> String {
    let canvas = Canvas::new(window.unwrap_or_else(|| about_bodies(model)));
    let mut picture = Picture {
        model,
        x: &model.mesh.coordinates,
        canvas,
    };
    picture.bodies();
    picture.surfaces();
    picture.supports();
    picture.arrows(&point_loads(model), LOAD, "force");
    picture.face_loads();
    picture.arrows(&body_forces(model), GRAVITY, "body force");
    picture.arrows(&velocities(model), VELOCITY, "initial velocity");
    for (index, surface) in model.surfaces.iter().enumerate() {
        picture.surface_name(surface, role(index, model).0);
    }
    picture.canvas.text(&model.title)
}

/// The extents of the deformable bodies, and of rigid surfaces up to a distance from the bodies equal to the larger
/// side of these, so that a long floor does not make the bodies small.
fn about_bodies(model: &Model) -> Window {
    let x = &model.mesh.coordinates;
    let of_elements = (model.mesh.elements.iter()).flat_map(|element| &element.nodes);
    let bodies = extents(of_elements.map(|&node| x[node]));
    let all = extents(x.iter().copied());
    let side = |i: usize| bodies[1][i] / 2.0 - bodies[0][i] / 2.0;
    let beyond = 2.0 * f64::max(side(0), side(1));
    Window([
        [0, 1].map(|i| all[0][i].max(bodies[0][i] - beyond)),
        [0, 1].map(|i| all[1][i].min(bodies[1][i] + beyond)),
    ])
}

/// A picture being drawn.
struct Picture<'m> {
    model: &'m Model,
    /// Reference coordinates of the nodes.
    x: &'m [Location],
    canvas: Canvas,
}

impl Picture<'_> {
    /// Draws the filled outline of all elements of a material, and the sides of the elements.
    fn bodies(&mut self) {
        let (model, x) = (self.model, self.x);
        for (index, material) in model.materials.iter().enumerate() {
            let is_of = |element: &&Element| model.sections[element.section].material == index;
            let elements: Vec<&Element> = model.mesh.elements.iter().filter(is_of).collect();
            if elements.is_empty() {
                continue;
            }
            let colour = FILLS[index % FILLS.len()];
            let (outline, inside) = sides(&elements);
            let places = |nodes: &Vec<usize>| nodes.iter().map(|&node| x[node]).collect();
            let loops: Vec<Vec<Location>> = loops(outline).iter().map(places).collect();
            self.canvas.fill(&loops, colour, OUTLINE);
            let inside: Vec<Stroke> = inside.iter().map(|side| side.map(|n| x[n])).collect();
            let length = |[a, b]: &Stroke| self.canvas.pixels((b[0] - a[0]).hypot(b[1] - a[1]));
            if inside.iter().map(length).sum::<f64>() > SMALLEST * inside.len() as f64 {
                self.canvas.lines(&inside, SIDES);
            }
            let text = format!("material {}", material.name);
            self.canvas.explain(Symbol::Fill(colour), &text);
        }
    }

    /// Draws surfaces with their outward normals, as slaves, masters or neither; the legend lists the contacts.
    fn surfaces(&mut self) {
        for (index, surface) in self.model.surfaces.iter().enumerate() {
            if let SurfaceKind::Rigid(_) = surface.kind {
                self.segments(surface, RIGID);
                self.canvas.explain(Symbol::Line(RIGID), "rigid surface");
            }
            let (pen, text, is_slave) = role(index, self.model);
            self.segments(surface, pen);
            let symbol = if is_slave {
                Symbol::Dotted
            } else {
                Symbol::Line
            };
            self.canvas.explain(symbol(pen), text);
            if is_slave || matches!(surface.kind, SurfaceKind::Nodes(_)) {
                let mut spacing = Spacing::new(6.0);
                for node in surface.nodes(&self.model.mesh) {
                    if let Some(at) = self.canvas.room(self.x[node], &mut spacing) {
                        self.canvas.dot(at, 2.2, pen.0);
                    }
                }
            }
        }
        for contact in &self.model.contacts {
            let surfaces = [contact.slave, contact.master];
            let [slave, master] = surfaces.map(|s| &self.model.surfaces[s].name);
            let sides = match contact.is_self_contact() {
                true => format!("{slave} with itself"),
                false => format!("{slave} on {master}"),
            };
            let text = format!("contact {sides}, {}", contact.interaction.friction);
            self.canvas.explain(Symbol::None, &text);
        }
    }

    /// The segments of a surface.
    fn lines_of(&self, surface: &Surface) -> Vec<Stroke> {
        let segments = surface.segments(&self.model.mesh).into_iter();
        segments.map(|s| s.map(|node| self.x[node])).collect()
    }

    /// Draws lines along the segments, and normals that point out of the body.
    fn segments(&mut self, surface: &Surface, pen: Pen) {
        let lines = self.lines_of(surface);
        self.canvas.lines(&lines, pen);
        let mut spacing = Spacing::new(NORMALS_APART);
        let mut normals = String::new();
        for [a, b] in lines.into_iter().filter_map(|line| self.canvas.part(line)) {
            let along = project(a, a, b);
            let count = (self.canvas.pixels(along.length) / NORMALS_FAR)
                .ceil()
                .max(1.0);
            for k in 0..count as usize {
                let part = (k as f64 + 0.5) / count;
                let [px, py] = self.canvas.at([0, 1].map(|i| a[i] + part * (b[i] - a[i])));
                if along.normal.iter().all(|n| n.is_finite()) && spacing.takes([px, py]) {
                    let [dx, dy] = [NORMAL * along.normal[0], -NORMAL * along.normal[1]];
                    normals.push_str(&format!("M{px:.1} {py:.1}l{dx:.1} {dy:.1}"));
                }
            }
        }
        self.canvas.stroke(&normals, Pen(pen.0, 1.0));
    }

    /// Writes the name of a surface beside the middle of its visible part, on the side of its normal.
    fn surface_name(&mut self, surface: &Surface, pen: Pen) {
        let lines = self.lines_of(surface).into_iter();
        let parts: Vec<Stroke> = lines.filter_map(|line| self.canvas.part(line)).collect();
        let (place, normal) = match parts.get(parts.len() / 2) {
            Some(&[a, b]) => (middle([a, b]), project(a, a, b).normal),
            None => {
                let nodes = surface.nodes(&self.model.mesh).into_iter();
                let mut places = nodes.map(|node| self.x[node]);
                match places.find(|&place| self.canvas.shows(place)) {
                    Some(place) => (place, [0.0, 1.0]),
                    None => return,
                }
            }
        };
        let [px, py] = self.canvas.at(place);
        let at = [px + 18.0 * normal[0], py - 18.0 * normal[1] + 4.0];
        let anchor = match normal[0] {
            n if n > 0.5 => "start",
            n if n < -0.5 => "end",
            _ => "middle",
        };
        self.canvas.label(at, anchor, pen.0, &surface.name);
    }

    /// Draws reference nodes of rigid surfaces, and prescribed directions of nodes with their displacements.
    fn supports(&mut self) {
        for body in &self.model.rigid_bodies {
            let place = self.x[body.reference];
            if self.canvas.shows(place) {
                let [x, y] = self.canvas.at(place);
                self.canvas.dot([x, y], 5.0, REFERENCE.0);
                let name = &body.name;
                self.canvas
                    .label([x + 9.0, y + 16.0], "start", REFERENCE.0, name);
            }
            let text = "reference node of a rigid body";
            self.canvas.explain(Symbol::Dotted(REFERENCE), text);
        }
        let mut held: BTreeMap<usize, [Option<f64>; 2]> = BTreeMap::new();
        let supports = self.model.steps.iter().flat_map(|step| &step.supports);
        for support in supports.filter(|support| support.dof / 2 < self.x.len()) {
            let largest = &mut held.entry(support.dof / 2).or_default()[support.dof % 2];
            let (direction, before) = (direction(support, self.model), largest.unwrap_or(0.0));
            *largest = Some(if direction.abs() > before.abs() {
                direction
            } else {
                before
            });
        }
        // the nodes of rigid surfaces do as their reference nodes
        let rigid: HashSet<usize> = self.model.rigid_segments().into_iter().flatten().collect();
        let (mut spacing, mut moving) = (Spacing::new(8.0), Vec::new());
        for (node, directions) in held.into_iter().filter(|(node, _)| !rigid.contains(node)) {
            let direction = directions.map(|direction| direction.unwrap_or(0.0));
            if direction != [0.0; 2] {
                moving.push((self.x[node], direction));
            } else if let Some(at) = self.canvas.room(self.x[node], &mut spacing) {
                self.support(at, directions.map(|direction| direction.is_some()));
            }
        }
        self.arrows(&moving, MOTION, "prescribed motion");
    }

    fn support(&mut self, at: Pixels, is_held: [bool; 2]) {
        if is_held == [true; 2] {
            self.canvas.fixed(at, SUPPORT);
            self.canvas
                .explain(Symbol::Fixed(SUPPORT), "fixed in x and y");
        } else {
            self.canvas.guided(at, usize::from(is_held[1]), SUPPORT);
            let text = "fixed in x (left) or y (below)";
            self.canvas.explain(Symbol::Guided(SUPPORT), text);
        }
    }

    /// Draws pressures and tractions as arrows of the same length, which end at the middles of their faces, or begin
    /// there if they pull.
    fn face_loads(&mut self) {
        let mut loads: Vec<Vector> = Vec::new();
        for step in &self.model.steps {
            let line = |face: &Face| face.ends(&self.model.mesh).map(|node| self.x[node]);
            loads.extend(step.pressures.iter().map(|load| {
                let [a, b] = line(&load.at.face);
                let force = load.at.force(project(a, a, b).normal);
                (middle([a, b]), force.map(|f| load.magnitude * f))
            }));
            loads.extend(step.tractions.iter().map(|load| {
                let force = load.at.direction.map(|n| load.magnitude * n);
                (middle(line(&load.at.face)), force)
            }));
        }
        let mut spacing = Spacing::new(ARROWS_APART);
        for (place, load) in loads.into_iter().filter(|(_, load)| *load != [0.0; 2]) {
            if let Some(at) = self.canvas.room(place, &mut spacing) {
                let size = load[0].hypot(load[1]);
                let direction = [load[0] / size, -load[1] / size].map(|e| 0.5 * ARROW * e);
                self.canvas.arrow(
                    [at[0] - direction[0], at[1] - direction[1]],
                    direction,
                    LOAD,
                );
            }
            self.canvas
                .explain(Symbol::Arrow(LOAD), "pressure or traction");
        }
    }

    /// Draws arrows at their places; the largest has full length, and no arrow is shorter than a third of it.
    fn arrows(&mut self, vectors: &[Vector], pen: Pen, text: &str) {
        let size = |v: &[f64; 2]| v[0].hypot(v[1]);
        let largest = vectors.iter().map(|(_, v)| size(v)).fold(0.0, f64::max);
        let mut spacing = Spacing::new(ARROWS_APART);
        let drawn = |(_, v): &&Vector| size(v) > 0.0 && largest.is_finite();
        for (place, vector) in vectors.iter().filter(drawn) {
            let Some(at) = self.canvas.room(*place, &mut spacing) else {
                continue;
            };
            let length = ARROW * (size(vector) / largest).max(0.35);
            let [ex, ey] = [vector[0], -vector[1]].map(|e| e / size(vector));
            // body forces stand beside velocities
            let beside = if pen.1 == GRAVITY.1 { 2.0 * pen.1 } else { 0.0 };
            let from = [at[0] + beside * ey, at[1] - beside * ex];
            self.canvas.arrow(from, [length * ex, length * ey], pen);
            self.canvas.explain(Symbol::Arrow(pen), text);
        }
    }
}

/// The middle of a line.
fn middle([a, b]: Stroke) -> Location {
    [0, 1].map(|i| a[i] / 2.0 + b[i] / 2.0)
}

/// Sides without an element of the group on their right, and all other sides, without duplicates.
fn sides(elements: &[&Element]) -> (Vec<[usize; 2]>, Vec<[usize; 2]>) {
    let in_order = || elements.iter().flat_map(|element| element.segments());
    let all: HashSet<[usize; 2]> = in_order().collect();
    let (inside, outline): (Vec<_>, Vec<_>) = in_order().partition(|&[a, b]| all.contains(&[b, a]));
    (outline, inside.into_iter().filter(|[a, b]| a < b).collect())
}

/// The closed loops along sides.
fn loops(sides: Vec<[usize; 2]>) -> Vec<Vec<usize>> {
    let mut ends: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for [a, b] in sides {
        ends.entry(a).or_default().push(b);
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = ends.first_key_value() {
        let (mut nodes, mut node) = (Vec::new(), start);
        while let Some(next) = ends.get_mut(&node).and_then(Vec::pop) {
            if ends[&node].is_empty() {
                ends.remove(&node);
            }
            nodes.push(node);
            node = next;
        }
        loops.push(nodes);
    }
    loops
}

/// Pen and name for the role of a surface in the contacts, and whether it is a slave.
fn role(index: usize, model: &Model) -> (Pen, &'static str, bool) {
    let is_slave = model.contacts.iter().any(|contact| contact.slave == index);
    let is_master = model.contacts.iter().any(|contact| contact.master == index);
    let (pen, text) = match (is_slave, is_master) {
        (true, true) => (BOTH, "slave and master surface"),
        (true, false) => (SLAVE, "slave surface and nodes"),
        (false, true) => (MASTER, "master surface"),
        (false, false) => (OTHER, "surface without contact"),
    };
    (pen, text, is_slave)
}

/// Displacement of a support in the first step; if it follows an amplitude, the largest value at the points of the
/// amplitude.
fn direction(support: &Support, model: &Model) -> f64 {
    match support.motion {
        SupportMotion::Ramp { to } => to,
        SupportMotion::Amplitude { value, amplitude } => {
            let ends = model.steps.iter().map(|step| step.increments.period);
            let mut values = ends.map(|t| model.amplitudes[amplitude].at(t));
            value * values.find(|a| *a != 0.0).unwrap_or(1.0).signum()
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

/// Draws the forces of all steps, by node.
fn point_loads(model: &Model) -> Vec<Vector> {
    let mut forces: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    let loads = model.steps.iter().flat_map(|step| &step.point_loads);
    for load in loads.filter(|load| load.at.dof < model.mesh.dof_count()) {
        forces.entry(load.at.dof / 2).or_default()[load.at.dof % 2] = load.magnitude;
    }
    let x = &model.mesh.coordinates;
    let forces = forces.into_iter();
    forces.map(|(node, force)| (x[node], force)).collect()
}

/// Draws an arrow in the middle of every body for each direction of its body forces.
fn body_forces(model: &Model) -> Vec<Vector> {
    let bodies = Bodies::new(&model.mesh);
    let middles = middles(&nodes_of(&bodies), model);
    let mut vectors: Vec<Vector> = Vec::new();
    for load in model.steps.iter().flat_map(|step| &step.body_forces) {
        let direction = load.at.direction.map(|e| e * load.magnitude.signum());
        let vector = (middles[bodies.of_element[load.at.element]], direction);
        if load.magnitude != 0.0 && vectors.last() != Some(&vector) && !vectors.contains(&vector) {
            vectors.push(vector);
        }
    }
    for load in model.steps.iter().flat_map(|step| &step.centrifugal_forces) {
        let of_body = middles[bodies.of_element[load.at.element]];
        // the middle of a section of a body of revolution is beside its axis
        let arm = match model.mesh.is_axisymmetric() {
            true => [of_body[0], 0.0],
            false => difference(load.at.axis, of_body),
        };
        let size = arm[0].hypot(arm[1]);
        let vector = (of_body, arm.map(|arm| arm / size));
        if load.magnitude != 0.0 && size > 0.0 && !vectors.contains(&vector) {
            vectors.push(vector);
        }
    }
    vectors
}

/// Draws initial velocities: one arrow for a body that moves without turning, else arrows at its nodes.
fn velocities(model: &Model) -> Vec<Vector> {
    let nodes = nodes_of(&Bodies::new(&model.mesh));
    let of_node = |node: usize| [0, 1].map(|i| model.initial_velocity[2 * node + i]);
    let mut vectors: Vec<Vector> = Vec::new();
    for (nodes, middle) in nodes.iter().zip(middles(&nodes, model)) {
        let own = nodes
            .iter()
            .map(|&node| (model.mesh.coordinates[node], of_node(node)));
        let is_uniform = nodes.windows(2).all(|n| of_node(n[0]) == of_node(n[1]));
        match nodes.first() {
            Some(&first) if is_uniform => vectors.push((middle, of_node(first))),
            _ => vectors.extend(own),
        }
    }
    vectors.retain(|(_, v)| *v != [0.0; 2]);
    vectors
}

/// Nodes of every body.
fn nodes_of(bodies: &Bodies) -> Vec<Vec<usize>> {
    let mut nodes = vec![Vec::new(); bodies.count];
    for (node, body) in bodies.of_node.iter().enumerate() {
        if let Some(body) = *body {
            nodes[body].push(node);
        }
    }
    nodes
}

/// Mean position of the nodes of every body.
fn middles(nodes: &[Vec<usize>], model: &Model) -> Vec<Location> {
    let mean = |nodes: &Vec<usize>, i: usize| {
        let x = nodes.iter().map(|&node| model.mesh.coordinates[node][i]);
        x.map(|x| x / nodes.len() as f64).sum()
    };
    nodes
        .iter()
        .map(|nodes| [0, 1].map(|i| mean(nodes, i)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_are_closed_and_holes_are_loops_of_their_own() {
        let ring = |nodes: &[usize]| -> Vec<[usize; 2]> {
            let next = nodes.iter().cycle().skip(1);
            nodes.iter().zip(next).map(|(&a, &b)| [a, b]).collect()
        };
        let sides = [ring(&[0, 1, 2, 3]), ring(&[7, 6, 5, 4])].concat();
        assert_eq!(loops(sides), [vec![0, 1, 2, 3], vec![4, 7, 6, 5]]);
    }
}
