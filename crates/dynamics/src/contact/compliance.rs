//! Compliance at the contacts: the entries of an inverse W that the Delassus operator Q = G T W T^T B^T needs, W
//! being K*^-1 in a pass and M^-1 for impulses. See docs/theory/complementarity.md,
//! docs/theory/impacts.md and docs/numerics.md, Compliance of
//! the pairs.
//!
//! The two products of the Delassus operator, eq. (5.1): gaps and slips of constraints under forces at the unknowns of
//! a compliance block, and gaps and slips under contact forces. See docs/theory/complementarity.md, Problem of a pass.

use std::array::from_fn;
use std::collections::BTreeMap;

use pulp::Simd;

use super::constraint::{Constraint, Rows};
use super::keys::SlaveKey;
use crate::archive::{Archive, ArchiveError};
use crate::linear::{CheckedSolver, LinearError, Rotation, Transformation};

/// The inverse of a factorised matrix at the unknowns on which constraints act, with one block for each connected group
/// of unknowns: between groups the inverse is zero.
///
/// The inverse is computed when constraints first need it and kept until the matrix changes, so a Delassus matrix for
/// other normals needs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// The map T: dependence of the dofs on the unknowns.
    map: Transformation,
    /// Rotation R of the bodies since the matrix was factorised.
    rotation: Rotation,
    /// Connected group of every unknown in the matrix.
    groups: Vec<usize>,
    /// Body of every unknown: its connected group in the matrix of the elements alone.
    bodies: Vec<usize>,
    /// The inverses computed so far, for all constraints or for the constraints of some bodies.
    inverses: BTreeMap<ConstraintGroup, Vec<InverseBlock>>,
}

/// Constraints whose compliance is computed together (a scope).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum ConstraintGroup {
    /// All constraints.
    All,
    /// The constraints between the same bodies, which are given by increasing numbers.
    Bodies(Vec<usize>),
    /// A part, along the surfaces, of the constraints between the same bodies; the contact and the number of the part
    /// identify the part.
    Part(Vec<usize>, [usize; 2]),
}

/// The inverse at some unknowns of a group.
#[derive(Debug, Clone)]
struct InverseBlock {
    group: usize,
    /// Unknowns of the rows and columns, increasing.
    unknowns: Vec<usize>,
    /// Entries of the inverse, column by column.
    inverse: Vec<f64>,
}

impl InverseBlock {
    /// The block of a group and the place of this block among `blocks`, whose groups increase.
    fn of(blocks: &[InverseBlock], group: usize) -> Option<(usize, &InverseBlock)> {
        let at = blocks.binary_search_by_key(&group, |block| block.group);
        at.ok().map(|at| (at, &blocks[at]))
    }

    /// Row of an unknown; the search begins with the row `next`.
    fn place(&self, unknown: usize, next: usize) -> Option<usize> {
        match self.unknowns.get(next) {
            Some(&of_next) if of_next == unknown => Some(next),
            _ => self.unknowns.binary_search(&unknown).ok(),
        }
    }
}

impl Compliance {
    /// Compliance for the unknowns on which all dofs depend; `bodies` are the connected groups of the unknowns in the
    /// matrix of the elements.
    pub fn new(map: Transformation, bodies: Vec<usize>) -> Self {
        Compliance {
            map,
            rotation: Rotation::default(),
            groups: bodies.clone(),
            bodies,
            inverses: BTreeMap::new(),
        }
    }

    /// Forgets the inverse because the matrix has changed; its connected groups may have changed
    /// too.
    pub fn renew(&mut self, groups: Vec<usize>) {
        self.groups = groups;
        self.rotation = Rotation::default();
        self.inverses.clear();
    }

    /// Transfers the rotation and the unknowns at which the inverse is known. After the archive is read, the `solver`
    /// computes the inverse anew, with the same bits.
    ///
    /// # Errors
    /// The archive belongs to another model.
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

    /// Turns W with the bodies, W <- R W R^T; `angles` are their rotations since the matrix was
    /// factorised (rad).
    pub fn turn(&mut self, angles: &[f64], body_of: &[usize]) {
        self.rotation.set(angles, body_of);
    }

    /// Rotation R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// The part to which a constraint belongs among the constraints between the same bodies; a part has `nodes` slave
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

    /// Computes the inverse of a scope also at those unknowns of `constraints` where it is missing. The function checks
    /// the inverse of the scope of all constraints; with the scopes of bodies, the caller must check the resulting
    /// forces.
    ///
    /// # Errors
    /// Returns the error of the solver.
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

