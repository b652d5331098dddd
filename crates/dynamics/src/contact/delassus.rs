//! Delassus operator Q = G W B^T of a set of constraints, and the frictional complementarity problem with this
//! operator. See docs/theory/complementarity.md, Problem of a pass (paper eqs 36 to 47).

use nalgebra::{DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use smallvec::SmallVec;

use super::compliance::{Compliance, ConstraintGroup, GroupRows, Responses, UnknownEntry};
use super::constraint::Constraint;
use crate::lcp::{FreeUnknowns, FrictionalLcp};

/// Memory of the Delassus operators of a matrix; the next matrix uses this memory again.
#[derive(Debug, Default)]
pub struct DelassusSpace {
    /// Entries of Q.
    q: Vec<f64>,
    /// Vectors of gaps, slips and friction coefficients.
    vectors: [Vec<f64>; 3],
    groups: Vec<GroupRows>,
    /// Responses of the constraints of every panel.
    responses: Vec<Responses>,
}

impl DelassusSpace {
    /// Reclaims the memory of a problem that is not needed any more.
    pub fn take(&mut self, problem: FrictionalLcp) {
        self.q = problem.q.data.into();
        self.vectors = [problem.gap, problem.slip, problem.mu].map(|vector| vector.data.into());
    }
}

/// The complementarity problem of some constraints with the given constant terms of gap and slip:
/// Q = G W B^T, eq. (5.1), with the compliance W, derivative rows G and force rows B.
///
/// Every constraint must have been prepared in the scope of the compliance. The operator Q is symmetric where G = B,
/// unless bodies turn: the rows of T for a turning body differ between gaps and forces, eq. (11.3).
pub fn frictional_lcp(
    constraints: &[&Constraint],
    (compliance, scope): (&Compliance, &ConstraintGroup),
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
        mu: vector(
            2,
            &mut constraints.iter().map(|constraint| constraint.friction()),
        ),
        q: delassus(constraints, compliance, scope, space),
        free: FreeUnknowns::default(),
    }
}

/// Number of constraints whose responses are computed together (a panel).
const PANEL: usize = 128;

/// Number of constraints whose columns of Q are one piece of work for a thread.
const PIECE: usize = 16;
const THREADS: usize = 64;

/// The operator Q = G W B^T, eq. (5.1), with all normal rows and columns before all tangential rows and columns. The
/// operator Q is a sum over the groups of unknowns; a group couples the constraints that act on it.
fn delassus(
    constraints: &[&Constraint],
    compliance: &Compliance,
    scope: &ConstraintGroup,
    space: &mut DelassusSpace,
) -> DMatrix<f64> {
    let n = constraints.len();
    let DelassusSpace {
        q,
        groups,
        responses,
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
        let members: SmallVec<[Member; PANEL]> = rows.iter().collect();
        set_responses(&members, compliance.inverse(scope, block), responses);
        let sum = GroupSum {
            members: &members,
            responses,
            n,
            adds: block > 0 || !is_whole(rows),
        };
        sum.write_to(&mut q);
    }
    let mut q = DMatrix::from_vec(2 * n, 2 * n, q);
    let is_symmetric = |c: &&Constraint| c.other_derivative_rows.is_none();
    if n > 0 && !compliance.map().has_own_derivatives() && constraints.iter().all(is_symmetric) {
        mirror(&mut q);
    }
    q
}

/// A constraint that acts on a group, with its rows.
type Member<'a> = (usize, &'a [UnknownEntry]);

/// Whether there are several threads, and enough constraints for them.
fn is_worth_threads(constraints: usize) -> bool {
    constraints >= THREADS && rayon::current_num_threads() > 1
}

/// Responses Y = W (G T)^T of the constraints that act on a group, panel by panel.
fn set_responses(members: &[Member], inverse: (&[f64], usize), responses: &mut Vec<Responses>) {
    let panels = members.chunks(PANEL).len();
    responses.resize_with(panels.max(responses.len()), Responses::default);
    let set = |(panel, responses): (&[Member], &mut Responses)| {
        Arch::new().dispatch(PanelResponses {
            inverse,
            panel,
            responses,
        });
    };
    match panels > 1 && is_worth_threads(members.len()) {
        true => members.par_chunks(PANEL).zip(responses).for_each(set),
        false => members.chunks(PANEL).zip(responses).for_each(set),
    }
}

