//! Formulation of contacts, node to surface or surface to surface, which the reader chooses if the deck leaves the
//! formulation open. See docs/numerics.md, Faces that lie on each other.

use std::cell::LazyCell;
use std::collections::{HashMap, HashSet};

use super::checks::prescribed_throughout;
use super::context::Context;
use crate::diagnostics::Code;
use crate::model::{
    Contact, ContactChanges, ContactFormulation, FrictionChange, Mesh, Model, Step, Surface,
    SurfaceKind,
};
use crate::vectors::{Circle, CircleTree, cross, difference, distance, dot, length};

/// Number of faces lying on each other from which on the reader advises against contact pairs in both orders: such a
/// run takes at least 1.3 times as long as a run with one order.
const MANY_LYING: usize = 50;

/// Largest distance of two faces that lie on each other, relative to the longer face.
const LYING_GAP: f64 = 0.1;

/// Sine of the largest angle between two faces that lie on each other.
const LYING_SINE: f64 = 0.01;

/// Part of the shorter of two faces that must lie on the other face.
const LYING_PART: f64 = 0.1;

/// Ratio of the segment lengths of two surfaces below which the first surface counts as the finer surface.
const FINER: f64 = 0.99;

/// Chooses the formulation of a contact if the deck leaves the formulation open and nodes of both sides are slaves.
/// Contacts with faces that lie on other bodies are surface to surface, because the conditions of single nodes depend
/// on each other where faces lie on each other. Then two pairs of the same surfaces, one in each order, become one
/// pair; so do two pairs that the deck makes surface to surface.
pub(super) fn choose(model: &mut Model, cx: &mut Context) {
    warn_of_two_laws(model, cx);
    choose_for_general(model);
    let both = both_orders(model);
    let of_nodes = |pair: &&BothOrders| pair.formulation == ContactFormulation::NodeToSegment;
    let pairs = (model.contacts.iter_mut()).filter(|contact| !contact.is_self_contact());
    pairs.for_each(|contact| contact.lying_faces = None);
    let (of_one, of_two): (Vec<_>, Vec<_>) =
        (both.iter()).partition(|pair| pair.becomes_one && (!of_nodes(pair) || pair.lying > 0));
    report_both_orders(model, (&of_one, &of_two), cx);
    let mut left_out = HashSet::new();
    for pair in of_one {
        let [kept, other] = pair.contacts;
        let contact = &mut model.contacts[kept];
        contact.lying_faces = of_nodes(&pair).then_some(pair.lying);
        contact.formulation = ContactFormulation::SurfaceToSurface;
        left_out.insert(other);
    }
    if !left_out.is_empty() {
        leave_out(&left_out, model);
    }
}

/// Removes contacts that other contacts replace from a model and from the changes of its steps.
fn leave_out(left_out: &HashSet<usize>, model: &mut Model) {
    let all = std::mem::take(&mut model.contacts).into_iter().enumerate();
    let (numbers, stay): (Vec<usize>, Vec<Contact>) =
        all.filter(|(number, _)| !left_out.contains(number)).unzip();
    model.contacts = stay;
    let place = |number: usize| numbers.binary_search(&number).ok();
    for step in &mut model.steps {
        let ContactChanges { removed, friction } = &mut step.contacts;
        *removed = removed.iter().filter_map(|&number| place(number)).collect();
        friction.retain_mut(|change| {
            let place = place(change.contact);
            place.inspect(|&place| change.contact = place).is_some()
        });
        // those of contacts that have become one have no interference
        step.interferences.retain_mut(|load| {
            let place = place(load.at.contact);
            place.inspect(|&place| load.at.contact = place).is_some()
        });
    }
}

/// Whether all steps change two contacts in the same way.
fn are_changed_alike(pair: [usize; 2], steps: &[Step]) -> bool {
    steps.iter().all(|step| {
        let [one, other] = pair.map(|number| {
            let of_contact = |change: &&FrictionChange| change.contact == number;
            let friction = step.contacts.friction.iter().find(of_contact);
            let is_removed = step.contacts.removed.contains(&number);
            (
                is_removed,
                friction.map(|change| (&change.friction, &change.from)),
            )
        });
        let mut interferences = step.interferences.iter();
        one == other && !interferences.any(|load| pair.contains(&load.at.contact))
    })
}

