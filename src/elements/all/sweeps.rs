//! Sweeps over all elements: internal force, tangents, strain energies and strains, in parallel.
//! Section 2 of docs/theory.md.

use std::sync::{MutexGuard, PoisonError};

use rayon::prelude::*;

use super::elements::{Elements, Space};
use crate::elements::element::AnyChunk;
use crate::elements::recovery::ElementResult;
use crate::elements::solid::{ElementMatrix, Motion, TangentPart};
use crate::elements::sweep::TangentSweep;

/// Elements below which a sweep over them is not worth a second thread.
pub(super) const PARALLEL_CHUNK: usize = 1024;

/// An element whose deformation gradient has a determinant that is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverted {
    /// Element (index).
    pub element: usize,
    /// Determinant.
    pub determinant: f64,
}

/// Internal variables at the end of an increment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Updated {
    /// Internal variables of all points, element by element.
    pub variables: Vec<f64>,
    /// Energy dissipated on the way to them (force length).
    pub dissipated: f64,
}

impl Elements {
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
        let of_chunk = |chunk: &AnyChunk| chunk.evaluate(u);
        let parts = self.parts.par_iter().with_min_len(PARALLEL_CHUNK);
        let parts = parts.map(|part| part.element.evaluate(&part.material(variables), u));
        let parts: Vec<ElementResult> = parts.collect();
        let chunks: Vec<_> = match self.is_worth_threads() {
            true => self.chunks.par_iter().map(of_chunk).collect(),
            false => self.chunks.iter().map(of_chunk).collect(),
        };
        let mut results = vec![ElementResult::default(); self.len()];
        for (element, result) in chunks.into_iter().flatten() {
            results[element] = result;
        }
        for (part, result) in self.parts.iter().zip(parts) {
            results[part.index] = result;
        }
        results
    }

    /// Internal force F at the end of a motion, or its energy-momentum form from start to end, 2 N
    /// entries.
    ///
    /// # Errors
    /// The first element that is turned inside out.
    pub fn internal_force(&self, motion: Motion) -> Result<Vec<f64>, Inverted> {
        let mut force = vec![0.0; self.dofs];
        self.write_internal_force(motion, &mut force)?;
        Ok(force)
    }

    /// Writes [`Self::internal_force`] to `total`, 2 N entries.
    ///
    /// # Errors
    /// The first element that is turned inside out.
    pub fn write_internal_force(&self, motion: Motion, total: &mut [f64]) -> Result<(), Inverted> {
        let Space { forces, .. } = &mut *self.space();
        if !self.sum_chunks(motion) {
            self.chunks.iter().for_each(AnyChunk::clear_sums);
            return Err(self.inverted(motion));
        }
        let parts = self.parts.par_iter().with_min_len(PARALLEL_CHUNK);
        parts
            .map(|part| part.force(motion))
            .collect_into_vec(forces);
        total.fill(0.0);
        self.chunks.iter().for_each(|chunk| chunk.add_sums(total));
        for (part, (force, determinant)) in self.parts.iter().zip(forces) {
            if determinant.is_nan() || *determinant <= 0.0 {
                return Err(self.inverted(motion));
            }
            for (dof, force) in part.element.dofs().zip(force) {
                total[dof] += *force;
            }
        }
        Ok(())
    }

    /// Whether there are threads, and elements enough for them.
    fn is_worth_threads(&self) -> bool {
        rayon::current_num_threads() > 1 && self.len() >= 2 * PARALLEL_CHUNK
    }

    /// Sums up the forces of the elements in chunks. False where one is turned inside out.
    fn sum_chunks(&self, motion: Motion) -> bool {
        let sum = |chunk: &AnyChunk| chunk.sum_forces(motion);
        if self.is_worth_threads() {
            let sums = self.chunks.par_iter().map(sum);
            sums.reduce(|| true, |all, chunk| all && chunk)
        } else {
            self.chunks.iter().all(sum)
        }
    }

    /// The first element that is turned inside out.
    fn inverted(&self, motion: Motion) -> Inverted {
        let of = |element: usize| {
            let material = self.material(element, motion.committed);
            let (_, determinant) = self.element(element).force(&material, motion);
            Inverted {
                element,
                determinant,
            }
        };
        let turned =
            |inverted: &Inverted| inverted.determinant.is_nan() || inverted.determinant <= 0.0;
        let least = |a: Inverted, b: Inverted| match a.determinant <= b.determinant {
            true => a,
            false => b,
        };
        let all = (0..self.len()).map(of);
        let none = Inverted {
            element: 0,
            determinant: f64::INFINITY,
        };
        all.clone()
            .find(turned)
            .unwrap_or_else(|| all.fold(none, least))
    }

    /// Memory of the sweeps, of which there is one at a time.
    fn space(&self) -> MutexGuard<'_, Space> {
        self.space.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls `add(element, k)` with the tangent of every element that is `wanted`, and maybe of others
    /// beside them, or its positive part, k being D x D column by column, in the configuration of
    /// [`Self::internal_force`].
    pub fn for_each_tangent(
        &self,
        motion: Motion,
        part: TangentPart,
        wanted: impl Fn(usize) -> bool + Sync,
        mut add: impl FnMut(usize, &[f64]),
    ) {
        let Space {
            tangents,
            block_tangents,
            ..
        } = &mut *self.space();
        for chunk in &self.chunks {
            let sweep = TangentSweep {
                motion,
                part,
                wanted: &wanted,
            };
            chunk.for_each_tangent(sweep, block_tangents, &mut add);
        }
        for parts in self.parts.chunks(2 * PARALLEL_CHUNK) {
            let sweep = parts.par_iter().with_min_len(PARALLEL_CHUNK);
            let sweep = sweep.map(|element| element.tangent(motion, part));
            sweep.collect_into_vec(tangents);
            for (part, k) in parts.iter().zip(tangents.iter()) {
                let d = 2 * part.element.nodes().len();
                add(part.index, &k[..d * d]);
            }
        }
    }

    /// Tangent of one element in the configuration of [`Self::internal_force`], D x D column by column.
    pub fn tangent(&self, element: usize, motion: Motion) -> Vec<f64> {
        let d = 2 * self.nodes(element).len();
        self.whole_tangent(element, motion)[..d * d].to_vec()
    }

    pub(super) fn whole_tangent(&self, element: usize, motion: Motion) -> ElementMatrix {
        let material = self.material(element, motion.committed);
        self.element(element)
            .tangent(&material, motion, TangentPart::Whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::all::damped::dofs;
    use crate::materials::{Law, NeoHooke};
    use crate::model::{Damping, Element, ElementType, Formulation, Material, Model, Section};

    /// A model of a law on three quadrilaterals and a triangle, with other types of the quadrilaterals.
    fn model(law: Law, quad: ElementType) -> Model {
        let mut model = Model::default();
        model.materials.push(Material {
            name: "M".into(),
            law,
            density: 1.0,
            damping: Damping::default(),
        });
        model.sections.push(Section {
            material: 0,
            thickness: 2.0,
        });
        let mesh = &mut model.mesh;
        mesh.coordinates = vec![
            [0.0, 0.0],
            [1.0, 0.1],
            [1.2, 1.1],
            [-0.1, 0.9],
            [0.6, 1.8],
            [2.1, 0.0],
            [2.0, 1.2],
            [3.0, 0.2],
            [3.1, 0.9],
        ];
        let tri = ElementType {
            plane: quad.plane,
            ..ElementType::CPE3
        };
        let elements = [
            (quad, vec![0, 1, 2, 3]),
            (tri, vec![3, 2, 4]),
            (quad, vec![1, 5, 6, 2]),
            (quad, vec![5, 7, 8, 6]),
        ];
        for (element_type, nodes) in elements {
            mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes: nodes.into(),
                section: 0,
            });
        }
        model
    }

    fn wave(scale: f64, k: f64) -> Vec<f64> {
        (0..18).map(|i| scale * (k * f64::from(i)).sin()).collect()
    }

    fn models() -> [Model; 3] {
        let elastic = Law::elastic(100.0, 0.3);
        let rubber = Law::NeoHooke(NeoHooke {
            c10: 20.0,
            d1: 0.02,
        });
        [
            model(elastic, ElementType::CPS4),
            model(elastic, ElementType::CPE4),
            model(rubber, ElementType::CPE4),
        ]
    }

    fn assert_near(one: &ElementResult, other: &ElementResult) {
        let all = |r: &ElementResult| {
            let [sx, sy, sxy] = r.stress;
            let [ex, ey, exy] = r.strain;
            [
                sx,
                sy,
                sxy,
                r.across,
                ex,
                ey,
                exy,
                r.principal_strain,
                r.energy,
            ]
        };
        let scale = [100.0, 100.0, 100.0, 100.0, 1.0, 1.0, 1.0, 1.0, 100.0];
        for ((a, b), scale) in all(one).iter().zip(all(other)).zip(scale) {
            assert!((a - b).abs() < 1e-13 * scale, "{one:?} {other:?}");
        }
    }

    #[test]
    fn sweeps_over_blocks_are_those_over_single_elements() {
        let (u0, u1) = (wave(0.1, 1.3), wave(0.12, 2.9));
        let between = Motion {
            start: Some(&u0),
            ..Motion::at(&u1, &[])
        };
        for (model, motion) in models()
            .iter()
            .flat_map(|m| [(m, between), (m, Motion::at(&u1, &[]))])
        {
            let elements = Elements::new(model);
            let mut force = vec![0.0; u1.len()];
            for element in 0..elements.len() {
                let material = elements.material(element, &[]);
                let (of_one, _) = elements.element(element).force(&material, motion);
                for (dof, f) in dofs(elements.nodes(element)).zip(of_one) {
                    force[dof] += f;
                }
            }
            let found = elements
                .internal_force(motion)
                .expect("no element inverted");
            let largest = force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
            let near = |a: &f64, b: &f64| (a - b).abs() < 1e-13 * largest;
            assert!(found.iter().zip(&force).all(|(a, b)| near(a, b)));
            for (element, result) in elements.evaluate(&u1, &[]).iter().enumerate() {
                let material = elements.material(element, &[]);
                let one = elements.element(element).evaluate(&material, &u1);
                assert_near(&one, result);
            }
            let mut swept = Vec::new();
            elements.for_each_tangent(
                motion,
                TangentPart::Whole,
                |_| true,
                |element, k| {
                    let one = elements.tangent(element, motion);
                    let largest = one.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
                    assert!(
                        one.iter()
                            .zip(k)
                            .all(|(a, b)| (a - b).abs() < 1e-13 * largest)
                    );
                    assert_eq!(one.len(), k.len());
                    swept.push(element);
                },
            );
            swept.sort_unstable();
            assert_eq!(swept, [0, 1, 2, 3]);
        }
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let mut model = model(Law::elastic(100.0, 0.3), ElementType::CPE4);
        let one = model.mesh.elements.clone();
        (0..1500).for_each(|_| model.mesh.elements.extend(one.clone()));
        let (elements, u) = (Elements::new(&model), wave(0.1, 1.3));
        let sweep = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads").install(|| {
                let motion = Motion::at(&u, &[]);
                let force = elements.internal_force(motion);
                let mut tangents: Vec<f64> = Vec::new();
                elements.for_each_tangent(
                    motion,
                    TangentPart::Whole,
                    |_| true,
                    |_, k| tangents.extend(k),
                );
                (force, tangents)
            })
        };
        let [one, two, three] = [1, 2, 3].map(sweep);
        assert!(one.0.is_ok() && one == two && one == three);
    }

    #[test]
    fn the_first_element_turned_inside_out_is_found() {
        for model in models() {
            // node 8 beyond node 5, node 4 below nodes 2 and 3
            for (node, move_by, element) in [(8, [-2.0, -2.0], 3), (4, [0.0, -2.0], 1)] {
                let mut u = vec![0.0; 18];
                u[2 * node..2 * node + 2].copy_from_slice(&move_by);
                let elements = Elements::new(&model);
                let found = elements.internal_force(Motion::at(&u, &[]));
                let inverted = found.expect_err("an element inverted");
                assert_eq!(inverted.element, element);
                assert!(inverted.determinant <= 0.0);
                u[2 * node] = f64::NAN;
                let found = elements.internal_force(Motion::at(&u, &[]));
                assert!(found.is_err_and(|inverted| inverted.determinant.is_nan()));
            }
        }
    }

    #[test]
    fn an_end_inside_out_is_found_where_halfway_nothing_is() {
        let mean = ElementType {
            formulation: Formulation::MeanDilatation,
            ..ElementType::CPE4
        };
        let with_mean = models().map(|m| model(m.materials[0].law, mean));
        for model in models().iter().chain(&with_mean) {
            // heights become -0.2 of themselves, halfway 0.4
            let coordinates = model.mesh.coordinates.iter();
            let u: Vec<f64> = coordinates.flat_map(|x| [0.0, -1.2 * x[1]]).collect();
            let start = vec![0.0; u.len()];
            let between = Motion {
                start: Some(&start),
                ..Motion::at(&u, &[])
            };
            let found = Elements::new(model).internal_force(between);
            let inverted = found.expect_err("an element inverted");
            assert!((inverted.determinant + 0.2).abs() < 1e-13, "{inverted:?}");
        }
    }

    #[test]
    fn bodies_that_move_as_one_have_no_force() {
        let elements = Elements::new(&model(Law::elastic(100.0, 0.3), ElementType::CPE4));
        let u: Vec<f64> = [0.1, 0.7].repeat(9);
        let force = elements
            .internal_force(Motion::at(&u, &[]))
            .expect("no element inverted");
        assert!(force.iter().all(|&f| f == 0.0));
    }

    #[test]
    fn the_tangent_product_is_the_change_of_the_internal_force() {
        let elements = Elements::new(&model(Law::elastic(100.0, 0.3), ElementType::CPE4));
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
