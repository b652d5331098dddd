//! The element types behind one enum, chunks of elements of one type, volume and mass of a single element. A shape has one file with its quadrature and mass. Section 2 of docs/theory.md.

use nalgebra::SMatrix;
use smallvec::SmallVec;

use super::chunk::{Chunk, ShapeChunk};
use super::displacement::Displacement;
use super::formulation::{ElementResult, PointResults};
use super::hourglass::variables;
use super::mean_dilatation::MeanDilatation;
use super::ring::{self, Ring};
use super::shapes::{
    Quad4, Quad4Enhanced, Quad4MeanDilatation, Quad4Reduced, Quad8, Quad8Reduced,
    QuadraticTriangle, Quadrilateral, ReducedSerendipity, Serendipity, Tri3, Tri6, Triangle,
};
use super::solid::{ElementMatrix, ElementVector, MAX_NODES, Motion, Solid, TangentPart};
use super::{block, enhanced_strain, formulation};
use crate::materials::{Committed, PlaneLaw, StressAtPoints, Viscosity};
use crate::model::{ElementType, Formulation, Model, Shape, Thickness};

/// An element of any type.
#[derive(Clone)]
#[allow(clippy::large_enum_variant)] // most elements are quadrilaterals: kept in one piece for speed
pub(super) enum AnyElement {
    /// T3, displacement formulation.
    Tri3(Tri3),
    /// Q4, displacement formulation.
    Quad4(Quad4),
    /// Q4, mean dilatation.
    Quad4MeanDilatation(Quad4MeanDilatation),
    /// Q4, enhanced strains.
    Quad4Enhanced(Quad4Enhanced),
    /// Q4, one strain and hourglass stiffness.
    Quad4Reduced(Quad4Reduced),
    /// T6, displacement formulation.
    Tri6(Box<Tri6>),
    /// Q8, displacement formulation.
    Quad8(Box<Quad8>),
    /// Q8, displacement formulation with 2 x 2 points.
    Quad8Reduced(Box<Quad8Reduced>),
    /// An element of any of these shapes with all components of the strain.
    Ring(Box<Ring>),
}

/// Evaluates an expression for the element in an [`AnyElement`], whatever its type.
macro_rules! with_element {
    ($any:expr, $element:ident => $value:expr) => {
        match $any {
            AnyElement::Tri3($element) => $value,
            AnyElement::Quad4($element) => $value,
            AnyElement::Quad4MeanDilatation($element) => $value,
            AnyElement::Quad4Enhanced($element) => $value,
            AnyElement::Quad4Reduced($element) => $value,
            AnyElement::Tri6($element) => $value,
            AnyElement::Quad8($element) => $value,
            AnyElement::Quad8Reduced($element) => $value,
            AnyElement::Ring($element) => $value,
        }
    };
}

