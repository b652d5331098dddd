//! Compliance at the contacts: the entries of an inverse W that the Delassus operator Q = G T W T^T B^T needs, W
//! being K*^-1 in a pass and M^-1 for impulses. See docs/theory/complementarity.md,
//! docs/theory/impacts.md and docs/numerics.md, Compliance of
//! the pairs.
//!
//! What gaps and slips of constraints take from forces at the unknowns of one block of the compliance, and
//! that of contact forces: the two products of the Delassus operator, eq. (5.1). See docs/theory/complementarity.md, Problem of a pass.

use std::array::from_fn;
use std::collections::BTreeMap;

use pulp::Simd;

use super::constraint::{Constraint, Rows};
use super::keys::SlaveKey;
use crate::archive::{Archive, ArchiveError};
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
    inverses: BTreeMap<ConstraintGroup, Vec<InverseBlock>>,
}

/// Constraints whose compliance is computed together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum ConstraintGroup {
    /// All of them.
    All,
    /// Those between the same bodies, given by increasing numbers.
    Bodies(Vec<usize>),
    /// A part of these along the surfaces, told by contact and part.
    Part(Vec<usize>, [usize; 2]),
}

/// The inverse at some unknowns of a group.
#[derive(Debug, Clone)]
struct InverseBlock {
    group: usize,
    /// Unknowns of the rows, increasing.
    unknowns: Vec<usize>,
    /// Column by column.
    inverse: Vec<f64>,
}

impl InverseBlock {
    /// The block of a group, among blocks with increasing groups, with its place.
    fn of(blocks: &[InverseBlock], group: usize) -> Option<(usize, &InverseBlock)> {
        let at = blocks.binary_search_by_key(&group, |block| block.group);
        at.ok().map(|at| (at, &blocks[at]))
    }

