//! The formulation of every element type, and the volume and mass of a single element. Each shape has a file with its
//! quadrature and mass. See docs/theory/elements.md.

use nalgebra::SMatrix;

use super::MAX_NODES;
use super::chunk::{Chunk, ChunkMaterial, ShapeChunk};
use super::dilatation::Dilatation;
use super::displacement::Displacement;
use super::enhanced_strain::EnhancedStrain;
use super::formulation::Formulation;
use super::reduced::ReducedIntegration;
use super::shapes::{
    IntegratedShape, QuadraticTriangle, Quadrilateral, ReducedSerendipity, Serendipity, Triangle,
};
use crate::materials::{PlaneLaw, Viscosity};
use crate::model::{self, ElementType, Model, Shape, Thickness};

/// Number of points of an element at which the stress of the material is evaluated.
pub(super) fn points(element_type: ElementType) -> usize {
    use model::Formulation::{Reduced, ReducedLinearPressure};
    match (element_type.shape, element_type.formulation) {
        (Shape::Tri3, _) | (Shape::Quad4, Reduced) => 1,
        (Shape::Tri6, _) => 3,
        (Shape::Quad4, _) | (Shape::Quad8, Reduced | ReducedLinearPressure) => 4,
        (Shape::Quad8, _) => 9,
    }
}

/// Indices of elements of one type and section of a model, and their law. The internal variables of the chunk start at
/// `first_variable` among the variables of all elements.
pub(super) struct ChunkParts<'a> {
    pub model: &'a Model,
    pub elements: &'a [usize],
    pub law: PlaneLaw,
    pub first_variable: usize,
}

/// A chunk of elements; the function chooses their formulation once for the whole chunk.
pub(super) fn new_chunk(parts: ChunkParts) -> Box<dyn Chunk> {
    use model::Formulation as Type;
    let element_type = parts.model.mesh.elements[parts.elements[0]].element_type;
    match (element_type.shape, element_type.formulation) {
        (Shape::Tri3, _) => parts.chunk::<Triangle, Displacement, Displacement, 3, 1>(),
        (Shape::Tri6, _) => parts.chunk::<QuadraticTriangle, Displacement, Displacement, 6, 3>(),
        (Shape::Quad4, Type::Enhanced) => {
            parts.chunk::<Quadrilateral, EnhancedStrain<4>, EnhancedStrain<5>, 4, 4>()
        }
        (Shape::Quad4, Type::Reduced) => {
            parts.chunk::<Quadrilateral, ReducedIntegration<2, 4>, ReducedIntegration<6, 5>, 4, 4>()
        }
        (Shape::Quad4, Type::MeanDilatation) => {
            parts.chunk::<Quadrilateral, Dilatation<1>, Dilatation<1>, 4, 4>()
        }
        (Shape::Quad4, _) => parts.chunk::<Quadrilateral, Displacement, Displacement, 4, 4>(),
        (Shape::Quad8, Type::LinearPressure) => {
            parts.of::<Serendipity, Dilatation<3>, 8, 9, true>()
        }
        (Shape::Quad8, Type::ReducedLinearPressure) => {
            parts.of::<ReducedSerendipity, Dilatation<3>, 8, 4, true>()
        }
        (Shape::Quad8, Type::Reduced) => {
            parts.chunk::<ReducedSerendipity, Displacement, Displacement, 8, 4>()
        }
        (Shape::Quad8, _) => parts.chunk::<Serendipity, Displacement, Displacement, 8, 9>(),
    }
}

impl ChunkParts<'_> {
    /// A chunk with a formulation of the plane or of bodies of revolution.
    fn chunk<S, F, G, const N: usize, const P: usize>(self) -> Box<dyn Chunk>
    where
        S: IntegratedShape<N, P> + Send + Sync + 'static,
        F: Formulation<N, P, false>,
        G: Formulation<N, P, true>,
    {
        let first = &self.model.mesh.elements[self.elements[0]];
        match first.element_type.has_all_strains() {
            false => self.of::<S, F, N, P, false>(),
            true => self.of::<S, G, N, P, true>(),
        }
    }

    /// A chunk with a given formulation.
    fn of<S, F, const N: usize, const P: usize, const HOOP: bool>(self) -> Box<dyn Chunk>
    where
        S: IntegratedShape<N, P> + Send + Sync + 'static,
        F: Formulation<N, P, HOOP>,
    {
        let mesh = &self.model.mesh;
        let first_element = &mesh.elements[self.elements[0]];
        let element_type = first_element.element_type;
        let section = &self.model.sections[first_element.section];
        let material = &self.model.materials[section.material];
        let (beta, moduli) = (material.damping.beta, material.law.small_strain());
        let viscosity = Viscosity::of(beta, moduli, element_type.plane);
        let nodes = self
            .elements
            .iter()
            .map(|&e| first(&mesh.elements[e].nodes));
        let nodes: Vec<_> = nodes.collect();
        Box::new(ShapeChunk::<N, P, HOOP, S, F>::new(
            self.elements.to_vec(),
            &nodes,
            &mesh.coordinates,
            Thickness::new(element_type, section.thickness),
            ChunkMaterial {
                law: self.law,
                viscosity,
                expansion: (material.expansion.clone())
                    .map(|expansion| (expansion, self.model.initial_temperature.as_slice())),
                plane: element_type.plane,
            },
            self.first_variable,
        ))
    }
}

/// The nodes of an element as an array; an element of a model has as many as its type.
fn first<const N: usize>(nodes: &[usize]) -> [usize; N] {
    std::array::from_fn(|a| nodes[a])
}

