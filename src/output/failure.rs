//! Reports of failed attempts and of a stopped run: cause, course of the passes, worst place, and what to
//! change.

use super::format::{counted, general, scientific, wrap, wrap_words};
use super::strain::inversion_hint;
use crate::dynamics::{
    Alternation, Cause, Course, Cutback, FailedLcp, Failure, IncrementReport, PassReport,
    Unbalanced, Worst,
};
use crate::elements::ElementResult;
use crate::lcp::LcpError;
use crate::linear::LinearError;
use crate::model::{Bodies, Model, Procedure, RigidBody, RigidProfile, Set, Step, SurfaceKind};
use crate::vectors::{cross, difference, length};

/// Number of pairs of a complementarity problem that the text names.
const SHOWN_PAIRS: usize = 4;
/// Ratio of the area between the sides of a corner to its initial value, below which the element counts as crushed
/// there.
const CRUSHED_CORNER: f64 = 0.01;
/// Sine of the smallest angle by which a sharp corner of a rigid surface turns.
const SHARP_SINE: f64 = 0.1;

/// Report of a stopped run: increment, time, cause, worst place, advice, halvings and the passes. `u` is the last
/// converged displacement, and `elements` holds the results of the elements for it.
pub(crate) fn failure_lines(
    failure: &Failure,
    model: &Model,
    u: &[f64],
    elements: &[ElementResult],
) -> Vec<String> {
    let time = scientific(failure.time, 6);
    let (increment, step) = (failure.increment, failure.step);
    let where_it_failed = match increment {
        0 => format!("the start of step {step} failed at time {time}"),
        _ => format!("increment {increment} of step {step} failed at time {time}"),
    };
    let what = [where_it_failed, failure.cause.to_string()];
    let mut lines = wrap("stopped", &what);
    if let Some(course) = &failure.course {
        lines.extend(wrap_words("", &course_text(course, model)));
    }
    lines.extend(failure.worst.as_ref().map(|worst| worst_line(worst, model)));
    lines.extend(place_line(&failure.cause, model, u));
    lines.extend(unbalanced_lines(&failure.cause, model));
    if let Cause::Indefinite { node } = failure.cause {
        lines.extend(body_line(node, model, elements));
    }
    let mut hints = hint(&failure.cause, model);
    let crushed = crushed(&failure.cause, model, u);
    if let Some(Crushed {
        element,
        node,
        part,
    }) = crushed
    {
        lines.extend(crushed_lines(element, node, part, model));
        hints = inversion_hint(element, model);
    }
    lines.extend(hints);
    if crushed.is_none()
        && let Some(advice) = advice(failure, model)
    {
        lines.extend(wrap_words("advice", &advice));
    }
    if increment > 0 {
        let steps = &model.steps;
        let cut = match steps.get(step.wrapping_sub(1)).map(|step| step.procedure) {
            Some(Procedure::Static) => "cut",
            _ => "halving",
        };
        lines.push(format!(
            "tried    {} of the increment; the last attempt with dt {}",
            counted(failure.halvings as usize, cut),
            scientific(failure.dt, 3),
        ));
    }
    if !failure.passes.is_empty() {
        lines.push("passes   of the last attempt:".into());
        lines.extend(pass_table(&failure.passes));
    }
    lines
}

fn worst_line(worst: &Worst, model: &Model) -> String {
    format!(
        "worst    node {} at {}: {} {}",
        model.node_name(worst.node),
        point(worst.position),
        worst.quantity,
        scientific(worst.value, 2),
    )
}

/// Likely reasons of the cause.
fn hint(cause: &Cause, model: &Model) -> Vec<String> {
    match *cause {
        Cause::Inverted { element, .. } => inversion_hint(element, model),
        Cause::Crossed {
            prescribed: true, ..
        } => vec!["         both sides are prescribed: they are driven into each other".to_owned()],
        _ => Vec::new(),
    }
}

/// An element with a corner that is inside out, or nearly.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crushed {
    element: usize,
    /// Node at the corner.
    node: usize,
    /// Area between the sides of the corner, relative to that in the reference configuration.
    part: f64,
}

