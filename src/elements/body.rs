//! Element quantities of all bodies of a model: internal force, tangents, masses, strain energies
//! and strains, by parallel sweeps. Section 2 of docs/theory.md.

use nalgebra::SMatrix;
use rayon::prelude::*;

use super::kinematics::Configuration;
use super::reference::Reference;
use super::solid::{internal_force, largest_strain, mass, strain_energy, tangent};
use super::voigt::{Elasticity, elasticity};
use crate::elements::{quad4, tri3};
use crate::model::{Cell, Model};

/// Elements below which a sweep over them is not worth a second thread.
const PARALLEL_CHUNK: usize = 1024;

/// An element whose deformation gradient has a determinant that is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverted {
    /// Element (index).
    pub element: usize,
    /// Determinant.
    pub determinant: f64,
}

/// The element with the largest principal strain.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strained {
    /// Element (index).
    pub element: usize,
    /// Largest absolute principal value of its Green-Lagrange strain in the plane.
    pub strain: f64,
}

/// Reference geometry of an element.
#[allow(clippy::large_enum_variant)] // most elements are quadrilaterals: kept in one piece for speed
enum Geometry {
    Tri3([usize; 3], Reference<3, 1>),
    Quad4([usize; 4], Reference<4, 4>),
}

/// An element with its elasticity and density.
struct Solid {
    geometry: Geometry,
    c: Elasticity,
    density: f64,
    thickness: f64,
}

/// All elements of a model, ready for integration. Displacements are vectors of 2 N entries.
///
/// Sweeps over the elements run in parallel; their results are added up in the order of the
/// elements, so that they do not depend on the number of threads.
pub struct Elements {
    solids: Vec<Solid>,
    dofs: usize,
}

/// Values of one element in the order of its dofs; 6 or 8 are used.
type ElementVector = [f64; 8];
/// Square matrix of one element, column by column; 36 or 64 entries are used.
type ElementMatrix = [f64; 64];

impl Elements {
    /// Elements of a model.
    pub fn new(model: &Model) -> Self {
        let x = &model.mesh.coordinates;
        let solids = model.mesh.elements.iter().map(|element| {
            let section = &model.sections[element.section];
            let material = &model.materials[section.material];
            let t = section.thickness;
            let geometry = match element.cell {
                Cell::Tri3(n) => Geometry::Tri3(n, tri3(&SMatrix::from_fn(|i, a| x[n[a]][i]), t)),
                Cell::Quad4(n) => {
                    Geometry::Quad4(n, quad4(&SMatrix::from_fn(|i, a| x[n[a]][i]), t))
                }
            };
            let c = elasticity(material, element.plane);
            Solid {
                geometry,
                c,
                density: material.density,
                thickness: t,
            }
        });
        Elements {
            solids: solids.collect(),
            dofs: model.mesh.dof_count(),
        }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.solids.len()
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.solids.is_empty()
    }

    /// Node indices of an element.
    pub fn nodes(&self, element: usize) -> &[usize] {
        self.solids[element].nodes()
    }

    /// Density of an element (mass/length^3).
    pub fn density(&self, element: usize) -> f64 {
        self.solids[element].density
    }

    /// Thickness of an element (length).
    pub fn thickness(&self, element: usize) -> f64 {
        self.solids[element].thickness
    }

    /// Share of each node of an element in a uniform force per volume (length^3); the fourth entry of a
    /// triangle is 0.
    pub fn nodal_volumes(&self, element: usize) -> [f64; 4] {
        let mut shares = [0.0; 4];
        match &self.solids[element].geometry {
            Geometry::Tri3(_, r) => shares[..3].copy_from_slice(r.nodal_volume().as_slice()),
            Geometry::Quad4(_, r) => shares.copy_from_slice(r.nodal_volume().as_slice()),
        }
        shares
    }

