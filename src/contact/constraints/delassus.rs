//! Delassus operator Q = B W B^T of a set of pairs, and the frictional complementarity problem it
//! forms. Section 5 of docs/theory.md (paper eqs 36 to 47).

use nalgebra::{DMatrix, DVector};

use super::compliance::Compliance;
use super::pair::Pair;
use crate::lcp::FrictionalLcp;

/// The complementarity problem of some pairs: Q = B W B^T, eq. (5.1), with the compliance W, and the given
/// constant terms, normal and tangential, of every pair.
///
/// Every pair must have been prepared in the compliance.
pub fn frictional_lcp(
    pairs: &[Pair],
    compliance: &Compliance,
    normal: Vec<f64>,
    tangential: Vec<f64>,
) -> FrictionalLcp {
    let n = pairs.len();
    let rows: Vec<_> = pairs.iter().map(|pair| compliance.entries(pair)).collect();
    let mut q = DMatrix::zeros(2 * n, 2 * n);
    for k in 0..n {
        for l in k..n {
            let product = compliance.between(&rows[k], &rows[l]);
            for (i, row) in product.into_iter().enumerate() {
                for (j, value) in row.into_iter().enumerate() {
                    q[(k + i * n, l + j * n)] = value;
                    q[(l + j * n, k + i * n)] = value;
                }
            }
        }
        // symmetric but for round-off
        let mean = (q[(k, k + n)] + q[(k + n, k)]) / 2.0;
        (q[(k, k + n)], q[(k + n, k)]) = (mean, mean);
    }
    FrictionalLcp {
        q,
        gap: DVector::from_vec(normal),
        slip: DVector::from_vec(tangential),
        mu: DVector::from_iterator(n, pairs.iter().map(|pair| pair.target.friction)),
    }
}

/// Adds Bn^T Pn + Bt^T Pt of one pair to a vector over all dofs.
pub fn add_contact_forces(pair: &Pair, pn: f64, pt: f64, force: &mut [f64]) {
    for (k, dof) in pair.dofs().into_iter().enumerate() {
        force[dof] += pair.normal[k] * pn + pair.tangent[k] * pt;
    }
}
