//! Dense factorisations on one core (the order of the operations, and so the result, never varies).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor as llt;
use faer::linalg::lu::partial_pivoting::{factor as lu, solve as lu_solve};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::perm::PermRef;
use faer::reborrow::ReborrowMut;
use faer::{MatMut, MatRef, Par};

/// A diagonal entry of a factor below this part of the largest one: the matrix counts as singular.
const SINGULAR: f64 = 1e-12;

/// Factors of a square matrix held by columns.
pub(crate) struct Factors {
    values: Vec<f64>,
    size: usize,
    kind: Kind,
}

enum Kind {
    /// L L^T, the lower triangle holds L.
    Cholesky,
    /// P A = L U with the permutation and its inverse.
    Lu(Vec<usize>, Vec<usize>),
}

impl Factors {
    /// Factorises a symmetric matrix of which the lower triangle is read. None unless it is
    /// positive definite beyond round-off.
    pub fn cholesky(mut values: Vec<f64>, size: usize) -> Option<Self> {
        let mut buffer = MemBuffer::new(llt::cholesky_in_place_scratch::<f64>(
            size,
            Par::Seq,
            Default::default(),
        ));
        llt::cholesky_in_place(
            MatMut::from_column_major_slice_mut(&mut values, size, size),
            Default::default(),
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        )
        .ok()?;
        // The pivots of the elimination are the squares of the diagonal of L.
        regular((0..size).map(|i| values[i + i * size].powi(2))).then_some(Self {
            values,
            size,
            kind: Kind::Cholesky,
        })
    }

    /// Factorises any square matrix. None when it is singular to round-off.
    pub fn lu(mut values: Vec<f64>, size: usize) -> Option<Self> {
        let mut buffer = MemBuffer::new(lu::lu_in_place_scratch::<usize, f64>(
            size,
            size,
            Par::Seq,
            Default::default(),
        ));
        let (mut forward, mut backward) = (vec![0; size], vec![0; size]);
        lu::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut values, size, size),
            &mut forward,
            &mut backward,
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        );
        regular((0..size).map(|i| values[i + i * size].abs())).then_some(Self {
            values,
            size,
            kind: Kind::Lu(forward, backward),
        })
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Overwrites b with the solution of A x = b.
    pub fn solve(&self, b: &mut [f64]) {
        let factor = MatRef::from_column_major_slice(&self.values, self.size, self.size);
        let mut x = MatMut::from_column_major_slice_mut(b, self.size, 1);
        match &self.kind {
            Kind::Cholesky => {
                solve_lower_triangular_in_place(factor, x.rb_mut(), Par::Seq);
                solve_upper_triangular_in_place(factor.transpose(), x, Par::Seq);
            }
            Kind::Lu(forward, backward) => {
                let scratch =
                    lu_solve::solve_in_place_scratch::<usize, f64>(self.size, 1, Par::Seq);
                let mut buffer = MemBuffer::new(scratch);
                let rows = PermRef::new_checked(forward, backward, self.size);
                let stack = MemStack::new(&mut buffer);
                lu_solve::solve_in_place(factor, factor, rows, x, Par::Seq, stack);
            }
        }
    }
}

/// Whether all pivots are finite and none is negligible against the largest.
fn regular(pivots: impl Iterator<Item = f64>) -> bool {
    let (mut smallest, mut largest, mut finite) = (f64::INFINITY, 0.0_f64, true);
    for pivot in pivots {
        finite &= pivot.is_finite();
        smallest = smallest.min(pivot);
        largest = largest.max(pivot);
    }
    finite && smallest > SINGULAR * largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_factorisations_solve() {
        // A = [4 1; 1 3], x = (1, 2), b = (6, 7)
        let a = vec![4.0, 1.0, 1.0, 3.0];
        for factors in [Factors::cholesky(a.clone(), 2), Factors::lu(a.clone(), 2)] {
            let mut b = [6.0, 7.0];
            factors.unwrap().solve(&mut b);
            assert!((b[0] - 1.0).abs() < 1e-15 && (b[1] - 2.0).abs() < 1e-15);
        }
    }

    #[test]
    fn singular_matrices_are_refused() {
        let a = vec![1.0, 1.0, 1.0, 1.0];
        assert!(Factors::cholesky(a.clone(), 2).is_none());
        assert!(Factors::lu(a, 2).is_none());
        assert!(Factors::cholesky(vec![1.0, 0.0, 0.0, -1.0], 2).is_none());
        assert!(Factors::lu(vec![f64::NAN; 4], 2).is_none());
        assert!(Factors::lu(vec![0.0], 1).is_none());
    }
}
