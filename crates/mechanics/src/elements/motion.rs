//! Motions in which elements are evaluated, and the part of their tangents that is assembled. See
//! docs/theory/elements.md and docs/theory/time.md.

use nalgebra::{DMatrix, SymmetricEigen};

use super::MAX_DOFS;

/// Values of one element in the order of its dofs; only the first D entries are used.
pub(super) type ElementVector = [f64; MAX_DOFS];
/// Square matrix of one element, column by column; only the first D^2 entries are used.
pub(super) type ElementMatrix = [f64; MAX_DOFS * MAX_DOFS];

/// 0
pub(super) const NO_MATRIX: ElementMatrix = [0.0; MAX_DOFS * MAX_DOFS];

/// Dofs of the nodes of an element, in the order of element vectors.
pub(super) fn dofs(nodes: &[usize]) -> impl Iterator<Item = usize> + '_ {
    nodes.iter().flat_map(|n| [2 * n, 2 * n + 1])
}

/// Displacements at the start and at the end of an increment, 2 N entries each.
pub type Increment<'a> = [&'a [f64]; 2];

/// Displacements of all nodes between which the elements are evaluated (2 N entries each), and the
/// internal variables of their materials.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// Displacements at the start, in the energy-momentum form; without these displacements, forces are the forces at
    /// the end.
    pub start: Option<&'a [f64]>,
    /// Displacements at the end.
    pub end: &'a [f64],
    /// Internal variables that the last accepted increment has committed, element by element.
    pub committed: &'a [f64],
    /// The increment in which damping acts; `None` without damping.
    pub increment: Option<Increment<'a>>,
    /// Temperature of every node at which the materials are evaluated; an empty list stands for the temperature at the
    /// start of the analysis.
    pub temperature: &'a [f64],
}

/// Part of the tangents of the elements from which a matrix is assembled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentPart {
    /// The complete tangents.
    Whole,
    /// The positive part of the tangents: negative eigenvalues of every element are replaced by
    /// zero. A sum of positive parts is never indefinite, for any stresses and any material.
    Positive,
}

impl<'a> Motion<'a> {
    /// A single configuration, with forces at its displacements.
    pub fn at(end: &'a [f64], committed: &'a [f64]) -> Self {
        Motion {
            start: None,
            end,
            committed,
            increment: None,
            temperature: &[],
        }
    }

    /// The same motion at given temperatures of the nodes.
    pub fn heated(self, temperature: &'a [f64]) -> Self {
        Motion {
            temperature,
            ..self
        }
    }
}

/// Tolerance and largest number of iterations for the eigenvalues of an element; an eigenvalue converges in two or
/// three iterations.
const EIGENVALUES: (f64, usize) = (f64::EPSILON, 1000);

/// Replaces a symmetric matrix of size `d` by K+ = sum max(lambda, 0) v v^T over its eigenpairs, eq. (4.14).
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
