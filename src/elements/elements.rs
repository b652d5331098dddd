//! Element quantities of all bodies of a model: internal force, tangents, masses, strain energies
//! and strains, by parallel sweeps. Section 2 of docs/theory.md.

use rayon::prelude::*;

use super::damping::ElementDamping;
use super::element::AnyElement;
use super::recovery::ElementResult;
use super::solid::{ElementMatrix, ElementVector, Increment, MAX_NODES, Motion, TangentPart};
use crate::materials::{Committed, ConstitutiveLaw, PlaneLaw};
use crate::model::Model;
use std::ops::Range;

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

/// An element with its material, density and thickness.
struct Part {
    element: AnyElement,
    law: PlaneLaw,
    /// Place of the internal variables of its points among those of all elements.
    variables: Range<usize>,
    density: f64,
    thickness: f64,
}

/// All elements of a model, ready for integration. Displacements are vectors of 2 N entries.
///
/// Sweeps over the elements run in parallel; their results are added up in the order of the
/// elements, so that they do not depend on the number of threads.
pub struct Elements {
    parts: Vec<Part>,
    /// Elements with damping, increasing.
    damped: Vec<(usize, ElementDamping)>,
    dofs: usize,
}

/// Internal variables at the end of an increment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Updated {
    /// Internal variables of all points, element by element.
    pub variables: Vec<f64>,
    /// Energy dissipated on the way to them (force length).
    pub dissipated: f64,
}

impl Part {
    /// The material with its committed variables among those of all elements.
    fn material<'a>(&'a self, committed: &'a [f64]) -> Committed<'a> {
        Committed::new(&self.law, &committed[self.variables.clone()])
    }

    fn force(&self, motion: Motion) -> (ElementVector, f64) {
        self.element.force(&self.material(motion.committed), motion)
    }

    fn tangent(&self, motion: Motion, part: TangentPart) -> ElementMatrix {
        self.element
            .tangent(&self.material(motion.committed), motion, part)
    }
}

