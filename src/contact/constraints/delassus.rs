//! Delassus operator Q = G W B^T of a set of constraints, and the frictional complementarity
//! problem it forms. Section 5 of docs/theory.md (paper eqs 36 to 47).

use nalgebra::{DMatrix, DVector};

use super::compliance::Compliance;
use super::constraint::Constraint;
use crate::lcp::FrictionalLcp;

/// The complementarity problem of some constraints: Q = G W B^T, eq. (5.1), with the compliance W,
/// derivative rows G and force rows B, and the given constant terms of gap and slip of every one.
///
/// Every constraint must have been prepared in the compliance. Q is symmetric where G = B.
pub fn frictional_lcp(
    constraints: &[&Constraint],
    compliance: &Compliance,
    normal: Vec<f64>,
    tangential: Vec<f64>,
) -> FrictionalLcp {
    let n = constraints.len();
    let mu = constraints.iter().map(|constraint| constraint.mu);
    FrictionalLcp {
        q: delassus(constraints, compliance),
        gap: DVector::from_vec(normal),
        slip: DVector::from_vec(tangential),
        mu: DVector::from_iterator(n, mu),
    }
}

/// Q = G W B^T, eq. (5.1), all normal before all tangential rows and columns.
fn delassus(constraints: &[&Constraint], compliance: &Compliance) -> DMatrix<f64> {
    let n = constraints.len();
    let entries = |constraint: &&Constraint| compliance.entries(constraint);
    let rows: Vec<_> = constraints.iter().map(entries).collect();
    let has_one_kind = |k: usize| constraints[k].other_derivative_rows.is_none();
    let mut q = DMatrix::zeros(2 * n, 2 * n);
    for k in 0..n {
        for l in k..n {
            let mut product = compliance.between(&rows[k], &rows[l]);
            let is_symmetric = has_one_kind(k) && has_one_kind(l);
            if is_symmetric && k == l {
                product[0][1] = product[1][0]; // but for round-off they are equal
            }
            let below = match is_symmetric {
                true => transpose(product),
                false => compliance.between(&rows[l], &rows[k]),
            };
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                q[(k + i * n, l + j * n)] = product[i][j];
                q[(l + i * n, k + j * n)] = below[i][j];
            }
        }
    }
    q
}

fn transpose([[a, b], [c, d]]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[a, c], [b, d]]
}
