//! The element types behind one enum, chunks of elements of one type behind another, volume and mass of a single
//! element. A shape has one file with its quadrature and mass. Section 2 of docs/theory.md.

use nalgebra::SMatrix;

use super::block::Shape as _;
use super::chunk::{BlockTangents, Chunk, TangentSweep};
use super::formulation::ElementResult;
use super::shapes::{Quad4, Quad4MeanDilatation, Quadrilateral, Tri3, Triangle};
use super::solid::{ElementMatrix, ElementVector, MAX_NODES, Motion, TangentPart};
use crate::materials::{Committed, ConstitutiveLaw, PlaneLaw, StressAtPoints};
use crate::model::{ElementType, Formulation, Mesh, Model, Shape};

/// An element of any type.
#[derive(Clone, Copy)]
#[allow(clippy::large_enum_variant)] // most elements are quadrilaterals: kept in one piece for speed
pub(super) enum AnyElement {
    /// T3, displacement formulation.
    Tri3(Tri3),
    /// Q4, displacement formulation.
    Quad4(Quad4),
    /// Q4, mean dilatation.
    Quad4MeanDilatation(Quad4MeanDilatation),
}

/// Evaluates an expression for the element in an [`AnyElement`], whatever its type.
macro_rules! with_element {
    ($any:expr, $element:ident => $value:expr) => {
        match $any {
            AnyElement::Tri3($element) => $value,
            AnyElement::Quad4($element) => $value,
            AnyElement::Quad4MeanDilatation($element) => $value,
        }
    };
}

impl AnyElement {
    /// The element of the model between nodes at the coordinates `x`, of thickness `t`.
    pub fn new(element: &crate::model::Element, x: &[[f64; 2]], t: f64) -> Self {
        let nodes = &element.nodes;
        let ElementType {
            shape, formulation, ..
        } = element.element_type;
        match (shape, formulation) {
            (Shape::Tri3, _) => {
                let nodes = first(nodes);
                Self::Tri3(Tri3::new(nodes, Triangle::reference(&corners(nodes, x), t)))
            }
            (Shape::Quad4, formulation) => {
                let nodes = first(nodes);
                let reference = Quadrilateral::reference(&corners(nodes, x), t);
                match formulation {
                    Formulation::Displacement => Self::Quad4(Quad4::new(nodes, reference)),
                    Formulation::MeanDilatation => {
                        Self::Quad4MeanDilatation(Quad4MeanDilatation::new(nodes, reference))
                    }
                }
            }
        }
    }

    /// Node indices, counter-clockwise.
    pub fn nodes(&self) -> &[usize] {
        with_element!(self, element => element.nodes())
    }

    /// Dofs of the nodes, in the order of element vectors.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes().iter().flat_map(|n| [2 * n, 2 * n + 1])
    }

    /// Number of integration points.
    pub fn points(&self) -> usize {
        with_element!(self, element => element.points())
    }

    /// Share of each node in a uniform force per volume (length^3).
    pub fn nodal_volumes(&self) -> [f64; MAX_NODES] {
        with_element!(self, element => element.nodal_volumes())
    }

    /// Consistent mass per direction, int rho h_a h_b dOmega, eq. (2.7), n x n column by column (mass).
    pub fn mass(&self, density: f64) -> Vec<f64> {
        match self {
            Self::Tri3(e) => (Triangle::mass(e.reference()) * density)
                .as_slice()
                .to_vec(),
            Self::Quad4(e) => (Quadrilateral::mass(e.reference()) * density)
                .as_slice()
                .to_vec(),
            Self::Quad4MeanDilatation(e) => (Quadrilateral::mass(e.reference()) * density)
                .as_slice()
                .to_vec(),
        }
    }

    /// Internal force with the smallest determinant of the deformation gradient.
    pub fn force(&self, material: &impl StressAtPoints, motion: Motion) -> (ElementVector, f64) {
        with_element!(self, element => element.force(material, motion))
    }

    /// Tangent, or its positive part.
    pub fn tangent(
        &self,
        material: &impl StressAtPoints,
        motion: Motion,
        part: TangentPart,
    ) -> ElementMatrix {
        match part {
            TangentPart::Whole => with_element!(self, e => e.tangent(material, motion)),
            TangentPart::Positive => with_element!(self, e => e.positive_tangent(material, motion)),
        }
    }

    /// Work of the stress on the strains of a motion from its start to its end (force length).
    pub fn work(&self, material: &impl StressAtPoints, motion: Motion) -> f64 {
        with_element!(self, element => element.work(material, motion))
    }

    /// Strain energy, stress and strain at displacements `u`.
    pub fn evaluate(&self, material: &Committed, u: &[f64]) -> ElementResult {
        with_element!(self, element => element.evaluate(material, u))
    }

    /// Internal variables at the end of a motion, written to `updated`, and the energy dissipated on the way to them
    /// (force length).
    pub fn update(&self, material: &Committed, motion: Motion, updated: &mut [f64]) -> f64 {
        with_element!(self, element => element.update(material, motion, updated))
    }
}

