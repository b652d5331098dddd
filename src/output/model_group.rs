//! Group `/model`: labels, coordinates, sets and bodies with their wave times; checks of names of the deck that become
//! names in the result file.

use std::collections::HashSet;

use hdf5::Group;

use super::column::{Meaning, constant, group};
use super::error::NameError;
use crate::model::{ALL_EXTERIOR, Bodies, Contact, Instance, Mesh, Model, Set};

/// Writes the group.
pub(crate) fn write(root: &Group, model: &Model) -> hdf5::Result<()> {
    let (mesh, at) = (&model.mesh, group(root, "model")?);
    let labels = mesh.node_labels.iter().map(|&label| label as i64);
    let text = "node numbers of the deck; nodes of instances have numbers of the program";
    numbers(&at, "node_labels", labels, text)?;
    let coordinates = mesh.coordinates.as_flattened();
    let shape = [mesh.node_count(), 2];
    constant(&at, "coordinates", &shape, coordinates, COORDINATES)?;
    let labels = mesh.elements.iter().map(|element| element.label as i64);
    let text = "element numbers of the deck; elements of instances have numbers of the program";
    numbers(&at, "element_labels", labels, text)?;
    let text = "node indices of all elements, one element after the other";
    numbers(&at, "connectivity", connectivity(mesh), text)?;
    write_instances(&at, &model.sets.instances)?;
    write_sets(&group(&at, "node_sets")?, &model.sets.nodes)?;
    write_sets(&group(&at, "element_sets")?, &model.sets.elements)?;
    write_bodies(&group(&at, "bodies")?, model)
}

/// Writes a dataset of pure numbers that never changes.
fn numbers(
    at: &Group,
    name: &str,
    values: impl IntoIterator<Item = i64>,
    text: &'static str,
) -> hdf5::Result<()> {
    let values: Vec<i64> = values.into_iter().collect();
    constant(at, name, &[values.len()], &values, ("1", text))
}

/// Node indices of all elements, element after element.
pub(crate) fn connectivity(mesh: &Mesh) -> Vec<i64> {
    let nodes = mesh.elements.iter().flat_map(|element| &element.nodes);
    nodes.map(|&node| node as i64).collect()
}

/// Numbers of bodies, -1 for none.
pub(crate) fn body_numbers(bodies: impl IntoIterator<Item = Option<usize>>) -> Vec<i64> {
    let number = |body: Option<usize>| body.map_or(-1, |body| body as i64);
    bodies.into_iter().map(number).collect()
}

/// The nodes and elements of instances, with their numbers in the part.
fn write_instances(at: &Group, instances: &[Instance]) -> hdf5::Result<()> {
    if instances.is_empty() {
        return Ok(());
    }
    let all = group(at, "instances")?;
    for instance in instances {
        let at = group(&all, &instance.name)?;
        let members = |first: usize, labels: &[u64]| (first as i64..).take(labels.len());
        let (nodes, elements) = (&instance.node_numbers, &instance.element_numbers);
        numbers(&at, "nodes", members(instance.first_node, nodes), MEMBERS)?;
        let text = "numbers of these nodes in the part";
        numbers(&at, "node_numbers", nodes.iter().map(|&n| n as i64), text)?;
        let indices = members(instance.first_element, elements);
        numbers(&at, "elements", indices, MEMBERS)?;
        let text = "numbers of these elements in the part";
        numbers(
            &at,
            "element_numbers",
            elements.iter().map(|&n| n as i64),
            text,
        )?;
    }
    Ok(())
}

fn write_sets(at: &Group, sets: &[Set]) -> hdf5::Result<()> {
    sets.iter().try_for_each(|set| {
        let members = set.members.iter().map(|&member| member as i64);
        numbers(at, &set.name, members, MEMBERS)
    })
}

