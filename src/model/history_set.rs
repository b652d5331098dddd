//! Node sets requested for the history output, group `/history/nodes` of the result file.

/// A node set in the history: sums and means over the set are always there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HistorySet {
    /// Index into `Model::node_sets`.
    pub set: usize,
    /// Whether motion and reactions of every node of the set are there too.
    pub each_node: bool,
}