    /// The map T: dependence of the dofs on the unknowns.
    pub fn map(&self) -> &Transformation {
        &self.map
    }

    /// The mutable matrix T, whose rows for bodies that turn depend on the iterate.
    pub fn map_mut(&mut self) -> &mut Transformation {
        &mut self.map
    }

    /// Calls `add` with those entries of the rows of a constraint, turned back with R^T, that are not all zero. The
    /// constraint must have been prepared in the scope.
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

    /// Entries of the normal and of the tangential row at the dofs of a node, times the rotation R (docs/numerics.md,
    /// Turned factors).
    fn turned_back(&self, dofs: &[usize], rows: &Rows, node: usize) -> [[f64; 2]; 2] {
        let Rows { normal, tangential } = rows;
        let mut normal = [normal[2 * node], normal[2 * node + 1]];
        let mut tangential = [tangential[2 * node], tangential[2 * node + 1]];
        self.rotation.turn_row(dofs, &mut normal);
        self.rotation.turn_row(dofs, &mut tangential);
        [normal, tangential]
    }

    /// The blocks of the inverse of a scope.
    fn blocks(&self, scope: &ConstraintGroup) -> &[InverseBlock] {
        self.inverses.get(scope).map_or(&[], Vec::as_slice)
    }

    /// Number of blocks of the inverse of a scope.
    pub(super) fn block_count(&self, scope: &ConstraintGroup) -> usize {
        self.blocks(scope).len()
    }

    /// The inverse of one block of a scope, column by column, and the number of its unknowns.
    pub(super) fn inverse(&self, scope: &ConstraintGroup, block: usize) -> (&[f64], usize) {
        let block = &self.blocks(scope)[block];
        (&block.inverse, block.unknowns.len())
    }
}

/// Adds missing unknowns, given with their groups and increasing, to the blocks, and returns the blocks that change.
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
    /// Row of the unknown in the inverse of its block.
    pub place: usize,
    /// Number of the block of the unknown's group.
    pub block: usize,
    /// Entries of Bn T and Bt T.
    pub force: [f64; 2],
    /// Entries of Gn T and Gt T.
    pub derivative: [f64; 2],
}

/// The rows of some constraints at the unknowns of one block.
#[derive(Debug, Default)]
pub(super) struct GroupRows {
    /// The constraints, increasing, each with the end of its entries in the list.
    pub members: Vec<(usize, usize)>,
    entries: Vec<UnknownEntry>,
}

impl GroupRows {
    /// Removes all constraints.
    pub fn clear(&mut self) {
        self.members.clear();
        self.entries.clear();
    }

    /// Adds an entry of a constraint, which must be the last constraint of the list or come after
    /// it.
    pub fn push(&mut self, constraint: usize, entry: UnknownEntry) {
        self.entries.push(entry);
        let end = self.entries.len();
        match self.members.last_mut() {
            Some((last, at)) if *last == constraint => *at = end,
            _ => self.members.push((constraint, end)),
        }
    }

    /// The constraints by their numbers, each with its entries.
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

/// Gaps and slips of some constraints under unit forces at the unknowns of a block.
#[derive(Debug, Default)]
pub(super) struct Responses {
    /// A row for every unknown: the gaps of all constraints, then their slips.
    rows: Vec<f64>,
    /// Number of entries of a row.
    width: usize,
    /// Columns (over the unknowns) of the gaps and slips of some constraints.
    columns: [[Vec<f64>; 2]; TOGETHER],
}

/// Number of constraints whose responses are written to the rows of a block together.
const TOGETHER: usize = 4;

impl Responses {
    /// Sets the rows to W^T (G_k T)^T of eq. (5.1) for some constraints k of a block, with W = W^T. The `inverse` has
    /// `size` rows and columns.
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

    /// Writes the columns of `together` constraints, which begin with the `first`, to the rows of `count` constraints.
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

    /// Products (B_l T) Y of eq. (5.1) with the rows Y: gaps and slips of the constraints under a unit normal and a
    /// unit tangential force of the constraint l. With `adds` the result is added to the sums, otherwise the result
    /// replaces the sums.
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

/// Vectors of one length, one after the other, with the function for the two factors of each entry.
struct Terms<'a, F: Fn(&UnknownEntry) -> [f64; 2]> {
    vectors: &'a [f64],
    length: usize,
    factors: F,
}

impl<F: Fn(&UnknownEntry) -> [f64; 2]> Terms<'_, F> {
    /// The two sums of the vectors of some entries times their factors; the sums are added to the values there, or
    /// replace these values.
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

    /// [`Self::combine`] for exactly N entries.
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
