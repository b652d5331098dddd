//! Nodes that need no element: reference nodes of rigid surfaces and nodes of equations.

use super::outline::Outline;
use crate::deck::{Card, Text};
use crate::reader::context::Context;
use crate::reader::label::LabelList;
use std::collections::BTreeSet;

/// Labels that may be those of reference nodes or of nodes of equations; `groups` are the node
/// sets of `*NODE` by their names, as compared, with the labels of their members.
pub(super) fn labels(
    outline: &Outline,
    groups: &[(&str, &LabelList)],
    cx: &Context,
) -> BTreeSet<u64> {
    let (mut labels, mut names) = (BTreeSet::new(), BTreeSet::new());
    for field in fields(outline) {
        match cx.is_number(field) {
            true => labels.extend(cx.as_label(field)),
            false => names.extend([field.name_key(), cx.key_of(field)]),
        }
    }
    for (_, members) in groups.iter().filter(|(name, _)| names.contains(*name)) {
        labels.extend(members.iter());
    }
    let is_meant = |set: &&Card| {
        let name = set.value("NSET");
        name.is_some_and(|name| names.contains(&cx.key_of(name)))
    };
    for set in outline.model_cards("NSET").into_iter().filter(is_meant) {
        let count = if set.has("GENERATE") { 2 } else { usize::MAX };
        let numbers = set.rows.iter().flat_map(|row| row.fields().take(count));
        labels.extend(numbers.filter_map(|field| cx.as_label(field)));
    }
    labels
}

/// Fields that name a reference node, or a node or node set of an equation.
fn fields<'a>(outline: &Outline<'a>) -> Vec<Text<'a>> {
    let bodies = outline.model_cards("RIGID BODY").into_iter();
    let equations = outline.model_cards("EQUATION").into_iter();
    // a line of one field is the number of terms
    let rows = equations.flat_map(|card| card.rows.iter());
    let terms = rows.filter(|row| row.get(1).is_some());
    bodies
        .filter_map(|card| card.value("REF NODE"))
        .chain(terms.flat_map(|row| row.fields().step_by(3)))
        .collect()
}
