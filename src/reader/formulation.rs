//! What contacts keep out: nodes, or means over faces. General contact chooses where the deck does not say.
//! docs/numerics.md, Faces that lie on each other.

use std::collections::HashSet;

use super::context::Context;
use crate::diagnostics::Code;
use crate::model::{Contact, ContactFormulation, Mesh, Model, Surface, SurfaceKind};
use crate::vectors::{Circle, CircleTree, cross, difference, dot, length};

/// Faces that lie on other bodies from which on general contact is from surface to surface: with fewer, conditions of
/// nodes on both sides, which depend on each other there, cost at most twice as much.
const MANY_LYING: usize = 50;

/// Distance of faces that lie on each other, in the length of the longer one.
const LYING_GAP: f64 = 0.1;

/// Sine of the angle between faces that lie on each other.
const LYING_SINE: f64 = 0.01;

/// Part of the shorter of two faces that must lie on the other.
const LYING_PART: f64 = 0.1;

/// Gives general contact its formulation where the deck does not: from surface to surface where many faces lie on other
/// bodies.
pub(super) fn choose(model: &mut Model) {
    let is_open = |contact: &Contact| contact.lying_faces.is_some();
    let Some(number) = model.contacts.iter().position(is_open) else {
        return;
    };
    let contact = &model.contacts[number];
    // a fit presses nodes on to segments
    let may_choose =
        !contact.is_interference_fit && not_from_surface_to_surface(contact, model).is_none();
    let faces = model.surfaces[contact.slave].segments(&model.mesh);
    let count = may_choose.then(|| lying_faces([&faces, &faces], &model.mesh));
    let contact = &mut model.contacts[number];
    contact.lying_faces = count;
    if count >= Some(MANY_LYING) {
        contact.formulation = ContactFormulation::SurfaceToSurface;
    }
}

/// Advises against both orders of pairs of nodes and segments where many faces lie on each other.
pub(super) fn report_both_orders(model: &Model, cx: &mut Context) {
    let of_nodes = |contact: &&Contact| contact.formulation == ContactFormulation::NodeToSegment;
    let pairs: Vec<&Contact> = model.contacts.iter().filter(of_nodes).collect();
    let sides: HashSet<_> = pairs.iter().map(|c| (c.slave, c.master)).collect();
    let in_both = |c: &&&Contact| c.slave != c.master && sides.contains(&(c.master, c.slave));
    let both: Vec<&Contact> = pairs.iter().filter(in_both).copied().collect();
    let count = |contact: &&Contact| {
        let of = |surface: usize| model.surfaces[surface].segments(&model.mesh);
        lying_faces([&of(contact.slave), &of(contact.master)], &model.mesh)
    };
    let Some(second) = both.iter().map(|contact| contact.span).nth(1) else {
        return;
    };
    let lying: usize = both.iter().map(count).sum();
    if lying >= MANY_LYING {
        let message =
            format!("pairs stand in both orders, and {lying} of their faces lie on each other");
        cx.d.note(Code::BothOrders, second, message).help(
            "the conditions of both sides depend on each other, which takes long: keep one order of each pair, with \
             TYPE=SURFACE TO SURFACE, or use *CONTACT",
        );
    }
}

/// Number of the faces that lie on one of the others, of another body.
fn lying_faces([faces, others]: [&[[usize; 2]]; 2], mesh: &Mesh) -> usize {
    let x = &mesh.coordinates;
    let bodies = mesh.bodies();
    let ends = |face: [usize; 2]| face.map(|node| x[node]);
    let circle = |face: &[usize; 2]| {
        let [a, b] = ends(*face);
        Circle {
            centre: [0, 1].map(|k| f64::midpoint(a[k], b[k])),
            radius: (0.5 + LYING_GAP) * length(difference(a, b)),
        }
    };
    let [tree, of_others] = [faces, others].map(|faces| CircleTree::new(faces.iter().map(circle)));
    let mut near = Vec::new();
    tree.overlaps(&of_others, &mut near);
    let mut lies = vec![false; faces.len()];
    for [i, j] in near.into_iter().map(|pair| pair.map(|k| k as usize)) {
        let is_of_other = bodies[faces[i][0]] != bodies[others[j][0]];
        if is_of_other && !lies[i] && lie_on_each_other(ends(faces[i]), ends(others[j])) {
            lies[i] = true;
        }
    }
    lies.into_iter().filter(|lies| *lies).count()
}

/// Whether two faces run against each other on one line, and have a part of it in common.
fn lie_on_each_other([a, b]: [[f64; 2]; 2], [p, q]: [[f64; 2]; 2]) -> bool {
    let [e, f] = [difference(a, b), difference(p, q)];
    let [of_e, of_f] = [length(e), length(f)];
    if dot(e, f) >= 0.0 || cross(e, f).abs() > LYING_SINE * of_e * of_f {
        return false;
    }
    let [from, to] = [p, q].map(|s| difference(a, s));
    let is_near = |r: [f64; 2]| cross(e, r).abs() <= LYING_GAP * of_e * of_e.max(of_f);
    let [low, high] = [to, from].map(|r| dot(r, e) / of_e);
    let common = high.min(of_e) - low.max(0.0);
    is_near(from) && is_near(to) && common >= LYING_PART * of_e.min(of_f)
}

/// Takes node to surface where contact from surface to surface cannot be used, with a warning that says why.
pub(super) fn restrict(model: &mut Model, cx: &mut Context) {
    for number in 0..model.contacts.len() {
        let contact = &model.contacts[number];
        if contact.formulation == ContactFormulation::NodeToSegment {
            continue;
        }
        if let Some(why) = not_from_surface_to_surface(contact, model) {
            let message = "TYPE=SURFACE TO SURFACE is taken as NODE TO SURFACE";
            cx.d.warning_once(Code::IgnoredParameter, contact.span, message)
                .help(why);
            model.contacts[number].formulation = ContactFormulation::NodeToSegment;
        }
    }
}

/// Why a contact cannot be from surface to surface, if it cannot.
fn not_from_surface_to_surface(contact: &Contact, model: &Model) -> Option<&'static str> {
    let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i]);
    let is_of_faces = |surface: &Surface| matches!(surface.kind, SurfaceKind::Faces(_));
    let has_segments = |surface: &Surface| !matches!(surface.kind, SurfaceKind::Nodes(_));
    if !is_of_faces(slave) || !has_segments(master) {
        Some("the slave surface must be made of element faces")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_lie_on_each_other_where_they_are_close_and_turned_to_each_other() {
        let below = [[1.0, 0.0], [0.0, 0.0]];
        let lies = |above: [[f64; 2]; 2]| {
            let both = [
                lie_on_each_other(above, below),
                lie_on_each_other(below, above),
            ];
            assert_eq!(both[0], both[1], "{above:?}");
            both[0]
        };
        assert!(lies([[0.3, 0.0], [1.3, 0.0]]));
        assert!(lies([[0.3, 0.09], [1.3, 0.09]]), "a small gap");
        assert!(lies([[0.4, -0.001], [0.6, 0.0]]), "a shorter face");
        assert!(!lies([[1.3, 0.0], [0.3, 0.0]]), "the same side");
        assert!(!lies([[0.3, 0.11], [1.3, 0.11]]), "a large gap");
        assert!(!lies([[0.95, 0.0], [1.95, 0.0]]), "beside each other");
        assert!(!lies([[0.3, 0.0], [1.3, 0.02]]), "inclined");
    }
}