/// A chunk of elements of any type that is swept by blocks.
pub(super) enum AnyChunk {
    /// T3, displacement formulation.
    Tri3(Chunk<3, 1, Triangle>),
    /// Q4, displacement formulation.
    Quad4(Chunk<4, 4, Quadrilateral>),
}

/// Evaluates an expression for the chunk in an [`AnyChunk`], whatever its type.
macro_rules! with_chunk {
    ($any:expr, $chunk:ident => $value:expr) => {
        match $any {
            AnyChunk::Tri3($chunk) => $value,
            AnyChunk::Quad4($chunk) => $value,
        }
    };
}

impl AnyChunk {
    /// Whether elements of a type and law are swept by blocks.
    pub fn has(element_type: &ElementType, law: &PlaneLaw) -> bool {
        let triangle = element_type.shape == Shape::Tri3;
        law.variables() == 0 && (triangle || element_type.formulation == Formulation::Displacement)
    }

    /// Elements (indices) of the model of one type, law and thickness `t`.
    pub fn new(model: &Model, elements: &[usize], t: f64, law: PlaneLaw) -> Self {
        let Mesh {
            coordinates,
            elements: all,
            ..
        } = &model.mesh;
        match all[elements[0]].element_type.shape {
            Shape::Tri3 => {
                let nodes: Vec<_> = elements.iter().map(|&e| first(&all[e].nodes)).collect();
                Self::Tri3(Chunk::new(elements.to_vec(), &nodes, coordinates, t, law))
            }
            Shape::Quad4 => {
                let nodes: Vec<_> = elements.iter().map(|&e| first(&all[e].nodes)).collect();
                Self::Quad4(Chunk::new(elements.to_vec(), &nodes, coordinates, t, law))
            }
        }
    }

    /// The element at a place of the chunk, between its nodes.
    pub fn element(&self, place: usize, nodes: &[usize]) -> AnyElement {
        match self {
            Self::Tri3(chunk) => AnyElement::Tri3(Tri3::new(first(nodes), chunk.reference(place))),
            Self::Quad4(chunk) => {
                AnyElement::Quad4(Quad4::new(first(nodes), chunk.reference(place)))
            }
        }
    }

    /// Sums up internal forces. False where an element is turned inside out.
    pub fn sum_forces(&self, motion: Motion) -> bool {
        with_chunk!(self, chunk => chunk.sum_forces(motion))
    }

    /// Adds the sums of the last sweep to a vector over all dofs.
    pub fn add_sums(&self, total: &mut [f64]) {
        with_chunk!(self, chunk => chunk.add_sums(total))
    }

    /// As [`Chunk::clear_sums`].
    pub fn clear_sums(&self) {
        with_chunk!(self, chunk => chunk.clear_sums())
    }

    /// Elements (indices) with strain energy, stress and strain at displacements `u`.
    pub fn evaluate(&self, u: &[f64]) -> Vec<(usize, ElementResult)> {
        with_chunk!(self, chunk => chunk.evaluate(u))
    }

    /// Calls `add(element, k)` with the tangent of every wanted element.
    pub fn for_each_tangent(
        &self,
        sweep: TangentSweep<impl Fn(usize) -> bool + Sync>,
        space: &mut Vec<BlockTangents>,
        add: &mut impl FnMut(usize, &[f64]),
    ) {
        with_chunk!(self, chunk => chunk.for_each_tangent(sweep, space, add))
    }
}

/// The nodes of an element as an array; a model's element has as many as its type.
fn first<const N: usize>(nodes: &[usize]) -> [usize; N] {
    std::array::from_fn(|a| nodes[a])
}

/// Coordinates of the nodes of an element, column a for node a.
fn corners<const N: usize>(nodes: [usize; N], x: &[[f64; 2]]) -> SMatrix<f64, 2, N> {
    SMatrix::from_fn(|i, a| x[nodes[a]][i])
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
    /// That of an element (index) of a model.
    pub fn new(model: &Model, index: usize) -> Self {
        let element = &model.mesh.elements[index];
        let section = &model.sections[element.section];
        let density = model.materials[section.material].density;
        let any = AnyElement::new(element, &model.mesh.coordinates, section.thickness);
        ElementInertia {
            volume: any.nodal_volumes().iter().sum(),
            nodes: any.nodes().to_vec(),
            mass: any.mass(density),
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
