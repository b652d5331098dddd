//! Group `/model`: labels, coordinates and sets.

use hdf5::Group;

use super::dataset::{Meaning, constant, group, meaning};
use super::vtkhdf::connectivity;
use crate::model::{Model, Set};

const CONNECTIVITY: Meaning = meaning(
    "node indices of all elements, one element after the other",
    "1",
);
const SET: Meaning = meaning("indices of the members, from 0", "1");

/// Writes the group.
pub(super) fn write(root: &Group, model: &Model) -> hdf5::Result<()> {
    let mesh = &model.mesh;
    let at = group(root, "model")?;
    let text = meaning("node numbers of the deck", "1");
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
    let text = meaning("element numbers of the deck", "1");
    constant(&at, "element_labels", &[labels.len()], &labels, text)?;
    let nodes = connectivity(mesh);
    constant(&at, "connectivity", &[nodes.len()], &nodes, CONNECTIVITY)?;
    write_sets(&group(&at, "node_sets")?, &model.node_sets)?;
    write_sets(&group(&at, "element_sets")?, &model.element_sets)
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
