//! Check of the initial configuration for penetration. The check reports penetrated nodes,
//! overlapping bodies, and surfaces that do not face each other as diagnostics at the contact in
//! the deck.

use super::initial_gaps::{InitialGap, gaps};
use crate::contact::tolerances::{COORDINATE_ROUND_OFF, PENETRATION_FAULT};
use crate::contact::{ContactSurfaces, project};
use crate::diagnostics::{Code, Diagnostic, Diagnostics};
use crate::model::{ALL_EXTERIOR, Contact, Model, Surface, SurfaceKind};
use std::collections::{HashMap, HashSet};

/// Number of nodes that are examined for a slave surface.
const FEW: usize = 8;

/// Reports slave nodes that start inside the master body: deep nodes as errors, and shallow nodes, which the first
/// increment pushes out, as warnings. Bodies on the same side of a common face are errors, since all gaps are zero
/// there and contact would never close. A pair without a node that faces the other surface is a warning.
pub(super) fn report_penetrations(
    model: &Model,
    surfaces: &[ContactSurfaces],
    (gaps, overlaps): (&[Vec<InitialGap>], &[Vec<f64>]),
    d: &mut Diagnostics,
) {
    let left = |contact: usize| {
        let allowed = model.allowed_at_start(contact);
        left_gaps(
            &gaps[contact],
            &surfaces[contact],
            (&overlaps[contact], allowed),
        )
    };
    let all_gaps: Vec<Vec<InitialGap>> = (0..surfaces.len()).map(left).collect();
    report_nothing_faced(model, &all_gaps, d);
    report_no_overlap(model, overlaps, d);
    let removed = (model.steps.first()).map_or(&[][..], |step| &step.contacts.removed);
    for (i, (contact, gaps)) in model.contacts.iter().zip(&all_gaps).enumerate() {
        if removed.contains(&i) {
            continue;
        }
        if let Some(behind) = behind_the_body(model, &surfaces[i], gaps) {
            d.push(facing_away(model, contact, behind));
            continue;
        }
        if let Some(face) = common_face(model, contact, gaps) {
            d.push(overlap(model, contact, face));
        }
        let depth = |gap: &InitialGap| -gap.gap / gap.edge;
        let is_inside = |gap: &&InitialGap| depth(gap) > COORDINATE_ROUND_OFF;
        let inside = || gaps.iter().filter(is_inside);
        let deepest = inside().max_by(|a, b| depth(a).total_cmp(&depth(b)));
        if let Some(deepest) = deepest {
            d.push(diagnostic(model, contact, deepest, inside().count()));
        }
    }
}

/// Initial gaps of a contact plus the overlaps that it allows at the start: one overlap for each slave node, or one for
/// all nodes.
fn left_gaps(
    gaps: &[InitialGap],
    contact: &ContactSurfaces,
    (overlaps, allowed): (&[f64], f64),
) -> Vec<InitialGap> {
    let slaves = contact.slaves.iter().copied();
    let own: HashMap<usize, f64> = slaves.zip(overlaps.iter().copied()).collect();
    let left = |gap: &InitialGap| InitialGap {
        gap: gap.gap + own.get(&gap.slave).copied().unwrap_or(allowed),
        ..*gap
    };
    gaps.iter().map(left).collect()
}

/// Warns about contacts that are to remove an overlap although the surfaces do not overlap.
fn report_no_overlap(model: &Model, overlaps: &[Vec<f64>], d: &mut Diagnostics) {
    let has_overlap = |contact: usize| overlaps[contact].iter().any(|o| *o > 0.0);
    for (i, contact) in model.contacts.iter().enumerate() {
        // in general contact an overlap may be between any two bodies or rigid surfaces
        let others = model.contacts.iter().enumerate();
        let mut others = others.filter(|(_, other)| {
            let [a, b] = [contact, *other].map(|contact| [contact.slave, contact.master]);
            a == [b[1], b[0]] || (contact.is_interference_fit && other.is_interference_fit)
        });
        if !model.shrinks(i) || has_overlap(i) || others.any(|(other, _)| has_overlap(other)) {
            continue;
        }
        let message = format!(
            "no node of {} is inside {} at the start: there is no overlap to press out",
            model.surfaces[contact.slave].name,
            opposite(model, contact)
        );
        (d.warning_once(Code::Interference, contact.span, message))
            .help("the bodies of a fit overlap in the mesh by their interference");
    }
}