/// The worst crushed element at the nodes of a contact that the cause names. The integration points lie
/// inside an element and do not see its corners.
fn crushed(cause: &Cause, model: &Model, u: &[f64]) -> Option<Crushed> {
    let named: Vec<usize> = match cause {
        Cause::Crossed { slave, segment, .. } => vec![*slave, segment[0], segment[1]],
        Cause::Collapsed { segment } => segment.to_vec(),
        Cause::Lcp(failed) => failed.pairs.iter().flatten().copied().collect(),
        _ => return None,
    };
    let all = model.mesh.elements.iter().enumerate();
    let at_contact = all.filter(|(_, element)| element.nodes.iter().any(|n| named.contains(n)));
    let corners = at_contact.flat_map(|(index, element)| {
        (0..element.side_count()).map(move |k| {
            let now = element.corner_area(k, |node| position(model, node, u));
            let part = now / element.corner_area(k, |node| model.mesh.coordinates[node]);
            Crushed {
                element: index,
                node: element.nodes[k],
                part,
            }
        })
    });
    corners
        .filter(|corner| corner.part <= CRUSHED_CORNER)
        .min_by(|p, q| p.part.total_cmp(&q.part))
}

/// Lines about a crushed element.
fn crushed_lines(element: usize, node: usize, part: f64, model: &Model) -> Vec<String> {
    let text = format!(
        "element {} is crushed: at its corner, node {}, the area between its sides is {} of \
         what it was (integration points do not see corners)",
        model.element_name(element),
        model.node_name(node),
        general(part, 2),
    );
    wrap_words("cause", &text)
}

/// Line about the element or node that the cause names.
fn place_line(cause: &Cause, model: &Model, u: &[f64]) -> Option<String> {
    let name = |node: usize| model.node_name(node);
    let at = |node: usize| format!("{} at {}", name(node), point(position(model, node, u)));
    let segment = |[a, b]: [usize; 2]| format!("{}-{}", name(a), name(b));
    let node_and_segment = |node: usize, lies: &str, ends: [usize; 2]| {
        format!("node     {} {lies} the segment {}", at(node), segment(ends))
    };
    Some(match *cause {
        Cause::Inverted { element, .. } => format!(
            "element  {} with its centre at {}",
            model.element_name(element),
            point(centre(model, element, u)),
        ),
        Cause::Crossed { slave, segment, .. } => node_and_segment(slave, "through", segment),
        Cause::Overlaps { slave, segment, .. } => node_and_segment(slave, "behind", segment),
        Cause::GainedEnergy {
            pair: Some([slave, a, b]),
            ..
        } => node_and_segment(slave, "on", [a, b]),
        Cause::Collapsed { segment: [a, b] } => format!(
            "segment  {} at {}",
            segment([a, b]),
            point(position(model, a, u))
        ),
        Cause::Lcp(ref failed) => pairs_line(failed, model),
        Cause::Indefinite { node }
        | Cause::Unstable { node }
        | Cause::Jump { node }
        | Cause::NotFinite { node, .. } => format!("node     {}", at(node)),
        Cause::LinearSolver(LinearError::Dependent { number }) => {
            let [a, b] = model.hinges.get(number)?.nodes;
            let place = point(position(model, a, u));
            format!("hinge    nodes {} and {} at {place}", name(a), name(b))
        }
        _ => return None,
    })
}

/// Lines about the body that is not in balance: the force and moment left over, and the motion that is about to begin.
fn unbalanced_lines(cause: &Cause, model: &Model) -> Vec<String> {
    let Cause::Unbalanceable(unbalanced) = cause else {
        return Vec::new();
    };
    let text = format!(
        "{} are left over; it is about to {}",
        unbalanced_text(unbalanced, model),
        motion_text(unbalanced)
    );
    wrap_words("body", &text)
}

/// Lines that say that from this increment on a motion is held which only the facets of surfaces resist.
pub(crate) fn held_lines(
    held: &Unbalanced,
    report: &IncrementReport,
    model: &Model,
) -> Vec<String> {
    let text = format!(
        "from increment {} on the body {}, {} of its normal forces, which only the facets of its surfaces \
         make; without friction it is free to {}",
        report.increment,
        unbalanced_text(held, model),
        scientific(report.solver.held, 1),
        motion_text(held),
    );
    wrap_words("held", &text)
}

fn unbalanced_text(unbalanced: &Unbalanced, model: &Model) -> String {
    format!(
        "{}: the force {} and the moment {} about its middle",
        body_name(unbalanced.node, model),
        point(unbalanced.force),
        scientific(unbalanced.moment, 2),
    )
}

