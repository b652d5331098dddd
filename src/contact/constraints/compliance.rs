//! Compliance at the contacts: the entries of an inverse W that the Delassus operator
//! Q = G T W T^T B^T needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of
//! docs/theory.md.

use pulp::Simd;
use smallvec::SmallVec;

use super::constraint::{Constraint, Rows};
use crate::linear::{CheckedSolver, LinearError, Rotation, Transformation};

/// The inverse of a factorised matrix at the unknowns that constraints act on, a block for each connected
/// group of unknowns: it is zero between them.
///
/// It is computed when constraints first need it and kept until the matrix changes, so that a Delassus
/// matrix for any normals costs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// T: what unknowns the dofs depend on.
    map: Transformation,
    /// R of the bodies since the matrix was factorised.
    rotation: Rotation,
    /// Connected group of every unknown.
    groups: Vec<usize>,
    /// Row of every unknown in the block of its group, where it has been computed.
    place: Vec<Option<usize>>,
    /// Blocks of the groups; empty ones where no constraint has acted.
    blocks: Vec<Block>,
}

/// The inverse at some unknowns of a group.
#[derive(Debug, Clone, Default)]
struct Block {
    /// Unknowns of the rows, increasing.
    unknowns: Vec<usize>,
    /// Column by column.
    inverse: Vec<f64>,
}

/// The rows of a constraint at one unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    /// Row of the inverse, in the block of the group.
    place: usize,
    /// Its group.
    pub group: usize,
    /// Entries of Bn T and Bt T.
    force: [f64; 2],
    /// Entries of Gn T and Gt T.
    derivative: [f64; 2],
}

/// The rows of some constraints at the unknowns of one group.
#[derive(Default)]
pub(super) struct GroupRows {
    /// The constraints, increasing, each with the end of its entries.
    pub members: Vec<(usize, usize)>,
    entries: Vec<UnknownEntry>,
}

impl GroupRows {
    /// Adds an entry of a constraint, which is the last one or comes after it.
    pub fn push(&mut self, constraint: usize, entry: UnknownEntry) {
        self.entries.push(entry);
        let end = self.entries.len();
        match self.members.last_mut() {
            Some((last, at)) if *last == constraint => *at = end,
            _ => self.members.push((constraint, end)),
        }
    }

    /// Entries of the constraints with their numbers, one constraint after the other.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[UnknownEntry])> {
        let mut start = 0;
        self.members.iter().map(move |&(constraint, end)| {
            let entries = &self.entries[start..end];
            start = end;
            (constraint, entries)
        })
    }
}

impl Compliance {
    /// Compliance for the unknowns that all dofs depend on, and the connected groups of the
    /// unknowns.
    pub fn new(map: Transformation, groups: Vec<usize>) -> Self {
        let mut compliance = Compliance {
            map,
            rotation: Rotation::default(),
            groups: Vec::new(),
            place: Vec::new(),
            blocks: Vec::new(),
        };
        compliance.renew(groups);
        compliance
    }

    /// Forgets the inverse: the matrix has changed, and with it, perhaps, the connected groups.
    pub fn renew(&mut self, groups: Vec<usize>) {
        let count = groups.iter().max().map_or(0, |last| last + 1);
        self.groups = groups;
        self.rotation = Rotation::default();
        self.place.clear();
        self.place.resize(self.map.unknowns(), None);
        self.blocks.clear();
        self.blocks.resize(count, Block::default());
    }

    /// Turns W with the bodies, to R W R^T, since the matrix was factorised.
    pub fn turn(&mut self, rotation: Rotation) {
        self.rotation = rotation;
    }