impl Elements {
    /// Elements of a model.
    pub fn new(model: &Model) -> Self {
        let x = &model.mesh.coordinates;
        let mut variables = 0;
        let (mut parts, mut damped) = (Vec::new(), Vec::new());
        for (index, element) in model.mesh.elements.iter().enumerate() {
            let section = &model.sections[element.section];
            let material = &model.materials[section.material];
            let plane = element.element_type.plane;
            let law = material.law.in_plane(plane);
            let element = AnyElement::new(element, x, section.thickness);
            damped.extend(ElementDamping::new(&element, material, plane).map(|d| (index, d)));
            let first = variables;
            variables += element.points() * law.variables();
            parts.push(Part {
                element,
                law,
                variables: first..variables,
                density: material.density,
                thickness: section.thickness,
            });
        }
        Elements {
            parts,
            damped,
            dofs: model.mesh.dof_count(),
        }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Node indices of an element.
    pub fn nodes(&self, element: usize) -> &[usize] {
        self.parts[element].element.nodes()
    }

    /// Density of an element (mass/length^3).
    pub fn density(&self, element: usize) -> f64 {
        self.parts[element].density
    }

    /// Thickness of an element (length).
    pub fn thickness(&self, element: usize) -> f64 {
        self.parts[element].thickness
    }

    /// Share of each node of an element in a uniform force per volume (length^3); entries beyond its
    /// nodes are 0.
    pub fn nodal_volumes(&self, element: usize) -> [f64; MAX_NODES] {
        self.parts[element].element.nodal_volumes()
    }

    /// Consistent mass of an element per direction, n x n column by column (mass).
    pub fn mass(&self, element: usize) -> Vec<f64> {
        let part = &self.parts[element];
        part.element.mass(part.density)
    }

    /// Internal variables of all points before the first increment, element by element: zero.
    pub fn initial_variables(&self) -> Vec<f64> {
        vec![0.0; self.parts.last().map_or(0, |part| part.variables.end)]
    }

    /// Internal variables at the end of an increment with displacements `u`. `committed` stays as it
    /// is: the increment commits or drops what this returns.
    pub fn update(&self, u: &[f64], committed: &[f64]) -> Updated {
        let mut updated = Updated {
            variables: committed.to_vec(),
            dissipated: 0.0,
        };
        for part in self.parts.iter().filter(|part| !part.variables.is_empty()) {
            let variables = &mut updated.variables[part.variables.clone()];
            updated.dissipated += part.element.update(&part.material(committed), u, variables);
        }
        updated
    }

    /// Strain energy, mean stress and mean strain of every element at displacements `u`, with the
    /// internal variables there.
    pub fn evaluate(&self, u: &[f64], variables: &[f64]) -> Vec<ElementResult> {
        self.parts
            .par_iter()
            .with_min_len(PARALLEL_CHUNK)
            .map(|part| part.element.evaluate(&part.material(variables), u))
            .collect()
    }

    /// Internal force F at the end of a motion, or its energy-momentum form from start to end, 2 N
    /// entries.
    ///
    /// # Errors
    /// The first element that is turned inside out.
    pub fn internal_force(&self, motion: Motion) -> Result<Vec<f64>, Inverted> {
        let forces: Vec<(ElementVector, f64)> = self
            .parts
            .par_iter()
            .with_min_len(PARALLEL_CHUNK)
            .map(|part| part.force(motion))
            .collect();
        let mut total = vec![0.0; self.dofs];
        for (element, (force, determinant)) in forces.iter().enumerate() {
            if determinant.is_nan() || *determinant <= 0.0 {
                return Err(Inverted {
                    element,
                    determinant: *determinant,
                });
            }
            for (a, &node) in self.parts[element].element.nodes().iter().enumerate() {
                total[2 * node] += force[2 * a];
                total[2 * node + 1] += force[2 * a + 1];
            }
        }
        Ok(total)
    }

    /// Calls `add(element, k)` with the tangent of every element in order, or its positive part, k being
    /// D x D column by column, in the configuration of [`Self::internal_force`].
    pub fn for_each_tangent(
        &self,
        motion: Motion,
        part: TangentPart,
        mut add: impl FnMut(usize, &[f64]),
    ) {
        for (chunk, parts) in self.parts.chunks(2 * PARALLEL_CHUNK).enumerate() {
            let tangents: Vec<ElementMatrix> = parts
                .par_iter()
                .with_min_len(PARALLEL_CHUNK)
                .map(|element| element.tangent(motion, part))
                .collect();
            for (i, k) in tangents.iter().enumerate() {
                let d = 2 * parts[i].element.nodes().len();
                add(chunk * 2 * PARALLEL_CHUNK + i, &k[..d * d]);
            }
        }
    }

    /// Tangent of one element in the configuration of [`Self::internal_force`], D x D column by column.
    pub fn tangent(&self, element: usize, motion: Motion) -> Vec<f64> {
        let part = &self.parts[element];
        let d = 2 * part.element.nodes().len();
        part.tangent(motion, TangentPart::Whole)[..d * d].to_vec()
    }

    /// K v with the tangent in the configuration of [`Self::internal_force`], 2 N entries. Elements
    /// at whose nodes `v` is zero cost nothing.
    pub fn tangent_product(&self, motion: Motion, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        for part in &self.parts {
            if part.element.dofs().any(|dof| v[dof] != 0.0) {
                let k = part.tangent(motion, TangentPart::Whole);
                add_product(&part.element, &k, v, &mut product);
            }
        }
        product
    }

    /// Whether any element is damped.
    pub fn has_damping(&self) -> bool {
        !self.damped.is_empty()
    }

    /// Force of damping F_d in an increment of length `dt` with the displacement increment `d`, eq.
    /// (4.22), 2 N entries.
    pub fn damping_force(&self, increment: Increment, d: &[f64], dt: f64) -> Vec<f64> {
        let impulses = self.of_damped(|element, damping| damping.impulse(element, increment, d));
        let mut force = self.sum_of_damped(&impulses);
        force.iter_mut().for_each(|f| *f /= dt);
        force
    }

    /// Impulse that mass-proportional damping takes in a displacement increment, alpha M d, 2 N entries
    /// (force time).
    pub fn mass_damping_impulse(&self, d: &[f64]) -> Vec<f64> {
        self.sum_of_damped(&self.of_damped(|element, damping| damping.mass_impulse(element, d)))
    }

    /// Energy d.F_d that damping dissipates in an increment of length `dt` with the displacement
    /// increment `d`, eq. (4.23) (force length).
    pub fn damping_dissipation(&self, increment: Increment, d: &[f64], dt: f64) -> f64 {
        let work = |element: &_, damping: &ElementDamping| damping.work(element, increment, d);
        self.of_damped(work).iter().sum::<f64>() / dt
    }

    /// Calls `add(element, c)` with the damping matrix of every damped element in order, eq. (4.24), or
    /// its positive part, c being D x D column by column (force time/length).
    pub fn for_each_damping(
        &self,
        increment: Increment,
        part: TangentPart,
        mut add: impl FnMut(usize, &[f64]),
    ) {
        let of = |element: &_, damping: &ElementDamping| damping.matrix(element, increment, part);
        for ((element, _), c) in self.damped.iter().zip(self.of_damped(of)) {
            let d = 2 * self.nodes(*element).len();
            add(*element, &c[..d * d]);
        }
    }

    /// Cd v with the damping matrix, 2 N entries.
    pub fn damping_product(&self, increment: Increment, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        for (element, damping) in &self.damped {
            let element = &self.parts[*element].element;
            let c = damping.matrix(element, increment, TangentPart::Whole);
            add_product(element, &c, v, &mut product);
        }
        product
    }

    /// A quantity of all damped elements.
    fn of_damped<T: Send>(&self, of: impl Fn(&AnyElement, &ElementDamping) -> T + Sync) -> Vec<T> {
        let damped = self.damped.par_iter().with_min_len(PARALLEL_CHUNK);
        let all = damped.map(|(element, damping)| of(&self.parts[*element].element, damping));
        all.collect()
    }

    /// Sum of vectors of the damped elements, 2 N entries.
    fn sum_of_damped(&self, vectors: &[ElementVector]) -> Vec<f64> {
        let mut sum = vec![0.0; self.dofs];
        for ((element, _), vector) in self.damped.iter().zip(vectors) {
            for (dof, value) in self.parts[*element].element.dofs().zip(vector) {
                sum[dof] += value;
            }
        }
        sum
    }
}

/// Adds k v to a product over all dofs, k being a matrix of the element.
fn add_product(element: &AnyElement, k: &ElementMatrix, v: &[f64], product: &mut [f64]) {
    let d = 2 * element.nodes().len();
    for (j, column) in element.dofs().enumerate() {
        for (i, row) in element.dofs().enumerate() {
            product[row] += k[j * d + i] * v[column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Law;
    use crate::model::{Damping, Element, ElementType, Material, Section};

    #[test]
    fn the_tangent_product_is_the_change_of_the_internal_force() {
        let mut model = Model::default();
        model.materials.push(Material {
            name: "M".into(),
            law: Law::elastic(100.0, 0.3),
            density: 1.0,
            damping: Damping::default(),
        });
        model.sections.push(Section {
            material: 0,
            thickness: 2.0,
        });
        let mesh = &mut model.mesh;
        mesh.coordinates = vec![[0.0, 0.0], [1.0, 0.1], [1.2, 1.1], [-0.1, 0.9], [0.6, 1.8]];
        let elements = [
            (ElementType::CPE4, vec![0, 1, 2, 3]),
            (ElementType::CPE3, vec![3, 2, 4]),
        ];
        for (element_type, nodes) in elements {
            mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes,
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
                .internal_force(Motion::at(&moved, &[]))
                .expect("no element inverted")
        };
        let (ahead, behind) = (force(1e-5), force(-1e-5));
        let product = elements.tangent_product(Motion::at(&u, &[]), &v);
        let largest = product.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        for (i, p) in product.iter().enumerate() {
            let quotient = (ahead[i] - behind[i]) / 2e-5;
            assert!((p - quotient).abs() < 1e-8 * largest, "{i}: {p} {quotient}");
        }
    }
}
