//! The element types behind one enum: each variant is one file with its quadrature and mass.
//! Section 2 of docs/theory.md.

use super::mean_dilatation::Quad4MeanDilatation;
use super::quad4::{self, Quad4};
use super::recovery::ElementResult;
use super::solid::{ElementMatrix, ElementVector, MAX_NODES, Motion, TangentPart};
use super::tri3::{self, Tri3};
use crate::materials::{Committed, StressAtPoints};
use crate::model::{ElementType, Formulation, Shape};

/// An element of any type.
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
            (Shape::Tri3, _) => Self::Tri3(Tri3::new(first(nodes), x, t, tri3::reference)),
            (Shape::Quad4, Formulation::Displacement) => {
                Self::Quad4(Quad4::new(first(nodes), x, t, quad4::reference))
            }
            (Shape::Quad4, Formulation::MeanDilatation) => Self::Quad4MeanDilatation(
                Quad4MeanDilatation::new(first(nodes), x, t, quad4::reference),
            ),
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

    /// Consistent mass per direction, n x n column by column (mass).
    pub fn mass(&self, density: f64) -> Vec<f64> {
        with_element!(self, element => element.mass(density))
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

    /// Internal variables at displacements `u`, written to `updated`, and the energy dissipated on the
    /// way to them (force length).
    pub fn update(&self, material: &Committed, u: &[f64], updated: &mut [f64]) -> f64 {
        with_element!(self, element => element.update(material, u, updated))
    }
}

/// The nodes of an element as an array; a model's element has as many as its type.
fn first<const N: usize>(nodes: &[usize]) -> [usize; N] {
    std::array::from_fn(|a| nodes[a])
}
