//! Delassus operator Q = G W B^T of a set of constraints, and the frictional complementarity
//! problem it forms. Section 5 of docs/theory.md (paper eqs 36 to 47).

use nalgebra::{DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};

use super::compliance::{Compliance, GroupRows, Responses, Scope, UnknownEntry, product};
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

/// Constraints whose responses are computed together.
const PANEL: usize = 128;

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
    let mut responses = Responses::default();
    for (block, rows) in groups.iter().enumerate() {
        Arch::new().dispatch(GroupSum {
            compliance,
            block: (scope, block),
            rows,
            responses: &mut responses,
            q: q.as_mut_slice(),
        });
    }
    transpose(constraints, &mut q);
    q
}

/// Adds what the unknowns of a group couple to Q^T, column by column.
struct GroupSum<'a> {
    compliance: &'a Compliance,
    block: (&'a Scope, usize),
    rows: &'a GroupRows,
    responses: &'a mut Responses,
    q: &'a mut [f64],
}

impl WithSimd for GroupSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { q, responses, .. } = self;
        let n = (q.len() / 4).isqrt();
        let members: Vec<(usize, &[UnknownEntry])> = self.rows.iter().collect();
        let mut sums = [Vec::new(), Vec::new()];
        for panel in members.chunks(PANEL) {
            // Y = W (B T)^T of the panel, then its products with the rows of all
            let of_panel = panel.iter().map(|member| member.1);
            (self.compliance).respond(simd, self.block, of_panel, responses);
            for &(k, of_k) in &members {
                product(simd, of_k, responses, &mut sums);
                for (row, sum) in [k, n + k].into_iter().zip(&sums) {
                    let (normal, tangential) = q[2 * n * row..2 * n * (row + 1)].split_at_mut(n);
                    let (to_normal, to_tangential) = sum.split_at(panel.len());
                    add(normal, panel, to_normal);
                    add(tangential, panel, to_tangential);
                }
            }
        }
    }
}

/// Adds values for the constraints of a panel to those of all.
#[inline(always)]
fn add(all: &mut [f64], panel: &[(usize, &[UnknownEntry])], values: &[f64]) {
    match panel {
        [(first, _), .., (last, _)] if last - first + 1 == panel.len() => {
            let all = &mut all[*first..=*last];
            all.iter_mut().zip(values).for_each(|(sum, v)| *sum += v);
        }
        _ => panel
            .iter()
            .zip(values)
            .for_each(|((l, _), v)| all[*l] += v),
    }
}

/// Q from Q^T; symmetric, as it is but for round-off, between constraints with G = B.
fn transpose(constraints: &[&Constraint], q: &mut DMatrix<f64>) {
    let size = q.nrows();
    let one_kind = (constraints.iter()).map(|c| c.other_derivative_rows.is_none());
    let one_kind: Vec<bool> = one_kind.clone().chain(one_kind).collect();
    for k in 1..size {
        let (before, column) = q.as_mut_slice().split_at_mut(k * size);
        let rows = before.chunks_exact_mut(size).map(|column| &mut column[k]);
        for ((above, below), other) in column.iter_mut().zip(rows).zip(&one_kind) {
            let entry = *above;
            if !(one_kind[k] && *other) {
                *above = *below;
            }
            *below = entry;
        }
    }
}
