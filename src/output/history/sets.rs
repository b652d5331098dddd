//! Histories of the node sets and element sets that the deck requests.

use hdf5::Group;

use super::elements::{ElementHistory, create_elements};
use super::nodes::{NodeHistory, create_nodes};
use crate::dynamics::IncrementReport;
use crate::model::Model;
use crate::output::file::{Columns, group};

/// `/history/nodes` and `/history/elements`.
pub(super) struct SetHistories {
    nodes: Vec<NodeHistory>,
    elements: Vec<ElementHistory>,
}

impl SetHistories {
    /// Creates the groups under `/history`, without rows.
    pub fn create(at: &Group, model: &Model) -> hdf5::Result<Self> {
        Ok(SetHistories {
            nodes: create_nodes(&group(at, "nodes")?, model)?,
            elements: create_elements(&group(at, "elements")?, model)?,
        })
    }

    /// Appends a row to each dataset.
    pub fn push(&mut self, report: &IncrementReport) {
        for nodes in &mut self.nodes {
            nodes.push(report);
        }
        for elements in &mut self.elements {
            elements.push(report);
        }
    }

    /// Their datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        for nodes in &mut self.nodes {
            nodes.columns(all);
        }
        for elements in &mut self.elements {
            elements.columns(all);
        }
    }
}
