//! Global mass matrices over the nodes and over the unknowns.
//! See docs/theory/elements.md.

use super::turning::TurningBody;
use super::unknowns::Unknowns;
use crate::elements::Elements;
use crate::linear::{Assembled, NodalMatrix, Transformation};
use crate::prepare::Redistribution;

/// Mass matrix M, the same for both directions: consistent, or redistributed at contact surfaces.
/// Nodal masses M 1: the mass that every node carries.
pub(crate) struct Mass {
    nodal: NodalMatrix,
    /// Nodal masses M 1: the mass that every node carries.
    pub shares: Vec<f64>,
}

impl Mass {
    /// Mass of all elements of a model, and of its bodies that turn, with `nodes` nodes.
    pub fn new(
        (elements, bodies): (&Elements, &[TurningBody]),
        redistribution: &Redistribution,
        nodes: usize,
    ) -> Self {
        let nodal = nodal_mass((elements, bodies), redistribution, nodes);
        let mut mass = Mass {
            nodal: NodalMatrix::new(nodal.matrix()),
            shares: Vec::new(),
        };
        let shares = mass.times(&vec![1.0; 2 * nodes]);
        mass.shares = shares.into_iter().step_by(2).collect();
        mass
    }

    /// The product M v for a vector v over all dofs.
    pub fn times(&self, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; v.len()];
        self.write_product(v, &mut product);
        product
    }

    /// Writes the product M v for a vector v over all dofs.
    pub fn write_product(&self, v: &[f64], product: &mut [f64]) {
        self.nodal.write_product(v, product);
    }
}

/// Mass matrix M over the nodes of a model with `nodes` nodes.
fn nodal_mass(
    (elements, bodies): (&Elements, &[TurningBody]),
    redistribution: &Redistribution,
    nodes: usize,
) -> Assembled {
    let masses = Masses::new((elements, bodies), redistribution);
    let mut nodal = Assembled::new(&Transformation::identity(nodes), &masses.nodes);
    for (list, m) in &masses.of_elements {
        nodal.add(*list, m, 1.0);
    }
    nodal
}

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Masses of elements, point masses and masses of bodies that turn, over the nodes that carry them.
pub(super) struct Masses {
    /// Lists of nodes, in this order: for every element (empty for a rigid element), spring and dashpot its nodes; for
    /// each element with massless nodes the nodes that carry its mass; for masses at nodes the nodes that carry these
    /// masses; for every body that turns its centre and angle.
    nodes: Vec<Vec<usize>>,
    /// For every mass the number of its list, and its matrix, n x n column by column.
    of_elements: Vec<(usize, Vec<f64>)>,
}

impl Masses {
    pub fn new(
        (elements, bodies): (&Elements, &[TurningBody]),
        redistribution: &Redistribution,
    ) -> Self {
        let nodes = elements.connected().enumerate().map(|(place, nodes)| {
            match place < elements.len() && elements.is_rigid(place) {
                true => Vec::new(),
                false => nodes.to_vec(),
            }
        });
        let mut masses = Masses {
            nodes: nodes.collect(),
            of_elements: Vec::with_capacity(elements.len()),
        };
        for element in (0..elements.len()).filter(|&e| !elements.is_rigid(e)) {
            let (own, m) = (elements.nodes(element), elements.mass(element));
            if own.iter().any(|&node| redistribution.is_massless(node)) {
                let (carriers, m) = carried(own, &m, redistribution);
                masses.of_elements.push((masses.nodes.len(), m));
                masses.nodes.push(carriers);
            } else {
                masses.of_elements.push((element, m));
            }
        }
        for &(node, m) in elements.point_masses() {
            let (carriers, m) = carried(&[node], &[m], redistribution);
            masses.of_elements.push((masses.nodes.len(), m));
            masses.nodes.push(carriers);
        }
        // m at the centre, I/L² at s = L c
        let has_inertia = |body: &&TurningBody| body.mass > 0.0 || body.inertia > 0.0;
        for body in bodies.iter().filter(has_inertia) {
            let of_angle = body.inertia / (body.length * body.length);
            for (node, m) in [(body.centre, body.mass), (body.centre + 1, of_angle)] {
                masses.of_elements.push((masses.nodes.len(), vec![m]));
                masses.nodes.push(vec![node]);
            }
        }
        masses
    }

    /// Adds the masses to a matrix over unknowns that was made with their lists.
    pub fn add_to(&self, mass: &mut Assembled) {
        for (list, m) in &self.of_elements {
            let n = self.nodes[*list].len();
            mass.add(*list, &in_both_directions(m, n), 1.0);
        }
    }
}

