use nalgebra::{DMatrix, DVector};

use super::{Compliance, Pair};
use crate::lcp::FrictionalLcp;

/// The complementarity problem of some pairs: Q = B W B^T with the compliance W, and the given
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
    let row = |k: usize| {
        let pair = &pairs[k % n];
        (pair, if k < n { &pair.normal } else { &pair.tangent })
    };
    let mut q = DMatrix::zeros(2 * n, 2 * n);
    for k in 0..2 * n {
        let (pair, b) = row(k);
        let column = compliance.times_row(pair, b);
        for l in 0..2 * n {
            let (pair, b) = row(l);
            q[(l, k)] = compliance.row_times(pair, b, &column);
        }
    }
    // symmetric but for round-off
    let q = (&q + q.transpose()) * 0.5;
    FrictionalLcp {
        q,
        gap: DVector::from_vec(normal),
        slip: DVector::from_vec(tangential),
        mu: DVector::from_iterator(n, pairs.iter().map(|pair| pair.at.friction)),
    }
}

/// Adds Bn^T Pn + Bt^T Pt of one pair to a vector over all dofs.
pub fn add_contact_forces(pair: &Pair, pn: f64, pt: f64, force: &mut [f64]) {
    for (k, dof) in pair.dofs().into_iter().enumerate() {
        force[dof] += pair.normal[k] * pn + pair.tangent[k] * pt;
    }
}
