//! Named sets of nodes and elements, and the node sets of the history output (group
//! `/history/nodes` of the result file).

use super::mesh::Set;

/// The sets of a model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedSets {
    /// Node sets; members sorted, without duplicates.
    pub nodes: Vec<Set>,
    /// Element sets; members sorted, without duplicates.
    pub elements: Vec<Set>,
    /// Node sets whose motion and reactions go to the history, each at most once.
    pub history: Vec<HistorySet>,
}

/// A node set in the history: sums and means over the set are always written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HistorySet {
    /// Index into `NamedSets::nodes`.
    pub set: usize,
    /// Whether motion and reactions of every node of the set are written too.
    pub each_node: bool,
}
