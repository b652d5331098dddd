//! Memory that a run needs, estimated from the mesh, the fill of the factors and the pairs that are near at the start.

use std::collections::BTreeMap;

use super::{InitialGap, PreparedModel};
use crate::linear::factor_entries;
use crate::model::{Bodies, Mesh};

/// Bytes that the program needs before it reads a model.
const PROGRAM: usize = 30 << 20;

/// Bytes of a number or an index.
const WORD: usize = 8;

/// Number of vectors over the dofs in a run: deck, states, results, frames, iterates.
const VECTORS: usize = 70;

/// Words for each entry of the pattern of the mesh: the values of K* and M, and half a word each for the index in the
/// pattern and the place of the entry in the fronts. With contacts an entry needs further words for the sum with
/// contact stiffness, and for the places of M.
const MATRICES: usize = 3;
const CONTACT_MATRICES: usize = 2;

/// Number of sets of factors: one for K*, and one for the lists, fronts and remainders of a factorisation, which need
/// as much memory. With contacts a run also needs the factors of M, for impulses.
const FACTORS: usize = 2;
const CONTACT_FACTORS: usize = 1;

/// Number of dense matrices over the unknowns of the pairs: the compliances of K* and of M, while they are computed.
const COMPLIANCES: usize = 4;

/// Bytes that a run needs, by purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryNeed {
    /// Mesh, states and results.
    pub mesh: u64,
    /// Matrices of the mesh.
    pub matrices: u64,
    /// Their factors.
    pub factors: u64,
    /// Compliance and complementarity problem of the pairs that are near at the start.
    pub contact: u64,
}

impl MemoryNeed {
    /// Estimates the memory that a run of a model needs.
    pub fn new(prepared: &PreparedModel) -> Self {
        let mesh = &prepared.model.mesh;
        let neighbours = neighbours(mesh);
        let dofs = mesh.dof_count();
        // 2 x 2 entries for each pair of nodes
        let entries = 4 * neighbours.iter().map(Vec::len).sum::<usize>();
        let factor = 4 * factor_entries(&neighbours);
        let (matrices, factors) = match prepared.model.contacts.is_empty() {
            true => (MATRICES, FACTORS),
            false => (MATRICES + CONTACT_MATRICES, FACTORS + CONTACT_FACTORS),
        };
        let elements: usize = (mesh.elements.iter())
            .map(|element| (2 * element.nodes.len()).pow(2))
            .sum();
        MemoryNeed {
            mesh: (PROGRAM + VECTORS * dofs * WORD) as u64,
            matrices: ((matrices * entries + elements) * WORD) as u64,
            factors: (factors * factor * WORD) as u64,
            contact: contact(prepared),
        }
    }

    /// Sum of all bytes.
    pub fn total(&self) -> u64 {
        self.mesh + self.matrices + self.factors + self.contact
    }
}

/// Pairs that are near at the start: all pairs, or the pairs between the same bodies.
#[derive(Default)]
struct NearPairs {
    nodes: Vec<usize>,
    pairs: usize,
}

impl NearPairs {
    fn add(&mut self, gap: &InitialGap) {
        self.pairs += 1;
        self.nodes
            .extend([gap.slave, gap.segment[0], gap.segment[1]]);
    }

    /// Bytes of the compliance over the unknowns of the nodes, and of Q of the pairs.
    fn bytes(mut self) -> u64 {
        self.nodes.sort_unstable();
        self.nodes.dedup();
        let (unknowns, rows) = (2 * self.nodes.len(), 2 * self.pairs);
        (COMPLIANCES * unknowns * unknowns * WORD + 2 * rows * rows * WORD) as u64
    }
}

/// Memory for the near pairs. If the memory of the pairs between the same bodies is much less, this memory is the
/// result, since the problems of these pairs are then solved by blocks.
fn contact(prepared: &PreparedModel) -> u64 {
    let bodies = Bodies::new(&prepared.model.mesh).of_node;
    let gaps = prepared.gaps.iter().flatten();
    let (mut all, mut blocks) = (NearPairs::default(), BTreeMap::new());
    for gap in gaps.filter(|gap| gap.gap.abs() <= gap.length) {
        all.add(gap);
        let between = [bodies[gap.slave], bodies[gap.segment[0]]];
        let block: &mut NearPairs = blocks.entry(between).or_default();
        block.add(gap);
    }
    let (all, blocks) = (
        all.bytes(),
        blocks.into_values().map(NearPairs::bytes).sum(),
    );
    if blocks <= all / 4 { blocks } else { all }
}

/// For each node the node itself and the nodes with which elements couple it, in increasing order.
fn neighbours(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut counts = vec![1; mesh.node_count()];
    for nodes in mesh.elements.iter().map(|element| &element.nodes) {
        nodes.iter().for_each(|&node| counts[node] += nodes.len());
    }
    let mut neighbours: Vec<Vec<usize>> = counts.into_iter().map(Vec::with_capacity).collect();
    for (node, neighbours) in neighbours.iter_mut().enumerate() {
        neighbours.push(node);
    }
    for element in &mesh.elements {
        for &node in &element.nodes {
            neighbours[node].extend_from_slice(&element.nodes);
        }
    }
    for nodes in &mut neighbours {
        nodes.sort_unstable();
        nodes.dedup();
    }
    neighbours
}