impl AnyElement {
    /// An element between nodes at the coordinates `x` of all nodes.
    pub fn new(
        element_type: ElementType,
        nodes: &[usize],
        x: &[[f64; 2]],
        thickness: Thickness,
    ) -> Self {
        let t = match thickness {
            Thickness::Of(t) if !element_type.has_all_strains() => t,
            _ => return Self::Ring(Box::new(Ring::new(element_type, nodes, x, thickness))),
        };
        use Formulation::{Enhanced, MeanDilatation, Reduced};
        match (element_type.shape, element_type.formulation) {
            (Shape::Tri3, _) => Self::Tri3(solid::<Triangle, _, _, _, _>(nodes, x, t)),
            (Shape::Quad4, MeanDilatation) => {
                Self::Quad4MeanDilatation(solid::<Quadrilateral, _, _, _, _>(nodes, x, t))
            }
            (Shape::Quad4, Enhanced) => {
                Self::Quad4Enhanced(solid::<Quadrilateral, _, _, _, _>(nodes, x, t))
            }
            (Shape::Quad4, Reduced) => {
                Self::Quad4Reduced(solid::<Quadrilateral, _, _, _, _>(nodes, x, t))
            }
            (Shape::Quad4, _) => Self::Quad4(solid::<Quadrilateral, _, _, _, _>(nodes, x, t)),
            (Shape::Tri6, _) => {
                Self::Tri6(solid::<QuadraticTriangle, _, _, _, _>(nodes, x, t).into())
            }
            (Shape::Quad8, Reduced) => {
                Self::Quad8Reduced(solid::<ReducedSerendipity, _, _, _, _>(nodes, x, t).into())
            }
            (Shape::Quad8, _) => Self::Quad8(solid::<Serendipity, _, _, _, _>(nodes, x, t).into()),
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

    /// Number of internal variables of all points with a law, of the hourglass modes of metals and of the element's own strains.
    pub fn variables(&self, law: &PlaneLaw) -> usize {
        let of_point = law.variables();
        // at the start all are zero
        let is_metal = law.is_metal();
        let own = match self {
            AnyElement::Quad4Reduced(_) if is_metal => variables(2),
            AnyElement::Quad4Enhanced(_) => enhanced_strain::STRAINS,
            AnyElement::Ring(ring) => ring.own_variables(is_metal),
            _ => 0,
        };
        self.points() * of_point + own
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

    /// Results of the points at displacements `u`, with their weights.
    pub fn at_points(&self, material: &Committed, u: &[f64]) -> PointResults {
        with_element!(self, element => element.at_points(material, u))
    }

    /// Internal variables at the end of a motion, written to `updated`, and the energy dissipated on the way to them
    /// (force length).
    pub fn update(&self, material: &Committed, motion: Motion, updated: &mut [f64]) -> f64 {
        with_element!(self, element => element.update(material, motion, updated))
    }
}

/// Whether elements of a type and law are swept by blocks.
pub(super) fn is_in_blocks(element_type: &ElementType, law: &PlaneLaw) -> bool {
    law.variables() == 0
        && !element_type.has_hourglass_modes()
        && match element_type.formulation {
            Formulation::Displacement | Formulation::Reduced => true,
            Formulation::MeanDilatation => !element_type.has_all_strains(),
            Formulation::Enhanced
            | Formulation::LinearPressure
            | Formulation::ReducedLinearPressure => false,
        }
}

/// A chunk of elements (indices) of the model of one type and section, and their law.
pub(super) fn new_chunk(model: &Model, elements: &[usize], law: PlaneLaw) -> Box<dyn Chunk> {
    let first = &model.mesh.elements[elements[0]];
    let (element_type, section) = (first.element_type, &model.sections[first.section]);
    let material = &model.materials[section.material];
    let (beta, moduli) = (material.damping.beta, material.law.small_strain());
    let viscosity = Viscosity::of(beta, moduli, element_type.plane);
    let law = (law, viscosity);
    if let Thickness::Around = Thickness::new(element_type, section.thickness) {
        return ring_chunk(model, elements, element_type, law);
    }
    let t = Thickness::Of(section.thickness);
    match (element_type.shape, element_type.formulation) {
        (Shape::Tri3, _) => chunk::<Triangle, Displacement, _, _, false>(model, elements, t, law),
        (Shape::Quad4, Formulation::MeanDilatation) => {
            chunk::<Quadrilateral, MeanDilatation, _, _, false>(model, elements, t, law)
        }
        (Shape::Quad4, _) => {
            chunk::<Quadrilateral, Displacement, _, _, false>(model, elements, t, law)
        }
        (Shape::Tri6, _) => {
            chunk::<QuadraticTriangle, Displacement, _, _, false>(model, elements, t, law)
        }
        (Shape::Quad8, Formulation::Reduced) => {
            chunk::<ReducedSerendipity, Displacement, _, _, false>(model, elements, t, law)
        }
        (Shape::Quad8, _) => {
            chunk::<Serendipity, Displacement, _, _, false>(model, elements, t, law)
        }
    }
}

/// The nodes of an element as an array; a model's element has as many as its type.
fn first<const N: usize>(nodes: &[usize]) -> [usize; N] {
    std::array::from_fn(|a| nodes[a])
}

/// Coordinates of the nodes of an element, column a for node a.
fn positions<const N: usize>(nodes: &[usize], x: &[[f64; 2]]) -> SMatrix<f64, 2, N> {
    SMatrix::from_fn(|i, a| x[nodes[a]][i])
}

/// An element of the shape S.
fn solid<S: block::IntegratedShape<N, P>, F, const N: usize, const P: usize, const D: usize>(
    nodes: &[usize],
    x: &[[f64; 2]],
    t: f64,
) -> Solid<N, P, D, F>
where
    F: formulation::ElementFormulation,
{
    Solid::new(first(nodes), S::reference(&S::map(&positions(nodes, x), t)))
}

/// A chunk of rings in the displacement formulation.
fn ring_chunk(
    model: &Model,
    elements: &[usize],
    element_type: ElementType,
    law: (PlaneLaw, Option<Viscosity>),
) -> Box<dyn Chunk> {
    let t = Thickness::Around;
    match (element_type.shape, element_type.formulation) {
        (Shape::Tri3, _) => chunk::<Triangle, Displacement, _, _, true>(model, elements, t, law),
        (Shape::Quad4, _) => {
            chunk::<Quadrilateral, Displacement, _, _, true>(model, elements, t, law)
        }
        (Shape::Tri6, _) => {
            chunk::<QuadraticTriangle, Displacement, _, _, true>(model, elements, t, law)
        }
        (Shape::Quad8, Formulation::Reduced) => {
            chunk::<ReducedSerendipity, Displacement, _, _, true>(model, elements, t, law)
        }
        (Shape::Quad8, _) => {
            chunk::<Serendipity, Displacement, _, _, true>(model, elements, t, law)
        }
    }
}

/// A chunk of elements of the shape S.
fn chunk<S, F, const N: usize, const P: usize, const HOOP: bool>(
    model: &Model,
    elements: &[usize],
    t: Thickness,
    law: (PlaneLaw, Option<Viscosity>),
) -> Box<dyn Chunk>
where
    S: block::IntegratedShape<N, P> + Send + Sync + 'static,
    F: block::BlockFormulation<HOOP> + Send + Sync + 'static,
{
    let mesh = &model.mesh;
    let nodes = elements.iter().map(|&e| first(&mesh.elements[e].nodes));
    let nodes: Vec<_> = nodes.collect();
    let x = &mesh.coordinates;
    Box::new(ShapeChunk::<N, P, HOOP, S, F>::new(
        elements.to_vec(),
        &nodes,
        x,
        t,
        law,
    ))
}

/// Shape and nodes of an element in the reference configuration, from which its mass follows.
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
        let Thickness::Of(t) = self.thickness else {
            return ring::mass(self.shape, &self.own_coordinates(), density);
        };
        match self.shape {
            Shape::Tri3 => self.mass_of::<Triangle, _, _>(density, t),
            Shape::Quad4 => self.mass_of::<Quadrilateral, _, _>(density, t),
            Shape::Tri6 => self.mass_of::<QuadraticTriangle, _, _>(density, t),
            Shape::Quad8 => self.mass_of::<Serendipity, _, _>(density, t),
        }
    }

    /// Coordinates of its nodes (length).
    fn own_coordinates(&self) -> SmallVec<[[f64; 2]; MAX_NODES]> {
        self.nodes
            .iter()
            .map(|&node| self.coordinates[node])
            .collect()
    }

    /// Share of each node in a uniform force per volume (length^3): entries beyond its nodes are 0. Those of the
    /// corners are negative in Q8 and 0 in T6.
    pub fn nodal_volumes(&self) -> [f64; MAX_NODES] {
        let Thickness::Of(t) = self.thickness else {
            return ring::nodal_volumes(self.shape, &self.own_coordinates());
        };
        match self.shape {
            Shape::Tri3 => self.shares_of::<Triangle, _, _>(t),
            Shape::Quad4 => self.shares_of::<Quadrilateral, _, _>(t),
            Shape::Tri6 => self.shares_of::<QuadraticTriangle, _, _>(t),
            Shape::Quad8 => self.shares_of::<Serendipity, _, _>(t),
        }
    }

    fn mass_of<S: block::IntegratedShape<N, P>, const N: usize, const P: usize>(
        &self,
        density: f64,
        t: f64,
    ) -> Vec<f64> {
        let x = positions(self.nodes, self.coordinates);
        (S::mass(&x, t) * density).as_slice().to_vec()
    }

    fn shares_of<S: block::IntegratedShape<N, P>, const N: usize, const P: usize>(
        &self,
        t: f64,
    ) -> [f64; MAX_NODES] {
        let x = positions(self.nodes, self.coordinates);
        let mut shares = [0.0; MAX_NODES];
        shares[..N].copy_from_slice(S::nodal_volumes(&x, t).as_slice());
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
    /// That of an element (index) of a model.
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