/// Coordinates of the nodes of an element; column a belongs to node a.
fn positions<const N: usize>(nodes: &[usize], x: &[[f64; 2]]) -> SMatrix<f64, 2, N> {
    SMatrix::from_fn(|i, a| x[nodes[a]][i])
}

/// Shape and nodes of an element in the reference configuration, from which its mass is computed.
#[derive(Clone, Copy)]
pub(super) struct Geometry<'a> {
    pub shape: Shape,
    pub nodes: &'a [usize],
    /// Positions of all nodes (length).
    pub coordinates: &'a [[f64; 2]],
    pub thickness: Thickness,
}

impl Geometry<'_> {
    /// Consistent mass per direction, int rho h_a h_b dOmega, eq. (2.7), n x n column by column (mass).
    pub fn mass(&self, density: f64) -> Vec<f64> {
        match self.shape {
            Shape::Tri3 => self.mass_of::<Triangle, _, _>(density),
            Shape::Quad4 => self.mass_of::<Quadrilateral, _, _>(density),
            Shape::Tri6 => self.mass_of::<QuadraticTriangle, _, _>(density),
            Shape::Quad8 => self.mass_of::<Serendipity, _, _>(density),
        }
    }

    /// Share of each node in a uniform force per volume (length^3); entries after its nodes are 0. The shares of the
    /// corners are negative in Q8 and 0 in T6.
    pub fn nodal_volumes(&self) -> [f64; MAX_NODES] {
        match self.shape {
            Shape::Tri3 => self.shares_of::<Triangle, _, _>(),
            Shape::Quad4 => self.shares_of::<Quadrilateral, _, _>(),
            Shape::Tri6 => self.shares_of::<QuadraticTriangle, _, _>(),
            Shape::Quad8 => self.shares_of::<Serendipity, _, _>(),
        }
    }

    fn mass_of<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
        &self,
        density: f64,
    ) -> Vec<f64> {
        let x = positions(self.nodes, self.coordinates);
        (S::mass(&x, self.thickness) * density).as_slice().to_vec()
    }

    fn shares_of<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
        &self,
    ) -> [f64; MAX_NODES] {
        let x = positions(self.nodes, self.coordinates);
        let mut shares = [0.0; MAX_NODES];
        shares[..N].copy_from_slice(S::nodal_volumes(&x, self.thickness).as_slice());
        shares
    }
}

/// Volume and consistent mass of an element.
pub struct ElementInertia {
    /// Volume of the undeformed element (length^3).
    pub volume: f64,
    nodes: Vec<usize>,
    /// Mass per direction, n x n column by column (mass).
    mass: Vec<f64>,
}

impl ElementInertia {
    /// Volume and mass of the element with the given index.
    pub fn new(model: &Model, index: usize) -> Self {
        let element = &model.mesh.elements[index];
        let section = &model.sections[element.section];
        let density = model.materials[section.material].density;
        let geometry = Geometry {
            shape: element.element_type.shape,
            nodes: &element.nodes,
            coordinates: &model.mesh.coordinates,
            thickness: model.thickness(element),
        };
        ElementInertia {
            volume: geometry.nodal_volumes().iter().sum(),
            nodes: element.nodes.to_vec(),
            mass: geometry.mass(density),
        }
    }

    /// Kinetic energy at the velocities `v`, 2 N entries (length/time):
    ///
    /// ```text
    /// sum over a, b of m_ab v_a . v_b / 2
    /// ```
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let columns = self.mass.chunks_exact(self.nodes.len());
        let columns = self.nodes.iter().zip(columns);
        let terms = columns.flat_map(|(&b, column)| {
            let rows = self.nodes.iter().zip(column);
            rows.map(move |(&a, m)| m * (v[2 * a] * v[2 * b] + v[2 * a + 1] * v[2 * b + 1]))
        });
        terms.sum::<f64>() / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Law;
    use crate::model::{Damping, Element, ElementType, Material, Mesh, Section};

    #[test]
    fn volume_and_kinetic_energy_of_a_block_that_turns() {
        // 2 x 1 x 0.5, density 3, mass 3: v = (1, 2) + omega cross (x - c), omega = 4
        let coordinates = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let model = Model {
            mesh: Mesh {
                node_labels: vec![1, 2, 3, 4],
                elements: vec![Element {
                    label: 1,
                    element_type: ElementType::CPE4,
                    nodes: vec![0, 1, 2, 3].into(),
                    section: 0,
                }],
                coordinates: coordinates.clone(),
            },
            materials: vec![Material {
                name: "M".into(),
                law: Law::elastic(1.0, 0.25),
                density: 3.0,
                damping: Damping::default(),
                expansion: None,
            }],
            sections: vec![Section {
                material: 0,
                thickness: 0.5,
            }],
            ..Model::default()
        };
        let inertia = ElementInertia::new(&model, 0);
        assert!((inertia.volume - 1.0).abs() < 1e-15);
        let velocity = |&[x, y]: &[f64; 2]| [1.0 - 4.0 * (y - 0.5), 2.0 + 4.0 * (x - 1.0)];
        let v: Vec<f64> = coordinates.iter().flat_map(velocity).collect();
        // m (1 + 4)/2 + omega^2 m (a^2 + b^2)/12 / 2
        let exact = 3.0 * 5.0 / 2.0 + 16.0 * 3.0 * 5.0 / 12.0 / 2.0;
        assert!((inertia.kinetic_energy(&v) - exact).abs() < 1e-14 * exact);
    }
}