/// Name of the body of a node in the words of the deck: a rigid body has its name, a deformable body has the name of
/// the smallest element set that holds all of it, or else it is named by the node.
fn body_name(node: usize, model: &Model) -> String {
    let name = model.node_name(node);
    let node = model.node_of(node);
    let moves = |body: &&RigidBody| body.reference == node || body.nodes.contains(&node);
    if let Some(body) = model.rigid_bodies.iter().find(moves) {
        return format!("{} with node {name}", body.name);
    }
    let bodies = Bodies::new(&model.mesh);
    let body = bodies.of_node.get(node).copied().flatten();
    let elements = bodies.of_element.iter().enumerate();
    let own: Vec<usize> = elements
        .filter(|(_, of)| Some(**of) == body)
        .map(|(element, _)| element)
        .collect();
    let holds =
        |set: &&Set| !own.is_empty() && own.iter().all(|e| set.members.binary_search(e).is_ok());
    let sets = model.sets.elements.iter().filter(holds);
    match sets.min_by_key(|set| set.members.len()) {
        Some(set) => format!("{} with node {name}", set.name),
        None => format!("of node {name}"),
    }
}

/// Largest ratio of the displacement of the middle of a body to that of its farthest node, for a motion that counts as
/// turning about one of its nodes or rolling; it leaves room for strain.
const ABOUT_A_NODE: f64 = 1.5;
/// Component of a direction below which it counts as round-off.
const NO_PART: f64 = 1e-9;

fn motion_text(unbalanced: &Unbalanced) -> String {
    let Unbalanced {
        motion: [x, y, angle],
        size,
        ..
    } = *unbalanced;
    let (travel, turn) = (x.hypot(y), angle.abs() * size);
    match ABOUT_A_NODE * turn > travel {
        true if angle > 0.0 => "turn to the left".to_owned(),
        true => "turn to the right".to_owned(),
        false => {
            let part = |c: f64| match (c / travel).abs() < NO_PART {
                true => 0.0,
                false => c / travel,
            };
            format!(
                "slide along ({}, {})",
                general(part(x), 3),
                general(part(y), 3)
            )
        }
    }
}

/// Line about the body of a node: the most compressed element at the node, with a set that holds the element.
fn body_line(node: usize, model: &Model, results: &[ElementResult]) -> Option<String> {
    let all = model.mesh.elements.iter().enumerate();
    let own = all.filter(|(_, element)| element.nodes.contains(&node));
    let strain = |index: usize| results.get(index).map_or(0.0, least_principal);
    let (index, _) = own.min_by(|p, q| strain(p.0).total_cmp(&strain(q.0)))?;
    let sets = (model.sets.elements.iter()).filter(|set| set.members.binary_search(&index).is_ok());
    let set = sets.min_by_key(|set| set.members.len());
    let of_set = set.map_or(String::new(), |set| format!(" of {}", set.name));
    let strained = match strain(index) {
        strain if strain < 0.0 => format!("compressed by the strain {}", general(strain, 2)),
        _ => "not compressed".to_owned(),
    };
    let label = model.element_name(index);
    Some(format!(
        "element  {label}{of_set} at this node was {strained}"
    ))
}

/// The smallest principal value of the mean strain of an element in the plane.
fn least_principal(result: &ElementResult) -> f64 {
    let [xx, yy, xy] = result.strain;
    (xx + yy) / 2.0 - ((xx - yy) / 2.0).hypot(xy)
}

/// Lines about the first pairs of an unsolved complementarity problem: on a ray, pairs that press against each other;
/// else any pairs.
fn pairs_line(failed: &FailedLcp, model: &Model) -> String {
    let pairs: Vec<[usize; 3]> = match &failed.error {
        LcpError::Ray { members, .. } if !members.is_empty() => members
            .iter()
            .filter_map(|&k| failed.pairs.get(k).copied())
            .collect(),
        _ => failed.pairs.clone(),
    };
    let label = |node: usize| model.node_name(node);
    let text = |&[slave, a, b]: &[usize; 3]| {
        format!("node {} on segment {}-{}", label(slave), label(a), label(b))
    };
    let mut texts: Vec<String> = pairs.iter().take(SHOWN_PAIRS).map(text).collect();
    if let Some(more @ 1..) = pairs.len().checked_sub(SHOWN_PAIRS) {
        texts.push(format!("{more} more"));
    }
    format!("pairs    {}", texts.join(", "))
}

