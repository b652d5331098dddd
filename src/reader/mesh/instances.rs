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
    let first = first_number(mesh.node_labels.iter());
    let labels = mesh.node_labels.iter_mut();
    for (index, instance, number) in renumbered(labels, first) {
        if let Some(instance) = instances.get_mut(instance) {
            if instance.node_numbers.is_empty() {
                instance.first_node = index;
            }
            instance.node_numbers.push(number);
        }
    }
    let first = first_number(mesh.elements.iter().map(|element| &element.label));
    let labels = mesh.elements.iter_mut().map(|element| &mut element.label);
    for (index, instance, number) in renumbered(labels, first) {
        if let Some(instance) = instances.get_mut(instance) {
            if instance.element_numbers.is_empty() {
                instance.first_element = index;
            }
            instance.element_numbers.push(number);
        }
    }
    instances
}

/// The number after the largest one outside instances.
fn first_number<'l>(labels: impl Iterator<Item = &'l u64>) -> u64 {
    let others = labels.filter(|label| instance_of(**label) == 0);
    1 + others.max().copied().unwrap_or(0)
}

/// Gives those of instances numbers of their own from `next` on; returns index, instance and number
/// in the part of each.
fn renumbered<'l>(
    labels: impl Iterator<Item = &'l mut u64>,
    mut next: u64,
) -> impl Iterator<Item = (usize, usize, u64)> {
    labels.enumerate().filter_map(move |(index, label)| {
        let instance = instance_of(*label).checked_sub(1)?;
        let number = number_of(*label);
        *label = next;
        next += 1;
        Some((index, instance as usize, number))
    })
}
