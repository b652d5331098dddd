//! Delassus operator Q = G W B^T of a set of constraints, and the frictional complementarity
//! problem it forms. Section 5 of docs/theory.md (paper eqs 36 to 47).

use nalgebra::{DMatrix, DVector};
use pulp::Arch;

use super::compliance::{Compliance, GroupRows, Response, Scope, product};
use super::constraint::Constraint;
use crate::lcp::FrictionalLcp;

/// The complementarity problem of some constraints: Q = G W B^T, eq. (5.1), with the compliance W,
/// derivative rows G and force rows B, and the given constant terms of gap and slip of every one.
///
/// Every constraint must have been prepared in the scope of the compliance. Q is symmetric where G = B.
pub fn frictional_lcp(
    constraints: &[&Constraint],
    (compliance, scope): (&Compliance, &Scope),
    normal: Vec<f64>,
    tangential: Vec<f64>,
) -> FrictionalLcp {
    let n = constraints.len();
    let mu = constraints.iter().map(|constraint| constraint.mu);
    FrictionalLcp {
        q: delassus(constraints, compliance, scope),
        gap: DVector::from_vec(normal),
        slip: DVector::from_vec(tangential),
        mu: DVector::from_iterator(n, mu),
    }
}

/// Q = G W B^T, eq. (5.1), all normal before all tangential rows and columns: the sum over the groups of
/// unknowns, each of which couples the constraints that act on it.
fn delassus(constraints: &[&Constraint], compliance: &Compliance, scope: &Scope) -> DMatrix<f64> {
    let n = constraints.len();
    let mut groups: Vec<GroupRows> = Vec::new();
    groups.resize_with(compliance.block_count(scope), GroupRows::default);
    for (k, constraint) in constraints.iter().enumerate() {
        for entry in compliance.entries(scope, constraint) {
            groups[entry.block].push(k, entry);
        }
    }
    let mut q = DMatrix::zeros(2 * n, 2 * n);
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for (block, rows) in groups.iter().enumerate() {
                add_group(compliance, (scope, block), rows, q.as_mut_slice());
            }
        },
    );
    mirror(constraints, &mut q);
    q
}

/// Adds what the unknowns of a group couple to Q, column by column.
#[inline(always)]
fn add_group(compliance: &Compliance, block: (&Scope, usize), rows: &GroupRows, q: &mut [f64]) {
    let n = (q.len() / 4).isqrt();
    let (normal, tangential) = q.split_at_mut(2 * n * n);
    let mut response = Response::default();
    for (l, of_l) in rows.iter() {
        // W (B_l T)^T, then its product with the rows of all
        let y = compliance.response(block, of_l, &mut response);
        let column = 2 * n * l..2 * n * (l + 1);
        let (of_normal, of_tangential) = (&mut normal[column.clone()], &mut tangential[column]);
        for (k, of_k) in rows.iter() {
            let [gap, slip] = product(of_k, y);
            of_normal[k] += gap[0];
            of_normal[k + n] += slip[0];
            of_tangential[k] += gap[1];
            of_tangential[k + n] += slip[1];
        }
    }
}

/// Makes Q symmetric, which it is but for round-off, between constraints with G = B.
fn mirror(constraints: &[&Constraint], q: &mut DMatrix<f64>) {
    let n = constraints.len();
    let has_one_kind: Vec<bool> = constraints
        .iter()
        .map(|c| c.other_derivative_rows.is_none())
        .collect();
    for column in (0..2 * n).filter(|j| has_one_kind[j % n]) {
        for row in (column + 1..2 * n).filter(|i| has_one_kind[i % n]) {
            q[(column, row)] = q[(row, column)];
        }
    }
}