    /// Row of an unknown, which may be the `next` one.
    fn place(&self, unknown: usize, next: usize) -> Option<usize> {
        match self.unknowns.get(next) {
            Some(&of_next) if of_next == unknown => Some(next),
            _ => self.unknowns.binary_search(&unknown).ok(),
        }
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

    /// Transfers the rotation and the unknowns at which the inverse is known; what is read is computed anew by the
    /// `solver`, the same bits.
    ///
    /// # Errors
    /// What is read is of another model.
    pub fn transfer(
        &mut self,
        archive: &mut Archive,
        solver: &mut CheckedSolver,
    ) -> Result<(), ArchiveError> {
        self.map.transfer(archive)?;
        archive.transfer(&mut self.rotation)?;
        archive.transfer_values(&mut self.groups)?;
        let lists = |blocks: &Vec<InverseBlock>| {
            let list = |block: &InverseBlock| (block.group, block.unknowns.clone());
            blocks.iter().map(list).collect::<Vec<_>>()
        };
        let scopes = self.inverses.iter();
        let mut lists: Vec<_> = scopes
            .map(|(scope, blocks)| (scope.clone(), lists(blocks)))
            .collect();
        archive.transfer(&mut lists)?;
        if !archive.is_reading() {
            return Ok(());
        }
        self.inverses.clear();
        for (scope, blocks) in lists {
            let unknowns: Vec<&[usize]> = blocks.iter().map(|block| &block.1[..]).collect();
            let size = solver.matrix().size();
            if unknowns
                .iter()
                .flat_map(|list| *list)
                .any(|&unknown| unknown >= size)
            {
                return Err(ArchiveError::Size);
            }
            let inverses = match solver.is_factorized() {
                true => solver.unchecked_inverse_at(&unknowns),
                false => vec![Vec::new(); blocks.len()],
            };
            let block = |((group, unknowns), inverse)| InverseBlock {
                group,
                unknowns,
                inverse,
            };
            let blocks = blocks.into_iter().zip(inverses).map(block);
            self.inverses.insert(scope, blocks.collect());
        }
        Ok(())
    }

    /// Turns W with the bodies, to R W R^T, by their angles since the matrix was factorised (rad).
    pub fn turn(&mut self, angles: &[f64], body_of: &[usize]) {
        self.rotation.set(angles, body_of);
    }

    /// R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// The part of the constraints between the same bodies that a constraint belongs to, where parts have so many slave
    /// nodes.
    pub fn part_of(&self, constraint: &Constraint, nodes: usize) -> ConstraintGroup {
        let SlaveKey { contact, slave } = constraint.key.slave();
        match self.scope_of(constraint) {
            ConstraintGroup::Bodies(bodies) => {
                ConstraintGroup::Part(bodies, [contact, slave / nodes])
            }
            other => other,
        }
    }

    /// The bodies that a constraint acts on.
    pub fn scope_of(&self, constraint: &Constraint) -> ConstraintGroup {
        let terms = constraint.dofs.iter().flat_map(|&dof| self.map.row(dof));
        let mut bodies: Vec<usize> = terms.map(|term| self.bodies[term.0]).collect();
        bodies.sort_unstable();
        bodies.dedup();
        ConstraintGroup::Bodies(bodies)
    }

    /// Computes the inverse of a scope at the unknowns of `constraints` too, if some are missing. That of all
    /// constraints is checked; the forces that those of bodies lead to must be.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        scope: &ConstraintGroup,
        constraints: &[&Constraint],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        if !self.inverses.contains_key(scope) {
            self.inverses.insert(scope.clone(), Vec::new());
        }
        let Some(blocks) = self.inverses.get_mut(scope) else {
            return Ok(());
        };
        let mut missing: Vec<(usize, usize)> = Vec::new();
        let mut place = 0;
        for &dof in constraints.iter().flat_map(|constraint| &constraint.dofs) {
            for &(unknown, _) in self.map.row(dof) {
                let group = self.groups[unknown];
                let found =
                    InverseBlock::of(blocks, group).and_then(|(_, b)| b.place(unknown, place + 1));
                match found {
                    Some(found) => place = found,
                    None => missing.push((group, unknown)),
                }
            }
        }
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
            ConstraintGroup::All => solver.inverse_at(&lists)?,
            ConstraintGroup::Bodies(_) | ConstraintGroup::Part(..) => {
                solver.unchecked_inverse_at(&lists)
            }
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

    /// T, of which the rows of bodies that turn change with the iterate.
    pub fn map_mut(&mut self) -> &mut Transformation {
        &mut self.map
    }

    /// Calls `add` with the entries of the rows of a constraint, turned back with R^T, that are not all
    /// zero; it must have been prepared in the scope.
    pub(super) fn for_each_entry(
        &self,
        scope: &ConstraintGroup,
        constraint: &Constraint,
        mut add: impl FnMut(UnknownEntry),
    ) {
        let (force_rows, derivative_rows) = (&constraint.force_rows, constraint.derivative_rows());
        let have_other = constraint.other_derivative_rows.is_some();
        let blocks = self.blocks(scope);
        let mut place = 0;
        for (node, dofs) in constraint.dofs.chunks_exact(2).enumerate() {
            let of_force = self.turned_back(dofs, force_rows, node);
            let of_derivative = match have_other {
                true => self.turned_back(dofs, derivative_rows, node),
                false => of_force,
            };
            for (i, &dof) in dofs.iter().enumerate() {
                let force = [of_force[0][i], of_force[1][i]];
                let derivative = [of_derivative[0][i], of_derivative[1][i]];
                if force == [0.0; 2] && derivative == [0.0; 2] {
                    continue;
                }
                let terms = self.map.row(dof).iter().zip(self.map.derivative_row(dof));
                for (&(unknown, c), (_, of_derivative)) in terms {
                    if let Some((at, block)) = InverseBlock::of(blocks, self.groups[unknown])
                        && let Some(found) = block.place(unknown, place + 1)
                    {
                        place = found;
                        add(UnknownEntry {
                            place,
                            block: at,
                            force: force.map(|entry| c * entry),
                            derivative: derivative.map(|entry| of_derivative * entry),
                        });
                    }
                }
            }
        }
    }

    /// Entries of normal and tangential row at the dofs of a node, times R (docs/numerics.md, Turned factors).
    fn turned_back(&self, dofs: &[usize], rows: &Rows, node: usize) -> [[f64; 2]; 2] {
        let Rows { normal, tangential } = rows;
        let mut normal = [normal[2 * node], normal[2 * node + 1]];
        let mut tangential = [tangential[2 * node], tangential[2 * node + 1]];
        self.rotation.turn_row(dofs, &mut normal);
        self.rotation.turn_row(dofs, &mut tangential);
        [normal, tangential]
    }

    /// The blocks of a scope.
    fn blocks(&self, scope: &ConstraintGroup) -> &[InverseBlock] {
        self.inverses.get(scope).map_or(&[], Vec::as_slice)
    }

    /// Number of blocks of a scope.
    pub(super) fn block_count(&self, scope: &ConstraintGroup) -> usize {
        self.blocks(scope).len()
    }

    /// The inverse at the unknowns of a block of a scope, column by column, and their number.
    pub(super) fn inverse(&self, scope: &ConstraintGroup, block: usize) -> (&[f64], usize) {
        let block = &self.blocks(scope)[block];
        (&block.inverse, block.unknowns.len())
    }
}

/// Adds unknowns that are missing, with their groups, increasing, to blocks, and says which blocks change.
fn add_unknowns(blocks: &mut Vec<InverseBlock>, missing: &[(usize, usize)]) -> Vec<usize> {
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
                let block = InverseBlock {
                    group,
                    unknowns: unknowns.collect(),
                    inverse: Vec::new(),
                };
                blocks.insert(at, block);
            }
        }
        groups.push(group);
    }
    let places = groups
        .into_iter()
        .filter_map(|g| InverseBlock::of(blocks, g));
    places.map(|(at, _)| at).collect()
}