/// Warns about pairs in both orders whose friction differs: the forces of both pairs add up, each by its own law.
fn warn_of_two_laws(model: &Model, cx: &mut Context) {
    for (number, contact) in model.contacts.iter().enumerate() {
        let mut before = model.contacts[..number].iter();
        let is_other = |other: &&Contact| {
            [other.slave, other.master] == [contact.master, contact.slave]
                && other.interaction.friction != contact.interaction.friction
        };
        if let Some(other) = before.find(is_other) {
            let message = "both orders of this pair have different friction: the nodes of either side have that of their \
                           own pair";
            cx.warning(Code::BothOrders, contact.span, message)
                .other("the other order", other.span)
                .help("give both orders one *SURFACE INTERACTION, or keep one order");
        }
    }
}

/// Makes general contact surface to surface if faces lie on other bodies and the deck leaves the formulation open.
fn choose_for_general(model: &mut Model) {
    let is_open = |contact: &Contact| contact.is_self_contact() && contact.lying_faces.is_some();
    let Some(number) = model.contacts.iter().position(is_open) else {
        return;
    };
    let contact = &model.contacts[number];
    // a fit presses nodes on to segments
    let may_choose =
        !contact.is_interference_fit && not_from_surface_to_surface(contact, model).is_none();
    let faces = model.surfaces[contact.slave].segments(&model.mesh);
    let bodies = model.mesh.bodies();
    let place = Place {
        mesh: &model.mesh,
        bodies: &bodies,
        held: &held_nodes(model),
    };
    let count = may_choose.then(|| lying_faces([&faces, &faces], &place));
    let contact = &mut model.contacts[number];
    contact.lying_faces = count;
    if count > Some(0) {
        contact.formulation = ContactFormulation::SurfaceToSurface;
    }
}

/// Two contact pairs of the same surfaces, one in each order.
struct BothOrders {
    /// Numbers of the two contacts: first the contact whose slave is the finer surface (or that stands first), then the
    /// other contact.
    contacts: [usize; 2],
    /// Formulation of both contacts.
    formulation: ContactFormulation,
    /// Number of faces of either surface that lie on the other surface.
    lying: usize,
    /// Whether one contact from surface to surface may replace both contacts.
    becomes_one: bool,
}

/// The contact pairs in both orders, with either formulation, in the order of the second pair.
fn both_orders(model: &Model) -> Vec<BothOrders> {
    let mut first = HashMap::new();
    let mut both = Vec::new();
    let bodies = LazyCell::new(|| model.mesh.bodies());
    let held = LazyCell::new(|| held_nodes(model));
    for (number, contact) in model.contacts.iter().enumerate() {
        if contact.is_self_contact() {
            continue;
        }
        let Some(&other) = first.get(&(contact.master, contact.slave)) else {
            first.insert((contact.slave, contact.master), number);
            continue;
        };
        let pair = [&model.contacts[other], contact];
        if pair[0].formulation != pair[1].formulation {
            continue;
        }
        let faces = pair.map(|contact| model.surfaces[contact.slave].segments(&model.mesh));
        let [p, q] = [&faces[0][..], &faces[1][..]];
        let mean = |faces: &[[usize; 2]]| {
            let x = &model.mesh.coordinates;
            let whole: f64 = faces.iter().map(|&[a, b]| distance(x[a], x[b])).sum();
            whole / faces.len() as f64
        };
        let contacts = match mean(q) < FINER * mean(p) {
            true => [number, other],
            false => [other, number],
        };
        let place = Place {
            mesh: &model.mesh,
            bodies: &bodies,
            held: &held,
        };
        let lying = |faces: [&[[usize; 2]]; 2]| lying_faces(faces, &place);
        both.push(BothOrders {
            contacts,
            formulation: contact.formulation,
            lying: lying([p, q]) + lying([q, p]),
            becomes_one: are_changed_alike(contacts, &model.steps) && may_be_one(pair, model),
        });
    }
    both
}

