//! Group `/history/nodes`: the node sets that the deck requests.

use hdf5::Group;

use crate::dynamics::IncrementReport;
use crate::model::{HistorySet, Model};
use crate::output::file::{Column, Columns, constant, group, growing, meaning};

/// A vector over the dofs in a report.
type Vector = fn(&IncrementReport) -> &[f64];
/// Name, description and dimension of a dataset, and the vector that it shows.
type Shown = (&'static str, &'static str, &'static str, Vector);

const EACH: [Shown; 3] = [
    ("U", "displacement", "length", |r| &r.state.u),
    ("V", "velocity", "length/time", |r| &r.state.v),
    ("RF", "support reaction", "force", |r| &r.nodal.reaction),
];

const SUMS: [Shown; 3] = [
    ("RF", "sum of the support reactions", "force", |r| {
        &r.nodal.reaction
    }),
    ("CF", "sum of the concentrated loads", "force", |r| {
        &r.nodal.concentrated
    }),
    (
        "CONTACT_FORCE",
        "sum of the contact forces on the nodes",
        "force",
        |r| &r.nodal.contact_force,
    ),
];

const MEANS: [Shown; 3] = [
    ("U", "mean displacement", "length", |r| &r.state.u),
    ("V", "mean velocity", "length/time", |r| &r.state.v),
    ("A", "mean acceleration", "length/time^2", |r| &r.state.a),
];

/// `/history/nodes/<NSET>`.
pub(crate) struct NodeHistory {
    nodes: Vec<usize>,
    /// Vectors of every node; none where only sums are asked for.
    each: Vec<(Column<f64>, Vector)>,
    sums: Vec<(Column<f64>, Vector)>,
    means: Vec<(Column<f64>, Vector)>,
}

impl NodeHistory {
    fn create(at: &Group, model: &Model, asked: &HistorySet) -> hdf5::Result<Self> {
        let nodes = model.sets.nodes[asked.set].members.clone();
        let label = |&node: &usize| model.mesh.node_labels[node] as i64;
        let labels: Vec<i64> = nodes.iter().map(label).collect();
        let text = meaning("node numbers of the deck", "1");
        constant(at, "labels", &[labels.len()], &labels, text)?;
        Ok(NodeHistory {
            each: match asked.each_member {
                true => columns(at, &[nodes.len(), 2], &EACH)?,
                false => Vec::new(),
            },
            sums: columns(&group(at, "sum")?, &[2], &SUMS)?,
            means: columns(&group(at, "mean")?, &[2], &MEANS)?,
            nodes,
        })
    }

    /// Appends a row to each dataset.
    pub fn push(&mut self, report: &IncrementReport) {
        for (column, vector) in &mut self.each {
            column.push(pick(&self.nodes, vector(report)).flatten());
        }
        for (column, vector) in &mut self.sums {
            column.push(sum(&self.nodes, vector(report)));
        }
        let count = self.nodes.len() as f64;
        for (column, vector) in &mut self.means {
            column.push(sum(&self.nodes, vector(report)).map(|sum| sum / count));
        }
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        for table in [&mut self.each, &mut self.sums, &mut self.means] {
            all.extend(growing(table));
        }
    }
}

fn columns(at: &Group, row: &[usize], shown: &[Shown]) -> hdf5::Result<Vec<(Column<f64>, Vector)>> {
    let column = |&(name, text, dimension, vector): &Shown| {
        let column = Column::series(at, name, row, meaning(text, dimension))?;
        Ok((column, vector))
    };
    shown.iter().map(column).collect()
}

/// The histories of the requested sets; an empty set has none.
pub(crate) fn create_nodes(at: &Group, model: &Model) -> hdf5::Result<Vec<NodeHistory>> {
    let mut requested: Vec<&HistorySet> = model.sets.history.iter().collect();
    requested.sort_unstable_by_key(|asked| asked.set);
    (requested.iter())
        .map(|asked| (asked, &model.sets.nodes[asked.set]))
        .filter(|(_, set)| !set.members.is_empty())
        .map(|(asked, set)| NodeHistory::create(&group(at, &set.name)?, model, asked))
        .collect()
}

/// Both components of `values` at each of the `nodes`.
fn pick<'a>(nodes: &'a [usize], values: &'a [f64]) -> impl Iterator<Item = [f64; 2]> + 'a {
    (nodes.iter()).map(|&node| [values[2 * node], values[2 * node + 1]])
}

/// Sum of `values` over the `nodes`.
fn sum(nodes: &[usize], values: &[f64]) -> [f64; 2] {
    pick(nodes, values).fold([0.0; 2], |[x, y], v| [x + v[0], y + v[1]])
}
