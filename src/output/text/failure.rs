//! Report of a stopped run: cause, worst place, advice and passes.

use super::format::{counted, scientific};
use super::layout::wrap;
use super::log::pass_table;
use super::strain::inversion_hint;
use crate::dynamics::{Cause, FailedLcp, Failure, Worst};
use crate::lcp::LcpError;
use crate::model::Model;

/// Pairs of a complementarity problem that the text names.
const SHOWN_PAIRS: usize = 4;

/// Increment, time, cause, worst place, halvings and the passes; `u` is the last converged
/// displacement.
pub(crate) fn failure_lines(failure: &Failure, model: &Model, u: &[f64]) -> Vec<String> {
    let time = scientific(failure.time, 6);
    let (increment, step) = (failure.increment, failure.step);
    let where_it_failed = match increment {
        0 => format!("the start of step {step} failed at time {time}"),
        _ => format!("increment {increment} of step {step} failed at time {time}"),
    };
    let what = [where_it_failed, failure.cause.to_string()];
    let mut lines = wrap("stopped", &what);
    lines.extend(failure.worst.as_ref().map(|worst| worst_line(worst, model)));
    lines.extend(place_line(&failure.cause, model, u));
    lines.extend(
        hint(&failure.cause, model)
            .iter()
            .map(|&line| line.to_owned()),
    );
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
        model.mesh.node_labels[worst.node],
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

/// The element or node that the cause names.
fn place_line(cause: &Cause, model: &Model, u: &[f64]) -> Option<String> {
    match *cause {
        Cause::Inverted { element, .. } => Some(format!(
            "element  {} with its centre at {}",
            model.mesh.elements[element].label,
            point(centre(model, element, u)),
        )),
        Cause::Crossed {
            slave,
            segment: [a, b],
            ..
        } => Some(format!(
            "node     {} at {} through the segment {}-{}",
            model.mesh.node_labels[slave],
            point(position(model, slave, u)),
            model.mesh.node_labels[a],
            model.mesh.node_labels[b],
        )),
        Cause::Collapsed { segment: [a, b] } => Some(format!(
            "segment  {}-{} at {}",
            model.mesh.node_labels[a],
            model.mesh.node_labels[b],
            point(position(model, a, u)),
        )),
        Cause::Lcp(ref failed) => Some(pairs_line(failed, model)),
        Cause::Indefinite { node } | Cause::NotFinite { node, .. } => Some(format!(
            "node     {} at {}",
            model.mesh.node_labels[node],
            point(position(model, node, u)),
        )),
        _ => None,
    }
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
    let label = |node: usize| model.mesh.node_labels[node];
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