/// Current position of a node.
fn position(model: &Model, node: usize, u: &[f64]) -> [f64; 2] {
    let node = model.node_of(node);
    let [x, y] = model.mesh.coordinates[node];
    match u.get(2 * node..2 * node + 2) {
        Some(d) => [x + d[0], y + d[1]],
        None => [x, y],
    }
}

/// Mean of the current positions of an element's nodes.
fn centre(model: &Model, element: usize, u: &[f64]) -> [f64; 2] {
    let nodes = &model.mesh.elements[element].nodes;
    let mut sum = [0.0; 2];
    for &node in nodes {
        let x = position(model, node, u);
        sum = [sum[0] + x[0], sum[1] + x[1]];
    }
    sum.map(|s| s / nodes.len() as f64)
}

fn point([x, y]: [f64; 2]) -> String {
    format!("({}, {})", scientific(x, 5), scientific(y, 5))
}

/// Largest number of halvings of an increment.
const NO_MORE_HALVINGS: u32 = 10;
/// Ratio of a correction to the tolerance up to which a correction that does not become smaller may be round-off.
const NEAR_ROUND_OFF: f64 = 1e4;

/// Text about the course of passes that did not converge.
pub(super) fn course_text(course: &Course, model: &Model) -> String {
    match course {
        Course::Growing { from } => format!("the corrections grew from pass {from} on"),
        Course::Alternating(alternations) => alternation_text(alternations, model),
        Course::Slow { rate, left } => format!(
            "about {} needed: each correction is {} of the last",
            match left {
                1 => "1 more pass was".to_owned(),
                _ => format!("{left} more passes were"),
            },
            general(*rate, 2),
        ),
        Course::Stagnant { correction } => format!(
            "the corrections became no smaller than {}",
            scientific(*correction, 1)
        ),
    }
}

/// Text about the first slave node whose state alternated, and the number of others.
fn alternation_text(alternations: &[Alternation], model: &Model) -> String {
    let label = |node: usize| model.node_name(node);
    let segment = |[a, b]: [usize; 2]| format!("{}-{}", label(a), label(b));
    let first = alternations.first().map(|alternation| match *alternation {
        Alternation::Closing([slave, a, b]) => format!(
            "node {} opened and closed on segment {}",
            label(slave),
            segment([a, b])
        ),
        Alternation::Changing {
            slave,
            segments: [p, q],
        } => format!(
            "node {} went to and fro between segments {} and {}",
            label(slave),
            segment(p),
            segment(q)
        ),
        Alternation::Sliding([slave, a, b]) => format!(
            "node {} stuck and slid on segment {}",
            label(slave),
            segment([a, b])
        ),
    });
    let others = match alternations.len() {
        0 | 1 => String::new(),
        count => format!(", as did {}", counted(count - 1, "other node")),
    };
    first.unwrap_or_default() + " from pass to pass" + &others
}

/// Advice on what to change; empty if the cause has its own lines or says everything.
pub(super) fn advice(failure: &Failure, model: &Model) -> Option<String> {
    let step = model.steps.get(failure.step.wrapping_sub(1))?;
    let is_static = step.procedure == Procedure::Static;
    let with_limit = |own: &str| match is_static && may_be_at_limit(&failure.cause) {
        true => format!("{own}; {}", limit_advice(step, model)),
        false => own.to_owned(),
    };
    let text = match (&failure.cause, failure.course.as_deref()) {
        (_, Some(Course::Slow { left, .. })) => {
            let passes = step.settings.max_passes.saturating_add(*left);
            format!("raise MAX PASSES of *STICKSLIP to {passes} or more")
        }
        (_, Some(Course::Stagnant { correction }))
            if *correction <= NEAR_ROUND_OFF * step.settings.tolerance =>
        {
            format!(
                "raise TOLERANCE of *STICKSLIP above {} if that is round-off",
                scientific(*correction, 0)
            )
        }
        (_, Some(Course::Alternating(all))) => with_limit(alternation_advice(all)?),
        (Cause::NotConverged | Cause::Diverged, _) if is_static => limit_advice(step, model),
        (cause, _) => with_limit(cause_advice(cause, model)?),
    };
    Some(match has_halvings_left(failure, step) {
        true => text + "; or let it be cut further, by a smaller least increment of the step",
        false => text,
    })
}

/// Whether a cause may mean that a static step has no further equilibrium: passes find none, or no contact forces hold
/// the bodies.
fn may_be_at_limit(cause: &Cause) -> bool {
    match cause {
        Cause::NotConverged | Cause::Diverged => true,
        Cause::Lcp(failed) => failed.is_contradiction(),
        _ => false,
    }
}

