//! Delassus operator Q = G W B^T of a set of constraints, and the frictional complementarity
//! problem it forms. Section 5 of docs/theory.md (paper eqs 36 to 47).

use nalgebra::{DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};
use smallvec::SmallVec;

use super::compliance::{Compliance, Scope};
use super::constraint::Constraint;
use super::responses::{GroupRows, Responses, UnknownEntry, resized};
use crate::lcp::FrictionalLcp;

/// Memory of the Delassus operators of a matrix, used again by the next one.
#[derive(Debug, Default)]
pub struct DelassusSpace {
    /// Entries of Q.
    q: Vec<f64>,
    /// Gaps, slips and friction coefficients.
    vectors: [Vec<f64>; 3],
    groups: Vec<GroupRows>,
    responses: Responses,
    sums: [Vec<f64>; 2],
}

impl DelassusSpace {
    /// Takes the memory of a problem that is not needed any more.
    pub fn take(&mut self, problem: FrictionalLcp) {
        self.q = problem.q.data.into();
        self.vectors = [problem.gap, problem.slip, problem.mu].map(|vector| vector.data.into());
    }
}

/// The complementarity problem of some constraints: Q = G W B^T, eq. (5.1), with the compliance W,
/// derivative rows G and force rows B, and the given constant terms, of gap and slip of every one.
///
/// Every constraint must have been prepared in the scope of the compliance. Q is symmetric where G = B.
pub fn frictional_lcp(
    constraints: &[&Constraint],
    (compliance, scope): (&Compliance, &Scope),
    constant_terms: &[[f64; 2]],
    space: &mut DelassusSpace,
) -> FrictionalLcp {
    let mut vector = |i: usize, values: &mut dyn Iterator<Item = f64>| {
        let mut vector = std::mem::take(&mut space.vectors[i]);
        vector.clear();
        vector.extend(values);
        DVector::from_vec(vector)
    };
    FrictionalLcp {
        gap: vector(0, &mut constant_terms.iter().map(|term| term[0])),
        slip: vector(1, &mut constant_terms.iter().map(|term| term[1])),
        mu: vector(2, &mut constraints.iter().map(|constraint| constraint.mu)),
        q: delassus(constraints, compliance, scope, space),
    }
}

/// Constraints whose responses are computed together.
const PANEL: usize = 128;

/// Q = G W B^T, eq. (5.1), all normal before all tangential rows and columns: the sum over the groups of
/// unknowns, each of which couples the constraints that act on it.
fn delassus(
    constraints: &[&Constraint],
    compliance: &Compliance,
    scope: &Scope,
    space: &mut DelassusSpace,
) -> DMatrix<f64> {
    let n = constraints.len();
    let DelassusSpace {
        q,
        groups,
        responses,
        sums,
        ..
    } = space;
    groups.resize_with(compliance.block_count(scope), GroupRows::default);
    groups.iter_mut().for_each(GroupRows::clear);
    for (k, constraint) in constraints.iter().enumerate() {
        compliance.for_each_entry(scope, constraint, |entry| {
            groups[entry.block].push(k, entry);
        });
    }
    let mut q = std::mem::take(q);
    q.resize(4 * n * n, 0.0);
    let is_whole = |rows: &GroupRows| n <= PANEL && rows.members.len() == n;
    if !groups.first().is_some_and(is_whole) {
        q.fill(0.0);
    }
    for (block, rows) in groups.iter().enumerate() {
        Arch::new().dispatch(GroupSum {
            inverse: compliance.inverse(scope, block),
            members: rows.iter().collect(),
            responses,
            sums,
            adds: block > 0 || !is_whole(rows),
            q: &mut q,
        });
    }
    let mut q = DMatrix::from_vec(2 * n, 2 * n, q);
    if n > 0
        && constraints
            .iter()
            .all(|c| c.other_derivative_rows.is_none())
    {
        mirror(&mut q);
    }
    q
}

/// Adds what the unknowns of a group couple to Q, column by column, or writes it.
struct GroupSum<'a> {
    /// The inverse at its unknowns, and their number.
    inverse: (&'a [f64], usize),
    /// The constraints that act on it, with their rows.
    members: SmallVec<[(usize, &'a [UnknownEntry]); PANEL]>,
    responses: &'a mut Responses,
    sums: &'a mut [Vec<f64>; 2],
    adds: bool,
    q: &'a mut [f64],
}

impl WithSimd for GroupSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            responses,
            members,
            sums,
            ..
        } = self;
        let n = (self.q.len() / 4).isqrt();
        let (normals, tangentials) = self.q.split_at_mut(2 * n * n);
        for panel in members.chunks(PANEL) {
            // Y = W (G T)^T of the panel, then its products with the force rows of all
            responses.set(simd, self.inverse, panel);
            for &(l, of_l) in &members {
                let columns = [&mut *normals, &mut *tangentials];
                let columns = columns.map(|all| &mut all[2 * n * l..2 * n * (l + 1)]);
                if panel.len() == n {
                    responses.product(simd, of_l, columns, self.adds);
                    continue;
                }
                responses.product(simd, of_l, resized(sums, 2 * panel.len()), false);
                for (column, sum) in columns.into_iter().zip(&*sums) {
                    let (normal, tangential) = column.split_at_mut(n);
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
    for ((l, _), value) in panel.iter().zip(values) {
        all[*l] += value;
    }
}

/// Makes Q symmetric, as it is but for round-off where G = B.
fn mirror(q: &mut DMatrix<f64>) {
    let size = q.nrows();
    for k in 1..size {
        let (before, column) = q.as_mut_slice().split_at_mut(k * size);
        let rows = before.chunks_exact(size).map(|column| column[k]);
        (column.iter_mut().zip(rows)).for_each(|(above, below)| *above = below);
    }
}
