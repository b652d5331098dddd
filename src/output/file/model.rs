//! Group `/model`: labels, coordinates, sets and bodies.

use hdf5::Group;

use super::body_times::body_times;
use super::dataset::{Meaning, constant, group, meaning};
use super::grid::{connectivity, number};
use crate::model::{Bodies, Instance, Model, Set};
use crate::output::text::element_mass;

const CONNECTIVITY: Meaning = meaning(
    "node indices of all elements, one element after the other",
    "1",
);
const SET: Meaning = meaning("indices of the members, from 0", "1");

/// Writes the group.
pub(crate) fn write(root: &Group, model: &Model) -> hdf5::Result<()> {
    let mesh = &model.mesh;
    let at = group(root, "model")?;
    let text = meaning(
        "node numbers: those of the deck, own ones in instances",
        "1",
    );
    constant(
        &at,
        "node_labels",
        &[mesh.node_count()],
        &as_i64(&mesh.node_labels),
        text,
    )?;
    let text = meaning("reference coordinates", "length");
    let coordinates: Vec<f64> = mesh.coordinates.iter().flatten().copied().collect();
    constant(
        &at,
        "coordinates",
        &[mesh.node_count(), 2],
        &coordinates,
        text,
    )?;
    let labels: Vec<i64> = mesh.elements.iter().map(|e| e.label as i64).collect();
    let text = meaning(
        "element numbers: those of the deck, own ones in instances",
        "1",
    );
    constant(&at, "element_labels", &[labels.len()], &labels, text)?;
    let nodes = connectivity(mesh);
    constant(&at, "connectivity", &[nodes.len()], &nodes, CONNECTIVITY)?;
    write_instances(&at, &model.sets.instances)?;
    write_sets(&group(&at, "node_sets")?, &model.sets.nodes)?;
    write_sets(&group(&at, "element_sets")?, &model.sets.elements)?;
    write_bodies(&group(&at, "bodies")?, model)
}

/// The nodes and elements of instances, with their numbers in the part.
fn write_instances(at: &Group, instances: &[Instance]) -> hdf5::Result<()> {
    if instances.is_empty() {
        return Ok(());
    }
    let all = group(at, "instances")?;
    for instance in instances {
        let at = group(&all, &instance.name)?;
        let each = |what: [&str; 2], first: usize, numbers: &[u64], text| {
            let indices: Vec<i64> = (first as i64..).take(numbers.len()).collect();
            constant(&at, what[0], &[indices.len()], &indices, SET)?;
            let text = meaning(text, "1");
            constant(&at, what[1], &[indices.len()], &as_i64(numbers), text)
        };
        let (nodes, elements) = (&instance.node_numbers, &instance.element_numbers);
        let text = "numbers of these nodes in the part";
        each(["nodes", "node_numbers"], instance.first_node, nodes, text)?;
        let text = "numbers of these elements in the part";
        each(
            ["elements", "element_numbers"],
            instance.first_element,
            elements,
            text,
        )?;
    }
    Ok(())
}

/// The bodies: members, masses and transit times of waves.
fn write_bodies(at: &Group, model: &Model) -> hdf5::Result<()> {
    let bodies = Bodies::new(&model.mesh);
    let node: Vec<i64> = bodies.of_node.iter().map(|&body| number(body)).collect();
    let element: Vec<i64> = bodies.of_element.iter().map(|&body| body as i64).collect();
    let mut mass = vec![0.0; bodies.count];
    for (element, &body) in model.mesh.elements.iter().zip(&bodies.of_element) {
        mass[body] += element_mass(model, element);
    }
    let times = body_times(model, &bodies);
    let edge: Vec<f64> = times.iter().map(|times| times.edge).collect();
    let body: Vec<f64> = times.iter().map(|times| times.body).collect();
    let text = meaning("body of each node, -1 for nodes without element", "1");
    constant(at, "node", &[node.len()], &node, text)?;
    let text = meaning("body of each element", "1");
    constant(at, "element", &[element.len()], &element, text)?;
    let each = |name, values: &[f64], text, dimension| {
        constant(at, name, &[values.len()], values, meaning(text, dimension))
    };
    each("mass", &mass, "mass of each body", "mass")?;
    let text = "shortest time a longitudinal wave takes along an edge of an element";
    each("edge_time", &edge, text, "time")?;
    let text = "time a longitudinal wave takes along the longer side of the bounding box";
    each("wave_time", &body, text, "time")
}

fn write_sets(at: &Group, sets: &[Set]) -> hdf5::Result<()> {
    for set in sets {
        let members: Vec<i64> = set.members.iter().map(|&m| m as i64).collect();
        constant(at, &set.name, &[members.len()], &members, SET)?;
    }
    Ok(())
}

fn as_i64(labels: &[u64]) -> Vec<i64> {
    labels.iter().map(|&label| label as i64).collect()
}