/// Advice for a static step that has no further equilibrium.
fn limit_advice(step: &Step, model: &Model) -> String {
    let is_loaded = !(step.point_loads.is_empty()
        && step.body_forces.is_empty()
        && step.centrifugal_forces.is_empty()
        && step.pressures.is_empty()
        && step.tractions.is_empty());
    let held = match is_loaded {
        true => ", or prescribe a displacement in place of the load",
        false => "",
    };
    let rounded = match has_sharp_die(model) {
        true => {
            "; where a body bends round a sharp corner of a rigid surface, round the corner by an arc"
        }
        false => "",
    };
    format!(
        "where equilibrium ends, as at a limit of the load, of friction or before a body snaps, go on with \
         *DYNAMIC, APPLICATION=QUASI-STATIC from the last increment{held}{rounded}"
    )
}

/// Whether the master of a contact is an analytical rigid surface with a sharp corner.
fn has_sharp_die(model: &Model) -> bool {
    let mut masters = (model.contacts.iter()).map(|contact| &model.surfaces[contact.master].kind);
    masters.any(|kind| match kind {
        SurfaceKind::Rigid(profile) => is_sharp(profile, &model.mesh.coordinates),
        SurfaceKind::Faces(_) | SurfaceKind::Nodes(_) => false,
    })
}

/// Whether a profile has a sharp corner; chords of arcs have no sharp corners.
fn is_sharp(profile: &RigidProfile, x: &[[f64; 2]]) -> bool {
    profile.segments.windows(2).any(|pair| {
        let [e, f] = [pair[0], pair[1]].map(|[from, to]| difference(x[from], x[to]));
        pair[0][1] == pair[1][0] && cross(e, f).abs() > SHARP_SINE * length(e) * length(f)
    })
}

/// Whether only the smallest increment of the deck kept a stopped run from halving its increment again.
fn has_halvings_left(failure: &Failure, step: &Step) -> bool {
    !failure.cause.stays()
        && failure.halvings < NO_MORE_HALVINGS
        && failure.dt / 2.0 < step.increments.dt_min
}

fn alternation_advice(alternations: &[Alternation]) -> Option<&'static str> {
    alternations.first().map(|alternation| match alternation {
        Alternation::Closing(_) => {
            "take smaller increments; where each surface is the slave of the other, leave out one of \
             the two contacts"
        }
        Alternation::Changing { .. } => {
            "take smaller increments, or a finer mesh where the surface bends there"
        }
        Alternation::Sliding(_) => "take smaller increments, or a smaller friction coefficient",
    })
}

fn cause_advice(cause: &Cause, model: &Model) -> Option<&'static str> {
    Some(match cause {
        Cause::NotConverged | Cause::Diverged => {
            "take smaller increments, a smaller load, or bring the load on more slowly (*AMPLITUDE)"
        }
        Cause::Unbalanceable(_) => {
            "hold the body with a support, let friction or another body hold it, or go on with *DYNAMIC"
        }
        Cause::Unstable { .. } | Cause::Jump { .. } => {
            "go on with *DYNAMIC from the last increment, or prescribe a displacement in place of the load"
        }
        Cause::Indefinite { node } => match is_for_small_strains_at(*node, model) {
            true => {
                "take smaller increments, in which inertia holds the body, or a smaller load; for \
                 large compression *ELASTIC, TYPE=HENCKY with the same constants"
            }
            false => "take smaller increments, in which inertia holds the body, or a smaller load",
        },
        Cause::Collapsed { .. } => "take a smaller load, or a coarser mesh there",
        Cause::Crossed {
            prescribed: false, ..
        } => "take smaller increments, or a finer mesh where the node went in",
        Cause::Overlaps { .. } => "move the bodies apart before the step that adds the contact",
        Cause::GainedEnergy { .. } => "take smaller increments",
        Cause::Unbalanced { is_round_off, .. } => match is_round_off {
            true => {
                "a body is so stiff that the round-off of its positions makes forces like those on it: \
                 see whether stiffness, loads, lengths and times are in consistent units"
            }
            false => "lower the TOLERANCE of *STICKSLIP, or take smaller increments",
        },
        Cause::Lcp(failed) => match failed.error {
            LcpError::Ray { .. } => {
                "let supports and rigid surfaces not drive the bodies into each other there"
            }
            LcpError::NotFinite => "see whether loads, materials and times are in consistent units",
            _ if failed.problem.mu.iter().any(|mu| *mu > 0.0) => {
                "take smaller increments, or a smaller friction coefficient"
            }
            _ => "take smaller increments",
        },
        Cause::LinearSolver(LinearError::Dependent { .. }) => {
            "leave out this hinge, or another one or a support that holds the same motion"
        }
        Cause::NotFinite { .. } => "see whether loads, materials and times are in consistent units",
        Cause::Inverted { .. }
        | Cause::Crossed { .. }
        | Cause::LinearSolver(_)
        | Cause::Inaccurate { .. } => return None,
    })
}