/// The deepest slave node of a contact, at the positions `x`, if this node is deeper inside the master body than a node
/// may be at the start.
pub(crate) fn deepest_fault(
    contact: &ContactSurfaces,
    x: &[[f64; 2]],
    bodies: &[usize],
) -> Option<InitialGap> {
    let depth = |gap: &InitialGap| -gap.gap / gap.edge;
    let all = gaps(contact, x, bodies, false).into_iter();
    let faults = all.filter(|gap| depth(gap) > PENETRATION_FAULT);
    faults.max_by(|a, b| depth(a).total_cmp(&depth(b)))
}

/// Warns about pairs without a node that faces the master; of two pairs in both orders only if neither has such a node.
fn report_nothing_faced(model: &Model, gaps: &[Vec<InitialGap>], d: &mut Diagnostics) {
    let faced: HashSet<[usize; 2]> = model
        .contacts
        .iter()
        .zip(gaps)
        .filter(|(_, gaps)| !gaps.is_empty())
        .flat_map(|(c, _)| [[c.slave, c.master], [c.master, c.slave]])
        .collect();
    for contact in &model.contacts {
        if !is_pair(model, contact) || faced.contains(&[contact.slave, contact.master]) {
            continue;
        }
        let [slave, master] = [contact.slave, contact.master].map(|s| &model.surfaces[s]);
        let (code, message) = match lies_behind(model, slave, master) {
            true => (
                Code::FacingAway,
                format!(
                    "{} looks away from {} at the start",
                    master.name, slave.name
                ),
            ),
            false => (
                Code::NothingFaced,
                format!(
                    "no node of {} faces {} at the start",
                    slave.name, master.name
                ),
            ),
        };
        let help = match master.kind {
            SurfaceKind::Rigid(_) => {
                "they may meet later; if not, its points are listed in the wrong order: the outside \
                 of a rigid surface is on the left of the way from START"
            }
            _ => {
                "they may meet later; if not, these are the wrong faces: a face looks out of its body"
            }
        };
        let warning = Diagnostic::warning(code, contact.span, message);
        d.push(warning.help(help));
    }
}

/// Whether the nodes of a slave surface project on segments of the master and lie behind these segments. The function
/// examines only a few nodes of the surface.
fn lies_behind(model: &Model, slave: &Surface, master: &Surface) -> bool {
    let x = &model.mesh.coordinates;
    let (nodes, segments) = (slave.nodes(&model.mesh), master.segments(&model.mesh));
    let some = nodes.iter().step_by(nodes.len().div_ceil(FEW).max(1));
    let gaps = some.flat_map(|&node| {
        let over = segments
            .iter()
            .map(move |&[a, b]| project(x[node], x[a], x[b]));
        over.filter(|p| (0.0..=1.0).contains(&p.xi)).map(|p| p.gap)
    });
    let nearest = gaps.fold(f64::NEG_INFINITY, f64::max);
    nearest.is_finite() && nearest < 0.0
}

/// The first slave node that lies behind the master surface at a depth that is an error, but in
/// none of its elements: the surface faces away from the node.
fn behind_the_body<'g>(
    model: &Model,
    surfaces: &ContactSurfaces,
    gaps: &'g [InitialGap],
) -> Option<&'g InitialGap> {
    gaps.iter().find(|gap| {
        let is_deep = -gap.gap > PENETRATION_FAULT * gap.edge;
        is_deep && !gap.is_inside(surfaces, &model.mesh.coordinates)
    })
}

fn facing_away(model: &Model, contact: &Contact, behind: &InitialGap) -> Diagnostic {
    let [slave, master] = [contact.slave, contact.master].map(|s| &model.surfaces[s].name);
    let message = format!(
        "{master} looks away from {slave}: node {} lies {:.3e} behind it, outside of its body",
        model.node_name(behind.slave),
        -behind.gap,
    );
    let error = Diagnostic::error(Code::FacingAway, contact.span, message);
    error.help("name the faces that look at each other: a face looks out of its body")
}