/// Whether one contact from surface to surface can replace two contacts of the same surfaces: both contacts have the
/// same law, no node is moved or left out, and the formulation is open or surface to surface.
fn may_be_one(pair: [&Contact; 2], model: &Model) -> bool {
    let laws = pair.map(|contact| &contact.interaction);
    let is_of_one_side = laws[0].wear.is_some() || laws[0].heat.is_some();
    let may = |contact: &Contact| {
        let is_open = contact.lying_faces.is_some()
            || contact.formulation == ContactFormulation::SurfaceToSurface;
        is_open
            && contact.adjust.is_none()
            && contact.left_out.is_empty()
            && not_from_surface_to_surface(contact, model).is_none()
    };
    laws[0] == laws[1] && !is_of_one_side && pair.into_iter().all(may)
}

/// Reports, as a note, that pairs in both orders have become one contact. Advises against pairs that stay in both
/// orders although their faces lie on each other.
fn report_both_orders(
    model: &Model,
    (of_one, of_two): (&[&BothOrders], &[&BothOrders]),
    cx: &mut Context,
) {
    let second = |pair: &BothOrders| {
        let [i, j] = pair.contacts;
        model.contacts[i.max(j)].span
    };
    let count = |pairs: &[&BothOrders]| pairs.iter().map(|pair| pair.lying).sum::<usize>();
    if let Some(pair) = of_one.first() {
        let message = match pair.formulation {
            ContactFormulation::NodeToSegment => format!(
                "pairs stand in both orders, and {} of their faces lie on each other: one order of each is taken, \
                 from surface to surface",
                count(of_one)
            ),
            ContactFormulation::SurfaceToSurface => {
                "pairs from surface to surface stand in both orders: one order of each is taken"
                    .to_owned()
            }
        };
        cx.d.note(Code::BothOrders, second(pair), message).help(
            "means over the faces of one side keep out both; TYPE=NODE TO SURFACE keeps both orders, whose conditions \
             depend on each other, which takes long",
        );
    }
    let lying = count(of_two);
    let is_slow = |pair: &&&BothOrders| {
        pair.formulation == ContactFormulation::SurfaceToSurface || lying >= MANY_LYING
    };
    if let Some(pair) = of_two.iter().filter(|pair| pair.lying > 0).find(is_slow) {
        let message =
            format!("pairs stand in both orders, and {lying} of their faces lie on each other");
        cx.d.note(Code::BothOrders, second(pair), message).help(
            "the conditions of both sides depend on each other, which takes long: keep one order of each pair, with \
             TYPE=SURFACE TO SURFACE, or use *CONTACT",
        );
    }
}

/// Places of faces, and which nodes can move.
struct Place<'a> {
    mesh: &'a Mesh,
    /// Body of every node.
    bodies: &'a [usize],
    /// For each node, whether the node is held in both directions in all steps, by itself or as a part of a rigid body.
    held: &'a [bool],
}

/// For each node, whether the node is held in both directions in all steps, by itself or as a part of a rigid body.
fn held_nodes(model: &Model) -> Vec<bool> {
    let dofs = prescribed_throughout(&model.steps);
    let is_held = |node: usize| [0, 1].iter().all(|axis| dofs.contains(&(2 * node + axis)));
    let mut held: Vec<bool> = (0..model.mesh.coordinates.len()).map(is_held).collect();
    for body in &model.rigid_bodies {
        let is_held = held[body.reference];
        body.nodes.iter().for_each(|&node| held[node] |= is_held);
    }
    held
}

/// Number of the faces that lie on a face of another body in the list `others`, where at least one of the two faces can
/// move.
fn lying_faces([faces, others]: [&[[usize; 2]]; 2], place: &Place) -> usize {
    let (x, bodies) = (&place.mesh.coordinates, place.bodies);
    let is_held = |face: [usize; 2]| face.iter().all(|&node| place.held[node]);
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
        let can_move = !is_held(faces[i]) || !is_held(others[j]);
        if is_of_other && can_move && !lies[i] && lie_on_each_other(ends(faces[i]), ends(others[j]))
        {
            lies[i] = true;
        }
    }
    lies.into_iter().filter(|lies| *lies).count()
}

/// Whether two faces run in opposite directions along one line and share a part of this line.
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

/// Replaces surface to surface by node to surface where surface to surface cannot be used, with a warning that says
/// why.
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

/// Reason why a contact cannot be surface to surface; `None` if it can be surface to surface.
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