    /// Consistent mass of an element per direction, n x n column by column (mass).
    pub fn mass(&self, element: usize) -> Vec<f64> {
        let solid = &self.solids[element];
        match &solid.geometry {
            Geometry::Tri3(_, r) => mass(r, solid.density).as_slice().to_vec(),
            Geometry::Quad4(_, r) => mass(r, solid.density).as_slice().to_vec(),
        }
    }

    /// Strain energy of every element at displacements `u` (force length).
    pub fn strain_energies(&self, u: &[f64]) -> Vec<f64> {
        self.solids
            .par_iter()
            .with_min_len(PARALLEL_CHUNK)
            .map(|solid| match &solid.geometry {
                Geometry::Tri3(n, r) => strain_energy(r, &solid.c, &gather(n, u)),
                Geometry::Quad4(n, r) => strain_energy(r, &solid.c, &gather(n, u)),
            })
            .collect()
    }

    /// The first element with the largest principal strain at displacements `u` (2 N entries).
    pub fn most_strained(&self, u: &[f64]) -> Strained {
        let strains: Vec<f64> = self
            .solids
            .par_iter()
            .with_min_len(PARALLEL_CHUNK)
            .map(|solid| match &solid.geometry {
                Geometry::Tri3(n, r) => largest_strain(r, &gather(n, u)),
                Geometry::Quad4(n, r) => largest_strain(r, &gather(n, u)),
            })
            .collect();
        let mut most = Strained::default();
        for (element, strain) in strains.into_iter().enumerate() {
            if strain > most.strain || strain.is_nan() {
                most = Strained { element, strain };
            }
        }
        most
    }

    /// Internal force F(u), or its energy-momentum form between `start` and `u`, 2 N entries.
    ///
    /// # Errors
    /// The first element that is turned inside out.
    pub fn internal_force(&self, start: Option<&[f64]>, u: &[f64]) -> Result<Vec<f64>, Inverted> {
        let forces: Vec<(ElementVector, f64)> = self
            .solids
            .par_iter()
            .with_min_len(PARALLEL_CHUNK)
            .map(|solid| solid.force(start, u))
            .collect();
        let mut total = vec![0.0; self.dofs];
        for (element, (force, determinant)) in forces.iter().enumerate() {
            if determinant.is_nan() || *determinant <= 0.0 {
                return Err(Inverted {
                    element,
                    determinant: *determinant,
                });
            }
            for (a, &node) in self.solids[element].nodes().iter().enumerate() {
                total[2 * node] += force[2 * a];
                total[2 * node + 1] += force[2 * a + 1];
            }
        }
        Ok(total)
    }

    /// Calls `add(element, k)` with the tangent of every element in order, k being D x D column by
    /// column, in the configuration of [`Self::internal_force`].
    pub fn for_each_tangent(
        &self,
        start: Option<&[f64]>,
        u: &[f64],
        mut add: impl FnMut(usize, &[f64]),
    ) {
        for (chunk, solids) in self.solids.chunks(2 * PARALLEL_CHUNK).enumerate() {
            let tangents: Vec<ElementMatrix> = solids
                .par_iter()
                .with_min_len(PARALLEL_CHUNK)
                .map(|solid| solid.tangent(start, u))
                .collect();
            for (i, k) in tangents.iter().enumerate() {
                let d = 2 * solids[i].nodes().len();
                add(chunk * 2 * PARALLEL_CHUNK + i, &k[..d * d]);
            }
        }
    }

    /// K v with the tangent in the configuration of [`Self::internal_force`], 2 N entries. Elements
    /// at whose nodes `v` is zero cost nothing.
    pub fn tangent_product(&self, start: Option<&[f64]>, u: &[f64], v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        for solid in &self.solids {
            let dofs = || solid.nodes().iter().flat_map(|n| [2 * n, 2 * n + 1]);
            if dofs().all(|dof| v[dof] == 0.0) {
                continue;
            }
            let (k, d) = (solid.tangent(start, u), 2 * solid.nodes().len());
            for (j, column) in dofs().enumerate() {
                for (i, row) in dofs().enumerate() {
                    product[row] += k[j * d + i] * v[column];
                }
            }
        }
        product
    }
}