/// The rows of a constraint at one unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    /// Row of the inverse, in its block.
    pub place: usize,
    /// Its block, that of the group of the unknown.
    pub block: usize,
    /// Entries of Bn T and Bt T.
    pub force: [f64; 2],
    /// Entries of Gn T and Gt T.
    pub derivative: [f64; 2],
}

/// The rows of some constraints at the unknowns of one block.
#[derive(Debug, Default)]
pub(super) struct GroupRows {
    /// The constraints, increasing, each with the end of its entries.
    pub members: Vec<(usize, usize)>,
    entries: Vec<UnknownEntry>,
}

impl GroupRows {
    /// Removes all constraints.
    pub fn clear(&mut self) {
        self.members.clear();
        self.entries.clear();
    }

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

/// What forces at the unknowns of a block do to gaps and slips of some constraints.
#[derive(Debug, Default)]
pub(super) struct Responses {
    /// A row for every unknown: all gaps, then all slips.
    rows: Vec<f64>,
    /// Entries of a row.
    width: usize,
    /// Gap and slip of some constraints, over the unknowns.
    columns: [[Vec<f64>; 2]; TOGETHER],
}

/// Constraints whose responses are written to the rows together.
const TOGETHER: usize = 4;

impl Responses {
    /// W^T (G_k T)^T of eq. (5.1) of some constraints k, in the rows of a block, with W = W^T. The `inverse`
    /// has `size` rows and columns.
    #[inline(always)]
    pub fn set<S: Simd>(
        &mut self,
        simd: S,
        (inverse, size): (&[f64], usize),
        constraints: &[(usize, &[UnknownEntry])],
    ) {
        let count = constraints.len();
        self.width = 2 * count;
        self.rows.resize(size * self.width, 0.0);
        let terms = Terms {
            vectors: inverse,
            length: size,
            factors: |entry| entry.derivative,
        };
        for (number, together) in constraints.chunks(TOGETHER).enumerate() {
            for ((_, entries), sums) in together.iter().zip(&mut self.columns) {
                terms.combine(simd, entries, resized(sums, size), false);
            }
            let first = number * TOGETHER;
            self.write_rows(first, [together.len(), count]);
        }
    }

    /// Writes the columns of so many constraints to the places from `first` on, of so many in all.
    #[inline(always)]
    fn write_rows(&mut self, first: usize, [together, count]: [usize; 2]) {
        let size = self.rows.len() / self.width;
        for i in 0..2 {
            let columns: [&[f64]; TOGETHER] = from_fn(|l| self.columns[l][i].as_slice());
            let at = i * count + first;
            if together < TOGETHER {
                for (unknown, row) in self.rows.chunks_exact_mut(self.width).enumerate() {
                    let row = &mut row[at..at + together];
                    (row.iter_mut().zip(&columns)).for_each(|(row, column)| *row = column[unknown]);
                }
                continue;
            }
            let tiles = columns.map(|column| column[..size].as_chunks::<TOGETHER>());
            let mut rows = self.rows.chunks_exact_mut(self.width);
            for tile in 0..size / TOGETHER {
                let tile: [[f64; TOGETHER]; TOGETHER] = from_fn(|l| tiles[l].0[tile]);
                for unknown in 0..TOGETHER {
                    if let Some(row) = rows.next() {
                        let row = &mut row[at..at + TOGETHER];
                        row.copy_from_slice(&tile.map(|column| column[unknown]));
                    }
                }
            }
            for (unknown, row) in rows.enumerate() {
                let row = &mut row[at..at + TOGETHER];
                row.copy_from_slice(&tiles.map(|tile| tile.1[unknown]));
            }
        }
    }

