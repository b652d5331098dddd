//! The mesh of group `/VTKHDF`: points, cells with their connectivity, and the body of each cell.

use hdf5::Group;

use crate::model::{Bodies, Mesh, Model};
use crate::output::file::dataset::{Meaning, constant, meaning};

const BODY: Meaning = meaning("body of the cell, -1 for rigid segments", "1");

/// Cell type of VTK of a rigid segment.
const VTK_LINE: u8 = 3;

/// The reference mesh, and lines between its nodes.
pub(crate) fn write_mesh(grid: &Group, mesh: &Mesh, lines: &[[usize; 2]]) -> hdf5::Result<()> {
    let (nodes, cells) = (mesh.node_count(), mesh.elements.len() + lines.len());
    let mut connectivity = connectivity(mesh);
    connectivity.extend(lines.as_flattened().iter().map(|&node| node as i64));
    let count =
        |name, value: usize, text| constant(grid, name, &[1], &[value as i64], meaning(text, "1"));
    count("NumberOfPoints", nodes, "number of nodes N")?;
    count(
        "NumberOfCells",
        cells,
        "number of elements and rigid segments",
    )?;
    count(
        "NumberOfConnectivityIds",
        connectivity.len(),
        "length of the connectivity",
    )?;
    let points: Vec<f64> = (mesh.coordinates.iter())
        .flat_map(|x| [x[0], x[1], 0.0])
        .collect();
    let text = meaning("reference coordinates", "length");
    constant(grid, "Points", &[nodes, 3], &points, text)?;
    let shape = [connectivity.len()];
    let text = meaning("node indices of all cells, one cell after the other", "1");
    constant(grid, "Connectivity", &shape, &connectivity, text)?;
    let text = meaning("where each cell's nodes start in the connectivity", "1");
    let offsets = offsets(mesh, lines.len());
    constant(grid, "Offsets", &[cells + 1], &offsets, text)?;
    let text = meaning(
        "cell type: 3 rigid segment, 5 triangle, 9 quadrilateral",
        "1",
    );
    let mut types = types(mesh);
    types.resize(cells, VTK_LINE);
    constant(grid, "Types", &[cells], &types, text)
}

/// The body of every cell, `lines` rigid segments being the last.
pub(crate) fn write_bodies(at: &Group, model: &Model, lines: usize) -> hdf5::Result<()> {
    let of_element = Bodies::new(&model.mesh).of_element;
    let elements = of_element.into_iter().map(|body| number(Some(body)));
    let cells: Vec<i64> = elements
        .chain(std::iter::repeat_n(number(None), lines))
        .collect();
    constant(at, "BODY", &[cells.len()], &cells, BODY)
}

/// Node indices of all elements, one element after the other.
pub(crate) fn connectivity(mesh: &Mesh) -> Vec<i64> {
    (mesh.elements.iter())
        .flat_map(|element| &element.nodes)
        .map(|&node| node as i64)
        .collect()
}

/// Start of each element and of each line in the connectivity, and its end.
fn offsets(mesh: &Mesh, lines: usize) -> Vec<i64> {
    let elements = mesh.elements.iter().map(|element| element.nodes.len());
    let mut offsets = vec![0];
    let mut end = 0;
    for nodes in elements.chain(std::iter::repeat_n(2, lines)) {
        end += nodes as i64;
        offsets.push(end);
    }
    offsets
}

fn types(mesh: &Mesh) -> Vec<u8> {
    (mesh.elements.iter())
        .map(|element| element.element_type.topology().vtk_cell)
        .collect()
}

/// Number of a body, -1 for none.
pub(crate) fn number(body: Option<usize>) -> i64 {
    body.map_or(-1, |body| body as i64)
}