fn is_for_small_strains_at(node: usize, model: &Model) -> bool {
    let elements = model.mesh.elements.iter().enumerate();
    let mut own = elements.filter(|(_, element)| element.nodes.contains(&node));
    own.any(|(index, _)| model.is_for_small_strains(index))
}

/// The convergence table of an increment.
pub(crate) fn pass_table(passes: &[PassReport]) -> Vec<String> {
    if passes.is_empty() {
        return vec![];
    }
    let header = "     pass  residual correction  active   stick     LCP  pivots".to_owned();
    let row = |(i, pass): (usize, &PassReport)| {
        format!(
            "     {:>4}{:>10}{:>11}{:>8}{:>8}{:>8}{:>8}",
            i + 1,
            scientific(pass.residual, 2),
            scientific(pass.correction, 2),
            pass.active,
            pass.stick,
            pass.lcp_size,
            pass.pivots,
        )
    };
    let rows = passes.iter().enumerate().map(row);
    std::iter::once(header).chain(rows).collect()
}

/// The lines about a cutback, or about an increment that is repeated because of its truncation error: increment, cause,
/// and course of the passes.
pub(crate) fn cutback_lines(cutback: &Cutback, model: &Model) -> Vec<String> {
    let failure = &cutback.failure;
    let pieces = [
        format!(
            "increment {} at {}, dt {} -> {}",
            failure.increment,
            scientific(failure.time, 3),
            scientific(failure.dt, 2),
            scientific(cutback.next_dt, 2),
        ),
        failure.cause.to_string(),
    ];
    let head = match failure.cause {
        Cause::Inaccurate { .. } => "repeated",
        _ => "cutback",
    };
    let mut lines = wrap(head, &pieces);
    let course = failure.course.as_deref();
    lines.extend(
        course
            .into_iter()
            .flat_map(|course| wrap_words("", &course_text(course, model))),
    );
    if let Cause::GainedEnergy {
        pair: Some([slave, a, b]),
        ..
    } = failure.cause
    {
        let [slave, a, b] = [slave, a, b].map(|node| model.node_name(node));
        lines.push(format!("         at node {slave} on the segment {a}-{b}"));
    }
    lines.extend(unbalanced_lines(&failure.cause, model));
    lines
}