/// Writes the bodies: members, masses and transit times of waves.
fn write_bodies(at: &Group, model: &Model) -> hdf5::Result<()> {
    let bodies = Bodies::new(&model.mesh);
    let text = "body of each node, -1 for nodes without element";
    numbers(
        at,
        "node",
        body_numbers(bodies.of_node.iter().copied()),
        text,
    )?;
    let of_element = bodies.of_element.iter().map(|&body| body as i64);
    numbers(at, "element", of_element, "body of each element")?;
    let mut mass = vec![0.0; bodies.count];
    for (element, &body) in model.mesh.elements.iter().zip(&bodies.of_element) {
        mass[body] += model.element_mass(element);
    }
    for &(node, of_point) in &model.point_masses {
        if let Some(body) = bodies.of_node[node] {
            mass[body] += of_point;
        }
    }
    for rigid in &model.rigid_bodies {
        if let Some(&element) = rigid.elements.first() {
            let of_points = rigid.masses.iter().map(|(_, mass)| mass);
            mass[bodies.of_element[element]] += of_points.sum::<f64>();
        }
    }
    let times = body_times(model, &bodies);
    let edge: Vec<f64> = times.iter().map(|times| times.edge).collect();
    let body: Vec<f64> = times.iter().map(|times| times.body).collect();
    for (name, values, meaning) in [
        ("mass", mass, MASS),
        ("edge_time", edge, EDGE_TIME),
        ("wave_time", body, WAVE_TIME),
    ] {
        constant(at, name, &[values.len()], &values, meaning)?;
    }
    Ok(())
}

const MEMBERS: &str = "indices of the members, from 0";
const COORDINATES: Meaning = ("length", "reference coordinates");
const MASS: Meaning = (
    "mass",
    "mass of each body, with that of point elements at its nodes",
);
const EDGE_TIME: Meaning = (
    "time",
    "shortest time a longitudinal wave takes along an edge of an element",
);
const WAVE_TIME: Meaning = (
    "time",
    "time a longitudinal wave takes along the longer side of the bounding box",
);

/// Checks the names of all sets and instances, and of surfaces that are in contact or have a reference node.
pub fn check_names(model: &Model) -> Result<(), NameError> {
    for set in &model.sets.nodes {
        check("node set", &set.name)?;
    }
    for set in &model.sets.elements {
        check("element set", &set.name)?;
    }
    for instance in &model.sets.instances {
        check("instance", &instance.name)?;
    }
    for contact in &model.contacts {
        check("surface", &model.surfaces[contact.slave].name)?;
        check("surface", &model.surfaces[contact.master].name)?;
    }
    for body in &model.rigid_bodies {
        check("surface", &body.name)?;
    }
    Ok(())
}

fn check(what: &'static str, name: &str) -> Result<(), NameError> {
    if name.is_empty() || name == "." || name.contains(['/', '\0']) {
        let name = name.to_owned();
        return Err(NameError { what, name });
    }
    Ok(())
}

/// Names of the contacts: `<SLAVE>_<MASTER>`, or `ALL_EXTERIOR` for general contact; a second contact with the same
/// name gets `_2`, and so on.
pub fn contact_names(model: &Model) -> Vec<String> {
    let mut taken = HashSet::new();
    (model.contacts.iter())
        .map(|contact| unique(base_name(model, contact), &mut taken))
        .collect()
}

fn base_name(model: &Model, contact: &Contact) -> String {
    let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i].name);
    match contact.is_self_contact() && slave == ALL_EXTERIOR {
        true => slave.clone(),
        false => format!("{slave}_{master}"),
    }
}

fn unique(base: String, taken: &mut HashSet<String>) -> String {
    let mut name = base.clone();
    let mut number = 2;
    while !taken.insert(name.clone()) {
        name = format!("{base}_{number}");
        number += 1;
    }
    name
}

/// Transit times of longitudinal waves in a body: the time scales for the choice of the increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BodyTimes {
    /// Shortest transit time along an edge of an element.
    pub edge: f64,
    /// Transit time along the longer side of the bounding box of the body, at the wave speed of its slowest element.
    pub body: f64,
}

/// The transit times of every body.
pub(crate) fn body_times(model: &Model, bodies: &Bodies) -> Vec<BodyTimes> {
    let mut edge = vec![f64::INFINITY; bodies.count];
    let mut slowest = vec![f64::INFINITY; bodies.count];
    let mut range = vec![[[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]]; bodies.count];
    for (element, &body) in model.mesh.elements.iter().zip(&bodies.of_element) {
        let (corners, speed) = (model.mesh.corners(element), model.wave_speed(element));
        edge[body] = edge[body].min(model.mesh.shortest_side(element) / speed);
        slowest[body] = slowest[body].min(speed);
        let [lower, upper] = &mut range[body];
        for x in corners {
            for i in 0..2 {
                (lower[i], upper[i]) = (lower[i].min(x[i]), upper[i].max(x[i]));
            }
        }
    }
    let longer = |[lower, upper]: [[f64; 2]; 2]| (upper[0] - lower[0]).max(upper[1] - lower[1]);
    (0..bodies.count)
        .map(|body| BodyTimes {
            edge: edge[body],
            body: longer(range[body]) / slowest[body],
        })
        .collect()
}
