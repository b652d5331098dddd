//! Compliance at the contacts: the entries of an inverse W that the Delassus operator
//! Q = G T W T^T B^T needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of
//! docs/theory.md.

use std::collections::BTreeMap;

use super::constraint::{Constraint, Rows};
use super::responses::UnknownEntry;
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

    /// Turns W with the bodies, to R W R^T, by their angles since the matrix was factorised (rad).
    pub fn turn(&mut self, angles: &[f64], body_of: &[usize]) {
        self.rotation.set(angles, body_of);
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
        let mut missing: Vec<(usize, usize)> = Vec::new();
        let mut place = 0;
        for &dof in constraints.iter().flat_map(|constraint| &constraint.dofs) {
            for &(unknown, _) in self.map.row(dof) {
                let group = self.groups[unknown];
                let found = Block::of(blocks, group).and_then(|(_, b)| b.place(unknown, place + 1));
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

    /// Calls `add` with the entries of the rows of a constraint, turned back with R^T, that are not all
    /// zero; it must have been prepared in the scope.
    pub(super) fn for_each_entry(
        &self,
        scope: &Scope,
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
                for &(unknown, c) in self.map.row(dof) {
                    if let Some((at, block)) = Block::of(blocks, self.groups[unknown])
                        && let Some(found) = block.place(unknown, place + 1)
                    {
                        place = found;
                        add(UnknownEntry {
                            place,
                            block: at,
                            force: force.map(|entry| c * entry),
                            derivative: derivative.map(|entry| c * entry),
                        });
                    }
                }
            }
        }
    }

    /// Entries of normal and tangential row at the dofs of a node, times R, eq. (4.20).
    fn turned_back(&self, dofs: &[usize], rows: &Rows, node: usize) -> [[f64; 2]; 2] {
        let Rows { normal, tangential } = rows;
        let mut normal = [normal[2 * node], normal[2 * node + 1]];
        let mut tangential = [tangential[2 * node], tangential[2 * node + 1]];
        self.rotation.turn_row(dofs, &mut normal);
        self.rotation.turn_row(dofs, &mut tangential);
        [normal, tangential]
    }

    /// The blocks of a scope.
    fn blocks(&self, scope: &Scope) -> &[Block] {
        self.inverses.get(scope).map_or(&[], Vec::as_slice)
    }

    /// Number of blocks of a scope.
    pub(super) fn block_count(&self, scope: &Scope) -> usize {
        self.blocks(scope).len()
    }

    /// The inverse at the unknowns of a block of a scope, column by column, and their number.
    pub(super) fn inverse(&self, scope: &Scope, block: usize) -> (&[f64], usize) {
        let block = &self.blocks(scope)[block];
        (&block.inverse, block.unknowns.len())
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