/// Advice on what to change so that such attempts do not fail again; empty without advice.
pub(crate) fn cutback_advice(cutback: &Cutback, model: &Model) -> Vec<String> {
    let text = advice(&cutback.failure, model);
    (text.into_iter())
        .flat_map(|text| wrap_words("advice", &text))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    use crate::dynamics::FailedLcp;
    use crate::lcp::{FreeUnknowns, FrictionalLcp};
    use crate::model::{
        Element, ElementType, Incrementation, Increments, Load, Mesh, PointLoad, Set, Variation,
    };

    #[test]
    fn a_corner_of_a_die_is_sharp_and_chords_of_an_arc_are_not() {
        let profile = RigidProfile {
            segments: vec![[0, 1], [1, 2]],
            ..RigidProfile::default()
        };
        let turned = |angle: f64| [[0.0, 0.0], [1.0, 0.0], [1.0 + angle.cos(), angle.sin()]];
        assert!(is_sharp(&profile, &turned(0.2)));
        assert!(!is_sharp(&profile, &turned(1.0_f64.to_radians())));
        let apart = RigidProfile {
            segments: vec![[0, 1], [2, 0]],
            ..RigidProfile::default()
        };
        assert!(!is_sharp(&apart, &turned(1.0)));
    }

    #[test]
    fn a_crushed_corner_at_a_contact_is_named() {
        let mut model = Model::default();
        model.mesh.coordinates = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        model.mesh.elements = vec![Element {
            label: 7,
            element_type: ElementType::CPE4,
            nodes: vec![0, 1, 2, 3].into(),
            section: 0,
        }];
        // node 2 goes through the diagonal: from there the sides to 3 and 1 are (-0.4, 0.6) and (0.6, -0.4)
        let u = [0.0, 0.0, 0.0, 0.0, -0.6, -0.6, 0.0, 0.0];
        let at = |segment: [usize; 2], u: &[f64]| crushed(&Cause::Collapsed { segment }, &model, u);
        let found = at([1, 2], &u).expect("crushed");
        assert_eq!((found.element, found.node), (0, 2));
        assert!((found.part + 0.2).abs() < 1e-15, "{found:?}");
        assert_eq!(at([1, 2], &[0.0; 8]), None, "as it was");
        assert_eq!(at([8, 9], &u), None, "elsewhere");
        assert_eq!(crushed(&Cause::NotConverged, &model, &u), None);
    }

    #[test]
    fn an_indefinite_matrix_names_the_body_and_its_compression() {
        let mut model = Model::default();
        model.mesh.elements = (0..3)
            .map(|k| Element {
                label: 10 * (k as u64 + 1),
                element_type: ElementType::CPE3,
                nodes: vec![k, k + 1, k + 2].into(),
                section: 0,
            })
            .collect();
        let set = |name: &str, members: &[usize]| Set {
            name: name.into(),
            members: members.to_vec(),
        };
        model.sets.elements = vec![set("ALL", &[0, 1, 2]), set("BAR", &[1, 2])];
        // the first two have node 1; principal strains of the second are -0.3 and 0.2
        let strained = |strain| ElementResult {
            strain,
            ..ElementResult::default()
        };
        let results = [[-0.1, 0.0, 0.0], [-0.05, -0.05, 0.25], [-0.9, 0.0, 0.0]].map(strained);
        let line = |node, results: &[ElementResult]| body_line(node, &model, results);
        let expected = "element  20 of BAR at this node was compressed by the strain -0.3";
        assert_eq!(line(1, &results).as_deref(), Some(expected));
        let start = line(0, &[]).expect("before the first increment");
        assert_eq!(start, "element  10 of ALL at this node was not compressed");
        assert_eq!(line(9, &results), None, "a node without element");
    }

    /// A model with nodes 10, 20, ... and a step whose increments are at least 0.01, with at most 25 passes.
    fn model() -> Model {
        let mesh = Mesh {
            node_labels: (1..=6).map(|k| 10 * k).collect(),
            coordinates: vec![[0.0; 2]; 6],
            elements: vec![],
        };
        let step = Step::new(Increments {
            dt_min: 0.01,
            incrementation: Incrementation::Passes,
            ..Increments::fixed(1.0, 1.0)
        });
        Model {
            mesh,
            steps: vec![step],
            ..Model::default()
        }
    }

    fn failure(cause: Cause, course: Option<Course>, dt: f64) -> Failure {
        Failure {
            increment: 4,
            step: 1,
            time: 0.3,
            dt,
            cause,
            course: course.map(Box::new),
            worst: None,
            passes: vec![],
            halvings: 1,
        }
    }

    #[test]
    fn every_course_is_told_with_what_to_change() {
        let nodes = [0, 1, 2];
        let changing = Alternation::Changing {
            slave: 0,
            segments: [[1, 2], [2, 3]],
        };
        for (course, told, advised) in [
            (
                Course::Growing { from: 5 },
                "grew from pass 5 on",
                "*AMPLITUDE",
            ),
            (
                Course::Slow {
                    rate: 0.614,
                    left: 12,
                },
                "about 12 more passes were needed: each correction is 0.61 of the last",
                "MAX PASSES of *STICKSLIP to 62 or more",
            ),
            (
                Course::Slow { rate: 0.1, left: 1 },
                "about 1 more pass was needed",
                "to 51 or more",
            ),
            (
                Course::Stagnant { correction: 3e-9 },
                "no smaller than 3.0e-09",
                "TOLERANCE of *STICKSLIP above 3e-09",
            ),
            (
                Course::Stagnant { correction: 3e-3 },
                "no smaller than 3.0e-03",
                "a smaller load",
            ),
            (
                Course::Alternating(vec![changing]),
                "node 10 went to and fro between segments 20-30 and 30-40 from pass to pass",
                "a finer mesh",
            ),
            (
                Course::Alternating(vec![Alternation::Closing(nodes), changing, changing]),
                "node 10 opened and closed on segment 20-30 from pass to pass, as did 2 other nodes",
                "leave out one",
            ),
            (
                Course::Alternating(vec![Alternation::Sliding(nodes)]),
                "node 10 stuck and slid on segment 20-30",
                "friction coefficient",
            ),
        ] {
            let text = course_text(&course, &model());
            assert!(text.contains(told), "{text}");
            let failure = failure(Cause::NotConverged, Some(course), 0.5);
            let text = advice(&failure, &model()).expect("advice");
            assert!(text.contains(advised) && !text.contains("halved"), "{text}");
        }
    }

    #[test]
    fn a_static_step_without_equilibrium_tells_the_ways_out() {
        let failed = FailedLcp {
            error: LcpError::Ray {
                pivots: 3,
                members: vec![0],
            },
            problem: FrictionalLcp {
                q: DMatrix::identity(2, 2),
                gap: vec![-1.0].into(),
                slip: vec![0.0].into(),
                mu: vec![0.2].into(),
                free: FreeUnknowns::default(),
            },
            pairs: vec![[0, 1, 2]],
        };
        let sliding = Course::Alternating(vec![Alternation::Sliding([0, 1, 2])]);
        for (cause, course) in [
            (Cause::Lcp(Box::new(failed)), None),
            (Cause::Diverged, None),
            (Cause::NotConverged, Some(sliding)),
        ] {
            let failure = failure(cause, course, 0.5);
            for (procedure, is_loaded) in [
                (Procedure::Dynamic, true),
                (Procedure::Static, true),
                (Procedure::Static, false),
            ] {
                let mut model = model();
                let step = &mut model.steps[0];
                step.procedure = procedure;
                if is_loaded {
                    step.point_loads.push(Load {
                        at: PointLoad { dof: 0 },
                        magnitude: 1.0,
                        variation: Variation::Constant,
                    });
                }
                let text = advice(&failure, &model).expect("advice");
                let is_static = procedure == Procedure::Static;
                assert_eq!(
                    text.contains("APPLICATION=QUASI-STATIC"),
                    is_static,
                    "{text}"
                );
                let held = text.contains("displacement in place of the load");
                assert_eq!(held, is_static && is_loaded, "{text}");
            }
        }
    }

    #[test]
    fn a_least_increment_that_ends_the_halving_is_told() {
        let advice = |dt| {
            advice(
                &failure(Cause::Collapsed { segment: [0, 1] }, None, dt),
                &model(),
            )
        };
        let [halved, least] = [0.02, 0.015].map(|dt| advice(dt).expect("advice"));
        assert!(!halved.contains("least increment"), "{halved}");
        assert!(least.starts_with("take a smaller load") && least.contains("least increment"));
    }

    #[test]
    fn friction_is_advised_on_where_there_is_some() {
        let of = |mu: f64, error: LcpError| {
            let problem = FrictionalLcp {
                q: DMatrix::identity(2, 2),
                gap: vec![-1.0].into(),
                slip: vec![0.0].into(),
                mu: vec![mu].into(),
                free: FreeUnknowns::default(),
            };
            let pairs = vec![[0, 1, 2]];
            let failed = FailedLcp {
                error,
                problem,
                pairs,
            };
            let text = advice(&failure(Cause::Lcp(Box::new(failed)), None, 0.5), &model());
            text.expect("advice").contains("friction")
        };
        let unsolved = || LcpError::PivotLimit { pivots: 9 };
        assert!(of(0.3, unsolved()) && !of(0.0, unsolved()));
        assert!(!of(0.3, LcpError::NotFinite));
    }

    #[test]
    fn what_puts_a_balance_off_is_told() {
        let text = |is_round_off| {
            let cause = Cause::Unbalanced {
                part: 0.1,
                is_round_off,
            };
            advice(&failure(cause, None, 0.015), &model()).expect("advice")
        };
        assert!(text(true).contains("consistent units") && !text(true).contains("cut further"));
        assert!(text(false).contains("TOLERANCE") && text(false).contains("cut further"));
    }

    #[test]
    fn causes_with_lines_of_their_own_need_no_advice() {
        let inverted = Cause::Inverted {
            element: 0,
            determinant: -1.0,
        };
        assert_eq!(advice(&failure(inverted, None, 0.5), &model()), None);
    }
}