/// A slave face that lies on a master face with the same outward normal.
fn common_face(model: &Model, contact: &Contact, gaps: &[InitialGap]) -> Option<[usize; 2]> {
    let x = &model.mesh.coordinates;
    let touching: HashMap<usize, [usize; 2]> = gaps
        .iter()
        .filter(|gap| gap.gap.abs() <= COORDINATE_ROUND_OFF * gap.edge)
        .map(|gap| (gap.slave, gap.segment))
        .collect();
    let coincides = |&[a, b]: &[usize; 2]| {
        let own = project(x[a], x[a], x[b]);
        let middle = [0, 1].map(|i| x[a][i] + (x[b][i] - x[a][i]) / 2.0);
        let faced = [a, b].into_iter().filter_map(|node| touching.get(&node));
        faced.map(|&[p, q]| project(middle, x[p], x[q])).any(|at| {
            let alike = at.normal[0] * own.normal[0] + at.normal[1] * own.normal[1];
            let is_on =
                at.gap.abs() <= COORDINATE_ROUND_OFF * at.length && (0.0..=1.0).contains(&at.xi);
            is_on && alike > 0.0
        })
    };
    let slave = &model.surfaces[contact.slave];
    slave.segments(&model.mesh).into_iter().find(coincides)
}

fn overlap(model: &Model, contact: &Contact, face: [usize; 2]) -> Diagnostic {
    let [a, b] = face.map(|node| model.node_name(node));
    let message = format!(
        "the face of {} between the nodes {a} and {b} lies in the boundary of {} and looks the \
         same way: the bodies overlap",
        model.surfaces[contact.slave].name,
        opposite(model, contact)
    );
    let help = match model.surfaces[contact.master].kind {
        SurfaceKind::Rigid(_) => {
            "the outside of a rigid surface is on the left of the way from START: list its points \
             in the other order"
        }
        _ => "move the bodies apart, or name faces that look at each other",
    };
    Diagnostic::error(Code::InitialPenetration, contact.span, message).help(help)
}

fn diagnostic(model: &Model, contact: &Contact, deepest: &InitialGap, count: usize) -> Diagnostic {
    let message = format!(
        "{count} {} of {} inside {} at the start; deepest: node {} by {:.3e} \
         ({:.1e} of the shorter edge)",
        if count == 1 { "node" } else { "nodes" },
        model.surfaces[contact.slave].name,
        opposite(model, contact),
        model.node_name(deepest.slave),
        -deepest.gap,
        -deepest.gap / deepest.edge,
    );
    let code = Code::InitialPenetration;
    if -deepest.gap > PENETRATION_FAULT * deepest.edge {
        let is_outside_chord = deepest.gap + deepest.rise >= 0.0;
        let straight =
            "the face is curved; GEOMETRIC CORRECTION=NONE on *CONTACT PAIR makes it straight";
        let help = match is_outside_chord && is_pair(model, contact) {
            true => format!("{straight}; else {}", remedy(model, contact)),
            false => remedy(model, contact),
        };
        Diagnostic::error(code, contact.span, message).help(help)
    } else {
        Diagnostic::warning(code, contact.span, message).help("the first increment pushes them out")
    }
}

/// Advice for nodes that are deep inside a body.
fn remedy(model: &Model, contact: &Contact) -> String {
    let apart = "move the bodies apart: pushing the nodes out would add energy";
    let adjust = "ADJUST= on *CONTACT PAIR moves the nodes onto the master before the start, free \
                  of strain";
    let initialization = "*CONTACT INITIALIZATION DATA, NAME=FIT with , , FIT under *CONTACT \
                          INITIALIZATION ASSIGNMENT moves the nodes onto the surfaces before the \
                          start, free of strain";
    let apart = if is_pair(model, contact) {
        format!("{apart}; {adjust}")
    } else if model.surfaces[contact.slave].name == ALL_EXTERIOR {
        format!("{apart}; {initialization}")
    } else {
        apart.to_owned()
    };
    match model.surfaces[contact.master].kind {
        SurfaceKind::Rigid(_) => format!(
            "if the rigid surface is the wrong way round, list its points in the other order: its \
             outside is on the left of the way from START; else {apart}"
        ),
        _ => apart,
    }
}

/// Whether a contact is a pair of two different surfaces of the deck.
fn is_pair(model: &Model, contact: &Contact) -> bool {
    !contact.is_self_contact() && model.surfaces[contact.slave].name != ALL_EXTERIOR
}

/// The opposite side of the slave surface, for messages.
fn opposite(model: &Model, contact: &Contact) -> String {
    match contact.is_self_contact() {
        true => "another body".into(),
        false => format!("the body of {}", model.surfaces[contact.master].name),
    }
}
