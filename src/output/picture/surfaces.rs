//! Surfaces with their outward normals, as slaves, masters or neither; the contacts in the legend.

use super::canvas::{Canvas, Pen, Spacing};
use super::legend::{Legend, Symbol};
use crate::contact::project;
use crate::model::{Model, Surface, SurfaceKind};

const SLAVE: Pen = Pen("#1d5fd1", 2.2);
const MASTER: Pen = Pen("#d9660f", 2.2);
const BOTH: Pen = Pen("#8a3fb0", 2.2);
const OTHER: Pen = Pen("#0b8c8c", 1.4);
const RIGID: Pen = Pen("#333333", 3.2);

/// Length of a normal, smallest and largest distance between two, in pixels.
const NORMAL: f64 = 9.0;
const APART: f64 = 16.0;
const FAR: f64 = 80.0;

/// Draws the surfaces; the contacts go to the legend.
pub(super) fn draw(model: &Model, canvas: &mut Canvas, legend: &mut Legend) {
    for (index, surface) in model.surfaces.iter().enumerate() {
        if let SurfaceKind::Rigid(_) = surface.kind {
            segments(surface, model, RIGID, canvas);
            legend.add(Symbol::Line(RIGID), "rigid surface");
        }
        let (pen, role, is_slave) = role(index, model);
        segments(surface, model, pen, canvas);
        legend.add(
            if is_slave {
                Symbol::Dotted(pen)
            } else {
                Symbol::Line(pen)
            },
            role,
        );
        if is_slave || matches!(surface.kind, SurfaceKind::Nodes(_)) {
            nodes(surface, model, pen, canvas);
        }
    }
    contacts(model, legend);
}

/// Writes the names of the surfaces, above everything else.
pub(super) fn names(model: &Model, canvas: &mut Canvas) {
    for (index, surface) in model.surfaces.iter().enumerate() {
        name(surface, model, role(index, model).0, canvas);
    }
}

/// Line and name of what a surface is in the contacts, and whether it is a slave.
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

/// Lines along the segments, and normals out of the body.
fn segments(surface: &Surface, model: &Model, pen: Pen, canvas: &mut Canvas) {
    let x = &model.mesh.coordinates;
    let segments = surface.segments(&model.mesh);
    let lines: Vec<[[f64; 2]; 2]> = segments.iter().map(|s| s.map(|n| x[n])).collect();
    canvas.lines(&lines, pen);
    let mut spacing = Spacing::new(APART);
    let mut normals = String::new();
    for [a, b] in lines.into_iter().filter_map(|line| canvas.part(line)) {
        let along = project(a, a, b);
        let count = (canvas.pixels(along.length) / FAR).ceil().max(1.0);
        for k in 0..count as usize {
            let part = (k as f64 + 0.5) / count;
            let [px, py] = canvas.at([0, 1].map(|i| a[i] + part * (b[i] - a[i])));
            if along.normal.iter().all(|n| n.is_finite()) && spacing.takes([px, py]) {
                let [dx, dy] = [NORMAL * along.normal[0], -NORMAL * along.normal[1]];
                normals.push_str(&format!("M{px:.1} {py:.1}l{dx:.1} {dy:.1}"));
            }
        }
    }
    canvas.stroke(&normals, Pen(pen.0, 1.0));
}

fn nodes(surface: &Surface, model: &Model, pen: Pen, canvas: &mut Canvas) {
    let mut spacing = Spacing::new(6.0);
    for node in surface.nodes(&model.mesh) {
        let place = model.mesh.coordinates[node];
        let at = canvas.at(place);
        if canvas.shows(place) && spacing.takes(at) {
            canvas.dot(at, 2.2, pen.0);
        }
    }
}

/// The name of a surface beside the middle of what is shown of it, on the side of its normal.
fn name(surface: &Surface, model: &Model, pen: Pen, canvas: &mut Canvas) {
    let x = &model.mesh.coordinates;
    let lines = surface
        .segments(&model.mesh)
        .into_iter()
        .map(|s| s.map(|node| x[node]));
    let parts: Vec<[[f64; 2]; 2]> = lines.filter_map(|line| canvas.part(line)).collect();
    let (place, normal) = match parts.get(parts.len() / 2) {
        Some(&[a, b]) => {
            let middle = [0, 1].map(|i| a[i] / 2.0 + b[i] / 2.0);
            (middle, project(a, a, b).normal)
        }
        None => {
            let mut places = surface.nodes(&model.mesh).into_iter().map(|node| x[node]);
            match places.find(|&place| canvas.shows(place)) {
                Some(place) => (place, [0.0, 1.0]),
                None => return,
            }
        }
    };
    let [px, py] = canvas.at(place);
    let at = [px + 18.0 * normal[0], py - 18.0 * normal[1] + 4.0];
    let anchor = match normal[0] {
        n if n > 0.5 => "start",
        n if n < -0.5 => "end",
        _ => "middle",
    };
    canvas.label(at, anchor, pen.0, &surface.name);
}

fn contacts(model: &Model, legend: &mut Legend) {
    for contact in &model.contacts {
        let [slave, master] = [contact.slave, contact.master].map(|s| &model.surfaces[s].name);
        let sides = match contact.is_self_contact() {
            true => format!("{slave} with itself"),
            false => format!("{slave} on {master}"),
        };
        let friction = contact.interaction.friction;
        legend.add(Symbol::None, &format!("contact {sides}, {friction}"));
    }
}
