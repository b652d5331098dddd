//! Compliance at the contacts: the entries of an inverse W that the Delassus operator
//! Q = G T W T^T B^T needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of
//! docs/theory.md.

use std::collections::BTreeMap;

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
    /// Group of every unknown in the matrix of the elements alone: its body.
    bodies: Vec<usize>,
    /// What has been computed, for all constraints or those of some bodies.
    inverses: BTreeMap<Scope, Vec<Block>>,
}

/// Constraints whose compliance is computed together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    /// All of them.
    All,
    /// Those between the same bodies, given by increasing numbers.
    Bodies(Vec<usize>),
}

/// The inverse at some unknowns of a group.
#[derive(Debug, Clone)]
struct Block {
    group: usize,
    /// Unknowns of the rows, increasing.
    unknowns: Vec<usize>,
    /// Column by column.
    inverse: Vec<f64>,
}

impl Block {
    /// The block of a group, among blocks with increasing groups, with its place.
    fn of(blocks: &[Block], group: usize) -> Option<(usize, &Block)> {
        let at = blocks.binary_search_by_key(&group, |block| block.group);
        at.ok().map(|at| (at, &blocks[at]))
    }

    /// Row of an unknown.
    fn place(&self, unknown: usize) -> Option<usize> {
        self.unknowns.binary_search(&unknown).ok()
    }
}

/// The rows of a constraint at one unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    /// Row of the inverse, in its block.
    place: usize,
    /// Its block, that of the group of the unknown.
    pub block: usize,
    /// Entries of Bn T and Bt T.
    force: [f64; 2],
    /// Entries of Gn T and Gt T.
    derivative: [f64; 2],
}