/// Responses of the constraints of one panel.
struct PanelResponses<'a> {
    inverse: (&'a [f64], usize),
    panel: &'a [Member<'a>],
    responses: &'a mut Responses,
}

impl WithSimd for PanelResponses<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.responses.set(simd, self.inverse, self.panel);
    }
}

/// The part of Q from the unknowns of one group.
#[derive(Clone, Copy)]
struct GroupSum<'a> {
    /// The constraints that act on the group.
    members: &'a [Member<'a>],
    /// Responses of the constraints that act on the group, panel by panel.
    responses: &'a [Responses],
    /// Number of all constraints.
    n: usize,
    /// Whether the part is added to the entries of Q, or replaces these entries.
    adds: bool,
}

impl GroupSum<'_> {
    /// Adds the part to Q, or writes it to Q, column by column.
    fn write_to(self, q: &mut [f64]) {
        let on_threads = is_worth_threads(self.members.len());
        let piece = if on_threads { PIECE } else { self.n.max(1) };
        let (normals, tangentials) = q.split_at_mut(q.len() / 2);
        let write = |(k, (normals, tangentials))| {
            Arch::new().dispatch(DelassusColumns {
                sum: self,
                first: k * piece,
                columns: [normals, tangentials],
            });
        };
        let entries = 2 * self.n.max(1) * piece;
        if on_threads {
            let pieces = (normals.par_chunks_mut(entries)).zip(tangentials.par_chunks_mut(entries));
            pieces.enumerate().for_each(write);
            return;
        }
        let pieces = (normals.chunks_mut(entries)).zip(tangentials.chunks_mut(entries));
        pieces.enumerate().for_each(write);
    }
}

/// The normal and tangential columns of Q of the constraints from the `first` on.
struct DelassusColumns<'a> {
    sum: GroupSum<'a>,
    first: usize,
    columns: [&'a mut [f64]; 2],
}

impl WithSimd for DelassusColumns<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            sum,
            first,
            columns: [normals, tangentials],
        } = self;
        let (members, n) = (sum.members, sum.n);
        let end = first + normals.len() / (2 * n);
        let [first_member, end_member] =
            [first, end].map(|k| members.partition_point(|(l, _)| *l < k));
        let mut sums = [[0.0; 2 * PANEL]; 2];
        for (panel, responses) in members.chunks(PANEL).zip(sum.responses) {
            // products of the responses of the panel with the force rows of the columns
            for &(l, of_l) in &members[first_member..end_member] {
                let start = 2 * n * (l - first);
                let columns =
                    [&mut *normals, &mut *tangentials].map(|all| &mut all[start..start + 2 * n]);
                if panel.len() == n {
                    responses.product(simd, of_l, columns, sum.adds);
                    continue;
                }
                let of_panel = (sums.each_mut()).map(|sums| &mut sums[..2 * panel.len()]);
                responses.product(simd, of_l, of_panel, false);
                for (column, sum) in columns.into_iter().zip(&sums) {
                    let (normal, tangential) = column.split_at_mut(n);
                    let (to_normal, rest) = sum.split_at(panel.len());
                    add(normal, panel, to_normal);
                    add(tangential, panel, rest);
                }
            }
        }
    }
}

/// Adds values of the constraints of a panel to the values of all constraints.
#[inline(always)]
fn add(all: &mut [f64], panel: &[Member], values: &[f64]) {
    for ((l, _), value) in panel.iter().zip(values) {
        all[*l] += value;
    }
}

/// Makes Q exactly symmetric; where G = B it is symmetric up to round-off.
fn mirror(q: &mut DMatrix<f64>) {
    let size = q.nrows();
    for k in 1..size {
        let (before, column) = q.as_mut_slice().split_at_mut(k * size);
        let rows = before.chunks_exact(size).map(|column| column[k]);
        (column.iter_mut().zip(rows)).for_each(|(above, below)| *above = below);
    }
}