    /// R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// Computes the inverse at the unknowns of `constraints` too, if some are missing.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        constraints: &[&Constraint],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        let dofs = constraints.iter().flat_map(|constraint| &constraint.dofs);
        let terms = dofs.flat_map(|&dof| self.map.row(dof));
        let missing = |unknown: &usize| self.place[*unknown].is_none();
        let missing: Vec<usize> = terms.map(|term| term.0).filter(missing).collect();
        if missing.is_empty() {
            return Ok(());
        }
        let mut renewed: Vec<usize> = missing
            .iter()
            .map(|&unknown| self.groups[unknown])
            .collect();
        renewed.sort_unstable();
        renewed.dedup();
        for unknown in missing {
            self.blocks[self.groups[unknown]].unknowns.push(unknown);
        }
        for &group in &renewed {
            self.blocks[group].unknowns.sort_unstable();
            self.blocks[group].unknowns.dedup();
        }
        let unknowns: Vec<&[usize]> = renewed
            .iter()
            .map(|&g| self.blocks[g].unknowns.as_slice())
            .collect();
        let inverses = solver.inverse_at(&unknowns)?;
        for (&group, inverse) in renewed.iter().zip(inverses) {
            let block = &mut self.blocks[group];
            block.inverse = inverse;
            for (place, &unknown) in block.unknowns.iter().enumerate() {
                self.place[unknown] = Some(place);
            }
        }
        Ok(())
    }

    /// T: what unknowns the dofs depend on.
    pub fn map(&self) -> &Transformation {
        &self.map
    }

    /// Entries of the rows of a constraint, turned back with R^T, that are not all zero; it must have
    /// been prepared.
    pub(super) fn entries(&self, constraint: &Constraint) -> Vec<UnknownEntry> {
        let rows = [&constraint.force_rows, constraint.derivative_rows()];
        let rows = rows.map(|rows| self.turned_back(&constraint.dofs, rows));
        let mut entries = Vec::with_capacity(constraint.dofs.len());
        for (k, &dof) in constraint.dofs.iter().enumerate() {
            let [force, derivative] =
                (rows.each_ref()).map(|rows| [rows.normal[k], rows.tangential[k]]);
            if force == [0.0; 2] && derivative == [0.0; 2] {
                continue;
            }
            for &(unknown, c) in self.map.row(dof) {
                if let Some(place) = self.place[unknown] {
                    entries.push(UnknownEntry {
                        place,
                        group: self.groups[unknown],
                        force: force.map(|entry| c * entry),
                        derivative: derivative.map(|entry| c * entry),
                    });
                }
            }
        }
        entries
    }

    /// Rows times R, over the dofs of a constraint, eq. (4.20).
    fn turned_back(&self, dofs: &[usize], rows: &Rows) -> Rows {
        let mut turned = rows.clone();
        self.rotation.turn_row(dofs, &mut turned.normal);
        self.rotation.turn_row(dofs, &mut turned.tangential);
        turned
    }

    /// Number of groups.
    pub(super) fn groups(&self) -> usize {
        self.blocks.len()
    }

    /// W (B_l T)^T of eq. (5.1) of some constraints l in the rows of a group: what their normal and
    /// tangential forces do to its unknowns.
    #[inline(always)]
    pub(super) fn respond<'q, S: Simd>(
        &self,
        simd: S,
        group: usize,
        constraints: impl ExactSizeIterator<Item = &'q [UnknownEntry]>,
        responses: &mut Responses,
    ) {
        let Block { unknowns, inverse } = &self.blocks[group];
        let (size, count) = (unknowns.len(), constraints.len());
        let Responses { rows, width, sums } = responses;
        *width = 2 * count;
        rows.resize(size * *width, 0.0);
        for (l, entries) in constraints.enumerate() {
            let column = |place: usize| &inverse[place * size..(place + 1) * size];
            let terms = entries.iter().map(|e| (column(e.place), e.force));
            combine(simd, &terms.collect::<Terms>(), (size, sums));
            let [normal, tangential] = sums;
            let both = normal.iter().zip(tangential.iter());
            for (row, (normal, tangential)) in rows.chunks_exact_mut(*width).zip(both) {
                row[l] = *normal;
                row[count + l] = *tangential;
            }
        }
    }
}

/// What the forces of some constraints do to the unknowns of a group.
#[derive(Default)]
pub(super) struct Responses {
    /// A row for every unknown: all normal forces, then all tangential ones.
    rows: Vec<f64>,
    /// Entries of a row.
    width: usize,
    /// What normal and tangential force of one constraint do.
    sums: [Vec<f64>; 2],
}

/// (G_k T) Y of eq. (5.1) in the rows of a group: what the forces add to gap and slip of k.
#[inline(always)]
pub(super) fn product<S: Simd>(
    simd: S,
    k: &[UnknownEntry],
    responses: &Responses,
    sums: &mut [Vec<f64>; 2],
) {
    let Responses { rows, width, .. } = responses;
    let row = |place: usize| &rows[place * width..(place + 1) * width];
    let terms = k.iter().map(|e| (row(e.place), e.derivative));
    combine(simd, &terms.collect::<Terms>(), (*width, sums));
}

/// Vectors of one length, each with two factors.
type Terms<'a> = SmallVec<[(&'a [f64], [f64; 2]); 8]>;

/// The two sums of vectors times their factors.
#[inline(always)]
fn combine<S: Simd>(simd: S, terms: &Terms, (length, sums): (usize, &mut [Vec<f64>; 2])) {
    sums.iter_mut().for_each(|sum| sum.resize(length, 0.0));
    let [first, second] = sums.each_mut().map(|sum| S::as_mut_simd_f64s(sum));
    let heads = terms.iter().map(|(vector, [a, b])| {
        let head = &S::as_simd_f64s(vector).0[..first.0.len()];
        (head, simd.splat_f64s(*a), simd.splat_f64s(*b))
    });
    let heads: SmallVec<[_; 8]> = heads.collect();
    for (i, (first, second)) in first.0.iter_mut().zip(second.0).enumerate() {
        let [mut sum_a, mut sum_b] = [simd.splat_f64s(0.0); 2];
        for &(head, a, b) in &heads {
            sum_a = simd.mul_add_e_f64s(a, head[i], sum_a);
            sum_b = simd.mul_add_e_f64s(b, head[i], sum_b);
        }
        (*first, *second) = (sum_a, sum_b);
    }
    let whole = length - first.1.len();
    for (i, (first, second)) in first.1.iter_mut().zip(second.1).enumerate() {
        (*first, *second) = (0.0, 0.0);
        for (vector, [a, b]) in terms {
            *first += a * vector[whole + i];
            *second += b * vector[whole + i];
        }
    }
}