/// The nodes with mass that carry an element's mass `m` over its nodes `own`, and the matrix P_e^T M_e P_e, eq. (2.17),
/// over these nodes.
fn carried(own: &[usize], m: &[f64], redistribution: &Redistribution) -> (Vec<usize>, Vec<f64>) {
    let row = |node: &usize| match redistribution.donors(*node) {
        Some(donors) => donors.to_vec(),
        None => vec![(*node, 1.0)],
    };
    let rows: Vec<Vec<(usize, f64)>> = own.iter().map(row).collect();
    let mut carriers: Vec<usize> = rows.iter().flatten().map(|term| term.0).collect();
    carriers.sort_unstable();
    carriers.dedup();
    let place = |node: usize| carriers.partition_point(|&carrier| carrier < node);
    let (n, size) = (own.len(), carriers.len());
    let mut carried = vec![0.0; size * size];
    for (b, column) in rows.iter().enumerate() {
        for (a, row) in rows.iter().enumerate() {
            for &(j, cj) in column {
                for &(i, ci) in row {
                    carried[place(j) * size + place(i)] += ci * m[b * n + a] * cj;
                }
            }
        }
    }
    (carriers, carried)
}

/// Mass matrix T^T M T over the unknowns of a step. The pattern of the mass matrix includes the pattern of the
/// elements, which come first in the assembly.
pub(super) fn unknown_mass(masses: &Masses, unknowns: &Unknowns) -> Assembled {
    let of_node = |&node: &usize| [2 * node, 2 * node + 1];
    let of_list = |nodes: &Vec<usize>| nodes.iter().flat_map(of_node).collect();
    let lists: Vec<Vec<usize>> = masses.nodes.iter().map(of_list).collect();
    let mut mass = Assembled::new(&unknowns.map, &lists);
    masses.add_to(&mut mass);
    mass
}

/// Expands a mass over nodes, n x n, to both directions of their dofs, 2n x 2n; both matrices are stored column by
/// column.
fn in_both_directions(m: &[f64], n: usize) -> Vec<f64> {
    let d = 2 * n;
    let mut both = vec![0.0; d * d];
    for a in 0..n {
        for b in 0..n {
            both[2 * b * d + 2 * a] = m[b * n + a];
            both[(2 * b + 1) * d + 2 * a + 1] = m[b * n + a];
        }
    }
    both
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::redistribution_tests::{block, redistribution};
    use nalgebra::DMatrix;

    /// Consistent and redistributed mass of a block with a hole, and the coordinates of its nodes.
    fn masses(is_triangular: fn(usize, usize) -> bool) -> ([DMatrix<f64>; 2], Vec<[f64; 2]>) {
        let has = |i: usize, j: usize| !((4..6).contains(&i) && (4..6).contains(&j));
        let model = block([10, 9], is_triangular, has);
        let (elements, nodes) = (Elements::new(&model), model.mesh.node_count());
        let masses = [Redistribution::default(), redistribution(&model)].map(|redistribution| {
            let mass = nodal_mass((&elements, &[]), &redistribution, nodes);
            let mut dense = DMatrix::zeros(nodes, nodes);
            for k in 0..nodes {
                let column = mass.matrix().column(k);
                column.for_each(|(row, value)| dense[(row, k)] = value);
            }
            dense
        });
        (masses, model.mesh.coordinates)
    }

    #[test]
    fn redistribution_keeps_mass_centre_and_inertia() {
        for is_triangular in [|_, _| false, |_, _| true, |i, j| (i * j) % 3 == 1] {
            let ([consistent, redistributed], x) = masses(is_triangular);
            let affine = [|_| 1.0, |x: [f64; 2]| x[0], |x: [f64; 2]| x[1]];
            for f in affine {
                for g in affine {
                    let moment = |m: &DMatrix<f64>| -> f64 {
                        let terms = (0..x.len()).flat_map(|i| (0..x.len()).map(move |j| (i, j)));
                        terms.map(|(i, j)| f(x[i]) * m[(i, j)] * g(x[j])).sum()
                    };
                    let [before, after] = [moment(&consistent), moment(&redistributed)];
                    let error = (after - before).abs() / before.abs();
                    assert!(error < 1e-14, "{before} {after}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn redistributed_mass_is_positive_semidefinite_and_zero_at_the_skin() {
        let ([consistent, redistributed], _) = masses(|i, j| (i + j) % 2 == 0);
        let eigenvalues = redistributed.clone().symmetric_eigenvalues();
        let largest = eigenvalues.max();
        assert!(
            eigenvalues.min() > -1e-15 * largest,
            "{}",
            eigenvalues.min()
        );
        let empty = (0..110)
            .filter(|&i| redistributed.column(i).amax() == 0.0)
            .count();
        // all of the outer edge, and the node inside the hole that has no elements
        assert_eq!(empty, 38 + 1);
        assert!((consistent.trace() - redistributed.trace()).abs() > 1e-3 * largest);
    }
}
