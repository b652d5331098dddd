//! Nodes without mass and their donors: V = P V. Section 2 of docs/theory.md, Redistributed mass.

use super::contact_nodes::contact_nodes;
use super::weights::weights;
use crate::contact::ContactSurfaces;
use crate::model::{Mesh, Model};

/// Rings of elements round a node in which its donors are looked for: the wider where the narrower do
/// not do.
const RINGS: [usize; 2] = [2, 3];

/// A node with the weight of its velocity in that of another.
type Donor = (usize, f64);

/// The redistribution P of the mass of contact surfaces: nodes without mass, whose velocities in the
/// kinetic energy are those of their donors, v_i = sum w_ij v_j, eq. (2.17). Empty with
/// `CONTACT MASS=CONSISTENT`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Redistribution {
    /// Nodes without mass, increasing, with their donors, which have mass.
    massless: Vec<(usize, Vec<Donor>)>,
    /// Nodes of contact surfaces that keep their mass, increasing.
    kept: Vec<usize>,
}

impl Redistribution {
    /// The redistribution of the mass at the given contacts of a model.
    ///
    /// Donors are nodes that cannot be without mass. Nodes that find no weights join them, until all
    /// others do: no answer depends on the order of the nodes.
    pub fn new(model: &Model, contacts: &[ContactSurfaces]) -> Self {
        let around = Neighbours::new(&model.mesh);
        let nodes = contact_nodes(model, contacts);
        let may_be = |&(node, may): &(usize, bool)| may.then_some(node);
        let mut massless: Vec<usize> = nodes.iter().filter_map(may_be).collect();
        loop {
            let find = |&node: &usize| Some((node, around.donors(node, &massless)?));
            let found: Vec<(usize, Vec<Donor>)> = massless.iter().filter_map(find).collect();
            if found.len() == massless.len() {
                let has_mass = |node: &usize| massless.binary_search(node).is_err();
                return Redistribution {
                    kept: nodes.iter().map(|n| n.0).filter(has_mass).collect(),
                    massless: found,
                };
            }
            massless = found.iter().map(|found| found.0).collect();
        }
    }

    /// Nodes without mass, increasing.
    pub fn massless(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.massless.iter().map(|(node, _)| *node)
    }

    /// Nodes of contact surfaces that keep their mass, increasing.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Whether every node has its mass.
    pub fn is_empty(&self) -> bool {
        self.massless.is_empty()
    }

    /// Whether a node is without mass.
    pub fn is_massless(&self, node: usize) -> bool {
        self.donors(node).is_some()
    }

    /// The donors of a node without mass, with their weights.
    pub fn donors(&self, node: usize) -> Option<&[Donor]> {
        let place = self.massless.binary_search_by_key(&node, |(node, _)| *node);
        place.ok().map(|place| self.massless[place].1.as_slice())
    }

    /// v <- P v over all dofs, at the dofs that `moves` names.
    pub fn follow(&self, v: &mut [f64], moves: impl Fn(usize) -> bool) {
        for (node, donors) in &self.massless {
            for i in 0..2 {
                let dof = 2 * node + i;
                if moves(dof) {
                    v[dof] = donors.iter().map(|(j, w)| w * v[2 * j + i]).sum();
                }
            }
        }
    }

    /// Adds a force that acts on the mass of a node to forces on all dofs.
    pub fn add_force(&self, node: usize, force: [f64; 2], all: &mut [f64]) {
        let own = [(node, 1.0)];
        for (j, w) in self.donors(node).unwrap_or(&own) {
            all[2 * j] += w * force[0];
            all[2 * j + 1] += w * force[1];
        }
    }

    /// f <- P^T f over all dofs.
    pub fn hand_on(&self, f: &mut [f64]) {
        for (node, donors) in &self.massless {
            for i in 0..2 {
                let force = std::mem::take(&mut f[2 * node + i]);
                for (j, w) in donors {
                    f[2 * j + i] += w * force;
                }
            }
        }
    }
}

/// Elements round every node.
struct Neighbours<'m> {
    mesh: &'m Mesh,
    elements: Vec<Vec<usize>>,
}

impl<'m> Neighbours<'m> {
    fn new(mesh: &'m Mesh) -> Self {
        let mut elements = vec![Vec::new(); mesh.node_count()];
        for (i, element) in mesh.elements.iter().enumerate() {
            for &node in &element.nodes {
                elements[node].push(i);
            }
        }
        Neighbours { mesh, elements }
    }

    /// Donors of a node among those that are not in `massless` (increasing), with their weights.
    fn donors(&self, node: usize, massless: &[usize]) -> Option<Vec<Donor>> {
        let x = &self.mesh.coordinates;
        RINGS.iter().find_map(|&rings| {
            let has_mass = |node: &usize| massless.binary_search(node).is_err();
            let near: Vec<usize> = self
                .within(node, rings)
                .into_iter()
                .filter(has_mass)
                .collect();
            let at: Vec<[f64; 2]> = near.iter().map(|&donor| x[donor]).collect();
            let weights = weights(x[node], &at)?;
            Some(near.into_iter().zip(weights).collect())
        })
    }

    /// Nodes within some rings of elements round a node, increasing.
    fn within(&self, node: usize, rings: usize) -> Vec<usize> {
        let mut nodes = vec![node];
        for _ in 0..rings {
            let elements = nodes.iter().flat_map(|&node| &self.elements[node]);
            let of_element = |&element: &usize| &self.mesh.elements[element].nodes;
            nodes = elements.flat_map(of_element).copied().collect();
            nodes.sort_unstable();
            nodes.dedup();
        }
        nodes
    }
}