/// The rows of some constraints at the unknowns of one block.
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
    /// Compliance for the unknowns that all dofs depend on, and the connected groups of the unknowns in the
    /// matrix that the elements make.
    pub fn new(map: Transformation, bodies: Vec<usize>) -> Self {
        Compliance {
            map,
            rotation: Rotation::default(),
            groups: bodies.clone(),
            bodies,
            inverses: BTreeMap::new(),
        }
    }

    /// Forgets the inverse: the matrix has changed, and with it, perhaps, the connected groups.
    pub fn renew(&mut self, groups: Vec<usize>) {
        self.groups = groups;
        self.rotation = Rotation::default();
        self.inverses.clear();
    }

    /// Turns W with the bodies, to R W R^T, since the matrix was factorised.
    pub fn turn(&mut self, rotation: Rotation) {
        self.rotation = rotation;
    }

    /// R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// The bodies that a constraint acts on.
    pub fn scope_of(&self, constraint: &Constraint) -> Scope {
        let terms = constraint.dofs.iter().flat_map(|&dof| self.map.row(dof));
        let mut bodies: Vec<usize> = terms.map(|term| self.bodies[term.0]).collect();
        bodies.sort_unstable();
        bodies.dedup();
        Scope::Bodies(bodies)
    }

    /// Computes the inverse of a scope at the unknowns of `constraints` too, if some are missing. That of all
    /// constraints is checked; the forces that those of bodies lead to must be.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        scope: &Scope,
        constraints: &[&Constraint],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        if !self.inverses.contains_key(scope) {
            self.inverses.insert(scope.clone(), Vec::new());
        }
        let Some(blocks) = self.inverses.get_mut(scope) else {
            return Ok(());
        };
        let dofs = constraints.iter().flat_map(|constraint| &constraint.dofs);
        let terms = dofs.flat_map(|&dof| self.map.row(dof));
        let unknowns = terms.map(|&(unknown, _)| (self.groups[unknown], unknown));
        let is_missing = |&(group, unknown): &(usize, usize)| {
            Block::of(blocks, group).is_none_or(|(_, block)| block.place(unknown).is_none())
        };
        let mut missing: Vec<(usize, usize)> = unknowns.filter(is_missing).collect();
        missing.sort_unstable();
        missing.dedup();
        let renewed = add_unknowns(blocks, &missing);
        if renewed.is_empty() {
            return Ok(());
        }
        let lists: Vec<&[usize]> = renewed
            .iter()
            .map(|&at| blocks[at].unknowns.as_slice())
            .collect();
        let inverses = match scope {
            Scope::All => solver.inverse_at(&lists)?,
            Scope::Bodies(_) => solver.unchecked_inverse_at(&lists),
        };
        for (&at, inverse) in renewed.iter().zip(inverses) {
            blocks[at].inverse = inverse;
        }
        Ok(())
    }

    /// T: what unknowns the dofs depend on.
    pub fn map(&self) -> &Transformation {
        &self.map
    }

    /// Entries of the rows of a constraint, turned back with R^T, that are not all zero; it must have
    /// been prepared in the scope.
    pub(super) fn entries(&self, scope: &Scope, constraint: &Constraint) -> Vec<UnknownEntry> {
        let rows = [&constraint.force_rows, constraint.derivative_rows()];
        let rows = rows.map(|rows| self.turned_back(&constraint.dofs, rows));
        let blocks = self.blocks(scope);
        let mut entries = Vec::with_capacity(constraint.dofs.len());
        for (k, &dof) in constraint.dofs.iter().enumerate() {
            let [force, derivative] =
                (rows.each_ref()).map(|rows| [rows.normal[k], rows.tangential[k]]);
            if force == [0.0; 2] && derivative == [0.0; 2] {
                continue;
            }
            for &(unknown, c) in self.map.row(dof) {
                if let Some((at, block)) = Block::of(blocks, self.groups[unknown])
                    && let Some(place) = block.place(unknown)
                {
                    entries.push(UnknownEntry {
                        place,
                        block: at,
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

    /// The blocks of a scope.
    fn blocks(&self, scope: &Scope) -> &[Block] {
        self.inverses.get(scope).map_or(&[], Vec::as_slice)
    }

    /// Number of blocks of a scope.
    pub(super) fn block_count(&self, scope: &Scope) -> usize {
        self.blocks(scope).len()
    }

    /// W (B_l T)^T of eq. (5.1) of some constraints l in the rows of a block: what their normal and
    /// tangential forces do to its unknowns.
    #[inline(always)]
    pub(super) fn respond<'q, S: Simd>(
        &self,
        simd: S,
        (scope, block): (&Scope, usize),
        constraints: impl ExactSizeIterator<Item = &'q [UnknownEntry]>,
        responses: &mut Responses,
    ) {
        let Block {
            unknowns, inverse, ..
        } = &self.blocks(scope)[block];
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

/// Adds unknowns that are missing, with their groups, increasing, to blocks, and says which blocks change.
fn add_unknowns(blocks: &mut Vec<Block>, missing: &[(usize, usize)]) -> Vec<usize> {
    let mut groups: Vec<usize> = Vec::new();
    for of_group in missing.chunk_by(|a, b| a.0 == b.0) {
        let group = of_group[0].0;
        let unknowns = of_group.iter().map(|&(_, unknown)| unknown);
        match blocks.binary_search_by_key(&group, |block| block.group) {
            Ok(at) => {
                blocks[at].unknowns.extend(unknowns);
                blocks[at].unknowns.sort_unstable();
            }
            Err(at) => {
                let block = Block {
                    group,
                    unknowns: unknowns.collect(),
                    inverse: Vec::new(),
                };
                blocks.insert(at, block);
            }
        }
        groups.push(group);
    }
    let places = groups.into_iter().filter_map(|g| Block::of(blocks, g));
    places.map(|(at, _)| at).collect()
}

/// What the forces of some constraints do to the unknowns of a block.
#[derive(Default)]
pub(super) struct Responses {
    /// A row for every unknown: all normal forces, then all tangential ones.
    rows: Vec<f64>,
    /// Entries of a row.
    width: usize,
    /// What normal and tangential force of one constraint do.
    sums: [Vec<f64>; 2],
}

/// (G_k T) Y of eq. (5.1) in the rows of a block: what the forces add to gap and slip of k.
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
