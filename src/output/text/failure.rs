//! Report of a stopped run: cause, worst place, advice and passes.

use super::advice::{advice, course_text};
use super::format::{counted, general, scientific};
use super::layout::{wrap, wrap_words};
use super::log::pass_table;
use super::strain::inversion_hint;
use crate::dynamics::{Cause, FailedLcp, Failure, Worst};
use crate::elements::ElementResult;
use crate::lcp::LcpError;
use crate::model::Model;
use crate::vectors::{cross, difference};

/// Pairs of a complementarity problem that the text names.
const SHOWN_PAIRS: usize = 4;
/// Part of the area between the sides of a corner at which its element is crushed there.
const CRUSHED_CORNER: f64 = 0.01;

/// Increment, time, cause, worst place, advice, halvings and the passes; `u` and `elements` are the last
/// converged displacement and the results of the elements there.
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
    lines.extend(hints.iter().map(|&line| line.to_owned()));
    if crushed.is_none()
        && let Some(advice) = advice(failure, model)
    {
        lines.extend(wrap_words("advice", &advice));
    }
    if increment > 0 {
        lines.push(format!(
            "tried    {} of the increment; the last attempt with dt {}",
            counted(failure.halvings as usize, "halving"),
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
fn hint(cause: &Cause, model: &Model) -> &'static [&'static str] {
    match *cause {
        Cause::Inverted { element, .. } => inversion_hint(element, model),
        Cause::Crossed {
            prescribed: true, ..
        } => &["         both sides are prescribed: they are driven into each other"],
        _ => &[],
    }
}

/// An element with a corner that is inside out, or nearly.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crushed {
    element: usize,
    /// At the corner.
    node: usize,
    /// Area between the sides of the corner beside that of the reference configuration.
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
        let count = element.nodes.len();
        (0..count).map(move |k| {
            let corner = [k, (k + 1) % count, (k + count - 1) % count].map(|k| element.nodes[k]);
            let area = |at: &dyn Fn(usize) -> [f64; 2]| {
                let [p, q, r] = corner.map(at);
                cross(difference(p, q), difference(p, r))
            };
            let now = area(&|node| position(model, node, u));
            let part = now / area(&|node| model.mesh.coordinates[node]);
            Crushed {
                element: index,
                node: corner[0],
                part,
            }
        })
    });
    corners
        .filter(|corner| corner.part <= CRUSHED_CORNER)
        .min_by(|p, q| p.part.total_cmp(&q.part))
}

/// What is crushed.
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

/// The element or node that the cause names.
fn place_line(cause: &Cause, model: &Model, u: &[f64]) -> Option<String> {
    match *cause {
        Cause::Inverted { element, .. } => Some(format!(
            "element  {} with its centre at {}",
            model.element_name(element),
            point(centre(model, element, u)),
        )),
        Cause::Crossed {
            slave,
            segment: [a, b],
            ..
        } => Some(format!(
            "node     {} at {} through the segment {}-{}",
            model.node_name(slave),
            point(position(model, slave, u)),
            model.node_name(a),
            model.node_name(b),
        )),
        Cause::Collapsed { segment: [a, b] } => Some(format!(
            "segment  {}-{} at {}",
            model.node_name(a),
            model.node_name(b),
            point(position(model, a, u)),
        )),
        Cause::Lcp(ref failed) => Some(pairs_line(failed, model)),
        Cause::Indefinite { node } | Cause::NotFinite { node, .. } => Some(format!(
            "node     {} at {}",
            model.node_name(node),
            point(position(model, node, u)),
        )),
        _ => None,
    }
}

/// The body of a node: its element there that is compressed most, with a set that holds the element.
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

/// The first pairs of an unsolved complementarity problem: on a ray those that press against each
/// other, else of all.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Element, ElementType, Set};

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
}
