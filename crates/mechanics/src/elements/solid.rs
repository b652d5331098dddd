//! A solid element with any number of nodes and integration points in a formulation: what sweeps
//! over all elements ask of each. Section 2 of docs/theory.md.

use std::marker::PhantomData;

use nalgebra::{DMatrix, SMatrix, SymmetricEigen};

use super::formulation::{
    Configuration, ElementFormulation, ElementResult, PointResults, Reference, at_points, evaluate,
    work,
};
use crate::materials::{Committed, StressAtPoints};
use crate::model::ElementType;

/// Largest number of nodes of an element.
pub(super) const MAX_NODES: usize = ElementType::MOST_NODES;
/// Largest number of dofs of an element.
pub(super) const MAX_DOFS: usize = 2 * MAX_NODES;
/// Values of one element in the order of its dofs; the first D are used.
pub(super) type ElementVector = [f64; MAX_DOFS];
/// Square matrix of one element, column by column; the first D^2 entries are used.
pub(super) type ElementMatrix = [f64; MAX_DOFS * MAX_DOFS];

/// An element with N nodes, P integration points and D = 2 N dofs in the formulation F.
#[derive(Clone)]
pub struct Solid<const N: usize, const P: usize, const D: usize, F> {
    /// Node indices, counter-clockwise.
    nodes: [usize; N],
    /// Integration points.
    reference: Reference<N, P>,
    formulation: PhantomData<F>,
}

/// Displacements of start and end of an increment, 2 N entries each.
pub type Increment<'a> = [&'a [f64]; 2];

/// Displacements of all nodes between which the elements are evaluated (2 N entries each), and the
/// internal variables of their materials.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// Displacements of the start in the energy-momentum form; without it forces are those of the end.
    pub start: Option<&'a [f64]>,
    /// Displacements of the end.
    pub end: &'a [f64],
    /// Internal variables that the last accepted increment has committed, element by element.
    pub committed: &'a [f64],
    /// The increment in which damping acts; without it there is none.
    pub increment: Option<Increment<'a>>,
}

/// What of the tangents of the elements a matrix is assembled from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentPart {
    /// All of them.
    Whole,
    /// Their positive part: the eigenvalues of every element that are negative are zero instead, so
    /// that no sum is indefinite, whatever the stresses and the material.
    Positive,
}

impl<'a> Motion<'a> {
    /// Displacements at which forces are those of the displacements.
    pub fn at(end: &'a [f64], committed: &'a [f64]) -> Self {
        Motion {
            start: None,
            end,
            committed,
            increment: None,
        }
    }
}

impl<const N: usize, const P: usize, const D: usize, F: ElementFormulation> Solid<N, P, D, F> {
    /// An element between some nodes.
    pub fn new(nodes: [usize; N], reference: Reference<N, P>) -> Self {
        Solid {
            nodes,
            reference,
            formulation: PhantomData,
        }
    }

    /// Node indices, counter-clockwise.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Number of integration points.
    pub(super) fn points(&self) -> usize {
        P
    }

    /// Internal force with the smallest determinant of the deformation gradient.
    pub(super) fn force(
        &self,
        material: &impl StressAtPoints,
        motion: Motion,
    ) -> (ElementVector, f64) {
        let mut result = [0.0; MAX_DOFS];
        let configuration = self.configuration(motion);
        let (force, determinant) =
            F::internal_force::<N, P>(&self.reference, material, &configuration);
        result[..D].copy_from_slice(force.as_slice());
        (result, determinant)
    }

    /// Tangent.
    pub(super) fn tangent(&self, material: &impl StressAtPoints, motion: Motion) -> ElementMatrix {
        let mut result = [0.0; MAX_DOFS * MAX_DOFS];
        let configuration = self.configuration(motion);
        let k = F::tangent::<N, P, D>(&self.reference, material, &configuration);
        result[..D * D].copy_from_slice(k.as_slice());
        result
    }

    /// Positive part of the tangent.
    pub(super) fn positive_tangent(
        &self,
        material: &impl StressAtPoints,
        motion: Motion,
    ) -> ElementMatrix {
        let mut k = self.tangent(material, motion);
        take_positive_part(&mut k[..D * D], D);
        k
    }

    /// Work of the stress on the strains of a motion from its start to its end (force length).
    pub(super) fn work(&self, material: &impl StressAtPoints, motion: Motion) -> f64 {
        work::<F, N, P>(&self.reference, material, &self.configuration(motion))
    }

    /// Strain energy, stress and strain.
    pub(super) fn evaluate(&self, material: &Committed, u: &[f64]) -> ElementResult {
        evaluate::<F, N, P>(&self.reference, material, &self.gather(u))
    }

    /// Results of the points.
    pub(super) fn at_points(&self, material: &Committed, u: &[f64]) -> PointResults {
        at_points::<F, N, P>(&self.reference, material, &self.gather(u))
    }

    /// Internal variables at the end of a motion, written to `updated`, and the energy dissipated on the way to them
    /// (force length).
    pub(super) fn update(&self, material: &Committed, motion: Motion, updated: &mut [f64]) -> f64 {
        let configuration = self.configuration(motion);
        F::update::<N, P>(&self.reference, material, &configuration, updated)
    }

    /// Entries of a vector over all dofs at the nodes, 2 x N.
    fn gather(&self, u: &[f64]) -> SMatrix<f64, 2, N> {
        SMatrix::from_fn(|i, a| u[2 * self.nodes[a] + i])
    }

    fn configuration(&self, motion: Motion) -> Configuration<N> {
        match motion.start {
            None => Configuration::At(self.gather(motion.end)),
            Some(start) => Configuration::Between(self.gather(start), self.gather(motion.end)),
        }
    }
}

/// Round-off and iterations of the eigenvalues of an element, which converge in two or three each.
const EIGENVALUES: (f64, usize) = (f64::EPSILON, 1000);

/// K+ = sum max(lambda, 0) v v^T over the eigenpairs of a symmetric matrix of size `d`, eq. (4.14), in
/// its place.
pub(super) fn take_positive_part(k: &mut [f64], d: usize) {
    let whole = DMatrix::from_column_slice(d, d, k);
    let (eps, iterations) = EIGENVALUES;
    let Some(pairs) = SymmetricEigen::try_new(whole, eps, iterations) else {
        return;
    };
    let positive = pairs.eigenvalues.map(|lambda| lambda.max(0.0));
    let scaled = &pairs.eigenvectors * DMatrix::from_diagonal(&positive);
    k.copy_from_slice((scaled * pairs.eigenvectors.transpose()).as_slice());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positive_part_by_hand() {
        // eigenvalues 3 and -1 with (1, 1) and (1, -1)
        let mut k = [1.0, 2.0, 2.0, 1.0];
        take_positive_part(&mut k, 2);
        assert!(k.iter().all(|value| (value - 1.5).abs() < 1e-15), "{k:?}");
        let mut k = [4.0, 1.0, 1.0, 4.0];
        take_positive_part(&mut k, 2);
        assert!(
            (k[0] - 4.0).abs() < 1e-15 && (k[1] - 1.0).abs() < 1e-15,
            "{k:?}"
        );
    }
}
