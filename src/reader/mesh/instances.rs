//! Numbers of the program's own for the nodes and elements of instances, whose numbers in the part
//! appear in every instance.

use crate::model::{Instance, Mesh};
use crate::reader::context::Context;
use crate::reader::label::{instance_of, number_of};

/// Replaces the labels of nodes and elements by numbers; those of instances follow the largest one
/// of the others.
pub(super) fn number(mesh: &mut Mesh, cx: &Context) -> Vec<Instance> {
    if cx.deck.instances.is_empty() {
        return Vec::new();
    }
    let mut instances: Vec<Instance> = Vec::new();
    for instance in &cx.deck.instances {
        instances.push(Instance {
            name: instance.name.typed.clone(),
            ..Instance::default()
        });
    }
    for (index, label, first) in renumbered(&mut mesh.node_labels.iter_mut().collect::<Vec<_>>()) {
        if let Some(instance) = instances.get_mut(index) {
            if instance.node_numbers.is_empty() {
                instance.first_node = first;
            }
            instance.node_numbers.push(label);
        }
    }
    let mut labels: Vec<&mut u64> = mesh.elements.iter_mut().map(|e| &mut e.label).collect();
    for (index, label, first) in renumbered(&mut labels) {
        if let Some(instance) = instances.get_mut(index) {
            if instance.element_numbers.is_empty() {
                instance.first_element = first;
            }
            instance.element_numbers.push(label);
        }
    }
    instances
}

/// Gives those of instances numbers of their own; returns instance, number in the part and index of
/// each.
fn renumbered(labels: &mut [&mut u64]) -> Vec<(usize, u64, usize)> {
    let others = labels.iter().filter(|label| instance_of(***label) == 0);
    let mut next = others.map(|label| **label).max().unwrap_or(0);
    let mut found = Vec::new();
    for (index, label) in labels.iter_mut().enumerate() {
        if let Some(instance) = instance_of(**label).checked_sub(1) {
            found.push((instance as usize, number_of(**label), index));
            next += 1;
            **label = next;
        }
    }
    found
}