impl Solid {
    fn nodes(&self) -> &[usize] {
        match &self.geometry {
            Geometry::Tri3(n, _) => n,
            Geometry::Quad4(n, _) => n,
        }
    }

    fn force(&self, start: Option<&[f64]>, u: &[f64]) -> (ElementVector, f64) {
        let mut result = [0.0; 8];
        let determinant = match &self.geometry {
            Geometry::Tri3(n, r) => {
                let (f, det) = internal_force(r, &self.c, &configuration(n, start, u));
                result[..6].copy_from_slice(f.as_slice());
                det
            }
            Geometry::Quad4(n, r) => {
                let (f, det) = internal_force(r, &self.c, &configuration(n, start, u));
                result.copy_from_slice(f.as_slice());
                det
            }
        };
        (result, determinant)
    }

    fn tangent(&self, start: Option<&[f64]>, u: &[f64]) -> ElementMatrix {
        let mut result = [0.0; 64];
        match &self.geometry {
            Geometry::Tri3(n, r) => {
                let k = tangent::<3, 1, 6>(r, &self.c, &configuration(n, start, u));
                result[..36].copy_from_slice(k.as_slice());
            }
            Geometry::Quad4(n, r) => {
                let k = tangent::<4, 4, 8>(r, &self.c, &configuration(n, start, u));
                result.copy_from_slice(k.as_slice());
            }
        }
        result
    }
}

/// Entries of a vector over all dofs at the nodes of an element, 2 x N.
pub(super) fn gather<const N: usize>(nodes: &[usize; N], u: &[f64]) -> SMatrix<f64, 2, N> {
    SMatrix::from_fn(|i, a| u[2 * nodes[a] + i])
}

fn configuration<const N: usize>(
    nodes: &[usize; N],
    start: Option<&[f64]>,
    u: &[f64],
) -> Configuration<N> {
    match start {
        None => Configuration::At(gather(nodes, u)),
        Some(start) => Configuration::Between(gather(nodes, start), gather(nodes, u)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Element, Material, Plane, Section};

    #[test]
    fn the_tangent_product_is_the_change_of_the_internal_force() {
        let mut model = Model::default();
        model.materials.push(Material {
            name: "M".into(),
            young: 100.0,
            poisson: 0.3,
            density: 1.0,
        });
        model.sections.push(Section {
            material: 0,
            thickness: 2.0,
        });
        let mesh = &mut model.mesh;
        mesh.coordinates = vec![[0.0, 0.0], [1.0, 0.1], [1.2, 1.1], [-0.1, 0.9], [0.6, 1.8]];
        for cell in [Cell::Quad4([0, 1, 2, 3]), Cell::Tri3([3, 2, 4])] {
            mesh.elements.push(Element {
                label: 1,
                cell,
                plane: Plane::Strain,
                section: 0,
            });
        }
        let elements = Elements::new(&model);
        let wave = |scale: f64, k: f64| -> Vec<f64> {
            (0..10).map(|i| scale * (k * f64::from(i)).sin()).collect()
        };
        let (u, v) = (wave(0.1, 1.3), wave(1.0, 2.1));
        let force = |t: f64| {
            let moved: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u + t * v).collect();
            elements
                .internal_force(None, &moved)
                .expect("no element inverted")
        };
        let (ahead, behind) = (force(1e-5), force(-1e-5));
        let product = elements.tangent_product(None, &u, &v);
        let largest = product.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        for (i, p) in product.iter().enumerate() {
            let quotient = (ahead[i] - behind[i]) / 2e-5;
            assert!((p - quotient).abs() < 1e-8 * largest, "{i}: {p} {quotient}");
        }
    }
}