    /// (B_l T) Y of eq. (5.1), Y being the rows: what normal and tangential force of l add to gaps and slips of
    /// the constraints; added to what there is, or written.
    #[inline(always)]
    pub fn product<S: Simd>(&self, simd: S, l: &[UnknownEntry], sums: [&mut [f64]; 2], adds: bool) {
        let terms = Terms {
            vectors: &self.rows,
            length: self.width,
            factors: |entry| entry.force,
        };
        terms.combine(simd, l, sums, adds);
    }
}

/// Two vectors of the given length.
#[inline(always)]
fn resized(vectors: &mut [Vec<f64>; 2], length: usize) -> [&mut [f64]; 2] {
    vectors.each_mut().map(|vector| {
        vector.resize(length, 0.0);
        vector.as_mut_slice()
    })
}

/// Vectors of one length, one after the other, and the two factors that an entry has for the vector of its place.
struct Terms<'a, F: Fn(&UnknownEntry) -> [f64; 2]> {
    vectors: &'a [f64],
    length: usize,
    factors: F,
}

impl<F: Fn(&UnknownEntry) -> [f64; 2]> Terms<'_, F> {
    /// The two sums of the vectors of some entries times their factors, added to what there is, or written.
    #[inline(always)]
    fn combine<S: Simd>(
        &self,
        simd: S,
        entries: &[UnknownEntry],
        [first, second]: [&mut [f64]; 2],
        mut adds: bool,
    ) {
        let (fours, rest) = entries.as_chunks::<4>();
        for four in fours {
            self.combine_some(simd, four, [first, second], adds);
            adds = true;
        }
        match rest {
            [a] => self.combine_some(simd, &[*a], [first, second], adds),
            [a, b] => self.combine_some(simd, &[*a, *b], [first, second], adds),
            [a, b, c] => self.combine_some(simd, &[*a, *b, *c], [first, second], adds),
            _ if adds => {}
            _ => [first, second].into_iter().for_each(|sum| sum.fill(0.0)),
        }
    }

    /// [`Self::combine`] for N entries.
    #[inline(always)]
    fn combine_some<S: Simd, const N: usize>(
        &self,
        simd: S,
        entries: &[UnknownEntry; N],
        [first, second]: [&mut [f64]; 2],
        adds: bool,
    ) {
        let length = self.length;
        let mut factors = [[simd.splat_f64s(0.0); 2]; N];
        let mut vectors = [S::as_simd_f64s(&[]); N];
        for ((entry, factors), vector) in entries.iter().zip(&mut factors).zip(&mut vectors) {
            let [a, b] = (self.factors)(entry);
            *factors = [simd.splat_f64s(a), simd.splat_f64s(b)];
            *vector = S::as_simd_f64s(&self.vectors[entry.place * length..][..length]);
        }
        let (first, first_rest) = S::as_mut_simd_f64s(&mut first[..length]);
        let (second, second_rest) = S::as_mut_simd_f64s(&mut second[..length]);
        let zero = simd.splat_f64s(0.0);
        for (i, (first, second)) in first.iter_mut().zip(second).enumerate() {
            let mut sums = if adds { [*first, *second] } else { [zero; 2] };
            for ([a, b], vector) in factors.iter().zip(&vectors) {
                sums[0] = simd.mul_add_e_f64s(*a, vector.0[i], sums[0]);
                sums[1] = simd.mul_add_e_f64s(*b, vector.0[i], sums[1]);
            }
            [*first, *second] = sums;
        }
        if !first_rest.is_empty() {
            let mut sums = match adds {
                true => [&*first_rest, &*second_rest].map(|rest| simd.partial_load_f64s(rest)),
                false => [zero; 2],
            };
            for ([a, b], vector) in factors.iter().zip(&vectors) {
                let rest = simd.partial_load_f64s(vector.1);
                sums[0] = simd.mul_add_e_f64s(*a, rest, sums[0]);
                sums[1] = simd.mul_add_e_f64s(*b, rest, sums[1]);
            }
            simd.partial_store_f64s(first_rest, sums[0]);
            simd.partial_store_f64s(second_rest, sums[1]);
        }
    }
}
